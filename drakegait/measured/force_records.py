"""Ground forces as they were recorded: one series for every plate or foot.

A group of columns is what precedes `vx`, `vy`, `vz` (force) and `px`, `py`, `pz` (centre of
pressure): `ground_force_`, `l_ground_force_`, `ground_force_r_`, `1_ground_force_`. Axes are those
of the motion file: X forward, Y up, Z to the right.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from drakegait.errors import BadFile, UnknownName
from drakegait.measured.notes import Notes
from drakegait.measured.table import Table
from drakegait.measured.time_axis import Series, equidistant, in_order, low_pass, runs, without_gaps

THRESHOLD = 20.0
"""Vertical force from which a foot stands [N]."""

_FORCE = re.compile(r"^(.*?)v([xyz])$", re.IGNORECASE)
_SIDES = (
    ("r", re.compile(r"(?:^|_)(?:r|right)(?:_|$)", re.IGNORECASE)),
    ("l", re.compile(r"(?:^|_)(?:l|left)(?:_|$)", re.IGNORECASE)),
)


@dataclass(frozen=True, eq=False, kw_only=True)
class ForceRecord:
    """Force of one plate, or on one foot.

    Attributes:
        label: name in the file.
        series: force x, y, z [N] on the foot (z up), filtered.
        load: (K,) vertical force before the filter, which would spread the ends of a stance [N].
        pressure: (K, 3) centre of pressure [m], nan where there is none; None if not recorded.
        side: `"r"`, `"l"` or None, as the file says.
    """

    label: str
    series: Series
    load: np.ndarray
    pressure: np.ndarray | None
    side: str | None

    def contacts(self) -> list[tuple[float, float]]:
        """Start and end [s] of every stretch in which something stands on it.

        Breaks of less than 50 ms are bridged; touches of less than 100 ms are left out.
        """
        time = self.series.time
        loaded = self.load > THRESHOLD
        for start, end in runs(~loaded):
            if start > 0 and end < time.size and time[end] - time[start] < 0.05:
                loaded[start:end] = True
        found = [(time[a], time[b - 1]) for a, b in runs(loaded)]
        return [(float(a), float(b)) for a, b in found if b - a > 0.1]


def is_force_column(name: str) -> bool:
    """Whether a column is a component of a force or of a centre of pressure."""
    return re.search(r"[vp][xyz]$", name) is not None


def turned(records: Sequence[ForceRecord], angle: float) -> list[ForceRecord]:
    """The records turned about the vertical by -angle [rad], as the motion was."""
    if angle == 0.0:
        return list(records)
    cos, sin = np.cos(angle), np.sin(angle)
    turn = np.array([[cos, sin, 0.0], [-sin, cos, 0.0], [0.0, 0.0, 1.0]])
    return [
        replace(
            record,
            series=replace(record.series, values=record.series.values @ turn.T),
            pressure=None if record.pressure is None else record.pressure @ turn.T,
        )
        for record in records
    ]


def read_forces(table: Table, *, cutoff: float, notes: Notes) -> list[ForceRecord]:
    """The force records of a table.

    Raises:
        BadFile: no group of force columns, or none that carries a body.
    """
    heads: dict[str, dict[str, str]] = {}
    for name in table.columns:
        match = _FORCE.match(name)
        if match:
            heads.setdefault(match.group(1), {})[match.group(2).lower()] = name
    heads = {head: columns for head, columns in heads.items() if len(columns) == 3}
    if not heads:
        names = ", ".join(list(table.columns)[1:20])
        raise BadFile(table.path, "has no ground forces: columns such as ground_force_vx, "
                      f"ground_force_vy, ground_force_vz are needed; it has {names}.")  # fmt: skip
    sides = _sides(list(heads), table)
    columns: list[str] = []
    for head, force in heads.items():
        columns += [force[axis] for axis in "xyz"]
        place = _place(head, table)
        columns += place or []
    raw = np.stack([table.columns[name] for name in columns], axis=-1)
    time, raw = in_order(table.path, table.time, raw, notes)
    values = dict(zip(columns, raw.T, strict=True))
    records = []
    for head, names in heads.items():
        force = _axes(np.stack([values[names[axis]] for axis in "xyz"], axis=-1))
        place = _place(head, table)
        pressure = None
        if place is not None:
            pressure = _axes(np.stack([values[name] for name in place], axis=-1))
        label = head.strip("_") or "force"
        labels = [names["x"], names["z"], names["y"]]
        record = make_record(
            table.path, label, labels, time, force, pressure, sides[head], cutoff, notes
        )
        if record is not None:
            records.append(record)
    if not records:
        raise BadFile(table.path, f"has forces, but none that exceeds {THRESHOLD:g} N.")
    return records


def make_record(
    path: str, label: str, names: Sequence[str], time: np.ndarray, force: np.ndarray,
    pressure: np.ndarray | None, side: str | None, cutoff: float, notes: Notes,
) -> ForceRecord | None:  # fmt: skip
    """A record from force (K, 3) and centre of pressure (K, 3) in our axes; None if empty."""
    force, usable = without_gaps(path, names, time, force, notes)
    if np.abs(force[:, 2]).max() < THRESHOLD:
        notes.say(f"{Path(path).name}: {label} carries nothing and was left out.")
        return None
    if force[:, 2].min() < -100.0 and -force[:, 2].min() > 2.0 * force[:, 2].max():
        force = -force
        notes.say(f"{Path(path).name}: {label} gives the force on the plate; its sign was turned.")
    even = equidistant(time, force, usable)
    series = low_pass(even, cutoff, "force cut-off")
    if pressure is not None:
        loaded = (force[:, 2] > THRESHOLD) & np.isfinite(pressure).all(axis=1)
        if loaded.sum() < 10:
            pressure = None
        else:
            there = time[loaded]
            pressure = np.stack(
                [np.interp(series.time, there, column[loaded]) for column in pressure.T], axis=-1
            )
            empty = np.interp(series.time, time, loaded.astype(float)) < 0.999
            pressure = _metres(pressure, empty, path, notes)
            pressure[empty] = np.nan
    load = even.values[:, 2]
    return ForceRecord(label=label, series=series, load=load, pressure=pressure, side=side)


def check_sides(sides: Mapping[str, str], known: Sequence[str], shown: Sequence[str]) -> None:
    """Refuse a foot on a plate that the file does not have.

    Args:
        known: every name under which a plate can be meant.
        shown: one name for each, for the message.

    Raises:
        UnknownName: naming it.
    """
    for plate in sides:
        if plate not in known:
            raise UnknownName("plate of a side", plate, shown)


def _sides(heads: list[str], table: Table) -> dict[str, str | None]:
    """The foot that the name of each group claims."""
    plates = [head.strip("_") for head in heads]
    check_sides(table.sides, [*heads, *plates], plates)
    sides: dict[str, str | None] = {}
    for head in heads:
        named = table.sides.get(head) or table.sides.get(head.strip("_"))
        found = [side for side, pattern in _SIDES if pattern.search(head)]
        sides[head] = named or (found[0] if len(found) == 1 else None)
    # gait2354's files: `ground_force_v` is the right foot beside `l_ground_force_v`
    if len(heads) == 2 and None in sides.values() and set(sides.values()) != {None}:
        known = next(side for side in sides.values() if side)
        sides = {head: side or ("l" if known == "r" else "r") for head, side in sides.items()}
    return sides


def _place(head: str, table: Table) -> list[str] | None:
    names = [f"{head}p{axis}" for axis in "xyz"]
    return names if all(name in table.columns for name in names) else None


def _axes(values: np.ndarray) -> np.ndarray:
    """X forward, Y up, Z right -> x forward, y left, z up."""
    return np.stack([values[:, 0], -values[:, 2], values[:, 1]], axis=-1)


def _metres(pressure: np.ndarray, empty: np.ndarray, path: str, notes: Notes) -> np.ndarray:
    """Centres of pressure in metres: under a foot they wander by 0.1 to 1 m."""
    spans = [float(np.ptp(pressure[a:b], axis=0).max()) for a, b in runs(~empty) if b - a > 20]
    if spans and 40.0 < float(np.median(spans)) < 5000.0:
        notes.say(f"{Path(path).name}: centres of pressure look like millimetres and were "
                  "converted.")  # fmt: skip
        return 1e-3 * pressure
    return pressure
