"""The default solver: an interior-point method that knows the structure of a gait program.

Drake's IPOPT and `ipopt_mumps` take any program and spend most of their time in sparse
factorisations of some 14 000 unknowns. Here contact forces and residuals are eliminated at
their control points and slacks with their rows, which leaves a dense matrix of a few hundred.
Programs that this does not cover go to `ipopt_mumps`, and the message says so.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from drakegait.program.gait_program import GaitProgram
from drakegait.program.lagrangian_hessian import LagrangianHessian
from drakegait.solvers.condensed.interior_point import InteriorPoint
from drakegait.solvers.condensed.iterate import Multipliers
from drakegait.solvers.condensed.supported import why_not
from drakegait.solvers.condensed.system import CondensedSystem
from drakegait.solvers.monitor import Monitor
from drakegait.solvers.options import SolverOptions
from drakegait.solvers.settled import Settled
from drakegait.solvers.solution import Solution

FIRST_BARRIER, WARM_BARRIER = 1e-3, 1e-4
# Of a start from its bounds, relative. A first start stands far off: its forces say little about
# which muscles will be silent, and what stands at a bound is slow to leave it. A warm start keeps
# to the width of its barrier: with a small one it comes from the optimum and would be thrown off.
_PUSH, _WARM_PUSH = 0.2, 1e-2
_LAST_BARRIER = 0.09  # of the tolerance on complementarity


def solve_condensed(
    program: GaitProgram,
    x: np.ndarray,
    options: SolverOptions,
    monitor: Monitor,
    warm: bool = False,
    known: Multipliers | None = None,
) -> Solution:
    """Minimise the program from `x`; see `Solution`.

    Args:
        warm: `x` is an earlier gait, near the optimum.
        known: its multipliers, of a program with the same rows and variables.
    """
    reason = why_not(program, options)
    if reason:
        return _by_ipopt(program, x, options, monitor, warm, f"{reason}: by ipopt-mumps")
    system = CondensedSystem(program, LagrangianHessian(program))
    complementarity = 0.01 * options.optimality
    first = options.barrier_start or (WARM_BARRIER if warm else FIRST_BARRIER)
    method = InteriorPoint(
        program,
        system,
        x,
        barrier=first,
        last_barrier=_LAST_BARRIER * complementarity,
        push=min(_WARM_PUSH, first**0.5) if warm else _PUSH,
        known=known,
    )
    monitor.step(method.x, 0)
    settled = Settled(options)
    iterations, status, detail = 0, "", ""
    while not status:
        errors = method.errors(0.0)
        if (
            method.smoothing == 1.0
            and errors.dual <= options.optimality
            and errors.primal <= options.feasibility
            and errors.complementarity <= complementarity
        ):
            status, detail = "converged", f"KKT errors {errors.dual:.1e}, {errors.primal:.1e}"
        elif settled.reached and method.at_last_barrier:
            status, detail = "converged", settled.sentence
        elif monitor.stop_reason is not None:
            status = monitor.stop_reason
        elif iterations >= options.max_iterations:
            status = "iteration_limit"
        else:
            if settled.reached:
                method.lower_barrier(settled.FACTOR)
            elif method.little_left:
                method.lower_barrier()
            while method.solved_barrier_problem() and not method.at_last_barrier:
                method.lower_barrier()
            if not method.step():
                detail = "no acceptable step"
                break
            iterations += 1
            monitor.step(method.x, iterations)
            settled.after(method.cost, method.violation, method.barrier)
    program.smoothing = 1.0
    if not status:
        return _by_ipopt(program, method.x, options, monitor, True, f"{detail}: on by ipopt-mumps")
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
    )


def _by_ipopt(
    program: GaitProgram,
    x: np.ndarray,
    options: SolverOptions,
    monitor: Monitor,
    warm: bool,
    why: str,
) -> Solution:
    """What this solver does not cover, by IPOPT."""
    try:
        from drakegait.solvers.ipopt_mumps import solve_with_ipopt_mumps as other
    except ImportError:  # no wheel of ipyopt for this machine
        from drakegait.solvers.drake import solve_with_drake as other

        options = options.replace(solver="ipopt")
    solution = other(program, x, options, monitor, warm)
    return replace(solution, detail=f"{why}; {solution.detail}")
