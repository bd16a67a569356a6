"""How hard to try: choices that change the way to an answer, not the question."""

from __future__ import annotations

from dataclasses import dataclass

from drakegait.settings import Settings, choice, quantity

SOLVERS = ("condensed", "ipopt-mumps", "ipopt", "snopt")


@dataclass(frozen=True, kw_only=True)
class SolverOptions(Settings):
    """Options of all solvers.

    The optimality tolerance is on the scaled KKT conditions; rows count as held when they are
    within `feasibility` of their bounds in units of their own tolerance.
    """

    solver: str = choice(
        "condensed",
        SOLVERS,
        "condensed: interior point on the splines' coefficients; ipopt-mumps: IPOPT with MUMPS, "
        "sparse arrays; ipopt, snopt: Drake's own solvers",
    )
    second_derivatives: str = choice(
        "exact",
        ("exact", "limited-memory"),
        "curvature in condensed and ipopt-mumps; projected multipliers and Drake's solvers use "
        "limited memory",
    )
    derivatives: str = choice(
        "analytic",
        ("analytic", "finite-differences"),
        "first derivatives; finite-differences (forward, sparse) for comparison, in ipopt-mumps "
        "with limited memory",
    )
    optimality: float = quantity(1e-3, "-", 1e-8, 1e-1, "tolerance on the scaled KKT conditions")
    feasibility: float = quantity(1e-3, "-", 1e-8, 1e-1, "violation of a row, in its tolerances")
    cost_change: float = quantity(
        1e-4,
        "-",
        0.0,
        1e-2,
        "condensed and ipopt-mumps also end where the cost has changed by less than this part of "
        "itself in 25 iterations that obey all laws (paper: 1e-2 spatial, 1e-4 planar); 0: never",
    )
    max_iterations: float = quantity(500, "-", 1, 1e5, "iterations in one round", True)
    time_limit: float = quantity(3600.0, "s", 0.1, 1e6, "wall time of the whole solve")
    barrier_start: float = quantity(
        0.0, "-", 0.0, 10.0, "first barrier parameter; 0: chosen (warm: small)"
    )
