"""IPOPT with MUMPS: exact second derivatives and limited memory solve the same problem."""

from __future__ import annotations

import numpy as np
import pytest

from drakegait.program.gait_program import GaitProgram
from drakegait.program.guess import guess_from_reference
from drakegait.solvers.ipopt_mumps import solve_with_ipopt_mumps
from drakegait.solvers.monitor import Monitor
from drakegait.solvers.options import SolverOptions
from drakegait.solvers.settled import Settled
from drakegait.solvers.solution import Solution
from drakegait.study import GaitStudy

pytestmark = pytest.mark.solve

# A small walk, but fine enough that its local optima lie close together. With 11 nodes they are
# 10 % apart, and either way of solving may find the lower one.
STUDY = GaitStudy.planar_symmetric(13, interior_points=(3, 2, 6, 5))


def solved(program: GaitProgram, start: np.ndarray | None = None, **options) -> Solution:
    """From the reference walk, or warm from `start`."""
    x = guess_from_reference(program) if start is None else start
    with Monitor(60.0, None) as monitor:
        monitor.begin(program)
        chosen = SolverOptions(**options)
        return solve_with_ipopt_mumps(program, x, chosen, monitor, warm=start is not None)


@pytest.fixture(scope="module")
def program() -> GaitProgram:
    return GaitProgram(STUDY.formulation())


@pytest.fixture(scope="module")
def exact(program) -> Solution:
    return solved(program)


@pytest.fixture(scope="module")
def approximate(program) -> Solution:
    return solved(program, second_derivatives="limited-memory")


def test_both_converge_and_obey_all_laws(program, exact, approximate):
    for found in (exact, approximate):
        assert found.status == "converged"
        assert program.violations(found.x).max() < 2e-3
        assert (found.x >= program.design.lower - 1e-9).all()
        assert (found.x <= program.design.upper + 1e-9).all()


def test_from_the_reference_both_end_within_two_per_cent(program, exact, approximate):
    assert program.cost(exact.x) == pytest.approx(program.cost(approximate.x), rel=0.02)


def test_exact_second_derivatives_need_fewer_iterations(exact, approximate):
    """A sixth fewer, half before force-velocity lost its corner; a wrong Hessian loses that."""
    assert exact.iterations < 0.9 * approximate.iterations


def test_exact_second_derivatives_end_no_higher_than_where_they_start(program, approximate):
    """The end point of limited memory is an optimum for both."""
    again = solved(program, approximate.x)
    assert again.status == "converged"
    assert program.cost(again.x) < 1.001 * program.cost(approximate.x)


def test_limited_memory_stays_at_the_optimum_of_exact_second_derivatives(program, exact):
    again = solved(program, exact.x, second_derivatives="limited-memory")
    assert again.status == "converged"
    assert program.cost(again.x) == pytest.approx(program.cost(exact.x), rel=1e-3)


def test_iterations_are_limited(program):
    stopped = solved(program, max_iterations=7)
    assert stopped.status == "iteration_limit"
    assert stopped.iterations == 7


def test_a_cost_that_has_settled_ends_the_solve(program, approximate, monkeypatch):
    """Restarts at lower barrier parameters until the last, then the end, in so many words."""
    monkeypatch.setattr(Settled, "LENGTH", 3)
    monkeypatch.setattr(Settled, "LENGTH_AT_END", 4)
    settled = solved(program, approximate.x, optimality=1e-8, cost_change=1e-2)
    assert settled.status == "converged"
    assert "cost within 0.01 of itself over 4 iterations" in settled.detail
    assert 10 < settled.iterations < 60  # those of all restarts
    assert program.violations(settled.x).max() < 2e-3
    assert program.cost(settled.x) == pytest.approx(program.cost(approximate.x), rel=1e-2)
