"""The multipliers of a solved program: what each bound costs, at the very point that was found."""

from __future__ import annotations

from dataclasses import dataclass, fields

import numpy as np

from drakegait.errors import InvalidInput


@dataclass(frozen=True, eq=False)
class KktMultipliers:
    """First-order certificate of an optimum of a `GaitProgram`, in its scaled variables and rows.

    With f the cost, J the Jacobian of the rows, z_L and z_U those of the variables' bounds,

        grad f + J^T lambda - z_L + z_U = 0,      z_L, z_U >= 0,

    lambda > 0 where an upper bound of a row is active and < 0 where a lower one is (IPOPT's
    signs; of equalities any).

    Attributes:
        x: design vector at which they hold (num_variables,).
        rows: lambda (num_constraints,).
        lower, upper: z_L, z_U (num_variables,).
        event_centres: fractions of the cycle (8,) about which the program let its events move.

    Raises:
        InvalidInput: lengths that do not match, or numbers that are not finite.
    """

    x: np.ndarray
    rows: np.ndarray
    lower: np.ndarray
    upper: np.ndarray
    event_centres: np.ndarray

    def __post_init__(self) -> None:
        for field in fields(self):
            value = np.asarray(getattr(self, field.name), dtype=float)
            if value.ndim != 1 or not np.isfinite(value).all():
                raise InvalidInput(f"multipliers: {field.name}", value, "a list of finite numbers")
            object.__setattr__(self, field.name, value)
        for name in ("lower", "upper"):
            if getattr(self, name).shape != self.x.shape:
                size = getattr(self, name).size
                raise InvalidInput(f"multipliers: {name}", size, f"{self.x.size} numbers")
