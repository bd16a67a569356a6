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
from drakegait.program.ground_forces import FRICTION_REGULARISATION
from drakegait.program.lagrangian_hessian import LagrangianHessian
from drakegait.walker.feet import ContactSettings

SHARE = 0.05  # of f: its multipliers, of the order of 1 per tolerance, stay below the price of 1
_PRICE = 1.0  # of a tolerance or typical size
# A row of friction is a difference of squared forces, and flat where a foot bears little: it has to
# be dearer, or light feet slip.
_FRICTION_PRICE = 100.0
# How far rows of friction (2e-4: 1.4 % of the body weight on a usual ground) and others may be off
# and count as held. Friction has to hold with a little to spare, its regularisation.
_FRICTION_HELD, _HELD = 2e-4, 0.02
_HARD = 0.02  # of a tolerance or typical size: what rows may be off that are not soft
# Excitations never lack a force that obeys them, and contact forces by least squares (17) are a
# definition.
_ALWAYS = ("excitation |", "least-squares contact forces |")


@dataclass(frozen=True)
class Bounds:
    """Bounds of the extended unknowns, as a solver reads them."""

    lower: np.ndarray
    upper: np.ndarray


class ElasticProgram:
    """What a solver needs of a program, with the soft laws of `program` elastic.

    The unknowns are x, then p of each soft row or variable that has a lower bound, then n of each
    that has an upper one; the rows are those of `program`, then one for each soft variable.
    `prices` may change between solves.

    Args:
        program: the program whose laws are to break.
        soft_rows: mask of its rows (num_constraints,).
        soft_variables: mask of its unknowns whose bounds may break (num_variables,).

    Attributes:
        ends: the soft rows, in the numbering of this program (num_soft,).
        freed: the soft variables; their rows come last.
        slips: which of them are rows of friction (num_soft,).
        short, over: positions in `ends` of what has p and of what has n.
        prices: of one unit of each soft row, at first those at which laws are to hold (num_soft,).
        held: how far each soft row may be off and count as held, in its unit (num_soft,).
    """

    @classmethod
    def of(cls, program: GaitProgram) -> ElasticProgram:
        """With all laws elastic that could break: all rows but those that can always hold, and the
        bounds of contact forces, steps and the stride time."""
        rows = np.array([not name.startswith(_ALWAYS) for name in program.row_names])
        names = np.array(program.design.names)
        forces = np.char.startswith(names, "contact force")
        forces &= np.isfinite(program.design.lower)
        steps = np.char.startswith(names, "step ") | (names == "stride time")
        return cls(program, rows, forces | steps)

    def __init__(self, program: GaitProgram, soft_rows: np.ndarray, soft_variables: np.ndarray):
        self.program, self.formulation = program, program.formulation
        self.freed = np.flatnonzero(soft_variables)
        self._size, count = program.num_variables, program.num_constraints
        added = count + np.arange(len(self.freed))
        self.ends = np.concatenate([np.flatnonzero(soft_rows), added])
        slip = np.array([name.startswith("friction |") for name in program.row_names], dtype=bool)
        slip = np.append(slip, np.zeros(len(self.freed), dtype=bool))[self.ends]
        self.slips = slip
        self.prices = np.where(slip, _FRICTION_PRICE, _PRICE)
        slippery = (program.formulation.contact.friction / ContactSettings().friction) ** 2
        spare = FRICTION_REGULARISATION / min(1.0, slippery)
        self.held = np.where(slip, _FRICTION_HELD + spare, _HELD)
        lower, upper = program.design.lower.copy(), program.design.upper.copy()
        self.lower = np.concatenate([program.lower, lower[self.freed]])
        self.upper = np.concatenate([program.upper, upper[self.freed]])
        lower[self.freed], upper[self.freed] = -np.inf, np.inf
        # What has no bound on one side cannot be off there.
        self.short = np.flatnonzero(np.isfinite(self.lower[self.ends]))
        self.over = np.flatnonzero(np.isfinite(self.upper[self.ends]))
        num = len(self.short) + len(self.over)
        self.num_variables, self.num_constraints = self._size + num, count + len(self.freed)
        self.design = Bounds(
            np.concatenate([lower, np.zeros(num)]), np.concatenate([upper, np.full(num, np.inf)])
        )
        off = np.concatenate([self.ends[self.short], self.ends[self.over]])
        self.jacobian_rows = np.concatenate([program.jacobian_rows, added, off])
        self.jacobian_columns = np.concatenate(
            [program.jacobian_columns, self.freed, self._size + np.arange(num)]
        )
        self._constant = np.ones(len(self.freed) + num)
        self._constant[len(self.freed) + len(self.short) :] = -1.0
        self.row_names = [
            *program.row_names,
            *(f"bound | stride | {program.design.names[i]}" for i in self.freed),
        ]
        self.row_scale = np.concatenate([program.row_scale, program.design.scale[self.freed]])
        self.row_units = [*program.row_units, *("" for _ in self.freed)]

    @property
    def smoothing(self) -> float:
        """Width of rounded corners, see `GaitProgram`."""
        return self.program.smoothing

    @smoothing.setter
    def smoothing(self, width: float) -> None:
        self.program.smoothing = width

    def start(self, x: np.ndarray) -> np.ndarray:
        """Extended unknowns at `x`, with p and n that make the soft rows hold."""
        rows = self._inner_rows(x)[self.ends]
        low, high = self.lower[self.ends] - rows, rows - self.upper[self.ends]
        return np.concatenate(
            [x, np.maximum(low[self.short], 0.0), np.maximum(high[self.over], 0.0)]
        )

    def unknowns(self, extended: np.ndarray) -> np.ndarray:
        """x of the extended unknowns."""
        return extended[: self._size]

    def as_walk(self, extended: np.ndarray) -> tuple[GaitProgram, np.ndarray]:
        """The program that it is made of, and x."""
        return self.program, self.unknowns(extended)

    def missing(self, extended: np.ndarray) -> np.ndarray:
        """p - n of each soft row, in its unit: above zero where it is too low (num_soft,)."""
        return self.spread(extended[self._size :])

    def spread(self, off: np.ndarray) -> np.ndarray:
        """The first of `off`, by `short`, less the others, by `over`, at soft rows (num_soft,)."""
        found = np.zeros(len(self.ends))
        found[self.short] = off[: len(self.short)]
        found[self.over] -= off[len(self.short) :]
        return found

    def off(self, extended: np.ndarray) -> np.ndarray:
        """How far each soft row is off, in units of what counts as held (num_soft,); infinite
        where rows that are not soft do not hold."""
        if self.violations(extended).max() > _HARD:
            return np.full(len(self.ends), np.inf)
        return np.abs(self.missing(extended)) / self.held

    @property
    def _slope(self) -> np.ndarray:
        """Prices of p, then of n."""
        return np.concatenate([self.prices[self.short], self.prices[self.over]])

    def cost(self, extended: np.ndarray) -> float:
        """Price of what is missing and the share of f."""
        x, off = extended[: self._size], extended[self._size :]
        return float(self._slope @ off + SHARE * self.program.cost(x))

    def gradient(self, extended: np.ndarray) -> np.ndarray:
        """Its derivatives (num_variables,)."""
        slope = SHARE * self.program.gradient(extended[: self._size])
        return np.concatenate([slope, self._slope])

    def rows(self, extended: np.ndarray) -> np.ndarray:
        """All rows, p and n included (num_constraints,)."""
        rows = self._inner_rows(extended[: self._size])
        rows[self.ends] += self.missing(extended)
        return rows

    def _inner_rows(self, x: np.ndarray) -> np.ndarray:
        return np.concatenate([self.program.rows(x), x[self.freed]])

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
