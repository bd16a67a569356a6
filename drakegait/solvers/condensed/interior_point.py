"""A primal-dual interior-point method on the condensed system.

    min f(x) - mu sum log(slack)   s.t.  c_E(x) = 0,  g(x) - s = 0

for a falling sequence of barrier parameters mu; line search with a filter and second-order
corrections. The algorithm is that of IPOPT (Waechter & Biegler 2006, equation numbers below)
without a restoration phase (where no step is acceptable the method says so), and with three
additions:

- corners of the energy rate are rounded widely at first and narrow with mu (`smoothing`);
- what makes K positive definite is looked for in the muscles first (`Regularisation`);
- steps that a few bounds cut short are corrected (`Targets`).
"""

from __future__ import annotations

import numpy as np

from drakegait.program.gait_program import GaitProgram
from drakegait.solvers.condensed.centrality import CORRECTIONS, LONG, WORTH, Targets
from drakegait.solvers.condensed.filter import Filter
from drakegait.solvers.condensed.iterate import Errors, Multipliers, inside, longest_step
from drakegait.solvers.condensed.regularisation import Regularisation
from drakegait.solvers.condensed.system import CondensedSystem

_TAU = 0.99  # smallest fraction to the boundary (8)
_KAPPA_EPS, _KAPPA_MU, _THETA_MU = 30.0, 0.2, 1.5  # barrier problem, (7)
_KAPPA_SIGMA = 1e10  # (16)
_LEAST_KNOWN = 0.1  # of mu over the distance to a bound, for multipliers from elsewhere
_SCALE_MAX = 100.0  # s_max of (5)
_CORRECTIONS, _CORRECTED = 4, 0.99  # second-order corrections (section 2.4)
_NARROW = 1e-6  # the barrier parameter at which corners have their own width
# Full steps that change the cost by less than this part of itself creep, if there are so many.
# A barrier problem is left when the cost has changed over so many steps by less than this part of
# the sum of products, mu at each bound.
_LOOK_BACK, _LITTLE_LEFT, _NEARLY_HELD = 4, 0.01, 0.1
_LITTLE_CHANGE, _FULL, _CREEPING = 1e-3, 0.95, 2


class InteriorPoint:
    """The iteration; call `step` until `converged`.

    Args:
        program, system: what is solved.
        x: start.
        barrier: first mu.
        last_barrier: smallest mu.
        push: least distance of the start from its bounds, relative.
        known: multipliers of rows and of lower and upper bounds from a solve nearby.
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
        self.program, self.system = program, system
        self._inequality = np.flatnonzero(~system.equality)
        self._target = np.where(system.equality, program.lower, 0.0)
        self._size = program.num_variables
        self._low = np.concatenate([program.design.lower, program.lower[self._inequality]])
        self._high = np.concatenate([program.design.upper, program.upper[self._inequality]])
        self._has_low, self._has_high = np.isfinite(self._low), np.isfinite(self._high)
        x = inside(x, self._low[: self._size], self._high[: self._size], push)
        rows = program.rows(x)
        slacks = inside(
            rows[self._inequality], self._low[self._size :], self._high[self._size :], push
        )
        self.w = np.concatenate([x, slacks])
        self.barrier, self._last_barrier = barrier, last_barrier
        self._regularisation, self._small_steps = Regularisation(system), 0
        self._costs: list[float] = []  # with this barrier parameter
        self.multipliers = self._first_multipliers(known)
        program.smoothing = self.smoothing
        self._evaluate()
        self._filter = Filter(np.abs(self._primal).sum())

    def _first_multipliers(self, known: Multipliers | None) -> Multipliers:
        low, high = self.barrier / np.stack(self._gaps(self.w))
        if known is None:
            return Multipliers(np.zeros(self.program.num_constraints), low, high)
        of_slacks = known.rows[self._inequality]
        return Multipliers(
            known.rows.copy(),
            np.maximum(np.concatenate([known.lower, -of_slacks]), _LEAST_KNOWN * low),
            np.maximum(np.concatenate([known.upper, of_slacks]), _LEAST_KNOWN * high),
        )

    def _gaps(self, w: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Distances to the bounds, infinite where there is none."""
        return w - self._low, self._high - w

    @property
    def smoothing(self) -> float:
        """Factor on the widths of rounded corners: 1 at the last barrier parameters."""
        return max(1.0, (self.barrier / max(self._last_barrier, _NARROW)) ** 0.5)

    # Evaluation --------------------------------------------------------------------------

    @property
    def x(self) -> np.ndarray:
        """The unknowns of the program."""
        return self.w[: self._size]

    @property
    def bound_multipliers(self) -> tuple[np.ndarray, np.ndarray]:
        """Multipliers of the lower and upper bounds of x."""
        z = self.multipliers
        return z.lower[: self._size].copy(), z.upper[: self._size].copy()

    def _primal_of(self, w: np.ndarray) -> np.ndarray:
        """c_E and g - s at the rows (num_constraints,)."""
        rows = self.program.rows(w[: self._size]) - self._target
        rows[self._inequality] -= w[self._size :]
        return rows

    def _barrier_cost(self, w: np.ndarray, cost: float) -> float:
        low, high = self._gaps(w)
        logs = np.log(low[self._has_low]).sum() + np.log(high[self._has_high]).sum()
        return cost - self.barrier * logs

    def _evaluate(self) -> None:
        x = self.x
        self.cost = self.program.cost(x)
        self._primal = self._primal_of(self.w)
        self._gradient = self.program.gradient(x)
        self._jacobian = self.system.jacobian(x)

    @property
    def violation(self) -> float:
        """Largest violation of a row that ignores slacks' help, scaled."""
        return float(np.abs(self._primal).max())

    def errors(self, barrier: float) -> Errors:
        """The scaled KKT errors for a barrier parameter (0: of the program itself)."""
        y, low_y, high_y = self.multipliers.rows, self.multipliers.lower, self.multipliers.upper
        dual = self._gradient + self._jacobian.T @ y
        dual = np.concatenate([dual, -y[self._inequality]]) - low_y + high_y
        low, high = self._gaps(self.w)
        products = np.concatenate(
            [
                low_y[self._has_low] * low[self._has_low],
                high_y[self._has_high] * high[self._has_high],
            ]
        )
        of_bounds = low_y.sum() + high_y.sum()
        count = len(products)
        scale_d = max(_SCALE_MAX, (np.abs(y).sum() + of_bounds) / (len(y) + count)) / _SCALE_MAX
        scale_c = max(_SCALE_MAX, of_bounds / count) / _SCALE_MAX
        return Errors(
            float(np.abs(dual).max() / scale_d),
            float(np.abs(self._primal).max()),
            float(np.abs(products - barrier).max() / scale_c),
        )

    # Iteration ---------------------------------------------------------------------------

    def lower_barrier(self, factor: float | None = None) -> None:
        """Go on to the next barrier problem, (7)."""
        if factor is None:
            smaller = min(_KAPPA_MU * self.barrier, self.barrier**_THETA_MU)
        else:
            smaller = factor * self.barrier
        self.barrier = max(self._last_barrier, smaller)
        self._filter.clear()
        self._small_steps, self._costs = 0, []
        if self.smoothing != self.program.smoothing:
            self.program.smoothing = self.smoothing
            self._evaluate()

    @property
    def at_last_barrier(self) -> bool:
        """Whether the barrier parameter will fall no more."""
        return self.barrier <= self._last_barrier

    def solved_barrier_problem(self) -> bool:
        """Whether the error is small enough for a smaller barrier parameter."""
        return self.errors(self.barrier).worst <= _KAPPA_EPS * self.barrier

    @property
    def little_left(self) -> bool:
        """Whether the cost of this barrier problem changes little beside what the barrier adds."""
        if self.at_last_barrier or len(self._costs) <= _LOOK_BACK or self.violation > _NEARLY_HELD:
            return False
        change = abs(self._costs[-1] - self._costs[-1 - _LOOK_BACK])
        count = np.count_nonzero(self._has_low) + np.count_nonzero(self._has_high)
        return change < _LITTLE_LEFT * self.barrier * count

    def step(self) -> bool:
        """One iteration; False if no acceptable step was found."""
        low, high = self._gaps(self.w)
        z = self.multipliers
        stiffness = z.lower / low + z.upper / high
        by_row = np.zeros(self.program.num_constraints)
        by_row[self._inequality] = stiffness[self._size :]
        self.system.linearise(
            self.x, z.rows, by_row, stiffness[: self._size], self._jacobian
        )
        if not self._regularisation.factor(self._small_steps >= _CREEPING):
            return False
        targets = Targets.equal(self.barrier, len(self.w))
        push = targets.push(low, high)
        while True:
            direction = self._direction(self._primal, stiffness, push)
            if self._centred(direction, stiffness, targets):
                return True
            if self._search(direction, stiffness, push):
                return True
            if not self._regularisation.more():
                return False

    def _direction(
        self, primal: np.ndarray, stiffness: np.ndarray, push: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray]:
        """Newton's step of (x, s) and of the rows' multipliers."""
        y, size, rows = self.multipliers.rows, self._size, self._inequality
        slack_stiffness = stiffness[size:]
        rest = y[rows] - push[size:]
        weights = np.zeros(len(y))
        weights[rows] = slack_stiffness * primal[rows] - rest
        b = -(self._gradient + self._jacobian.T @ (y + weights) + push[:size])
        dx, dy = self.system.solve(b, primal)
        ds = (self._jacobian @ dx)[rows] + primal[rows]
        dy[rows] = slack_stiffness * ds - rest
        return np.concatenate([dx, ds]), dy

    def _centred(
        self, direction: tuple[np.ndarray, np.ndarray], stiffness: np.ndarray, targets: Targets
    ) -> bool:
        """A longer step by corrected targets; moves if there is one and it is accepted."""
        low, high = self._gaps(self.w)
        fraction, push = self._fraction, targets.push(low, high)
        longest = longest_step(low, high, direction[0], fraction)
        better = None
        for _ in range(CORRECTIONS):
            if longest > LONG:
                break
            corrected = targets.corrected(
                self.barrier, low, high, self.multipliers, direction[0], longest
            )
            other = self._direction(self._primal, stiffness, corrected.push(low, high))
            length = longest_step(low, high, other[0], fraction)
            if length < longest + WORTH:
                break
            targets, direction, longest, better = corrected, other, length, other
        if better is None:
            return False
        dw, dy = better
        trial = self.w + longest * dw
        measures, _ = self._measure(trial)
        theta, phi = np.abs(self._primal).sum(), self._barrier_cost(self.w, self.cost)
        slope = float(self._gradient @ dw[: self._size] + push @ dw)
        if not self._filter.accepts(theta, phi, measures, slope, longest):
            return False
        self._move(trial, dw, dy, longest, targets)
        return True

    def _search(
        self,
        direction: tuple[np.ndarray, np.ndarray],
        stiffness: np.ndarray,
        push: np.ndarray,
    ) -> bool:
        """Backtracking line search; moves if a step is accepted."""
        dw, dy = direction
        longest = longest_step(*self._gaps(self.w), dw, self._fraction)
        theta = np.abs(self._primal).sum()
        phi = self._barrier_cost(self.w, self.cost)
        slope = float(self._gradient @ dw[: self._size] + push @ dw)
        smallest = self._filter.smallest_step(theta, slope)
        step, first = longest, True
        equal = Targets.equal(self.barrier, len(dw))
        while step >= max(smallest, 1e-8):
            trial = self.w + step * dw
            measures, primal = self._measure(trial)
            if self._filter.accepts(theta, phi, measures, slope, step):
                self._move(trial, dw, dy, step, equal)
                return True
            worse = first and theta <= measures[0] < np.inf
            if worse and self._correct(primal, stiffness, push, theta, phi, slope, step):
                return True
            first = False
            step *= 0.5
        return False

    def _correct(
        self, primal: np.ndarray, stiffness: np.ndarray, push: np.ndarray, theta: float,
        phi: float, slope: float, step: float,
    ) -> bool:  # fmt: skip
        """Second-order corrections of the longest step."""
        total = step * self._primal + primal
        before, equal = np.inf, Targets.equal(self.barrier, len(self.w))
        for _ in range(_CORRECTIONS):
            dw, dy = self._direction(total, stiffness, push)
            longest = longest_step(*self._gaps(self.w), dw, self._fraction)
            trial = self.w + longest * dw
            measures, primal = self._measure(trial)
            if self._filter.accepts(theta, phi, measures, slope, step):
                self._move(trial, dw, dy, longest, equal)
                return True
            if not measures[0] <= _CORRECTED * before:
                return False
            before, total = measures[0], longest * total + primal
        return False

    def _measure(self, w: np.ndarray) -> tuple[tuple[float, float], np.ndarray]:
        """Violation and barrier cost at `w`, and the violated rows."""
        primal = self._primal_of(w)
        theta = float(np.abs(primal).sum())
        if not np.isfinite(theta):
            return (np.inf, np.inf), primal
        cost = self._barrier_cost(w, self.program.cost(w[: self._size]))
        return (theta, cost if np.isfinite(cost) else np.inf), primal

    @property
    def _fraction(self) -> float:
        """Of the distance to a bound that a step may use, (8)."""
        return max(_TAU, 1.0 - self.barrier)

    def _move(
        self, w: np.ndarray, dw: np.ndarray, dy: np.ndarray, step: float, targets: Targets
    ) -> None:
        """Accept `w`; the multipliers follow."""
        z, barrier, before = self.multipliers, self.barrier, self.cost
        d_low, d_high = targets.changes(*self._gaps(self.w), z, dw)
        free = np.full(len(w), np.inf)
        longest = min(
            longest_step(z.lower, free, d_low, self._fraction),
            longest_step(z.upper, free, d_high, self._fraction),
        )
        self.w = w
        new_low, new_high = self._gaps(w)

        def guarded(value: np.ndarray, gap: np.ndarray) -> np.ndarray:
            return np.clip(value, barrier / (_KAPPA_SIGMA * gap), _KAPPA_SIGMA * barrier / gap)

        self.multipliers = Multipliers(
            z.rows + step * dy,
            guarded(z.lower + longest * d_low, new_low),
            guarded(z.upper + longest * d_high, new_high),
        )
        self._evaluate()
        self._costs.append(self.cost)
        small = step >= _FULL and abs(self.cost - before) < _LITTLE_CHANGE * abs(before)
        self._small_steps = self._small_steps + 1 if small else 0
