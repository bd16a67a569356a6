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
from drakegait.solvers.condensed.barrier_problem import BarrierProblem
from drakegait.solvers.condensed.centrality import CORRECTIONS, LONG, WORTH, Targets
from drakegait.solvers.condensed.filter import Filter
from drakegait.solvers.condensed.iterate import Multipliers, longest_step
from drakegait.solvers.condensed.regularisation import Regularisation
from drakegait.solvers.condensed.system import CondensedSystem

_TAU = 0.99  # smallest fraction to the boundary (8)
_KAPPA_SIGMA = 1e10  # (16)
_CORRECTIONS, _CORRECTED = 4, 0.99  # second-order corrections (section 2.4)
# Full steps that change the cost by less than this part of itself creep, if there are so many.
_LITTLE_CHANGE, _FULL, _CREEPING = 1e-3, 0.95, 2
# A barrier problem of a first solve is left when the cost has changed over so many steps by less
# than this part of the sum of products, mu at each bound, with rows nearly held.
_LOOK_BACK, _LITTLE_LEFT, _NEARLY_HELD = 4, 0.03, 0.1


class InteriorPoint(BarrierProblem):
    """The iteration; call `step` until the errors are small. Arguments: see `BarrierProblem`."""

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
        super().__init__(program, system, x, barrier, last_barrier, push, known)
        self._regularisation, self._small_steps = Regularisation(system), 0
        self._filter = Filter(np.abs(self.primal).sum())
        self._costs: list[float] = []  # with this barrier parameter
        self._first_solve = known is None

    def lower_barrier(self, factor: float | None = None) -> None:
        """Go on to the next barrier problem."""
        super().lower_barrier(factor)
        self._filter.clear()
        self._small_steps, self._costs = 0, []

    def move_bounds(self, program: GaitProgram, system: CondensedSystem) -> None:
        """Go on with a program that differs in bounds only."""
        super().move_bounds(program, system)
        self._regularisation.move_to(system)
        self._filter.clear()

    @property
    def little_left(self) -> bool:
        """Whether the cost of this barrier problem changes little beside what the barrier adds."""
        if not self._first_solve or self.at_last_barrier or self.violation > _NEARLY_HELD:
            return False
        if len(self._costs) <= _LOOK_BACK:
            return False
        change = abs(self._costs[-1] - self._costs[-1 - _LOOK_BACK])
        count = np.count_nonzero(self.has_low) + np.count_nonzero(self.has_high)
        return change < _LITTLE_LEFT * self.barrier * count

    def step(self) -> bool:
        """One iteration; False if no acceptable step was found."""
        low, high = self.gaps(self.w)
        z = self.multipliers
        stiffness = z.lower / low + z.upper / high
        by_row = np.zeros(self.program.num_constraints)
        by_row[self.inequality] = stiffness[self.size :]
        self.system.linearise(
            self.x, z.rows, by_row, stiffness[: self.size], self.jacobian
        )
        if not self._regularisation.factor(self._small_steps >= _CREEPING):
            return False
        targets = Targets.equal(self.barrier, len(self.w))
        push = targets.push(low, high)
        while True:
            direction = self._direction(self.primal, stiffness, push)
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
        y, size, rows = self.multipliers.rows, self.size, self.inequality
        slack_stiffness = stiffness[size:]
        rest = y[rows] - push[size:]
        weights = np.zeros(len(y))
        weights[rows] = slack_stiffness * primal[rows] - rest
        b = -(self.gradient + self.jacobian.T @ (y + weights) + push[:size])
        dx, dy = self.system.solve(b, primal)
        ds = (self.jacobian @ dx)[rows] + primal[rows]
        dy[rows] = slack_stiffness * ds - rest
        return np.concatenate([dx, ds]), dy

    def _centred(
        self, direction: tuple[np.ndarray, np.ndarray], stiffness: np.ndarray, targets: Targets
    ) -> bool:
        """A longer step by corrected targets; moves if there is one and it is accepted."""
        low, high = self.gaps(self.w)
        fraction, push = self._fraction, targets.push(low, high)
        longest = longest_step(low, high, direction[0], fraction)
        better = None
        for _ in range(CORRECTIONS):
            if longest > LONG:
                break
            corrected = targets.corrected(
                self.barrier, low, high, self.multipliers, direction[0], longest
            )
            other = self._direction(self.primal, stiffness, corrected.push(low, high))
            length = longest_step(low, high, other[0], fraction)
            if length < longest + WORTH:
                break
            targets, direction, longest, better = corrected, other, length, other
        if better is None:
            return False
        dw, dy = better
        trial = self.w + longest * dw
        measures, _ = self.measure(trial)
        theta, phi = np.abs(self.primal).sum(), self.barrier_cost(self.w, self.cost)
        slope = float(self.gradient @ dw[: self.size] + push @ dw)
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
        longest = longest_step(*self.gaps(self.w), dw, self._fraction)
        theta = np.abs(self.primal).sum()
        phi = self.barrier_cost(self.w, self.cost)
        slope = float(self.gradient @ dw[: self.size] + push @ dw)
        smallest = self._filter.smallest_step(theta, slope)
        step, first = longest, True
        equal = Targets.equal(self.barrier, len(dw))
        while step >= max(smallest, 1e-8):
            trial = self.w + step * dw
            measures, primal = self.measure(trial)
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
        total = step * self.primal + primal
        before, equal = np.inf, Targets.equal(self.barrier, len(self.w))
        for _ in range(_CORRECTIONS):
            dw, dy = self._direction(total, stiffness, push)
            longest = longest_step(*self.gaps(self.w), dw, self._fraction)
            trial = self.w + longest * dw
            measures, primal = self.measure(trial)
            if self._filter.accepts(theta, phi, measures, slope, step):
                self._move(trial, dw, dy, longest, equal)
                return True
            if not measures[0] <= _CORRECTED * before:
                return False
            before, total = measures[0], longest * total + primal
        return False

    @property
    def _fraction(self) -> float:
        """Of the distance to a bound that a step may use, (8)."""
        return max(_TAU, 1.0 - self.barrier)

    def _move(
        self, w: np.ndarray, dw: np.ndarray, dy: np.ndarray, step: float, targets: Targets
    ) -> None:
        """Accept `w`; the multipliers follow."""
        z, barrier, before = self.multipliers, self.barrier, self.cost
        d_low, d_high = targets.changes(*self.gaps(self.w), z, dw)
        free = np.full(len(w), np.inf)
        longest = min(
            longest_step(z.lower, free, d_low, self._fraction),
            longest_step(z.upper, free, d_high, self._fraction),
        )
        self.w = w
        new_low, new_high = self.gaps(w)

        def guarded(value: np.ndarray, gap: np.ndarray) -> np.ndarray:
            return np.clip(value, barrier / (_KAPPA_SIGMA * gap), _KAPPA_SIGMA * barrier / gap)

        self.multipliers = Multipliers(
            z.rows + step * dy,
            guarded(z.lower + longest * d_low, new_low),
            guarded(z.upper + longest * d_high, new_high),
        )
        self.evaluate()
        self._costs.append(self.cost)
        small = step >= _FULL and abs(self.cost - before) < _LITTLE_CHANGE * abs(before)
        self._small_steps = self._small_steps + 1 if small else 0
