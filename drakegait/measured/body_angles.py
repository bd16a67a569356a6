"""What the columns of a motion file mean: angles and pelvis position in our axes and signs.

The vocabulary is that of OpenSim's walking models (gait2354, gait2392, gait10dof, Rajagopal 2015),
axes X forward, Y up, Z to the right, and our own names (docs/conventions.md) beside it. OpenSim's
body-fixed sequences Z, X, Y of pelvis, lumbar and hips are our R_y(b) R_x(a) R_z(g) with
b = -(angle about Z), a = angle about X, g = angle about Y: x = X, y = -Z, z = Y.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from scipy.interpolate import CubicSpline

from drakegait.errors import BadFile, UnknownName
from drakegait.measured.notes import Notes
from drakegait.measured.opensim_file import angle_scale
from drakegait.measured.table import Table
from drakegait.measured.time_axis import Series, equidistant, in_order, low_pass, without_gaps
from drakegait.walker.rotation_sequence import rotation_matrix

KNEES = ("auto", "flexion-positive", "flexion-negative")
RATE = 200.0
"""Samples per second of the motion inside: enough for events, few enough for a minute of data."""

# quantity -> columns that give it, each with the sign that makes the plant's sense of it
_VOCABULARY: dict[str, tuple[tuple[str, float], ...]] = {
    "pelvis_b": (("pelvis_tilt", -1), ("hat_tilt", 1)),
    "pelvis_a": (("pelvis_list", 1), ("hat_list", 1)),
    "pelvis_g": (("pelvis_rotation", 1), ("hat_rotation", 1)),
    "trunk_b": (("lumbar_extension", -1),),
    "trunk_a": (("lumbar_bending", 1),),
    "trunk_g": (("lumbar_rotation", 1),),
} | {
    f"{quantity}_{side}": tuple((f"{column}_{side}", sign) for column, sign in columns)
    for side, out in (("r", 1), ("l", -1))
    for quantity, columns in {
        "hip_b": (("hip_flexion", -1),),
        "hip_a": (("hip_adduction", out),),
        "hip_g": (("hip_rotation", out),),
        "knee": (("knee_angle", 1), ("knee_flexion", 1)),
        "ankle": (("ankle_angle", -1), ("ankle_dorsiflexion", -1)),
    }.items()
}
ANGLES = tuple(_VOCABULARY)
_PLACES = (
    (("pelvis_tx", 1), ("hat_x", 1)),
    (("pelvis_tz", -1), ("hat_y", 1)),
    (("pelvis_ty", 1), ("hat_z", 1)),
)
NAMES = tuple(
    name for columns in (*_VOCABULARY.values(), *_PLACES) for name, _ in columns
)
"""Every column that is understood."""
_NEEDED = ("pelvis_b", *(f"{x}_{side}" for side in "rl" for x in ("hip_b", "knee", "ankle")))
_LATERAL = ("pelvis_a", "pelvis_g", *(f"hip_{x}_{side}" for side in "rl" for x in "ag"))
# From the pelvis origin to the middle of the hips, x and z in the pelvis' axes, 1.80 m tall [m]:
# gait2354/2392 and Rajagopal 2015 (generic models).
_HIPS_OLD, _HIPS_NEW = (-0.0707, -0.0661), (-0.0563, -0.0785)
_MODEL_HEIGHT = 1.80


@dataclass(frozen=True, eq=False, kw_only=True)
class BodyAngles:
    """A walk in plant signs [rad, m] at `RATE`.

    Attributes:
        path: of the file.
        series: columns `ANGLES`, then x, y, z of the middle of the hips (zeros if unknown). Hips
            relative to the pelvis, trunk relative to the pelvis, pelvis relative to the world.
        missing: quantities of `ANGLES` that the file does not have; zero in the series.
        place: whether x, y and z were measured.
        rate: of the file [1/s].
    """

    path: str
    series: Series
    missing: frozenset[str]
    place: tuple[bool, bool, bool]
    rate: float

    @property
    def lateral(self) -> bool:
        """Whether the frontal and transverse planes were measured."""
        return not self.missing & set(_LATERAL)


def read_body_angles(
    table: Table, *, height: float, knee: str, cutoff: float, notes: Notes
) -> BodyAngles:
    """Angles and hip position of a motion table, in order, without gaps, filtered.

    Args:
        height: of the body [m], scales the way from the pelvis' origin to the hips.
        knee: one of `KNEES`: which sense of the knee angle is positive in the file.
        cutoff: of the low-pass filter [Hz].

    Raises:
        BadFile: a column that cannot be done without is not there.
        UnknownName: `knee`.
    """
    if knee not in KNEES:
        raise UnknownName("knee", knee, KNEES)
    chosen = {quantity: _find(table, columns) for quantity, columns in _VOCABULARY.items()}
    for quantity in _NEEDED:
        if chosen[quantity] is None:
            names = " or ".join(repr(name) for name, _ in _VOCABULARY[quantity])
            raise BadFile(table.path, f"has no column {names}; it has {_list(table)}.")
    missing = frozenset(quantity for quantity, found in chosen.items() if found is None)
    places = [_find(table, columns) for columns in _PLACES]
    used = [found for found in (*chosen.values(), *places) if found is not None]
    headings = [name for name, _ in used]
    raw = np.stack([table.columns[name] for name in headings], axis=-1)
    time, raw = in_order(table.path, table.time, raw, notes)
    raw, usable = without_gaps(table.path, headings, time, raw, notes)
    signed = dict(zip(headings, (raw * [sign for _, sign in used]).T, strict=True))
    knees = [chosen[f"knee_{side}"][0] for side in "rl"]
    scale = angle_scale(table, max(float(np.abs(signed[name]).max()) for name in knees), notes)
    negative = _knee_sign(knee, knees, signed, notes, table)
    angles = [
        np.zeros(time.size) if found is None else scale * signed[found[0]]
        for found in chosen.values()
    ]
    for k, quantity in enumerate(ANGLES):
        if negative and quantity.startswith("knee"):
            angles[k] = -angles[k]
        if quantity.endswith("_g") or quantity.endswith("_b"):
            angles[k] = np.unwrap(angles[k])
    _say_missing(missing, notes, table)
    place = [np.zeros(time.size) if p is None else signed[p[0]] for p in places]
    place, known = _metres(place, [p is not None for p in places], notes, table)
    if chosen["pelvis_b"][0] == "pelvis_tilt":
        arm = np.array(_HIPS_OLD if negative else _HIPS_NEW) * height / _MODEL_HEIGHT
        place = place + _hip_offset(angles[:3], arm)
    series = equidistant(time, np.column_stack([*angles, *place]), usable)
    rate = series.rate
    series = _resampled(low_pass(series, cutoff, "motion cut-off"))
    return BodyAngles(path=table.path, series=series, missing=missing, place=known, rate=rate)


def _find(table: Table, columns: Sequence[tuple[str, float]]) -> tuple[str, float] | None:
    return next(((name, sign) for name, sign in columns if name in table.columns), None)


def _list(table: Table) -> str:
    names = [name for name in table.columns if name != "time"]
    return ", ".join(names[:30]) + (" ..." if len(names) > 30 else "")


def _knee_sign(asked, knees, signed, notes: Notes, table: Table) -> bool:
    """Whether flexion is negative in the file: a knee flexes far and hardly overextends."""
    if asked != "auto":
        return asked == "flexion-negative"
    if all(name.startswith("knee_flexion") for name in knees):
        return False  # our name says the sense
    far = [float(signed[name].max() + signed[name].min()) for name in knees]
    if far[0] * far[1] < 0.0:
        raise BadFile(table.path, "flexes one knee to the positive and the other to the negative "
                      "side; say which is right with the option for the knee's sign.")  # fmt: skip
    negative = far[0] < 0.0
    if negative:
        notes.say(
            f"{Path(table.path).name}: knee flexion is negative, as in gait2354 and gait2392."
        )
    return negative


def _say_missing(missing: frozenset[str], notes: Notes, table: Table) -> None:
    name = Path(table.path).name
    if {"trunk_b", "trunk_a", "trunk_g"} & missing:
        notes.say(f"{name} has no (complete) lumbar angles: the trunk was taken to move with the "
                  "pelvis where they are missing.")  # fmt: skip
    lateral = sorted(missing & set(_LATERAL))
    if lateral:
        names = ", ".join(_VOCABULARY[quantity][0][0] for quantity in lateral)
        notes.say(f"{name} does not have {names}: these were taken from the embedded stride and "
                  "are NOT this person's. The planar reference does not need them.")  # fmt: skip


def _metres(place, known, notes: Notes, table: Table) -> tuple[np.ndarray, tuple[bool, ...]]:
    """Positions in metres: hips are at half the body height."""
    place, unit = np.array(place), 1.0
    size = float(np.median(np.abs(place[2]))) if known[2] else float(np.ptp(place[0])) / 5.0
    for factor, name in ((1e-3, "millimetres"), (1e-2, "centimetres")):
        low, high = (0.4 / factor, 1.5 / factor) if known[2] else (0.1 / factor, 5 / factor)
        if low <= size <= high:
            unit = factor
            notes.say(f"{Path(table.path).name}: positions look like {name} and were converted.")
            break
    return unit * place, tuple(known)


def _hip_offset(pelvis, arm) -> np.ndarray:
    rotation = rotation_matrix(np.stack(pelvis, axis=-1))
    return (rotation @ np.array([arm[0], 0.0, arm[1]])).T


def _resampled(series: Series) -> Series:
    count = round((series.time[-1] - series.time[0]) * RATE) + 1
    time = np.linspace(series.time[0], series.time[-1], count)
    values = CubicSpline(series.time, series.values, axis=0)(time)
    usable = np.interp(time, series.time, series.usable.astype(float)) > 0.999
    return Series(time=time, values=values, usable=usable)
