"""Elastic programs by the interior-point method of the default solver.

An elastic program can always be satisfied, so that a solve ends at an optimum or at a limit.
"""

from __future__ import annotations

import numpy as np

from drakegait.program.elastic import ElasticProgram
from drakegait.solvers.condensed.elastic_system import ElasticSystem
from drakegait.solvers.condensed.interior_point import InteriorPoint
from drakegait.solvers.condensed.solve import COMPLEMENTARITY, LAST_BARRIER, iterate, solution_of
from drakegait.solvers.monitor import Monitor
from drakegait.solvers.options import SolverOptions
from drakegait.solvers.solution import Solution

# First barrier parameter and distance of the start from its bounds, p and n included. Where laws
# break by hundreds of tolerances the barrier has to be of the order of the prices; and another
# price moves a walk far, so that to start from it at the last barrier parameter leads to steps of
# a hundredth.
_FIRST_BARRIER, _PUSH = 1.0, 0.2
_NEAR_BARRIER, _NEAR_PUSH = 1e-3, 0.1


def solve_elastic(
    elastic: ElasticProgram,
    x: np.ndarray,
    options: SolverOptions,
    monitor: Monitor,
    near: bool = False,
) -> Solution:
    """Minimise an elastic program from `x`; see `Solution`.

    Args:
        elastic: of a program that the default solver takes, see `supported.why_not`.
        x: extended unknowns.
        near: `x` is the answer at other prices.
    """
    barrier, push = (_NEAR_BARRIER, _NEAR_PUSH) if near else (_FIRST_BARRIER, _PUSH)
    method = InteriorPoint(
        elastic,
        ElasticSystem(elastic),
        x,
        barrier=options.barrier_start or barrier,
        last_barrier=LAST_BARRIER * (COMPLEMENTARITY * options.optimality),
        push=push,
    )
    iterations, status, detail = iterate(method, options, monitor)
    elastic.smoothing = 1.0
    return solution_of(method, monitor, iterations, status or "failed", detail)
