"""Which trial points a line search accepts: those that no earlier iterate dominates.

Waechter & Biegler, "On the implementation of an interior-point filter line-search algorithm
for large-scale nonlinear programming", Math. Program. 106 (2006), section 2.3; constants theirs.
"""

from __future__ import annotations

_GAMMA_VIOLATION, _GAMMA_COST = 1e-5, 1e-8
_POWER_COST, _POWER_VIOLATION = 2.3, 1.1
_ARMIJO = 1e-8
_MOST, _LITTLE = 1e4, 1e-4  # of the first violation: never allowed above; small below
_ROUNDING = 1e-14  # of the cost: differences below it mean nothing


class Filter:
    """Pairs (violation theta, barrier cost phi) that trial points must improve on.

    Args:
        violation: theta at the start.
    """

    def __init__(self, violation: float):
        self._most = _MOST * max(1.0, violation)
        self._little = _LITTLE * max(1.0, violation)
        self._entries: list[tuple[float, float]] = []

    def clear(self) -> None:
        """Forget all pairs: another barrier parameter makes another cost."""
        self._entries.clear()

    def accepts(
        self,
        violation: float,
        cost: float,
        trial: tuple[float, float],
        slope: float,
        step: float,
    ) -> bool:
        """Whether `trial` (theta, phi) may follow (violation, cost); adds to the filter.

        Args:
            slope: directional derivative of phi along the full step.
            step: length of this trial, 0 to 1.
        """
        new_violation, new_cost = trial
        if not new_violation <= self._most:
            return False
        if any(new_violation >= theta and new_cost >= phi for theta, phi in self._entries):
            return False
        rounding = _ROUNDING * 10.0 * max(1.0, abs(cost))
        switching = (
            slope < 0.0
            and step * (-slope) ** _POWER_COST > violation**_POWER_VIOLATION
        )
        if violation <= self._little and switching:
            return new_cost <= cost + _ARMIJO * step * slope + rounding
        better = (
            new_violation <= (1.0 - _GAMMA_VIOLATION) * violation
            or new_cost <= cost - _GAMMA_COST * violation + rounding
        )
        if better:
            self._entries.append(
                ((1.0 - _GAMMA_VIOLATION) * violation, cost - _GAMMA_COST * violation)
            )
        return better

    def smallest_step(self, violation: float, slope: float) -> float:
        """Steps below this are not worth trying."""
        smallest = _GAMMA_VIOLATION
        if slope < 0.0:
            smallest = min(smallest, -_GAMMA_COST * violation / slope)
            if violation <= self._little:
                smallest = min(smallest, violation**_POWER_VIOLATION / (-slope) ** _POWER_COST)
        return 0.05 * smallest
