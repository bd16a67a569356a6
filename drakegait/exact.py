"""A gait solved on to the very optimum.

    exact = solve_exactly(gait)
    exact.sensitivities()       # dE^t/dp is the derivative there, not an estimate

A walk needs its optimum to a few parts in ten thousand of the cost, which is where `solve` ends.
Which of the thousands of bounds are active is then still open, and the cost of transport E^t
hangs on that: the cost f is flat in directions in which E^t is not. From a solved gait with its
multipliers the remaining way takes the default solver seconds.
"""

from __future__ import annotations

from collections.abc import Callable

from drakegait.errors import InvalidInput
from drakegait.gait import Gait
from drakegait.solve import solve
from drakegait.solvers.monitor import Progress

# KKT conditions to 1e-7 leave 1e-8 of the gradient (measured), a hundredth of what
# `sensitivities.EXACT` asks for. The barrier starts where the earlier solve, whose last one was
# about 1e-6, has little to say: the bounds that it thought active stay so unless they push back.
OPTIONS = {"optimality": 1e-7, "cost_change": 0.0, "barrier_start": 1e-8, "solver": "condensed"}
"""Options of `solve` with which it ends nowhere but at the optimum."""


def solve_exactly(
    gait: Gait,
    *,
    time_limit: float = 600.0,
    report: Callable[[Progress], None] | None = None,
) -> Gait:
    """Solve a gait on until nothing is left of its optimality conditions.

    The control points stay as they are, so that it is the optimum of the same program.

    Args:
        gait: converged; its multipliers are where the solver starts.
        time_limit: wall time [s].
        report: called with the progress of the solve.

    Returns:
        The optimum if its `outcome` says converged, else whatever was found.

    Raises:
        InvalidInput: the gait has not converged, or is of a program without second derivatives.
    """
    if gait.outcome.status != "converged":
        raise InvalidInput("gait to solve exactly", gait.outcome.status, "a gait that converged")
    if gait.study.multipliers != "lifted":
        allowed = "lifted, whose program has second derivatives"
        raise InvalidInput("multipliers of a gait to solve exactly", "projected", allowed)
    choices = {**OPTIONS, "time_limit": time_limit}
    return solve(gait.study, guess=gait, refine=False, report=report, **choices)
