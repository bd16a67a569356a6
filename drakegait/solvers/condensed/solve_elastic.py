"""Elastic programs by the interior-point method of the default solver.

An elastic program can always be satisfied, so that a solve ends at an optimum or at a limit.
"""

from __future__ import annotations

import numpy as np

from drakegait.program.elastic import ElasticProgram
from drakegait.program.gait_program import GaitProgram
from drakegait.solvers.condensed.elastic_system import ElasticSystem
from drakegait.solvers.condensed.interior_point import InteriorPoint
from drakegait.solvers.condensed.iterate_to_end import iterate, last_barrier, solution_of
from drakegait.solvers.monitor import Monitor
from drakegait.solvers.options import SolverOptions
from drakegait.solvers.solution import Solution

# First barrier parameter and distance of the start from its bounds, p and n included. Where laws
# break by hundreds of tolerances the barrier has to be of the order of the prices; and another
# price moves a walk far, so that to start from it at the last barrier parameter leads to steps of
# a hundredth.
_FIRST_BARRIER, _PUSH = 1.0, 0.2
# Sums of what is missing are known to a per cent.
ELASTIC_OPTIONS = SolverOptions(max_iterations=250, optimality=3e-3)
_NEAR_BARRIER, _NEAR_PUSH = 1e-3, 0.1


def solve_elastic(
    elastic: ElasticProgram,
    x: np.ndarray,
    monitor: Monitor,
    near: bool = False,
) -> Solution:
    """Minimise an elastic program from `x`; see `Solution`.

    Args:
        elastic: of a program that the default solver takes, see `supported.why_not`.
        x: extended unknowns.
        near: `x` is the answer at other prices.
    """
    options = ELASTIC_OPTIONS
    barrier, push = (_NEAR_BARRIER, _NEAR_PUSH) if near else (_FIRST_BARRIER, _PUSH)
    monitor.begin(elastic)
    system = ElasticSystem(elastic)
    # p and n come in pairs, thousands of them near 0: bent one by one, they break their rows.
    method = InteriorPoint(
        elastic, system, x, barrier, last_barrier(options), push, bends=False
    )
    iterations, status, detail = iterate(method, options, monitor)
    elastic.smoothing = 1.0
    return solution_of(method, monitor, iterations, status or "failed", detail)


def solve_least(program: GaitProgram, x: np.ndarray, monitor: Monitor) -> Solution:
    """The walk near `x` that breaks the laws of `program` least.

    Returns:
        Its unknowns; the status is `"infeasible"` if it breaks laws, empty if it does not or was
        not found to its end.
    """
    elastic = ElasticProgram.of(program)
    found = solve_elastic(elastic, elastic.start(x), monitor)
    unknowns, stopped = elastic.unknowns(found.x), monitor.stop_reason
    if stopped is not None:
        return Solution(unknowns, stopped, found.iterations, "")
    if elastic.off(found.x).max() <= 1.0:
        return Solution(unknowns, "", found.iterations, "on from where all laws hold")
    if found.status != "converged":  # which says nothing
        return Solution(unknowns, "", found.iterations, "on from where laws break less")
    detail = "the walk that breaks the laws least breaks some"
    return Solution(unknowns, "infeasible", found.iterations, detail)
