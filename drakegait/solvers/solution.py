"""What every solver returns."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from drakegait.program.gait_program import GaitProgram

MESSAGES = {
    "converged": "The gait meets every law and is locally optimal.",
    "acceptable": "Every law nearly holds, but the solver stopped before it met its tolerances.",
    "iteration_limit": "The limit on iterations was reached.",
    "time_limit": "The time limit was reached.",
    "interrupted": "Interrupted; the best gait so far is kept.",
    "infeasible": "No walk that obeys all laws was found near this one.",
    "failed": "The solver failed.",
}


@dataclass(frozen=True)
class Solution:
    """The end point of a solver.

    Attributes:
        x: scaled design vector.
        status: a word of `outcome.STATUSES`.
        iterations: number of iterations, -1 if the solver does not tell.
        detail: the solver's own words.
        row_multipliers: KKT multipliers of the rows, df/d(bound) with the sign of IPOPT
            (num_constraints,), or None.
        lower_multipliers, upper_multipliers: of the variables' bounds, or None.
        program: what x and the multipliers belong to, where the solver moved the bounds of
            events along (`recentred`); None: what it was given.
    """

    x: np.ndarray
    status: str
    iterations: int
    detail: str
    row_multipliers: np.ndarray | None = None
    lower_multipliers: np.ndarray | None = None
    upper_multipliers: np.ndarray | None = None
    program: GaitProgram | None = None


def status_of_ipopt(code: int, stop_reason: str | None) -> str:
    """Status word for IPOPT's return code."""
    if code == 0:
        return "converged"
    if stop_reason is not None:
        return stop_reason
    words = {1: "acceptable", 2: "infeasible", 6: "acceptable", -1: "iteration_limit"}
    words |= {-2: "infeasible", -4: "time_limit", -5: "time_limit"}
    return words.get(code, "failed")
