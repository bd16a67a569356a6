"""A gait as CSV tables: one file for each quantity, a row for each instant."""

from __future__ import annotations

import itertools
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from drakegait.gait import Gait
from drakegait.whole_file import new_folder, write_text

if TYPE_CHECKING:
    import xarray as xr

_DEGREE = {"degree": "deg", "degree/s": "deg/s"}


def export_csv(gait: Gait, folder: str | Path, *, num: int = 201) -> list[Path]:
    """Write what `Gait.sample` gives, in its signs and units.

    Each file is named after the quantity (`joint_moment.csv`); its first columns are `percent` of
    the stride and `time [s]`, then one for each coordinate, joint, muscle or axis with its unit
    (`hip_flexion_r [deg]`). Cells without a value, such as the centre of pressure of a foot in the
    air, are empty. `coordinates.csv` and `events.csv` tell the motion; `events.csv` the phases.

    Args:
        folder: made if need be; files in it are replaced.
        num: instants, both ends counted.

    Raises:
        InvalidInput: fewer than 2 instants.
        BadFile: a file cannot be written.
    """
    data = gait.sample(num)
    folder = new_folder(folder)
    files = []
    for name, variable in data.data_vars.items():
        if variable.dims and variable.dims[0] == "time":
            files.append(folder / f"{name}.csv")
            write_text(files[-1], _table(data, name))
    files.append(folder / "events.csv")
    rows = [
        f"{event},{percent:.9g},{percent / 100.0 * gait.stride_time:.9g}"
        for event, percent in zip(data.event.values, data.event_percent.values, strict=True)
    ]
    write_text(files[-1], "\n".join(["event,percent,time [s]", *rows]) + "\n")
    return files


def _table(data: xr.Dataset, name: str) -> str:
    variable = data[name]
    labels = [[str(x) for x in data[dim].values] for dim in variable.dims[1:]]
    heads = [" ".join(words) for words in itertools.product(*labels)] if labels else [name]
    units = _units(data, name, len(heads))
    pairs = zip(heads, units, strict=True)
    headings = [f"{head} [{unit}]" if unit else head for head, unit in pairs]
    values = variable.values.reshape(data.sizes["time"], -1)
    rows = np.column_stack([data.percent, data.time, values])
    lines = [",".join(["percent", "time [s]", *headings])]
    lines += [",".join("" if np.isnan(x) else f"{x:.9g}" for x in row) for row in rows]
    return "\n".join(lines) + "\n"


def _units(data: xr.Dataset, name: str, count: int) -> list[str]:
    unit = data[name].attrs["units"]
    if data[name].dims[-1] == "coordinate":  # "degree or m", "degree/s or m/s", "N or N m"
        angle, _, length = unit.partition(" or ")
        if name == "equation_residual":
            angle, length = length, angle
        kinds = data.coordinate_unit.values
        return [_DEGREE.get(angle, angle) if kind == "degree" else length for kind in kinds]
    return ["" if unit == "1" else _DEGREE.get(unit, unit)] * count
