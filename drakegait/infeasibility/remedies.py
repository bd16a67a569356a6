"""The mildest change with which a walk is found.

Whether the laws can hold is asked of the elastic program, which answers in a few seconds also
where they cannot; what it affirms is solved, and counts only if that converges and passes. The
first change that is affirmed comes first, so that there is a remedy soon, then a milder one.
"""

from __future__ import annotations

from dataclasses import dataclass

from drakegait.gait import Gait
from drakegait.infeasibility.attempts import Attempts
from drakegait.infeasibility.explanation import Remedy
from drakegait.infeasibility.knobs import Knob, changed_study
from drakegait.study import GaitStudy

MOST_FAILURES = 3  # solves for one law: more of them only cost time
_FIRST_SHARE, _MILDER_SHARE = 0.5, 0.2  # of the time left, for one solve
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
        failures: solves for this law that found nothing so far.

    Attributes:
        failures: these and further ones.
        why: what came of the last value, once none was found.
    """

    def __init__(self, knob: Knob, near: Gait, attempts: Attempts, failures: int = 0):
        self._knob, self._near, self._attempts = knob, near, attempts
        self.failures, self.why = failures, ""

    def run(self) -> Remedy | None:
        """The remedy; None if there is none or no time."""
        failed = self._knob.now
        for value in self._knob.values:
            enough = self._asked(value, self._near)
            remedy = None if enough is None else self._solved(enough, _FIRST_SHARE)
            if enough is not None and remedy is not None:
                return self._milder(failed, enough) or remedy
            if self.failures >= MOST_FAILURES or self._attempts.ended is not None:
                break
            failed = value
        return None

    def _milder(self, failed: float, enough: _Candidate) -> Remedy | None:
        """The mildest change between `failed` and `enough` that may do, if it has a walk.

        It is at the limit of what can be, where solves are hard and checks fail.
        """
        mildest = self._mildest(failed, enough)
        return None if mildest is enough else self._solved(mildest, _MILDER_SHARE)

    def _solved(self, candidate: _Candidate, share: float) -> Remedy | None:
        """The walk with this change, if there is one; may take so much of the time left."""
        if self.failures >= MOST_FAILURES or self._attempts.ended is not None:
            return None
        words = self._knob.words(candidate.value)
        self._attempts.say(f"solving {words}")
        gait, why = self._attempts.walk(candidate.study, (candidate.near,), share)
        if gait is not None:
            return Remedy(words, candidate.study, gait)
        self.failures += 1
        self.why = f"{words} ({why})"
        return None

    def _mildest(self, failed: float, enough: _Candidate) -> _Candidate:
        """The mildest value that may do, between `failed` and `enough`, by halving."""
        for _ in range(_MAX_HALVINGS):
            value = self._knob.middle(failed, enough.value)
            if value is None:
                break
            milder = self._asked(value, enough.near)
            if milder is None:
                failed = value
            else:
                enough = milder
        return enough

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
