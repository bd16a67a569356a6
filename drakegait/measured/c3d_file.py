"""Force plates in C3D files, through ezc3d: types 1 to 4 by their calibration and corners."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import numpy as np

from drakegait.errors import BadFile
from drakegait.measured.column_map import axes_matrix
from drakegait.measured.force_records import THRESHOLD, ForceRecord, check_sides, make_record
from drakegait.measured.notes import Notes
from drakegait.measured.time_axis import runs

_LEAST_PRESSURE_FORCE = 50.0  # [N] below, the centre of pressure is noise


def read_c3d(
    path: str | Path, *, sides: Mapping[str, str], axes: tuple[str, str] | None, cutoff: float,
    notes: Notes,
) -> list[ForceRecord]:  # fmt: skip
    """Force records of the plates, named `plate 1`, `plate 2` ..., in our axes.

    Args:
        sides: foot by `"plate 1"` or `"1"`, where known.
        axes: forward and up axis of the laboratory; None to find them: up is the plates' normal,
            forward the way of the propulsive force of late stance.

    Raises:
        BadFile: ezc3d is missing, or it cannot read the file, or there is no loaded plate.
    """
    file = open_c3d(path)
    try:
        plates = file["data"]["platform"]
        parameters = file["parameters"]
        analog = float(parameters["ANALOG"]["RATE"]["value"][0])
        frames = float(parameters["POINT"]["RATE"]["value"][0])
        first = int(file["header"]["points"]["first_frame"])
    except Exception as error:  # noqa: BLE001 - ezc3d raises what its C++ throws
        reason = str(error).splitlines()[0] if str(error) else "damaged"
        raise BadFile(path, f"cannot be read as C3D with force plates ({reason}).") from None
    if not plates:
        raise BadFile(path, "holds no force plates (FORCE_PLATFORM), only markers or signals.")
    plain = [f"plate {number}" for number in range(1, len(plates) + 1)]
    check_sides(sides, [*plain, *(name.removeprefix("plate ") for name in plain)], plain)
    rate = analog if analog > 0.0 else frames
    begins = first / frames if frames > 0.0 else 0.0
    raw = []
    for plate in plates:
        force = np.asarray(plate["force"], dtype=float).T
        # the unit is often not stated; no plate is longer than 10 m
        millimetres = float(np.ptp(np.asarray(plate["corners"]), axis=1).max()) > 10.0
        pressure = np.asarray(plate["center_of_pressure"], dtype=float).T
        raw.append((force, pressure * (1e-3 if millimetres else 1.0)))
    turn = axes_matrix(axes) if axes is not None else _find_axes(raw, notes, path)
    records = []
    for number, (force, pressure) in enumerate(raw, 1):
        label = f"plate {number}"
        if not np.isfinite(force).any():
            continue
        time = begins + np.arange(len(force)) / rate
        pressure = pressure @ turn.T
        weak = np.abs(force @ turn[2]) < _LEAST_PRESSURE_FORCE
        pressure[weak] = np.nan
        side = sides.get(label) or sides.get(str(number))
        names = [f"{label} {axis}" for axis in "xyz"]
        record = make_record(
            str(path), label, names, time, force @ turn.T, pressure, side, cutoff, notes
        )
        if record is not None:
            records.append(record)
    if not records:
        raise BadFile(path, f"has {len(raw)} force plates, but none carries {THRESHOLD:g} N.")
    return records


def open_c3d(path: str | Path):
    """A C3D file as ezc3d gives it, with its force plates computed.

    Raises:
        BadFile: ezc3d or the file is missing, or it cannot be read.
    """
    try:
        import ezc3d
    except ImportError:
        raise BadFile(path, "needs the package ezc3d to be read: pip install ezc3d.") from None
    if not Path(path).is_file():
        raise BadFile(path, "does not exist.")
    try:
        return ezc3d.c3d(str(path), extract_forceplat_data=True)
    except Exception as error:  # noqa: BLE001 - ezc3d raises what its C++ throws
        reason = str(error).splitlines()[0] if str(error) else "damaged"
        raise BadFile(path, f"cannot be read as C3D ({reason}).") from None


def _find_axes(raw, notes: Notes, path: str | Path) -> np.ndarray:
    """Rotation from the laboratory's axes to ours."""
    sizes = sum(np.nansum(np.abs(force), axis=0) for force, _ in raw)
    vertical = int(np.argmax(sizes))
    push = np.zeros(3)
    for force, _ in raw:
        up = force[:, vertical]
        sign = np.sign(np.nansum(up)) or 1.0
        for start, end in runs(sign * up > THRESHOLD):
            # braking in the first half of a stance, propulsion in the second
            half = np.sign(np.linspace(-1.0, 1.0, end - start))[:, None]
            push += sign * np.nansum(half * force[start:end], axis=0)
    push[vertical] = 0.0
    ahead = int(np.argmax(np.abs(push)))
    name = ("-" if push[ahead] < 0.0 else "") + "xyz"[ahead]
    notes.say(f"{Path(path).name}: {'xyz'[vertical]} is vertical, and the walk goes along {name}, "
              "the way of the propulsive force.")  # fmt: skip
    return axes_matrix((name, "xyz"[vertical]))
