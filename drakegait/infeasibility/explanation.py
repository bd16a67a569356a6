"""What was found about a study without a walk, as data and as sentences."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

from drakegait.gait import Gait
from drakegait.infeasibility.place import Place
from drakegait.study import GaitStudy

CONFLICT, WALKS, UNDECIDED, UNKNOWN = "conflict", "walks", "undecided", "unknown"
"""Verdicts: laws cannot all hold; there is a walk after all; all laws hold in a walk from which no
solve converged; ended before anything was known."""

_ENDED = {
    "time_limit": "The time for the explanation ran out",
    "interrupted": "The explanation was interrupted",
}


@dataclass(frozen=True, eq=False)
class Remedy:
    """A change of the study with which a walk was found.

    Attributes:
        words: the change, to be read after "feasible".
        study: the changed study.
        gait: its walk: converged, check passed.
    """

    words: str
    study: GaitStudy
    gait: Gait


@dataclass(frozen=True, eq=False)
class Explanation:
    """Why a study has no walk.

    Attributes:
        verdict: `"conflict"`, `"walks"`, `"undecided"` or `"unknown"`.
        conflict: names of the laws that cannot all hold.
        stated: in words, those of them that the study states.
        others: in words, those that hold for every walk.
        smallest: whether none of them can be left out, as far as local solves can tell.
        unique: whether every conflict of this study contains all of them.
        place: where the walk has to break a law, first of all those of muscles; None if unknown.
        remedies: changes that were verified by solving, at most two.
        tried: changes in words with which no walk was found, and why in brackets; for
            `"undecided"` why alone.
        settled: whether the walk that breaks the laws least was found to its optimum.
        gait: the walk that was found after all; None for other verdicts.
        ended: `"time_limit"` or `"interrupted"` if it ended early, else None.
        wall_time: seconds.
    """

    verdict: str
    conflict: tuple[str, ...] = ()
    stated: tuple[str, ...] = ()
    others: tuple[str, ...] = ()
    smallest: bool = False
    unique: bool = False
    place: Place | None = None
    remedies: tuple[Remedy, ...] = ()
    tried: tuple[str, ...] = ()
    settled: bool = True
    gait: Gait | None = None
    ended: str | None = None
    wall_time: float = 0.0

    @property
    def sentences(self) -> tuple[str, ...]:
        """What to tell, one sentence each."""
        found: list[str] = []
        if self.verdict == WALKS:
            found.append(
                "Feasible after all: with more iterations or from another start a walk was found "
                "that meets every law."
            )
        elif self.verdict == UNDECIDED:
            why = f" ({self.tried[-1]})" if self.tried else ""
            found.append(
                "All laws can be held together, as far as can be told, but no walk was found "
                f"from there{why}: try --starts, more nodes or more iterations."
            )
        elif self.verdict == CONFLICT:
            found += self._of_conflict()
        if self.ended is not None:
            known = "" if found else "; nothing is known yet"
            found.append(f"{_ENDED[self.ended]}{known}.")
        return tuple(found)

    def _of_conflict(self) -> list[str]:
        found = [] if self.place is None else [f"{self.place.sentence}."]
        if self.conflict:
            stated = ", ".join(self.stated) or "laws that hold for every walk"
            others = f"; with them: {', '.join(self.others)}" if self.others and self.stated else ""
            if not self.stated:
                stated += f": {', '.join(self.others)}"
            least = " (give up any one, and the rest can hold)" if self.smallest else ""
            found.append(f"Cannot all hold: {stated}{others}{least}.")
            if self.smallest and not self.unique:
                found.append("There are further conflicts beside this one.")
            if not self.settled:
                found.append(
                    "This is a hint, not more: the walk that breaks the laws least was not found "
                    "to its optimum."
                )
        if self.remedies:
            words = " or ".join(remedy.words for remedy in self.remedies)
            found.append(f"Feasible {words} (solved again, check passed).")
        elif self.ended is None:
            tried = f"; tried: {', '.join(self.tried)}" if self.tried else ""
            found.append(f"No single change that makes it feasible was found{tried}.")
        return found

    def __str__(self) -> str:
        return " ".join(self.sentences)

    def to_dict(self) -> dict[str, Any]:
        """As plain types that JSON can hold, without the gaits."""
        place = self.place
        return {
            "verdict": self.verdict,
            "sentences": list(self.sentences),
            "conflict": list(self.conflict),
            "smallest": self.smallest,
            "unique": self.unique,
            "place": None if place is None else {
                "law": place.law,
                "what": place.what,
                "when": place.when,
                "percent": None if math.isnan(place.percent) else place.percent,
                "missing": place.missing,
                "unit": place.unit,
                "saturated_muscles": list(place.muscles),
            },
            "remedies": [remedy.words for remedy in self.remedies],
            "tried": list(self.tried),
            "settled": self.settled,
            "ended": self.ended,
            "wall_time_s": self.wall_time,
        }  # fmt: skip
