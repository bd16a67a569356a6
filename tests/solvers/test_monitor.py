"""Watching a solve: the best gait so far, the time limit, Ctrl-C, progress."""

from __future__ import annotations

import os
import signal
import threading
import time

import numpy as np
import pytest

from drakegait import GaitStudy
from drakegait.program.elastic import ElasticProgram
from drakegait.program.gait_program import GaitProgram
from drakegait.program.guess import guess_from_reference
from drakegait.solvers.monitor import Monitor, Progress


class Walk:
    """Stands for a program: one unknown; cost and violations as told."""

    row_names = ("clearance | right heel off | toe_r", "friction | right heel off | foot_r")

    def __init__(self, *points: tuple[float, float]):
        self.points = points

    def cost(self, x: np.ndarray) -> float:
        return self.points[int(x[0])][0]

    def violations(self, x: np.ndarray) -> np.ndarray:
        return np.array([0.0, self.points[int(x[0])][1]])

    def as_walk(self, x: np.ndarray) -> tuple[Walk, np.ndarray]:
        return self, x


def follow(*points: tuple[float, float], order=None) -> int:
    """Number of the best of these (cost, violation)."""
    monitor = Monitor(100.0)
    monitor.begin(Walk(*points))
    for i in order if order is not None else range(len(points)):
        monitor.step(np.array([float(i)]))
    return int(monitor.best[0])


def test_a_smaller_violation_is_better_whatever_it_costs():
    assert follow((1.0, 50.0), (9.0, 0.5), (5.0, 2.0)) == 1


def test_among_those_that_hold_the_cheaper_one_is_better():
    # All below one per cent of a tolerance: nobody can tell their violations apart.
    assert follow((5.0, 0.0), (4.0, 0.009), (4.5, 0.001)) == 1


@pytest.mark.parametrize("order", [(0, 1, 2), (2, 1, 0), (1, 2, 0)])
def test_what_is_no_number_is_never_best(order):
    bad = (np.nan, 0.0), (1.0, np.nan)
    assert follow((7.0, 30.0), *bad, order=order) == 0


def test_the_best_is_a_copy_and_each_round_starts_afresh():
    monitor = Monitor(100.0)
    monitor.begin(Walk((1.0, 0.0), (2.0, 0.0)))
    x = np.array([0.0])
    monitor.step(x)
    x[0] = 1.0
    assert monitor.best[0] == 0.0
    monitor.begin(Walk((9.0, 9.0)))
    assert monitor.best is None
    assert (monitor.round, monitor.iteration) == (2, 0)
    monitor.step(np.array([0.0]))
    assert monitor.best[0] == 0.0


def test_the_time_limit_counts_from_the_start_of_the_whole_solve():
    monitor = Monitor(0.05)
    monitor.begin(Walk((1.0, 0.0)))
    assert monitor.step(np.array([0.0])) is None
    assert 0.0 < monitor.remaining <= 0.05
    time.sleep(0.06)
    monitor.begin(Walk((1.0, 0.0)))
    assert monitor.step(np.array([0.0])) == monitor.stop_reason == "time_limit"
    assert monitor.remaining < 0.0


def test_ctrl_c_stops_the_solve_and_then_works_as_before():
    before = signal.getsignal(signal.SIGINT)
    with Monitor(100.0) as monitor:
        monitor.begin(Walk((1.0, 0.0)))
        assert monitor.step(np.array([0.0])) is None
        os.kill(os.getpid(), signal.SIGINT)
        assert monitor.step(np.array([0.0])) == monitor.stop_reason == "interrupted"
    assert signal.getsignal(signal.SIGINT) is before
    with pytest.raises(KeyboardInterrupt):
        os.kill(os.getpid(), signal.SIGINT)
        time.sleep(0.1)


def test_ctrl_c_works_as_before_after_an_error_too():
    before = signal.getsignal(signal.SIGINT)
    with pytest.raises(ZeroDivisionError), Monitor(100.0):
        raise ZeroDivisionError
    assert signal.getsignal(signal.SIGINT) is before


def test_a_solve_in_another_thread_leaves_ctrl_c_alone():
    before, seen = signal.getsignal(signal.SIGINT), []

    def work():
        with Monitor(100.0) as monitor:
            monitor.begin(Walk((1.0, 0.0)))
            seen.append((monitor.step(np.array([0.0])), signal.getsignal(signal.SIGINT)))

    thread = threading.Thread(target=work)
    thread.start()
    thread.join()
    assert seen == [(None, before)]


def test_progress_names_the_worst_row():
    said: list[Progress] = []
    monitor = Monitor(100.0, said.append, interval=0.0)
    monitor.begin(Walk((3.0, 0.7), (2.0, 0.0)))
    monitor.step(np.array([0.0]), 4)
    monitor.step(np.array([1.0]), 5)
    first, second = said
    assert (first.round, first.iteration, first.cost, first.violation) == (1, 4, 3.0, 0.7)
    assert first.worst == "friction | right heel off | foot_r"
    assert second.worst == ""
    assert first.elapsed + first.remaining == pytest.approx(100.0)


def test_progress_is_not_told_at_every_iteration():
    said: list[Progress] = []
    monitor = Monitor(100.0, said.append, interval=30.0)
    monitor.begin(Walk((3.0, 0.7)))
    for _ in range(5):
        monitor.step(np.array([0.0]))
    assert len(said) == 1
    assert monitor.iteration == 5


def test_progress_is_that_of_the_walk_where_laws_may_break_at_a_price():
    program = GaitProgram(GaitStudy.planar_symmetric(13).formulation())
    x = guess_from_reference(program)
    elastic = ElasticProgram.of(program)
    said: list[Progress] = []
    monitor = Monitor(100.0, said.append, interval=0.0)
    monitor.begin(program)
    monitor.step(x)
    monitor.begin(elastic)
    monitor.step(elastic.start(x))
    plain, relaxed = said
    assert elastic.cost(elastic.start(x)) > 2.0 * plain.cost
    assert (relaxed.cost, relaxed.violation, relaxed.worst) == (
        plain.cost, plain.violation, plain.worst,
    )  # fmt: skip
    assert plain.worst
