"""The results of a sweep as one table: a row, or a point of the grid, for each study."""

from __future__ import annotations

import io
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from drakegait.sweep import axes as sweep_axes
from drakegait.whole_file import write_bytes

if TYPE_CHECKING:
    import pandas as pd
    import xarray as xr

    from drakegait.sweep.result import SweepResult

TABLE = "sweep"
COLUMNS = {
    "status": ("", "done or failed", ()),
    "reason": ("", "why it failed", ()),
    "cost_of_transport_J_per_m": (
        "J/m", "metabolic energy per metre, E^t of eq. (8)",
        ("cost", "metabolic_cost_of_transport_J_per_m")),
    "deviation_s": ("s", "deviation from the reference, J_dev of eq. (11)", ("cost", "deviation")),
    "cost": ("-", "f of eq. (13), as the solver saw it", ("cost", "total")),
    "speed_m_per_s": ("m/s", "average forward velocity", ("gait", "speed_m_per_s")),
    "stride_time_s": ("s", "duration of a stride", ("gait", "stride_time_s")),
    "step_length_right_m": ("m", "step of the right foot", ("gait", "step_length_right_m")),
    "step_length_left_m": ("m", "step of the left foot", ("gait", "step_length_left_m")),
    "step_width_m": ("m", "distance of the feet", ("gait", "step_width_m")),
    "check_passed": ("", "whether the gait holds between its control points", ("check", "passed")),
    "solver_status": ("", "how the solve ended", ("solver", "status")),
    "iterations": ("-", "of the solver", ("solver", "iterations")),
    "wall_time_s": ("s", "in the solver", ("solver", "wall_time_s")),
    "setup_time_s": ("s", "before the solver", ("solver", "setup_time_s")),
    "control_points": ("-", "where the laws are rows", ("control_points",)),
    "guess": ("", "study from whose gait this one was started", ("sweep", "guess")),
}  # fmt: skip
"""Unit, meaning and place in `summary.json` of every column after the name and the axes."""
_NUMBERS = {name for name, (unit, _, place) in COLUMNS.items() if unit}
NOT_CONVERGED_TOO = ("status", "reason", "solver_status", "iterations", "wall_time_s",
                     "setup_time_s", "control_points", "guess")  # fmt: skip
"""Columns that a study that failed has as well; its nearest gait is no answer."""


def rows(result: SweepResult) -> list[dict[str, Any]]:
    """A dict for each study: name, axes, columns; None where not known."""
    found = []
    for name in result.studies:
        state, summary = result.states[name], result.summary(name)
        row: dict[str, Any] = {"study": name, **result.axes[name]}
        for column, (_, _, place) in COLUMNS.items():
            known = state.status == "done" or column in NOT_CONVERGED_TOO
            row[column] = _pick(summary, place) if place and known else None
        row |= {"status": state.status, "reason": state.reason}
        found.append(row)
    return found


def data_frame(result: SweepResult) -> pd.DataFrame:
    """The rows, indexed by the name of the study."""
    import pandas as pd

    frame = pd.DataFrame(rows(result)).set_index("study")
    for column in _NUMBERS:
        frame[column] = pd.to_numeric(frame[column])
    return frame


def dataset(result: SweepResult) -> xr.Dataset:
    """The rows over the axes of the grid, or over `study` where they make no full grid.

    Numbers that are not known are NaN, words empty; every variable has its unit.
    """
    import xarray as xr

    table, grid = rows(result), sweep_axes.grid(result.axes)
    if grid is None:
        dims, shape = ("study",), (len(table),)
        places = [(row,) for row in range(len(table))]
        names = list(result.axes[table[0]["study"]])
        coords = {axis: ("study", _array([row[axis] for row in table])) for axis in names}
        coords["study"] = ("study", _array([row["study"] for row in table]))
    else:
        dims, shape = tuple(grid), tuple(len(values) for values in grid.values())
        places = [tuple(grid[axis].index(_level(row[axis], grid[axis])) for axis in dims)
                  for row in table]  # fmt: skip
        coords = {axis: (axis, _array(values)) for axis, values in grid.items()}
    variables = {}
    for name, (unit, meaning, _) in COLUMNS.items():
        variables[name] = (dims, _spread(table, name, places, shape), _attributes(unit, meaning))
    if grid is not None:
        names, meaning = _spread(table, "study", places, shape), "name of the study and its folder"
        variables["study"] = (dims, names, _attributes("", meaning))
    found = xr.Dataset(variables, coords=coords, attrs={"title": "a sweep of drakegait"})
    for axis in found.coords:
        if axis != "study" and sweep_axes.unit(str(axis)):
            found[axis].attrs["units"] = sweep_axes.unit(str(axis))
    return found


def save(result: SweepResult, folder: Path) -> list[Path]:
    """Write `sweep.csv` and `sweep.nc`, each whole or not at all; raises BadFile."""
    paths = [folder / f"{TABLE}.csv", folder / f"{TABLE}.nc"]
    write_bytes(paths[0], data_frame(result).to_csv(lineterminator="\n").encode())
    memory = io.BytesIO()
    dataset(result).to_netcdf(memory, engine="h5netcdf")
    write_bytes(paths[1], memory.getvalue())
    return paths


def _pick(summary: Mapping[str, Any], place: tuple[str, ...]) -> Any:
    value: Any = summary
    for key in place:
        value = value.get(key) if isinstance(value, Mapping) else None
    return value


def _attributes(unit: str, meaning: str) -> dict[str, str]:
    return {"long_name": meaning, **({"units": unit} if unit else {})}


def _level(value: Any, values: list[Any]) -> Any:
    return value if value in values else str(value)


def _array(values: list[Any]) -> np.ndarray:
    if sweep_axes.numeric(values):
        return np.array(values, dtype=float)
    return np.array([str(value) for value in values], dtype=object)


def _spread(
    table: list[dict[str, Any]], name: str, places: list[tuple[int, ...]], shape: tuple[int, ...]
) -> np.ndarray:
    number = name in _NUMBERS
    array = np.full(shape, np.nan if number else "", dtype=float if number else object)
    for row, place in zip(table, places, strict=True):
        value = row[name]
        if value is not None:
            array[place] = value if number else _word(value)
    return array


def _word(value: Any) -> str:
    return {True: "yes", False: "no"}.get(value, value) if isinstance(value, bool) else str(value)
