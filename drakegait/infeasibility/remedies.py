"""The mildest change with which a walk is found.

Whether the laws can hold is asked of the elastic program, which answers in a few seconds also
where they cannot; what it affirms is solved, and counts only if that converges and passes.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from drakegait.gait import Gait
from drakegait.infeasibility.attempts import Attempts
from drakegait.infeasibility.explanation import Remedy
from drakegait.infeasibility.knobs import Knob, changed_study
from drakegait.study import GaitStudy

_MAX_HALVINGS = 3  # between a change that is too small and one that is enough


@dataclass(frozen=True, eq=False)
class _Candidate:
    """A value of a knob with which all laws can hold, as far as elastic solves tell."""

    value: float
    study: GaitStudy
    near: Gait


class RemedySearch:
    """The search along one knob.

    Args:
        knob: what may change.
        near: the walk that gives up the knob's law.
        attempts: by which to solve.

    Attributes:
        why: what came of the last value, once none was found.
    """

    def __init__(self, knob: Knob, near: Gait, attempts: Attempts):
        self._knob, self._near, self._attempts = knob, near, attempts
        self.why = ""

    def run(self) -> Remedy | None:
        """The remedy; None if there is none or no time."""
        for candidate in self._candidates():
            words = self._knob.words(candidate.value)
            self._attempts.say(f"solving {words}")
            gait, why = self._attempts.walk(candidate.study, (candidate.near,))
            if gait is not None:
                return Remedy(words, candidate.study, gait)
            if self._attempts.ended is not None:
                break
            self.why = f"{words} ({why})"
        return None

    def _candidates(self) -> Iterator[_Candidate]:
        """Values that may do, mildest first."""
        failed = self._knob.now
        for value in self._knob.values:
            found = self._asked(value, self._near)
            if found is not None:
                yield from self._milder(failed, found)
            failed = value

    def _milder(self, failed: float, enough: _Candidate) -> list[_Candidate]:
        """Values from the mildest that may do up to `enough`, by halving."""
        found = [enough]
        for _ in range(_MAX_HALVINGS):
            value = self._knob.middle(failed, found[0].value)
            if value is None:
                break
            milder = self._asked(value, found[0].near)
            if milder is None:
                failed = value
            else:
                found.insert(0, milder)
        return found

    def _asked(self, value: float, near: Gait) -> _Candidate | None:
        """Whether all laws can hold with this value."""
        study = changed_study(self._knob, value)
        if study is None or self._attempts.ended is not None:
            return None
        words = self._knob.words(value)
        self._attempts.say(f"asking whether all laws can hold {words}")
        walk = self._attempts.holding(study, near)
        if walk is None:
            self.why = f"{words} (laws break)"
            return None
        return _Candidate(value, study, walk)
