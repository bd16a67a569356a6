"""The steps of one solve, until it has converged or is stopped."""

from __future__ import annotations

import numpy as np
from threadpoolctl import threadpool_limits

from drakegait.program.elastic import ElasticProgram
from drakegait.program.lagrangian_hessian import LagrangianHessian
from drakegait.program.recentring import recentred
from drakegait.solvers.condensed.interior_point import InteriorPoint
from drakegait.solvers.condensed.stalled import Stalled
from drakegait.solvers.condensed.system import CondensedSystem
from drakegait.solvers.monitor import Monitor
from drakegait.solvers.options import SolverOptions
from drakegait.solvers.settled import Settled
from drakegait.solvers.solution import Solution

_COMPLEMENTARITY = 0.01  # tolerance, of that on optimality
_LAST_BARRIER = 0.09  # of the tolerance on complementarity
_NEAR_BOUND = 0.9  # of the reach of an event
# Iterations after bounds moved, and part of the cost lost since they first did, that end a run: the
# optimum has become a far one, and with the last barrier parameter steps are short.
_MANY, _MUCH = 150, 0.005
FAR = "events went far"


def last_barrier(options: SolverOptions) -> float:
    """The smallest barrier parameter."""
    return _LAST_BARRIER * (_COMPLEMENTARITY * options.optimality)


@threadpool_limits.wrap(limits=1, user_api="blas")  # its blocks are small: threads would wait
def iterate(
    method: InteriorPoint, options: SolverOptions, monitor: Monitor
) -> tuple[int, str, str]:
    """Step until it has converged or is stopped.

    An elastic program can always be satisfied: it goes on where violated rows get no better. Of
    others the bounds of events move along, at the last barrier parameter; before it, events that
    the barrier pushes come back.

    Returns:
        Iterations, status, and how it ended; the status is empty where there is no going on.
    """
    complementarity = _COMPLEMENTARITY * options.optimality
    elastic = isinstance(method.program, ElasticProgram)
    monitor.step(method.x, 0)
    settled, stalled = Settled(options), Stalled()
    iterations, since_moved = 0, np.inf  # iterations since bounds moved along
    cost_then = -np.inf  # when they first did
    while True:
        errors = method.errors(0.0)
        if (
            method.smoothing == 1.0
            and errors.dual <= options.optimality
            and errors.primal <= options.feasibility
            and errors.complementarity <= complementarity
        ):
            detail = f"KKT errors {errors.dual:.1e}, {errors.primal:.1e}"
            return iterations, "converged", detail
        if settled.reached and method.at_last_barrier:
            return iterations, "converged", settled.sentence
        if monitor.stop_reason is not None:
            return iterations, monitor.stop_reason, ""
        if iterations >= options.max_iterations:
            return iterations, "iteration_limit", ""
        if settled.reached:
            method.lower_barrier(settled.FACTOR)
        elif method.little_left:
            method.lower_barrier()
        while method.solved_barrier_problem() and not method.at_last_barrier:
            method.lower_barrier()
        if stalled.reached and not elastic:
            return iterations, "", "laws remain broken"
        if since_moved == _MANY or method.cost < (1.0 - _MUCH) * cost_then:
            return iterations, "", FAR
        if not method.step():
            return iterations, "", "no acceptable step"
        iterations += 1
        monitor.step(method.x, iterations)
        if method.at_last_barrier and not elastic:
            since_moved += 1
            if _recentred(method, monitor):
                cost_then = method.cost if since_moved == np.inf else cost_then
                since_moved = 0
        settled.after(method.cost, method.violation, method.barrier)
        stalled.after(method.violation, method.barrier)


def _recentred(method: InteriorPoint, monitor: Monitor) -> bool:
    """Move the bounds of events along where one has come near; whether they moved."""
    moved = recentred(method.program, method.x, _NEAR_BOUND)
    if moved is None:
        return False
    method.move_bounds(moved, CondensedSystem(moved, LagrangianHessian(moved)))
    monitor.go_on(moved, method.x)
    return True


def solution_of(
    method: InteriorPoint, monitor: Monitor, iterations: int, status: str, detail: str
) -> Solution:
    """What `iterate` found, or the best of what it saw."""
    end = method.x if status == "converged" or monitor.best is None else monitor.best
    lower, upper = method.bound_multipliers
    return Solution(
        x=np.array(end),
        status=status,
        iterations=iterations,
        detail=detail,
        row_multipliers=method.multipliers.rows.copy(),
        lower_multipliers=lower,
        upper_multipliers=upper,
        program=None if isinstance(method.program, ElasticProgram) else method.program,
    )
