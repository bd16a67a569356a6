"""The default solver: an interior-point method that knows the structure of a gait program.

Drake's IPOPT and `ipopt_mumps` take any program and spend most of their time in sparse
factorisations of some 14 000 unknowns. Here contact forces and residuals are eliminated at
their control points and slacks with their rows, which leaves the coefficients of the splines:
a matrix that couples neighbouring knots.
Programs that this does not cover go to `ipopt_mumps`, and the message says so. Where rows get no
better, or no step is acceptable, the elastic program (`solve_least`) tells whether the laws can
hold near here: if so, the solve goes on from there; if not, that is the answer.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from drakegait.program.gait_program import GaitProgram
from drakegait.program.lagrangian_hessian import LagrangianHessian
from drakegait.solvers.condensed.interior_point import InteriorPoint
from drakegait.solvers.condensed.iterate import Multipliers
from drakegait.solvers.condensed.iterate_to_end import FAR, iterate, last_barrier, solution_of
from drakegait.solvers.condensed.solve_elastic import solve_least
from drakegait.solvers.condensed.supported import why_not
from drakegait.solvers.condensed.system import CondensedSystem
from drakegait.solvers.monitor import Monitor
from drakegait.solvers.options import SolverOptions
from drakegait.solvers.solution import Solution

FIRST_BARRIER, WARM_BARRIER = 1e-3, 1e-4
# Of a start from its bounds, relative. A first start stands far off: its forces say little about
# which muscles will be silent, and what stands at a bound is slow to leave it. A warm start keeps
# to the width of its barrier: with a small one it comes from the optimum and would be thrown off.
_PUSH, _WARM_PUSH = 0.2, 1e-2
_MOST_RESTARTS = 3


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
    first, push = (WARM_BARRIER, _WARM_PUSH) if warm else (FIRST_BARRIER, _PUSH)
    first = options.barrier_start or first
    push = min(push, first**0.5) if warm else push
    found, method = _found(program, x, options, monitor, first, push, known)
    if found.status:
        return found
    program = method.program
    # Where there is no going on, the walk that breaks the laws least tells whether they can hold.
    least = solve_least(program, method.x, monitor)
    spent = found.iterations + least.iterations
    if least.status:
        detail = f"{found.detail}; {least.detail}"
        return replace(least, iterations=spent, detail=detail, program=program)
    monitor.begin(program)
    again, method = _found(program, least.x, options, monitor, WARM_BARRIER, _WARM_PUSH)
    program, detail = method.program, f"{found.detail}; {least.detail}; {again.detail}"
    spent += again.iterations
    if again.status:
        return replace(again, iterations=spent, detail=detail)
    detail = f"{detail}: on by ipopt-mumps"
    last = _by_ipopt(program, method.x, options, monitor, True, detail)
    return replace(last, iterations=spent + last.iterations)


def _found(
    program: GaitProgram, x: np.ndarray, options: SolverOptions, monitor: Monitor, barrier: float,
    push: float, known: Multipliers | None = None,
) -> tuple[Solution, InteriorPoint]:  # fmt: skip
    """A run, and others from where it ended as long as events go far.

    The status is empty where there is no going on.
    """
    found, method = _run(program, x, options, monitor, barrier, push, known)
    for _ in range(_MOST_RESTARTS):
        if found.detail != FAR:
            break
        spent = found.iterations
        monitor.begin(method.program)
        found, method = _run(
            method.program, method.x, options, monitor, WARM_BARRIER, _WARM_PUSH, None
        )
        found = replace(found, iterations=spent + found.iterations)
    return found, method


def _run(
    program: GaitProgram, x: np.ndarray, options: SolverOptions, monitor: Monitor, barrier: float,
    push: float, known: Multipliers | None,
) -> tuple[Solution, InteriorPoint]:  # fmt: skip
    system = CondensedSystem(program, LagrangianHessian(program))
    method = InteriorPoint(program, system, x, barrier, last_barrier(options), push, known)
    iterations, status, detail = iterate(method, options, monitor)
    method.program.smoothing = 1.0
    return solution_of(method, monitor, iterations, status, detail), method


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
    return replace(solution, detail=f"{why}; {solution.detail}", program=program)
