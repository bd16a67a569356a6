"""Does a table hold a walking person, in the units that it states?

A factor of 57 or 1000 is easier to see here than in an optimisation that does not converge.
All values come in plant signs and in what the table says are metres, radians and newtons.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from drakegait.errors import InvalidInput
from drakegait.walker.coordinates import Coordinate
from drakegait.walker.subject import Subject

"""Acceleration of gravity that makes a body weight of a mass [m/s^2]."""

LARGEST_ANGLE = math.pi  # no joint of a walking person, not even the knee, gets near
SMALLEST_LARGEST_ANGLE = math.radians(5.0)  # a knee that stays below this does not walk


def check_angles(table: Sequence[Coordinate], motion: np.ndarray) -> None:
    """Refuse degrees called radians and radians called degrees; motion (K, num_coordinates)."""
    angles = [k for k, c in enumerate(table) if c.is_rotation]
    reach = np.abs(motion[:, angles]).max(axis=0)
    worst = int(np.argmax(reach))
    largest, name = float(reach[worst]), table[angles[worst]].name
    if largest > LARGEST_ANGLE:
        allowed = "at most pi; this looks like degrees stated as radians"
        raise InvalidInput(f"largest {name} in rad", round(largest, 3), allowed)
    if largest < SMALLEST_LARGEST_ANGLE:
        allowed = "at least 0.087, 5 degrees; this looks like radians stated as degrees"
        raise InvalidInput(f"largest angle, {name}, in rad", round(largest, 5), allowed)


def check_height(hip_height: np.ndarray, subject: Subject) -> None:
    """Refuse a hip that is not at hip height: hat_z is about half the body height."""
    low, high = 0.3 * subject.height, 0.75 * subject.height
    mean = float(np.mean(hip_height))
    if not low <= mean <= high:
        allowed = f"{low:.2f} to {high:.2f}, the height of the hips{_hint(mean, low, high)}"
        raise InvalidInput("mean hat_z in m", round(mean, 4), allowed)


def check_sideways(sideways: np.ndarray) -> None:
    """Refuse a body that sways by more than half a metre."""
    extent = float(np.ptp(sideways))
    if extent > 0.5:
        allowed = f"at most 0.5{_hint(extent, 0.01, 0.2)}"
        raise InvalidInput("range of hat_y in m", round(extent, 3), allowed)


def check_advance(forward: np.ndarray, stride_length: float) -> float:
    """What hat_x gains in the table: a stride length within 5 %, or nothing if removed before."""
    advance = float(forward[-1] - forward[0])
    margin = 0.05 * abs(stride_length)
    removed = abs(advance) <= margin and np.ptp(forward) <= 0.5 * abs(stride_length)
    if removed or abs(advance - stride_length) <= margin:
        return advance
    if abs(advance) <= margin:
        advance = float(np.ptp(forward))
    hint = _hint(abs(advance), 0.8 * abs(stride_length), 1.2 * abs(stride_length))
    allowed = (
        f"within 5 % of the stride length {stride_length:.3f} of the foot placement, "
        f"or 0 if removed before{hint}"
    )
    raise InvalidInput("advance of hat_x in m", round(advance, 3), allowed)


def check_forces(forces: np.ndarray, body_weight: float) -> None:
    """Refuse forces that cannot carry the body; forces (K, 6) act on the feet, z up."""
    peak = float(forces[:, [2, 5]].max())
    low, high = 0.5 * body_weight, 4.0 * body_weight
    if not low <= peak <= high:
        hint = _hint(peak, low, high)
        if low <= peak * body_weight <= high:
            hint = "; this looks like body weights stated as newtons"
        elif low <= -float(forces[:, [2, 5]].min()) <= high:
            hint = "; the sign is reversed: forces of the ground on the feet point up"
        allowed = f"{low:.0f} to {high:.0f}{hint}"
        raise InvalidInput("largest vertical force in N", round(peak, 3), allowed)


def _hint(value: float, low: float, high: float) -> str:
    for factor in (100.0, 1000.0):
        if low <= value / factor <= high:
            return f"; the unit looks {factor:g} times too large"
        if low <= value * factor <= high:
            return f"; the unit looks {factor:g} times too small"
    return ""
