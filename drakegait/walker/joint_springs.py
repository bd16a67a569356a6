"""Springs and dampers at single joints: stiff joints, orthoses, prosthetic feet.

With x the angle beyond the neutral one in the joint's anatomical sense and P(x) a rounded
max(x, 0), the moment in that sense is

    M = -[ k_below x + (k_above - k_below) P(x) ] - d x',
    P(x) = (x + sqrt(x^2 + w^2) - w) / 2,   w = 2 degrees,

so that the two stiffnesses meet without a corner and M = 0 at the neutral angle.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from drakegait.walker import coordinates

ROUNDING = math.radians(2.0)
"""w: width over which one stiffness passes into the other [rad]."""


@dataclass(frozen=True)
class JointSpring:
    """A spring with a damper at one joint.

    Attributes:
        coordinate: name of the joint angle.
        below, above: stiffness on either side of the neutral angle [N m/rad], anatomical sense.
        neutral: angle without moment, anatomical sense [rad].
        damping: [N m s/rad].
    """

    coordinate: str
    below: float
    above: float
    neutral: float
    damping: float


class JointSprings:
    """All springs of a walker, as functions of its coordinates in plant signs.

    Args:
        kind: `"spatial"` or `"planar"`.
        springs: any number, also several at one joint.

    Attributes:
        damping: (n,) sums of the dampers of each coordinate [N m s/rad].
    """

    def __init__(self, kind: str, springs: Sequence[JointSpring]):
        self._which = coordinates.positions(kind, [spring.coordinate for spring in springs])
        self._signs = coordinates.anatomical_signs(kind)[self._which]
        self._neutral = np.array([spring.neutral for spring in springs])
        self._below = np.array([spring.below for spring in springs])
        self._rise = np.array([spring.above - spring.below for spring in springs])
        num = len(coordinates.names(kind))
        self._spread = np.zeros((len(springs), num))
        self._spread[np.arange(len(springs)), self._which] = 1.0
        self.damping = np.array([spring.damping for spring in springs]) @ self._spread

    def _stretch(self, q: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """x (..., springs) and sqrt(x^2 + w^2)."""
        x = self._signs * np.asarray(q)[..., self._which] - self._neutral
        return x, np.sqrt(x * x + ROUNDING**2)

    def forces(self, q: np.ndarray) -> np.ndarray:
        """Elastic generalised forces (..., n) [N m]."""
        x, root = self._stretch(q)
        moment = -(self._below * x + self._rise * 0.5 * (x + root - ROUNDING))
        return (self._signs * moment) @ self._spread

    def slopes(self, q: np.ndarray) -> np.ndarray:
        """Derivatives (..., n) of each force by its own coordinate [N m/rad]."""
        x, root = self._stretch(q)
        return -(self._below + self._rise * 0.5 * (1.0 + x / root)) @ self._spread

    def bends(self, q: np.ndarray) -> np.ndarray:
        """Second derivatives (..., n) of each force by its own coordinate [N m/rad^2]."""
        _, root = self._stretch(q)
        return -(self._signs * self._rise * 0.5 * ROUNDING**2 / root**3) @ self._spread
