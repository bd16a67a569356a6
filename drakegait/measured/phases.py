"""The eight contact phases of a measured stride.

Heel strike and toe off come from the forces; toe down and heel off from the pitch of the foot.
"""

from __future__ import annotations

import numpy as np

from drakegait.measured.notes import Notes
from drakegait.measured.strides import Stride

FLAT = np.radians(2.5)
"""Pitch up to which a foot counts as flat; 9 mm between heel and toe."""
RISEN = np.radians(1.0)
"""Pitch from which the heel has left the ground; it is 3.5 mm up."""
SHORTEST = 0.02
"""Shortest phase [s]."""

_NAMES = {"r": "right", "l": "left"}


def phase_events(
    stride: Stride, tau: np.ndarray, pitch: np.ndarray, notes: Notes
) -> np.ndarray:
    """Start of the eight phases (8,) as fractions of the cycle.

    The model's order of events is kept: a foot is flat before the other one leaves the ground, and
    rises its heel after that and before the other one strikes. Where the measured foot does
    otherwise, the event is put at the limit, and it is said.

    Args:
        tau: (K,) from 0, equidistant, without 1.
        pitch: (K, 2) of right and left foot relative to flat, toe down positive [rad].
    """
    events = stride.strikes_and_offs
    least = SHORTEST / stride.duration
    found = {}
    for foot, side in enumerate("rl"):
        other = "l" if side == "r" else "r"
        strike, off = events[side]
        other_off = events[other][1] % 1.0
        other_off += 1.0 if other_off < strike else 0.0
        other_strike = events[other][0]
        other_strike += 1.0 if other_strike < strike else 0.0
        curve = lambda t, foot=foot: np.interp(t % 1.0, tau, pitch[:, foot], period=1.0)  # noqa: E731
        after = np.linspace(strike, other_off, 200)
        flat = np.flatnonzero(curve(after) > -FLAT)
        down = after[flat[0]] if flat.size else np.inf
        before = np.linspace(off, other_off, 400)
        low = np.flatnonzero(curve(before) < RISEN)
        rise = before[low[0]] if low.size else -np.inf
        found[side] = (
            _within(down, strike + least, other_off - least, f"{_NAMES[side]} toe down", notes),
            _within(rise, other_off + least, other_strike - least, f"{_NAMES[side]} heel off",
                    notes),
        )  # fmt: skip
    right, left = events["r"], events["l"]
    return np.array([0.0, found["r"][0], left[1] - 1.0, found["r"][1], left[0], found["l"][0],
                     right[1], found["l"][1]])  # fmt: skip


def _within(value: float, low: float, high: float, name: str, notes: Notes) -> float:
    if low <= value <= high:
        return float(value)
    bound = low if value < low else high
    where = "earlier" if value < low else "later"
    notes.say(f"The {name} of this walk is {where} than the model's order of phases allows; it was "
              f"put at {100 * bound:.1f} % of the stride.")  # fmt: skip
    return float(bound)
