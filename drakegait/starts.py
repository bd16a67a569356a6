"""The best of several solves that started from different points."""

from __future__ import annotations

import dataclasses
import time
from collections.abc import Callable, Sequence

import numpy as np

from drakegait.gait import Gait
from drakegait.program.starts import Start
from drakegait.solvers.outcome import StartRecord


def best_of(
    starts: Sequence[Start], attempt: Callable[[Start], Gait], stopped: Callable[[], bool]
) -> Gait:
    """Try one start after the other and keep the gait of the lowest cost.

    A converged gait is better than any other. Its outcome lists all starts, the best included.

    Args:
        starts: where to start from.
        attempt: solves from one of them.
        stopped: whether the time is up or the user has had enough; then the rest is left out.
    """
    best: Gait | None = None
    records = []
    for start in starts:
        began = time.monotonic()
        gait = attempt(start)
        records.append(_record(start, gait, time.monotonic() - began))
        if best is None or _rank(gait) < _rank(best):
            best = gait
        if stopped():
            break
    assert best is not None
    outcome = dataclasses.replace(best.outcome, starts=tuple(records))
    return dataclasses.replace(best, outcome=outcome)


def _rank(gait: Gait) -> tuple[bool, float]:
    cost = gait.cost.get("total", np.inf)
    return not gait.converged, cost if np.isfinite(cost) else np.inf


def _record(start: Start, gait: Gait, elapsed: float) -> StartRecord:
    return StartRecord(
        start=start.name,
        status=gait.outcome.status,
        cost=float(gait.cost.get("total", np.nan)),
        energy=float(gait.metabolic.cost_of_transport),
        iterations=gait.outcome.iterations,
        wall_time=elapsed,
        phase_durations=tuple(float(x) for x in gait.phase_durations),
    )
