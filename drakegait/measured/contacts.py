"""Which foot stands when: from forces where there are any, from the motion elsewhere."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.signal import find_peaks

from drakegait.errors import BadFile
from drakegait.measured.force_records import ForceRecord
from drakegait.measured.notes import Notes
from drakegait.measured.posture import Posture

_LONGEST_STANCE = 1.45  # of the stance that the motion shows: more is two feet on one plate
_OVERLAP = 0.3  # of two stances that are one and the same, at least
_NEAR = 0.35  # [m] a centre of pressure farther from both feet belongs to other axes


@dataclass(frozen=True, eq=False, kw_only=True)
class Contact:
    """One foot on the ground.

    Attributes:
        side: `"r"` or `"l"`.
        start, end: heel strike and toe off [s].
        record: the force, None where only the motion tells.
        whole: whether start and end were both seen.
    """

    side: str
    start: float
    end: float
    record: ForceRecord | None
    whole: bool


def find_contacts(
    posture: Posture, records: Sequence[ForceRecord], notes: Notes, name: str
) -> list[Contact]:
    """All contacts of both feet in the order of their start.

    Every stretch of force is given to the foot that stands there: the one nearest to the centre of
    pressure; where there is none, or it fits neither foot, the one whose stance, by the motion,
    overlaps most. What the file says comes last; but of a stance of which the motion shows no
    start or the forces no end, it comes before the motion.

    Args:
        name: of the file of forces, for messages.
    """
    moving = {side: kinematic_stances(posture, side) for side in "rl"}
    typical = np.median([b - a for stances in moving.values() for a, b in stances] or [0.8])
    loaded, swapped = [], {}
    for record in records:
        time = record.series.time
        for start, end in record.contacts():
            if end < posture.time[0] or start > posture.time[-1]:
                continue
            whole = start > time[0] + 0.01 and end < time[-1] - 0.01
            if end - start > _LONGEST_STANCE * typical:
                notes.say(
                    f"{name}: {record.label} is loaded from {start:.2f} to {end:.2f} s without a "
                    "break: both feet stood on it, and it was not used there."
                )
                continue
            side = _nearest(record, start, end, posture, notes, name)
            if side is None:
                side = _by_time(record, start, end, whole, moving)
            if side is not None and record.side is not None:
                swapped.setdefault(record.label, []).append(side != record.side)
            loaded.append((side, start, end, record, whole))
    _say_swapped(swapped, notes, name)
    found = [
        Contact(
            side=side or _by_name(record, swapped), start=start, end=end, record=record,
            whole=whole,
        )
        for side, start, end, record, whole in loaded
    ]  # fmt: skip
    if not found:
        raise BadFile(name, "has no contact of one foot in the time of the motion "
                      f"({posture.time[0]:.2f} to {posture.time[-1]:.2f} s).")  # fmt: skip
    found += _unloaded(found, moving, notes)
    return sorted(found, key=lambda contact: contact.start)


def kinematic_stances(posture: Posture, side: str) -> list[tuple[float, float]]:
    """Heel strikes and toe offs of a foot from the motion alone [s].

    The heel is farthest in front of the hips at heel strike, the toe farthest behind them at toe
    off (Zeni, Richards & Higginson 2008).
    """
    heel, toe = (0, 1) if side == "r" else (2, 3)
    time = posture.time
    step = time[1] - time[0]
    least = max(1, int(0.5 / step))
    strikes = find_peaks(posture.points[:, heel, 0], distance=least, prominence=0.1)[0]
    offs = find_peaks(-posture.points[:, toe, 0], distance=least, prominence=0.1)[0]
    stances = []
    for strike in strikes:
        after = offs[offs > strike]
        if after.size and time[after[0]] - time[strike] < 1.6:
            stances.append((float(time[strike]), float(time[after[0]])))
    return stances


def _nearest(
    record: ForceRecord, start: float, end: float, posture: Posture, notes: Notes, name: str
) -> str | None:
    """The foot near the centres of pressure, None if they do not tell."""
    margin = 0.2 * (end - start)
    inside = (record.series.time > start + margin) & (record.series.time < end - margin)
    if record.pressure is not None and all(posture.place[:2]) and inside.any():
        time, place = record.series.time[inside], record.pressure[inside]
        seen = np.isfinite(place).all(axis=1) & (time >= posture.time[0])
        seen &= time <= posture.time[-1]
        if seen.any():
            far = _distances(posture, time[seen], place[seen])
            if far.min() < _NEAR and abs(far[0] - far[1]) > 0.05:
                return "rl"[int(np.argmin(far))]
            if far.min() >= _NEAR:
                notes.say(
                    f"{name}: centres of pressure lie {far.min():.2f} m or more from both feet, so "
                    "they are given in other axes than the motion; the feet were told apart by "
                    "time."
                )
    return None


def _by_time(
    record: ForceRecord,
    start: float,
    end: float,
    whole: bool,
    moving: dict[str, list[tuple[float, float]]],
) -> str | None:
    """The foot whose stance, by the motion, overlaps most; None to go by the file."""
    overlap = [_overlap(moving[side], start, end) for side in "rl"]
    clear = whole and max(overlap) >= _OVERLAP and abs(overlap[0] - overlap[1]) >= 0.1
    if record.side is not None and not clear:
        return None
    return "rl"[int(np.argmax(overlap))]


def _by_name(record: ForceRecord, swapped: dict[str, list[bool]]) -> str:
    """The foot that the file names, or the other if its whole stances were the other's."""
    if np.mean(swapped.get(record.label, [False])) > 0.5:
        return "l" if record.side == "r" else "r"
    return record.side


def _distances(posture: Posture, time: np.ndarray, place: np.ndarray) -> np.ndarray:
    """Mean horizontal distance (2,) of centres of pressure from right and left foot [m]."""
    far = []
    for heel in (0, 2):
        points = posture.points[:, heel : heel + 2, :2] + posture.hips[:, None, :2]
        flat = points.reshape(len(points), 4)
        there = np.stack([np.interp(time, posture.time, column) for column in flat.T], axis=-1)
        a, b = there[:, :2], there[:, 2:]
        along = b - a
        share = np.sum((place[:, :2] - a) * along, axis=1) / np.sum(along**2, axis=1)
        nearest = a + np.clip(share, 0.0, 1.0)[:, None] * along
        far.append(np.linalg.norm(place[:, :2] - nearest, axis=1).mean())
    return np.array(far)


def _overlap(stances: Sequence[tuple[float, float]], start: float, end: float) -> float:
    shares = [max(0.0, min(end, b) - max(start, a)) / (max(end, b) - min(start, a))
              for a, b in stances]  # fmt: skip
    return max(shares, default=0.0)


def _say_swapped(swapped: dict[str, list[bool]], notes: Notes, name: str) -> None:
    wrong = [label for label, votes in swapped.items() if np.mean(votes) > 0.5]
    if wrong:
        notes.say(f"{name}: the feet are swapped: {', '.join(wrong)} stood under the other foot "
                  "than its name says; the forces were given to the right feet.")  # fmt: skip
    odd = [label for label, votes in swapped.items() if 0.0 < np.mean(votes) <= 0.5]
    if odd:
        notes.say(f"{name}: {', '.join(odd)} was trodden by the other foot at times; those forces "
                  "were given to that foot.")  # fmt: skip


def _unloaded(found: list[Contact], moving, notes: Notes) -> list[Contact]:
    """Stances that the motion shows and no plate recorded, shifted as the others differ."""
    added = []
    shift = np.median(
        [(c.start - a, c.end - b) for c in found if c.whole for a, b in moving[c.side]
         if abs(c.start - a) < 0.2 and abs(c.end - b) < 0.25] or [(0.0, 0.0)], axis=0,
    )  # fmt: skip
    if max(abs(shift)) > 0.08:
        notes.say(f"Heel strike is {1e3 * shift[0]:+.0f} ms and toe off {1e3 * shift[1]:+.0f} ms "
                  "later by force than by motion: are both files on one clock?")  # fmt: skip
    for side in "rl":
        loaded = [(c.start, c.end) for c in found if c.side == side]
        for a, b in moving[side]:
            if _overlap(loaded, a, b) < _OVERLAP:
                added.append(Contact(side=side, start=a + shift[0], end=b + shift[1], record=None,
                                     whole=True))  # fmt: skip
    return added
