"""A gait program in which laws may break, each at a price.

    minimise   sum_k price_k (p_k + n_k) + share * f(x)
    such that  lower <= g(x) + p - n <= upper    for the rows of soft laws,
               lower <= x_i + p - n <= upper     for the bounds of soft variables,
               all other rows and bounds as they are,   p, n >= 0

The sum of what is missing (the elastic programming of J. W. Chinneck, "Feasibility and
Infeasibility in Optimization", Springer 2008, chapter 6) is an exact penalty: where the laws can be
held, p and n become zero; where they cannot, few of them remain, and those tell where the
walk has to break a law. A share of the usual cost f keeps the walk a walk.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from drakegait.program.gait_program import GaitProgram
from drakegait.program.lagrangian_hessian import LagrangianHessian

SHARE = 0.05  # of f: its multipliers, of the order of 1 per tolerance, stay below the price of 1


@dataclass(frozen=True)
class Bounds:
    """Bounds of the extended unknowns, as a solver reads them."""

    lower: np.ndarray
    upper: np.ndarray


class ElasticProgram:
    """What a solver needs of a program, with the soft laws of `program` elastic.

    The unknowns are x, then p and then n of each soft row and of each soft variable; the rows are
    those of `program`, then one for each soft variable. `prices` may change between solves.

    Args:
        program: the program whose laws are to break.
        soft_rows: mask of its rows (num_constraints,).
        soft_variables: mask of its unknowns whose bounds may break (num_variables,).

    Attributes:
        ends: the soft rows, in the numbering of this program (num_soft,).
        prices: of one unit of each of them (num_soft,).
    """

    def __init__(self, program: GaitProgram, soft_rows: np.ndarray, soft_variables: np.ndarray):
        self.program, self.formulation = program, program.formulation
        self._freed = np.flatnonzero(soft_variables)
        self._size, count = program.num_variables, program.num_constraints
        added = count + np.arange(len(self._freed))
        self.ends = np.concatenate([np.flatnonzero(soft_rows), added])
        num = len(self.ends)
        self.prices = np.ones(num)
        self.num_variables, self.num_constraints = self._size + 2 * num, count + len(self._freed)
        lower, upper = program.design.lower.copy(), program.design.upper.copy()
        self.lower = np.concatenate([program.lower, lower[self._freed]])
        self.upper = np.concatenate([program.upper, upper[self._freed]])
        lower[self._freed], upper[self._freed] = -np.inf, np.inf
        # What has no bound on one side cannot be off there.
        ends = np.concatenate([self.lower[self.ends], self.upper[self.ends]])
        most = np.where(np.isfinite(ends), np.inf, 0.0)
        self.design = Bounds(
            np.concatenate([lower, np.zeros(2 * num)]), np.concatenate([upper, most])
        )
        slack = self._size + np.arange(num)
        self.jacobian_rows = np.concatenate([program.jacobian_rows, added, self.ends, self.ends])
        self.jacobian_columns = np.concatenate(
            [program.jacobian_columns, self._freed, slack, slack + num]
        )
        self._constant = np.concatenate([np.ones(len(self._freed) + num), -np.ones(num)])
        self.row_names = [
            *program.row_names,
            *(f"bound | stride | {program.design.names[i]}" for i in self._freed),
        ]
        scale, units = program.design.scale[self._freed], ["" for _ in self._freed]
        self.row_scale = np.concatenate([program.row_scale, scale])
        self.row_units = [*program.row_units, *units]

    def start(self, x: np.ndarray) -> np.ndarray:
        """Extended unknowns at `x`, with p and n that make the soft rows hold."""
        rows = self._inner_rows(x)[self.ends]
        short = np.maximum(self.lower[self.ends] - rows, 0.0)
        over = np.maximum(rows - self.upper[self.ends], 0.0)
        return np.concatenate([x, short, over])

    def unknowns(self, extended: np.ndarray) -> np.ndarray:
        """x of the extended unknowns."""
        return extended[: self._size]

    def missing(self, extended: np.ndarray) -> np.ndarray:
        """p - n of each soft row, in its unit: above zero where it is too low (num_soft,)."""
        short, over = extended[self._size :].reshape(2, -1)
        return short - over

    def cost(self, extended: np.ndarray) -> float:
        """Price of what is missing and the share of f."""
        x, off = extended[: self._size], extended[self._size :].reshape(2, -1)
        return float(self.prices @ off.sum(axis=0) + SHARE * self.program.cost(x))

    def gradient(self, extended: np.ndarray) -> np.ndarray:
        """Its derivatives (num_variables,)."""
        slope = SHARE * self.program.gradient(extended[: self._size])
        return np.concatenate([slope, self.prices, self.prices])

    def rows(self, extended: np.ndarray) -> np.ndarray:
        """All rows, p and n included (num_constraints,)."""
        rows = self._inner_rows(extended[: self._size])
        rows[self.ends] += self.missing(extended)
        return rows

    def _inner_rows(self, x: np.ndarray) -> np.ndarray:
        return np.concatenate([self.program.rows(x), x[self._freed]])

    def jacobian(self, extended: np.ndarray) -> np.ndarray:
        """Entries at `jacobian_rows`, `jacobian_columns`."""
        return np.concatenate([self.program.jacobian(extended[: self._size]), self._constant])

    def violations(self, extended: np.ndarray) -> np.ndarray:
        """How far each row is outside its bounds, p and n included (num_constraints,)."""
        rows = self.rows(extended)
        return np.maximum(np.maximum(self.lower - rows, rows - self.upper), 0.0)


class ElasticHessian:
    """Second derivatives of an elastic program: those of the program that it is made of.

    Attributes:
        rows, columns: positions of the entries, lower triangle.
    """

    def __init__(self, elastic: ElasticProgram):
        self._inner = LagrangianHessian(elastic.program)
        self._count = elastic.program.num_constraints
        self._size = elastic.program.num_variables
        self.rows, self.columns = self._inner.rows, self._inner.columns

    def values(self, x: np.ndarray, multipliers: np.ndarray, objective: float) -> np.ndarray:
        """Entries at (`rows`, `columns`); p, n and the rows of bounds are linear."""
        rows = multipliers[: self._count]
        return self._inner.values(x[: self._size], rows, SHARE * objective)
