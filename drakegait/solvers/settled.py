"""Has the cost stopped changing? A second test of convergence beside the KKT conditions."""

from __future__ import annotations

from drakegait.solvers.options import SolverOptions


class Settled:
    """Notices that the cost has settled at one barrier parameter.

    The paper ends its solves by such a test (TolFun 1e-2 spatial, 1e-4 planar; section 4).

    Attributes:
        reached: the last iterations obeyed all laws and kept the cost.
        at_end: the barrier parameter was as small as it is to become.
    """

    LENGTH = 12  # iterations before the last barrier parameter,
    LENGTH_AT_END = 25  # and with it
    FACTOR = 0.03  # from one barrier parameter to the next

    def __init__(self, options: SolverOptions):
        self._options = options
        self._smallest = 0.01 * options.optimality
        self._costs: list[float] = []
        self._barrier = 0.0
        self.reached = False
        self.sentence = (
            f"cost within {options.cost_change:g} of itself over {self.LENGTH_AT_END} iterations"
        )

    @property
    def at_end(self) -> bool:
        """Whether the barrier parameter is at its smallest."""
        return self._barrier <= self._smallest

    def next_barrier(self) -> float:
        """Start again: the barrier parameter to go on with."""
        self._costs.clear()
        self.reached = False
        return max(self.FACTOR * self._barrier, 0.09 * self._smallest)

    def after(self, cost: float, violation: float, barrier: float) -> bool:
        """Take note of an iteration; True if the cost has settled."""
        if barrier != self._barrier or violation > 10.0 * self._options.feasibility:
            self._costs.clear()
        self._barrier = barrier
        length = self.LENGTH_AT_END if self.at_end else self.LENGTH
        self._costs = [*self._costs[1 - length :], cost]
        spread = max(self._costs) - min(self._costs)
        full = len(self._costs) == length and violation <= self._options.feasibility
        self.reached = full and spread < self._options.cost_change * abs(cost)
        return self.reached
