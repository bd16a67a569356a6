"""One leg of a gait as curves over its own cycle, and what is read off them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from drakegait.paper.numbers import Missing
from drakegait.report.curves import GaitCurves

Curve = tuple[np.ndarray, np.ndarray]
"""Percentage of the leg's own cycle, from its heel strike, and values."""


@dataclass(frozen=True)
class Leg:
    """One side of a gait.

    Attributes:
        curves: of the gait.
        side: `"right"` or `"left"`.
    """

    curves: GaitCurves
    side: str

    def angle(self, joint: str) -> Curve:
        """Joint angle [degree], positive in the sense of its name."""
        return self._own(self.curves.coordinate(f"{joint}_{self.side[0]}"), joint)

    def moment(self, joint: str) -> Curve:
        """Internal joint moment [N m/kg], positive in the sense of the joint's name."""
        return self._own(self._joint(joint, "joint_moment"), joint, self.curves.mass)

    def power(self, joint: str) -> Curve:
        """Power at this axis of a joint [W/kg], positive where it is generated."""
        return self._own(self._joint(joint, "joint_power"), joint, self.curves.mass)

    def force(self, axis: str) -> Curve:
        """Force of the ground [body weights]: `"vertical"`, `"fore-aft"` or `"medial"`."""
        return self._own(self.curves.ground_reaction(self.side, axis), axis, 100.0)

    def _joint(self, joint: str, variable: str) -> np.ndarray | None:
        return self.curves.joint(f"{joint}_{self.side[0]}", variable)

    def _own(self, values: np.ndarray | None, name: str, divisor: float = 1.0) -> Curve:
        if values is None:
            raise Missing(f"This walker has no {name}.")
        percent, own = self.curves.own_cycle(self.side, values)
        within = (percent >= 0.0) & (percent <= 100.0)
        return percent[within], own[within] / divisor


Read = Callable[[Leg], float]


def _part(curve: Curve, low: float, high: float) -> Curve:
    percent, values = curve
    within = (percent >= low) & (percent <= high)
    return percent[within], values[within]


def largest(curve: Callable[[Leg], Curve], low: float = 0.0, high: float = 100.0) -> Read:
    """The greatest value between two percentages of the leg's cycle."""
    return lambda leg: float(_part(curve(leg), low, high)[1].max())


def least(curve: Callable[[Leg], Curve], low: float = 0.0, high: float = 100.0) -> Read:
    """The least value between two percentages of the leg's cycle."""
    return lambda leg: float(_part(curve(leg), low, high)[1].min())


def when(curve: Callable[[Leg], Curve], sign: int, low: float = 0.0, high: float = 100.0) -> Read:
    """Where the greatest (sign 1) or least (sign -1) value is [% of the leg's cycle]."""

    def read(leg: Leg) -> float:
        percent, values = _part(curve(leg), low, high)
        return float(percent[np.argmax(sign * values)])

    return read
