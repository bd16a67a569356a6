"""Solves that share the time of one explanation, and the words about them."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

from drakegait.gait import Gait
from drakegait.infeasibility.conflict import Relaxation
from drakegait.solve import solve
from drakegait.solvers.monitor import Monitor, Progress
from drakegait.solvers.options import SolverOptions
from drakegait.study import GaitStudy

_FOR_CONFLICT = 0.6  # of the time; the rest is for remedies
_SHARE, _LEAST_SHARE = 0.25, 30.0  # of the time that is left, and [s], for one solve
_LEAST_TIME = 1.0  # [s] without which no solve is begun

Report = Callable[[str, Progress | None], None]


class Attempts:
    """Begins solves while there is time for them.

    Args:
        time_limit: for all of them [s].
        options: of solves for walks.
        report: told what is being tried, and of the progress of each solve; or None.

    Attributes:
        monitor: of all solves; a context, see `Monitor`.
        elastic: of those for the conflict, which may take a share of the time.
    """

    def __init__(self, time_limit: float, options: SolverOptions, report: Report | None):
        self._options, self._report = options, report
        self._task, self._interrupted = "", False
        self.monitor = Monitor(time_limit, self._progress)
        self.elastic = Monitor(_FOR_CONFLICT * time_limit, self._progress)

    def _progress(self, progress: Progress) -> None:
        if self._report is not None:
            self._report(self._task, replace(progress, remaining=self.monitor.remaining))

    def say(self, task: str) -> None:
        """Tell what is tried next."""
        self._task = task
        if self._report is not None:
            self._report(task, None)

    @property
    def ended(self) -> str | None:
        """`"interrupted"`, `"time_limit"` or None."""
        if self._interrupted or "interrupted" in (
            self.monitor.stop_reason, self.elastic.stop_reason,
        ):  # fmt: skip
            return "interrupted"
        return "time_limit" if self.monitor.remaining < _LEAST_TIME else None

    def conflict_ended(self) -> bool:
        """Whether no further solve for the conflict may begin."""
        return self.ended is not None or self.elastic.stop_reason is not None

    def walk(
        self, study: GaitStudy, guesses: Sequence[Gait | None], share: float = _SHARE
    ) -> tuple[Gait | None, str]:
        """A walk of `study`, converged and with its check passed, and else why there is none.

        Args:
            share: of the time that is left, for each solve.
        """
        why = "no time was left"
        for guess in guesses:
            if self.ended is not None:
                break
            left = self.monitor.remaining
            time_limit = min(max(share * left, _LEAST_SHARE), max(left, _LEAST_TIME))
            options = self._options.replace(time_limit=time_limit)
            gait = solve(study, guess=guess, options=options, report=self._progress)
            self._interrupted |= gait.outcome.status == "interrupted"
            if not gait.converged:
                why = "did not converge"
            elif gait.report is None or not gait.report.passed:
                items = () if gait.report is None else gait.report.items
                failed = ", ".join(item.label for item in items if not item.passed)
                why = f"converged, but its check failed: {failed}"
            else:
                return gait, ""
        return None, why

    def holding(self, study: GaitStudy, near: Gait) -> Gait | None:
        """A motion near another one that holds all laws of `study`, not optimal; None if there is
        none."""
        relaxation = Relaxation(study, near.values, self.monitor, near=True)
        least = relaxation.least()
        return None if least.broken else relaxation.gait(least)
