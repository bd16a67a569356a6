"""A primal-dual interior-point method on the condensed system.

    min f(x) - mu sum log(slack)   s.t.  c_E(x) = 0,  g(x) - s = 0

for a falling sequence of barrier parameters mu; line search with a filter and second-order
corrections. The algorithm is that of IPOPT (Waechter & Biegler 2006, equation numbers below)
without a restoration phase (where no step is acceptable the method says so), and with these
additions:

- corners of the energy rate are rounded widely at first and narrow with mu (`smoothing`), and their
  slopes are unknowns of their own (`walker.corners`);
- what makes K positive definite is looked for in the muscles first (`Regularisation`);
- steps bend at bounds instead of ending there (`bent_steps`), and those that a few bounds cut
  short nevertheless are corrected (`Targets`);
- a step that turns back goes half way: between two flat sides of a corner steps swing for ever.
"""

from __future__ import annotations

import numpy as np

from drakegait.program.gait_program import GaitProgram
from drakegait.solvers.condensed.barrier_problem import KAPPA_MU, BarrierProblem
from drakegait.solvers.condensed.bent_steps import OVERSHOOT, along, bent
from drakegait.solvers.condensed.centrality import CORRECTIONS, LONG, WORTH, Targets
from drakegait.solvers.condensed.filter import Filter
from drakegait.solvers.condensed.iterate import Multipliers, longest_step
from drakegait.solvers.condensed.regularisation import Regularisation
from drakegait.solvers.condensed.system import CondensedSystem
from drakegait.walker.corners import CornerSlopes

_TAU = 0.99  # smallest fraction to the boundary (8)
_KAPPA_SIGMA = 1e10  # (16)
_CORRECTIONS, _CORRECTED = 4, 0.99  # second-order corrections (section 2.4)
# A barrier problem is left when a step, taken at full length, would have changed the cost by less
# than this part of the sum of products, mu at each bound, with rows nearly held.
_LITTLE_LEFT, _NEARLY_HELD = 0.3, 0.1
_TURNED, _HALF = -0.3, 0.5  # cosine between steps from which on one turns back; and its length


class InteriorPoint(BarrierProblem):
    """The iteration; call `step` until the errors are small.

    Args:
        bends: whether steps bend at bounds, turn back half way and take corners by slopes of their
            own; others: see `BarrierProblem`.
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
        bends: bool = True,
    ):
        super().__init__(program, system, x, barrier, last_barrier, push, known)
        self._bends = bends
        self._regularisation = Regularisation(system)
        self._filter = Filter(np.abs(self.primal).sum())
        self._corners = CornerSlopes() if bends else None
        self._last_change = np.inf  # of the cost by a full step, with this barrier parameter
        self._last_step = np.zeros(0)

    def lower_barrier(self, factor: float = KAPPA_MU) -> None:
        """Go on to the next barrier problem."""
        super().lower_barrier(factor)
        self._filter.clear()
        self._last_change = np.inf

    def move_bounds(self, program: GaitProgram, system: CondensedSystem) -> None:
        """Go on with a program that differs in bounds only."""
        super().move_bounds(program, system)
        self._regularisation.move_to(system)
        self._filter.clear()

    @property
    def little_left(self) -> bool:
        """Whether the cost of this barrier problem changes little beside what the barrier adds."""
        if self.at_last_barrier or self.violation > _NEARLY_HELD:
            return False
        count = np.count_nonzero(self.has_low) + np.count_nonzero(self.has_high)
        return self._last_change < _LITTLE_LEFT * self.barrier * count

    def step(self) -> bool:
        """One iteration; False if no acceptable step was found."""
        low, high = self.gaps(self.w)
        z = self.multipliers
        stiffness = z.lower / low + z.upper / high
        by_row = np.zeros(self.program.num_constraints)
        by_row[self.inequality] = stiffness[self.size :]
        self.system.linearise(
            self.x, z.rows, by_row, stiffness[: self.size], self.jacobian, corners=self._corners
        )
        if not self._regularisation.factor():
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
        push = targets.push(low, high)
        longest = self._longest(direction[0])
        better = None
        for _ in range(CORRECTIONS):
            if longest > LONG:
                break
            corrected = targets.corrected(
                self.barrier, low, high, self.multipliers, direction[0], longest
            )
            other = self._direction(self.primal, stiffness, corrected.push(low, high))
            length = self._longest(other[0])
            if length < longest + WORTH:
                break
            targets, direction, longest, better = corrected, other, length, other
        if better is None:
            return False
        dw, dy = better
        trial = self._along(dw, longest)
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
        """Backtracking line search; moves if a step is accepted.

        Where the bent step is not, straight ones are tried: many unknowns that bend bend rows.
        """
        dw, dy = direction
        longest = self._longest(dw)
        straight = longest_step(*self.gaps(self.w), dw, self._fraction)
        theta = np.abs(self.primal).sum()
        phi = self.barrier_cost(self.w, self.cost)
        slope = float(self.gradient @ dw[: self.size] + push @ dw)
        smallest = self._filter.smallest_step(theta, slope)
        step, first = longest, True
        equal = Targets.equal(self.barrier, len(dw))
        while step >= max(smallest, 1e-8):
            trial = self._along(dw, step) if first else self.w + step * dw
            measures, primal = self.measure(trial)
            if self._filter.accepts(theta, phi, measures, slope, step):
                self._move(trial, dw, dy, step, equal)
                return True
            worse = first and theta <= measures[0] < np.inf
            if worse and self._correct(primal, stiffness, push, theta, phi, slope, step):
                return True
            step = straight if first and straight < step else 0.5 * step
            first = False
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
            longest = self._longest(dw)
            trial = self._along(dw, longest)
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

    @property
    def _overshoot(self) -> float:
        """How far a step may go, in steps to the nearest bound."""
        return OVERSHOOT if self._bends else 1.0

    def _longest(self, dw: np.ndarray) -> float:
        """The longest step along `dw` that is tried."""
        most = self._overshoot * longest_step(*self.gaps(self.w), dw, self._fraction)
        return min(_HALF if self._turns_back(dw) else 1.0, most)

    def _turns_back(self, dw: np.ndarray) -> bool:
        if not (self._bends and self.at_last_barrier):
            return False
        one, other = dw[: len(self._last_step)], self._last_step
        return float(one @ other) < _TURNED * np.sqrt((one @ one) * (other @ other))

    def _along(self, dw: np.ndarray, step: float) -> np.ndarray:
        if not self._bends:
            return self.w + step * dw
        return along(self.w, step * dw, *self.gaps(self.w))

    def _move(
        self, w: np.ndarray, dw: np.ndarray, dy: np.ndarray, step: float, targets: Targets
    ) -> None:
        """Accept `w`; the multipliers follow."""
        z, barrier, before = self.multipliers, self.barrier, self.cost
        d_low, d_high = targets.changes(*self.gaps(self.w), z, dw)
        free = np.full(len(w), np.inf)
        longest = self._overshoot * min(
            longest_step(z.lower, free, d_low, self._fraction),
            longest_step(z.upper, free, d_high, self._fraction),
        )
        longest = min(1.0, longest)
        self._last_step = (w - self.w)[: self.size]
        self.w = w
        gaps = self.gaps(w)

        def changed(value: np.ndarray, change: np.ndarray, gap: np.ndarray) -> np.ndarray:
            share = np.divide(change, value, out=np.zeros_like(value), where=value > 0.0)
            factor = bent(longest * share) if self._bends else 1.0 + longest * share
            least, most = barrier / (_KAPPA_SIGMA * gap), _KAPPA_SIGMA * barrier / gap
            return np.clip(value * factor, least, most)

        self.multipliers = Multipliers(
            z.rows + step * dy,
            changed(z.lower, d_low, gaps[0]),
            changed(z.upper, d_high, gaps[1]),
        )
        self.evaluate()
        self._last_change = abs(self.cost - before) / step
