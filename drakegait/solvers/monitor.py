"""Watches a running solve: progress, the best gait so far, time limit, Ctrl-C."""

from __future__ import annotations

import signal
import threading
import time
from collections.abc import Callable
from dataclasses import dataclass
from types import TracebackType

import numpy as np

from drakegait.program.gait_program import GaitProgram


@dataclass(frozen=True)
class Progress:
    """State of a solve, for one line on the screen.

    Attributes:
        round: 1 for the first solve, more with more nodes or control points, or moved events.
        iteration: of this round.
        cost: f of eq. (13).
        violation: worst violation in units of the row's tolerance or size.
        worst: name of that row, empty if all rows hold.
        elapsed, remaining: [s] since the start, to the time limit.
    """

    round: int
    iteration: int
    cost: float
    violation: float
    worst: str
    elapsed: float
    remaining: float


class StopSolve(Exception):
    """Raised inside a solver's callbacks to end it; `reason` is a status word."""

    def __init__(self, reason: str):
        super().__init__(reason)
        self.reason = reason


class Monitor:
    """Follows the iterates of one or several solves.

    Use as a context manager: inside, Ctrl-C sets `stop_reason` instead of raising.

    Args:
        time_limit: for everything inside [s].
        report: called with a `Progress` at most every `interval` seconds.
    """

    def __init__(
        self,
        time_limit: float,
        report: Callable[[Progress], None] | None = None,
        interval: float = 0.25,
    ):
        self._limit, self._report, self._interval = time_limit, report, interval
        self._start = time.monotonic()
        self._last_report = -np.inf
        self._interrupted = False
        self._previous_handler = None
        self.round = 0
        self.iteration = 0
        self.program: GaitProgram | None = None
        self.best: np.ndarray | None = None
        self._best_rank = (np.inf, np.inf)

    def __enter__(self) -> Monitor:
        if threading.current_thread() is threading.main_thread():
            self._previous_handler = signal.signal(signal.SIGINT, self._interrupt)
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        if self._previous_handler is not None:
            signal.signal(signal.SIGINT, self._previous_handler)

    def _interrupt(self, *_: object) -> None:
        self._interrupted = True

    def begin(self, program: GaitProgram) -> None:
        """Start the next round with a (new) program; the best iterate starts afresh."""
        self.program = program
        self.round += 1
        self.iteration = 0
        self.best, self._best_rank = None, (np.inf, np.inf)

    def go_on(self, program: GaitProgram, x: np.ndarray) -> None:
        """The round goes on with a program of the same unknowns and rows, from `x`.

        Earlier iterates may lie outside its bounds, so that the best starts afresh.
        """
        self.program = program
        self.best, self._best_rank = None, (np.inf, np.inf)
        self.step(x, self.iteration)

    @property
    def elapsed(self) -> float:
        """Seconds since the monitor was made."""
        return time.monotonic() - self._start

    @property
    def remaining(self) -> float:
        """Seconds left to the time limit."""
        return self._limit - self.elapsed

    @property
    def stop_reason(self) -> str | None:
        """`"interrupted"`, `"time_limit"` or None."""
        if self._interrupted:
            return "interrupted"
        return "time_limit" if self.remaining <= 0.0 else None

    def step(self, x: np.ndarray, iteration: int | None = None) -> str | None:
        """Take note of an iterate; returns why the solve should stop, or None."""
        program = self.program
        assert program is not None
        self.iteration = self.iteration + 1 if iteration is None else iteration
        cost, violations = program.cost(x), program.violations(x)
        violation = float(violations.max())
        # Below one per cent of a tolerance a lower cost counts, above it the violation.
        rank = (max(violation, 0.01), cost)
        if np.isfinite(cost) and np.isfinite(violation) and rank < self._best_rank:
            self.best, self._best_rank = x.copy(), rank
        now = self.elapsed
        if self._report is not None and now - self._last_report >= self._interval:
            self._last_report = now
            self._report(self._progress(x, now))
        return self.stop_reason

    def _progress(self, x: np.ndarray, now: float) -> Progress:
        """Of the walk in `x`; where laws may break at a price, without the price."""
        assert self.program is not None
        walk, x = self.program.as_walk(x)
        violations = walk.violations(x)
        worst = int(np.argmax(violations))
        violation = float(violations[worst])
        name = walk.row_names[worst] if violation > 1e-3 else ""
        return Progress(
            self.round, self.iteration, walk.cost(x), violation, name, now, self._limit - now
        )
