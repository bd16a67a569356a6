"""Which reader a file needs."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from pathlib import Path

from drakegait.errors import BadFile, InvalidInput, UnknownName
from drakegait.measured.body_angles import NAMES
from drakegait.measured.column_map import ColumnMap, read_map
from drakegait.measured.csv_columns import read_csv_table
from drakegait.measured.force_records import ForceRecord, is_force_column, read_forces
from drakegait.measured.markers import MARKERS
from drakegait.measured.notes import Notes
from drakegait.measured.opensim_file import read_opensim
from drakegait.measured.table import Table

OPENSIM, CSV, C3D = (".mot", ".sto"), (".csv", ".txt", ".tsv"), (".c3d",)


def read_motion_file(
    path: str | Path, columns: str | Path | None, height: float, notes: Notes
) -> Table:
    """The table of a motion file; of a C3D file, what its markers say for a body of `height` [m].

    Raises:
        BadFile: of a kind that holds no motion.
    """
    if Path(path).suffix.lower() in C3D:
        from drakegait.measured.c3d_markers import read_c3d_motion

        return read_c3d_motion(path, _map(columns), height=height, notes=notes)
    return _table(path, _map(columns), NAMES.__contains__, notes)


def read_force_file(
    path: str | Path, columns: str | Path | None, sides: Mapping[str, str], cutoff: float,
    notes: Notes,
) -> list[ForceRecord]:  # fmt: skip
    """The force records of a file.

    Raises:
        BadFile: of an unknown kind, or without forces.
    """
    given = _map(columns)
    feet = {**given.sides, **sides}
    if Path(path).suffix.lower() in C3D:
        from drakegait.measured.c3d_file import read_c3d

        return read_c3d(path, sides=feet, axes=given.axes, cutoff=cutoff, notes=notes)
    table = _table(path, given, is_force_column, notes)
    return read_forces(replace(table, sides={**table.sides, **feet}), cutoff=cutoff, notes=notes)


def _map(columns: str | Path | None) -> ColumnMap:
    """What the user says about columns, all of which must be known."""
    if columns is None:
        return ColumnMap()
    found = read_map(columns)
    for name in found.columns:
        if name not in (*NAMES, "time") and not is_force_column(name):
            raise UnknownName("column of the map", name, (*NAMES, "time", "..._vx", "..._px"))
    for name in found.markers:
        if name not in MARKERS:
            raise UnknownName("marker of the map", name, MARKERS)
    return found


def _table(
    path: str | Path, columns: ColumnMap, wanted: Callable[[str], bool], notes: Notes
) -> Table:
    suffix = Path(path).suffix.lower()
    if suffix in OPENSIM:
        useless = [f"columns.{name}" for name in columns.columns if wanted(name)]
        if columns.degrees is not None and any(map(wanted, NAMES)):  # a file of angles
            useless.append("angle_unit")
        if useless:
            allowed = f"left out for {path}: headings and units of an OpenSim file are its own"
            raise InvalidInput("the map of columns", ", ".join(useless), allowed)
        return read_opensim(path, notes)
    if suffix in CSV:
        return read_csv_table(path, columns, wanted)
    known = ", ".join((*OPENSIM, *CSV, *C3D))
    raise BadFile(path, f"has the unknown suffix {suffix!r}; what can be read is {known}.")
