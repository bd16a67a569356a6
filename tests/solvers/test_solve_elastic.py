"""Elastic programs solved: against IPOPT, in the limit of dear laws, and as the way out."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from drakegait import GaitStudy
from drakegait.program.elastic import SHARE, ElasticHessian, ElasticProgram
from drakegait.program.gait_program import GaitProgram
from drakegait.program.guess import guess_from_reference
from drakegait.solvers.condensed import solve as solve_module
from drakegait.solvers.condensed.solve import solve_condensed
from drakegait.solvers.condensed.solve_elastic import solve_elastic, solve_least
from drakegait.solvers.condensed.stalled import Stalled
from drakegait.solvers.monitor import Monitor
from drakegait.solvers.options import SolverOptions
from drakegait.solvers.solution import Solution

SMALL = GaitStudy.planar_symmetric(13, interior_points=(2, 2, 6, 4))
WEAK = SMALL.replace(strength=dict.fromkeys(SMALL.walker.muscles.abbreviations, 0.2))
OPTIONS = SolverOptions(max_iterations=300)


def program_of(study: GaitStudy) -> tuple[GaitProgram, np.ndarray]:
    program = GaitProgram(study.formulation())
    return program, guess_from_reference(program)


def solved(program: GaitProgram, x: np.ndarray) -> Solution:
    with Monitor(120.0) as monitor:
        monitor.begin(program)
        return solve_condensed(program, x, OPTIONS, monitor)


@pytest.mark.solve
def test_the_walk_that_breaks_least_is_that_of_ipopt() -> None:
    ipopt = pytest.importorskip("drakegait.solvers.ipopt_mumps")
    program, x = program_of(WEAK)
    elastic = ElasticProgram.of(program)
    mine = solve_elastic(elastic, elastic.start(x), Monitor(120.0))
    assert mine.status == "converged"
    with Monitor(120.0) as monitor:
        monitor.begin(elastic)
        other = ipopt.solve_with_ipopt_mumps(
            elastic, mine.x, OPTIONS, monitor, warm=True, curvature=ElasticHessian(elastic)
        )
    assert other.status == "converged"
    assert elastic.cost(other.x) == pytest.approx(elastic.cost(mine.x), rel=2e-3)
    most = np.abs(elastic.missing(other.x)).max()
    assert most > 1.0  # something is missing
    assert np.abs(elastic.missing(mine.x) - elastic.missing(other.x)).max() < 0.02 * most


@pytest.mark.solve
def test_with_dear_laws_that_can_hold_it_is_the_program_itself() -> None:
    program, x = program_of(SMALL)
    hard = solved(program, x)
    assert hard.status == "converged"
    elastic = ElasticProgram.of(program)
    elastic.prices = 30.0 * elastic.prices
    soft = solve_elastic(elastic, elastic.start(hard.x), Monitor(120.0), near=True)
    assert soft.status == "converged"
    assert elastic.off(soft.x).max() < 0.1
    inner = elastic.unknowns(soft.x)
    assert program.cost(inner) == pytest.approx(program.cost(hard.x), rel=5e-3)
    assert elastic.cost(soft.x) == pytest.approx(SHARE * program.cost(hard.x), rel=5e-3)


@pytest.mark.solve
def test_cheap_laws_break_more_and_the_others_less() -> None:
    program, x = program_of(WEAK)
    elastic = ElasticProgram.of(program)
    dear = elastic.prices.copy()
    first = solve_elastic(elastic, elastic.start(x), Monitor(120.0))
    names = [elastic.row_names[i] for i in elastic.ends]
    joints = np.array([name.startswith("equations of motion") for name in names])
    elastic.prices = np.where(joints, 2e-3, 1.0) * dear
    second = solve_elastic(elastic, first.x, Monitor(120.0), near=True)
    assert second.status == "converged"
    for rows, more in ((joints, True), (~joints, False)):
        before, after = (np.abs(elastic.missing(z.x))[rows].sum() for z in (first, second))
        assert (after > before) == more


@pytest.mark.solve
def test_laws_that_cannot_hold_end_a_solve_with_the_walk_that_breaks_them_least() -> None:
    program, x = program_of(WEAK)
    found = solved(program, x)
    assert found.status == "infeasible"
    assert "breaks the laws least" in found.detail and "ipopt" not in found.detail
    assert program.smoothing == 1.0
    broken = [item.kind for item in program.worst(found.x)]
    assert broken[0] == "average speed"


@pytest.mark.solve
@pytest.mark.parametrize("far", [False, True])
def test_a_solve_that_got_stuck_goes_on_from_where_all_laws_hold(
    monkeypatch: pytest.MonkeyPatch, far: bool
) -> None:
    """Also if its events go far on the way back."""
    program, x = program_of(SMALL)
    assert solve_least(program, x, Monitor(120.0)).status == ""
    stuck, once = Stalled.after, iter([True])

    def at_once(self: Stalled, violation: float, barrier: float) -> None:
        stuck(self, violation, barrier)
        self.reached = violation > 1.0 and next(once, False)

    monkeypatch.setattr(Stalled, "after", at_once)
    monkeypatch.setattr(solve_module, "_by_ipopt", None)  # nothing is left to it
    real, counts = solve_module.iterate, []

    def counted(*args: Any) -> tuple[int, str, str]:
        ended = real(*args)
        counts.append(ended[0])
        return (ended[0], "", solve_module.FAR) if far and len(counts) == 2 else ended

    monkeypatch.setattr(solve_module, "iterate", counted)
    found = solved(program, x)
    assert found.status == "converged"
    assert "laws remain broken; on from where all laws hold" in found.detail
    assert program.violations(found.x).max() < 1e-2
    assert len(counts) == (3 if far else 2)
    assert found.iterations > sum(counts)  # those of the elastic program, too


def test_a_limit_on_time_ends_the_way_out_too() -> None:
    program, x = program_of(WEAK)
    assert solve_least(program, x, Monitor(0.0)).status == "time_limit"


def test_stalled_means_that_violations_stay() -> None:
    for ratio, expected in ((0.97, False), (0.995, True)):
        stalled, violation = Stalled(), 5.0
        for _ in range(41):
            assert not stalled.reached  # not before there is something to look back to
            stalled.after(violation, 1e-4)
            violation *= ratio
        assert stalled.reached == expected
    lowered = Stalled()
    for iteration in range(60):  # slow, but at two barrier parameters
        lowered.after(5.0, 1e-3 if iteration < 30 else 1e-4)
    assert not lowered.reached
    small = Stalled()
    for _ in range(60):
        small.after(0.05, 1e-4)
    assert not small.reached
    bent = Stalled()
    for iteration in range(60):  # rows that were nearly held, and a long step
        bent.after(0.15 if iteration == 59 else 0.02, 1e-4)
    assert not bent.reached
