"""How a solve ended, in words that a user understands."""

from __future__ import annotations

import math
from dataclasses import dataclass

STATUSES = (
    "converged",
    "acceptable",
    "iteration_limit",
    "time_limit",
    "interrupted",
    "infeasible",
    "failed",
)


@dataclass(frozen=True)
class StartRecord:
    """How the solve from one of several starts ended.

    Attributes:
        start: what it started from, in words.
        status: one of `STATUSES`.
        cost: f of eq. (13) [-].
        energy: exact cost of transport [J/m].
        iterations: of the solver, all rounds together.
        wall_time: seconds, all included.
        phase_durations: t_ph (8,) [s].
    """

    start: str
    status: str
    cost: float
    energy: float
    iterations: int
    wall_time: float
    phase_durations: tuple[float, ...]


@dataclass(frozen=True)
class Outcome:
    """The end of a solve.

    Attributes:
        solver: one of `options.SOLVERS`.
        status: one of `STATUSES`.
        message: what happened, in a sentence.
        iterations: of the solver, all rounds together.
        wall_time: seconds in the solver.
        setup_time: seconds for building the program and the guess.
        num_variables, num_constraints, jacobian_nonzeros: size of the program.
        worst: rows that hold least, in gait terms; empty if all hold.
        advice: what to try next; empty if converged.
        refinements: one sentence for each round of more nodes or control points.
        starts: how each of several starts ended, this one included; empty if there was one.
    """

    solver: str
    status: str
    message: str
    iterations: int
    wall_time: float
    setup_time: float
    num_variables: int
    num_constraints: int
    jacobian_nonzeros: int
    worst: tuple[str, ...] = ()
    advice: str = ""
    refinements: tuple[str, ...] = ()
    starts: tuple[StartRecord, ...] = ()

    @property
    def spread(self) -> float:
        """(largest - least) / least f of the starts that converged; nan for less than two."""
        costs = [record.cost for record in self.starts if record.status == "converged"]
        return (max(costs) - min(costs)) / min(costs) if len(costs) > 1 else math.nan

    @property
    def converged(self) -> bool:
        """Whether the solver met its tolerances; "acceptable" is not converged."""
        return self.status == "converged"
