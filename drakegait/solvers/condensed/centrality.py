"""Targets of complementarity that let a step go further.

Newton's step aims all products of a distance to a bound and its multiplier at the barrier
parameter mu. A few of thousands then often end the step early. After Gondzio (Comput. Optim.
Appl. 6, 1996): see where the products would be a little further along, and move the targets of
those that would be far off mu; one more solve with the same factor gives the step.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from drakegait.solvers.condensed.iterate import Multipliers

CORRECTIONS = 3
LONG = 0.9  # a step of this length needs no correction
FURTHER = 0.5  # than the step so far: where products are looked at
WORTH = 0.05  # least gain of length
_SPREAD = 10.0  # products from mu / 10 to 10 mu are left alone


@dataclass(frozen=True)
class Targets:
    """What products of distance and multiplier are to become, at lower and upper bounds."""

    low: np.ndarray
    high: np.ndarray

    @classmethod
    def equal(cls, barrier: float, size: int) -> Targets:
        """mu everywhere."""
        same = np.full(size, barrier)
        return cls(same, same)

    def push(self, low: np.ndarray, high: np.ndarray) -> np.ndarray:
        """The gradient of the barrier for these targets; distances may be infinite."""
        return self.high / high - self.low / low

    def changes(
        self, low: np.ndarray, high: np.ndarray, multipliers: Multipliers, change: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray]:
        """Newton's changes of the bounds' multipliers with the change of the unknowns."""
        z = multipliers
        d_low = self.low / low - z.lower - z.lower / low * change
        d_high = self.high / high - z.upper + z.upper / high * change
        return d_low, d_high

    def corrected(
        self,
        barrier: float,
        low: np.ndarray,
        high: np.ndarray,
        multipliers: Multipliers,
        change: np.ndarray,
        step: float,
    ) -> Targets:
        """Targets for a step longer than `step`.

        Args:
            low, high: distances to the bounds, infinite where there is none.
            change: of the unknowns with the present targets.
        """
        further = min(1.0, step + FURTHER)
        d_low, d_high = self.changes(low, high, multipliers, change)
        z = multipliers
        return Targets(
            _target(self.low, low + further * change, z.lower + further * d_low, barrier),
            _target(self.high, high - further * change, z.upper + further * d_high, barrier),
        )


def _target(
    target: np.ndarray, distance: np.ndarray, multiplier: np.ndarray, barrier: float
) -> np.ndarray:
    bounded = np.isfinite(distance)
    products = np.where(bounded, distance, 0.0) * multiplier
    wanted = np.clip(products, barrier / _SPREAD, barrier * _SPREAD)
    moved = target + np.maximum(wanted - products, -_SPREAD * barrier)
    return np.where(bounded, moved, 0.0)
