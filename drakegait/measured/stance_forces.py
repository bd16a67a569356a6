"""The ground force on each foot over the chosen stride.

A stance that begins before or ends after the stride is folded into the cycle: a foot's force is
one whole stance, laid from its heel strike to its toe off.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from scipy.interpolate import CubicSpline

from drakegait.errors import BadFile
from drakegait.measured.contacts import Contact
from drakegait.measured.notes import Notes
from drakegait.measured.strides import Stride

_SIDE_NAMES = {"r": "right", "l": "left"}
_CLOSE = 0.06  # [s] heel strikes that are the same


def stance_forces(
    stride: Stride, contacts: Sequence[Contact], tau: np.ndarray, notes: Notes
) -> np.ndarray:
    """Forces (K, 6) [N] on right and left foot at tau (K,), zero in swing.

    A foot whose stance was not recorded completely gets another complete stance of the same foot;
    if there is none, that of the other foot, mirrored. Both are said.

    Raises:
        BadFile: no complete stance of either foot.
    """
    forces = np.zeros((tau.size, 6))
    whole = {side: [c for c in contacts if c.side == side and c.whole and c.record is not None
                    and c.record.series.covers(c.start, c.end)] for side in "rl"}  # fmt: skip
    events = stride.strikes_and_offs
    for foot, side in enumerate("rl"):
        strike, off = events[side]
        mirrored = not whole[side]
        candidates = whole["l" if side == "r" else "r"] if mirrored else whole[side]
        if not candidates:
            raise BadFile("the force file", "holds no stance of one foot, from heel strike to toe "
                          "off, whose force was recorded completely.")  # fmt: skip
        own = stride.stances[side]
        contact = min(candidates, key=lambda c: abs(c.start - own[0]))
        if mirrored:
            notes.say(
                f"No stance of the {_SIDE_NAMES[side]} foot was recorded completely: its force is "
                "that of the other foot, mirrored."
            )
        elif min(abs(contact.start - instant) for instant in own) > _CLOSE:
            notes.say(
                f"The force on the {_SIDE_NAMES[side]} foot is that of its stance from "
                f"{contact.start:.2f} s, as the one in the stride was not recorded completely."
            )
        share = ((tau - strike) % 1.0) / (off - strike)
        inside = share <= 1.0
        values = _curve(contact)(share[inside])
        if mirrored:
            values[:, 1] *= -1.0
        forces[inside, 3 * foot : 3 * foot + 3] = values
    forces[:, [2, 5]] = np.maximum(forces[:, [2, 5]], 0.0)
    return forces


def _curve(contact: Contact) -> CubicSpline:
    """Force (..., 3) [N] by the share of the stance, going to zero at both ends."""
    time, values = contact.record.series.time, contact.record.series.values
    inside = (time >= contact.start) & (time <= contact.end)
    share = (time[inside] - contact.start) / (contact.end - contact.start)
    # the filter spreads what is there beyond both ends: fade it over 2 % of the stance
    edge = np.clip(np.minimum(share, 1.0 - share) / 0.02, 0.0, 1.0)
    fade = edge * edge * (3.0 - 2.0 * edge)
    return CubicSpline(share, fade[:, None] * values[inside], axis=0)
