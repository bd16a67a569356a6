"""A solved program as a function of its own constants: what the cost answers to each of them.

The variables y (physical, unscaled) and the multipliers of an optimum are held while its program
is exchanged for a slightly different one. By the envelope theorem the cost at the new optimum
differs, to first order, by

    df* = df + lambda . (dg - db) + z_L . dy_L - z_U . dy_U

with f the cost, g the rows, b their active bounds, y_L and y_U the bounds of the variables: no
solve is needed. How other functions answer is in `kkt_system`.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields, replace

import numpy as np
import scipy.sparse

from drakegait.program.gait_program import GaitProgram
from drakegait.program.kkt import KktMultipliers
from drakegait.program.local_costs import MetabolicCost


@dataclass(frozen=True)
class Functions:
    """A program's functions at one y (or differences of them), in the units of the optimum.

    Attributes:
        cost, energy: f of eq. (13); E^t with the solver's rounded corners [J/m].
        slope: gradient of the Lagrangian f + lambda . g (num_variables,).
        rows, row_lower, row_upper: g and its bounds (num_constraints,).
        lower, upper: bounds of the variables (num_variables,).
    """

    cost: float
    energy: float
    slope: np.ndarray
    rows: np.ndarray
    row_lower: np.ndarray
    row_upper: np.ndarray
    lower: np.ndarray
    upper: np.ndarray

    @classmethod
    def combined(cls, weights: Sequence[float], parts: Sequence[Functions]) -> Functions:
        """Weighted sum with weights that add up to zero: infinite bounds do not move."""
        out = {}
        for field in fields(cls):
            values = np.array([getattr(part, field.name) for part in parts])
            with np.errstate(invalid="ignore"):
                total = np.tensordot(np.asarray(weights), values, axes=1)
            out[field.name] = np.where(np.isfinite(values).all(axis=0), total, 0.0)
        return cls(**out)


class Optimum:
    """A program at its optimum.

    Attributes:
        program: the program that was solved.
        multipliers: of its bounds.
    """

    def __init__(self, program: GaitProgram, multipliers: KktMultipliers):
        self.program, self.multipliers = program, multipliers
        self._y = multipliers.x * program.design.scale
        self._row_multipliers = multipliers.rows / program.row_scale

    @property
    def stationarity(self) -> float:
        """Largest part of the KKT residual, relative to the largest gradient of the cost."""
        left = self.functions(self.program).slope - self.multipliers.lower + self.multipliers.upper
        return float(np.abs(left).max() / np.abs(self.program.gradient(self.multipliers.x)).max())

    def functions(self, program: GaitProgram) -> Functions:
        """Functions of a program with the same variables and rows, at this optimum's y."""
        design, own = program.design, self.program
        by_scale = design.scale / own.design.scale
        by_row = program.row_scale / own.row_scale
        x = self._y / design.scale
        jacobian = jacobian_matrix(program, x)
        slope = program.gradient(x) + jacobian.T @ (self._row_multipliers * program.row_scale)
        return Functions(
            cost=program.cost(x),
            energy=float(energy_of(program).values(program.state(x)).sum()),
            slope=slope / by_scale,
            rows=program.rows(x) * by_row,
            row_lower=program.lower * by_row,
            row_upper=program.upper * by_row,
            lower=design.lower * by_scale,
            upper=design.upper * by_scale,
        )

    def cost_answer(self, change: Functions) -> float:
        """df* to a change of the program."""
        kkt = self.multipliers
        bound = np.where(kkt.rows > 0.0, change.row_upper, change.row_lower)
        return float(
            change.cost
            + kkt.rows @ (change.rows - bound)
            + kkt.lower @ change.lower
            - kkt.upper @ change.upper
        )


def jacobian_matrix(program: GaitProgram, x: np.ndarray) -> scipy.sparse.csr_array:
    """The Jacobian of the scaled rows (num_constraints, num_variables)."""
    return scipy.sparse.csr_array(
        (program.jacobian(x), (program.jacobian_rows, program.jacobian_columns)),
        shape=(program.num_constraints, program.num_variables),
    )


def energy_of(program: GaitProgram) -> MetabolicCost:
    """E^t [J/m] as a function of a program's state, whatever its weight in the cost."""
    return MetabolicCost(replace(program.formulation, energy_weight=100.0), program.points)
