"""A barrier problem: where the iteration is, what it costs there, what its multipliers are.

    min f(x) - mu sum log(distance to bounds)   s.t.  c_E(x) = 0,  g(x) - s = 0

Equation numbers are those of Waechter & Biegler, Math. Program. 106 (2006).
"""

from __future__ import annotations

import numpy as np
import scipy.sparse

from drakegait.program.gait_program import GaitProgram
from drakegait.solvers.condensed.iterate import Errors, Multipliers, inside
from drakegait.solvers.condensed.system import CondensedSystem

_KAPPA_EPS, KAPPA_MU = 30.0, 0.1  # barrier problem, (7); looser than theirs
_LEAST_KNOWN = 0.1  # of mu over the distance to a bound, for multipliers from elsewhere
_FAR_OFF = 15.0  # tolerances: where rows are off by more, they say little
_SCALE_MAX = 100.0  # s_max of (5)
_NARROW = 1e-6  # the barrier parameter at which corners have their own width


class BarrierProblem:
    """An iterate w = (x, s) with its multipliers, and the problem that it is to solve.

    Args:
        program, system: what is solved.
        x: start.
        barrier: first mu.
        last_barrier: smallest mu.
        push: least distance of the start from its bounds, relative.
        known: multipliers of rows and of lower and upper bounds from a solve nearby; unused if rows
            are far off.

    Attributes:
        barrier: mu.
        w: unknowns of the program, then slacks of inequality rows.
        multipliers: of rows, and of the lower and upper bounds of w.
        cost, gradient, jacobian: of the program at x.
        primal: c_E and g - s (num_constraints,).
    """

    def __init__(
        self,
        program: GaitProgram,
        system: CondensedSystem,
        x: np.ndarray,
        barrier: float,
        last_barrier: float,
        push: float,
        known: Multipliers | None = None,
    ):
        self._state(program, system)
        x = inside(x, self._low[: self.size], self._high[: self.size], push)
        rows = program.rows(x)
        slacks = inside(
            rows[self.inequality], self._low[self.size :], self._high[self.size :], push
        )
        self.w = np.concatenate([x, slacks])
        self.barrier, self._last_barrier = barrier, last_barrier
        self.multipliers = self._first_multipliers(known)
        program.smoothing = self.smoothing
        self.evaluate()

    def _state(self, program: GaitProgram, system: CondensedSystem) -> None:
        self.program, self.system = program, system
        self.inequality = np.flatnonzero(~system.equality)
        self._target = np.where(system.equality, program.lower, 0.0)
        self.size = program.num_variables
        self._low = np.concatenate([program.design.lower, program.lower[self.inequality]])
        self._high = np.concatenate([program.design.upper, program.upper[self.inequality]])
        self.has_low, self.has_high = np.isfinite(self._low), np.isfinite(self._high)

    def move_bounds(self, program: GaitProgram, system: CondensedSystem) -> None:
        """Go on with the same unknowns in a program that differs in bounds only.

        Products of distances and multipliers stay: those of bounds that moved follow their
        distances.

        Args:
            program: w lies within its bounds.
            system: its linear systems.
        """
        before = self.gaps(self.w)
        self._state(program, system)
        after, z = self.gaps(self.w), self.multipliers
        with np.errstate(invalid="ignore"):
            ratios = [np.where(new != old, old / new, 1.0)
                      for old, new in zip(before, after, strict=True)]  # fmt: skip
        self.multipliers = Multipliers(z.rows, z.lower * ratios[0], z.upper * ratios[1])
        self.evaluate()

    def _first_multipliers(self, known: Multipliers | None) -> Multipliers:
        low, high = self.barrier / np.stack(self.gaps(self.w))
        if known is None or np.abs(self._primal_of(self.w)).max() > _FAR_OFF:
            return Multipliers(np.zeros(self.program.num_constraints), low, high)
        of_slacks = known.rows[self.inequality]
        return Multipliers(
            known.rows.copy(),
            np.maximum(np.concatenate([known.lower, -of_slacks]), _LEAST_KNOWN * low),
            np.maximum(np.concatenate([known.upper, of_slacks]), _LEAST_KNOWN * high),
        )

    def gaps(self, w: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Distances to the bounds, infinite where there is none."""
        return w - self._low, self._high - w

    @property
    def smoothing(self) -> float:
        """Factor on the widths of rounded corners: 1 at the last barrier parameters."""
        return max(1.0, (self.barrier / max(self._last_barrier, _NARROW)) ** 0.5)

    @property
    def x(self) -> np.ndarray:
        """The unknowns of the program."""
        return self.w[: self.size]

    @property
    def bound_multipliers(self) -> tuple[np.ndarray, np.ndarray]:
        """Multipliers of the lower and upper bounds of x."""
        z = self.multipliers
        return z.lower[: self.size].copy(), z.upper[: self.size].copy()

    def _primal_of(self, w: np.ndarray) -> np.ndarray:
        """c_E and g - s at the rows (num_constraints,)."""
        rows = self.program.rows(w[: self.size]) - self._target
        rows[self.inequality] -= w[self.size :]
        return rows

    def barrier_cost(self, w: np.ndarray, cost: float) -> float:
        """phi at `w`, whose cost is given."""
        low, high = self.gaps(w)
        logs = np.log(low[self.has_low]).sum() + np.log(high[self.has_high]).sum()
        return cost - self.barrier * logs

    def evaluate(self) -> None:
        """Evaluate cost, rows and derivatives at w."""
        x = self.x
        self.cost = self.program.cost(x)
        self.primal = self._primal_of(self.w)
        self.gradient = self.program.gradient(x)
        self.jacobian: scipy.sparse.csr_array = self.system.jacobian(x)

    @property
    def violation(self) -> float:
        """Largest violation of a row that ignores slacks' help, scaled."""
        return float(np.abs(self.primal).max())

    def errors(self, barrier: float) -> Errors:
        """The scaled KKT errors for a barrier parameter (0: of the program itself)."""
        y, low_y, high_y = self.multipliers.rows, self.multipliers.lower, self.multipliers.upper
        dual = self.gradient + self.jacobian.T @ y
        dual = np.concatenate([dual, -y[self.inequality]]) - low_y + high_y
        low, high = self.gaps(self.w)
        products = np.concatenate(
            [
                low_y[self.has_low] * low[self.has_low],
                high_y[self.has_high] * high[self.has_high],
            ]
        )
        of_bounds = low_y.sum() + high_y.sum()
        count = len(products)
        scale_d = max(_SCALE_MAX, (np.abs(y).sum() + of_bounds) / (len(y) + count)) / _SCALE_MAX
        scale_c = max(_SCALE_MAX, of_bounds / count) / _SCALE_MAX
        return Errors(
            float(np.abs(dual).max() / scale_d),
            float(np.abs(self.primal).max()),
            float(np.abs(products - barrier).max() / scale_c),
        )

    def measure(self, w: np.ndarray) -> tuple[tuple[float, float], np.ndarray]:
        """Violation and barrier cost at `w`, and the violated rows."""
        primal = self._primal_of(w)
        theta = float(np.abs(primal).sum())
        if not np.isfinite(theta):
            return (np.inf, np.inf), primal
        cost = self.barrier_cost(w, self.program.cost(w[: self.size]))
        return (theta, cost if np.isfinite(cost) else np.inf), primal

    def lower_barrier(self, factor: float = KAPPA_MU) -> None:
        """Go on to the next barrier problem, (7)."""
        self.barrier = max(self._last_barrier, factor * self.barrier)
        if self.smoothing != self.program.smoothing:
            self.program.smoothing = self.smoothing
            self.evaluate()

    @property
    def at_last_barrier(self) -> bool:
        """Whether the barrier parameter will fall no more."""
        return self.barrier <= self._last_barrier

    def solved_barrier_problem(self) -> bool:
        """Whether the error is small enough for a smaller barrier parameter."""
        return self.errors(self.barrier).worst <= _KAPPA_EPS * self.barrier
