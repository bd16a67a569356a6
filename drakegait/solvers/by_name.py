"""Which function is behind a solver's name."""

from __future__ import annotations

from collections.abc import Callable

from drakegait.errors import InvalidInput
from drakegait.solvers.solution import Solution


def solver_of(name: str) -> Callable[..., Solution]:
    """The function behind a solver's name; loads its libraries.

    Raises:
        InvalidInput: ipopt-mumps where `ipyopt` is not installed; it has wheels for Linux on
            x86-64 only, Drake's solvers run everywhere.
    """
    if name == "condensed":
        from drakegait.solvers.condensed.solve import solve_condensed

        return solve_condensed
    if name != "ipopt-mumps":
        from drakegait.solvers.drake import solve_with_drake

        return solve_with_drake
    try:
        from drakegait.solvers.ipopt_mumps import solve_with_ipopt_mumps
    except ImportError:
        allowed = "ipopt or snopt on this machine, which lacks the package ipyopt"
        raise InvalidInput("solver", name, allowed) from None
    return solve_with_ipopt_mumps
