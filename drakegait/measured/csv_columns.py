"""Tables of other programs: separated by commas, semicolons or tabs, with a map of columns."""

from __future__ import annotations

import csv
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np

from drakegait.errors import BadFile, UnknownName
from drakegait.measured.column_map import ColumnMap, axes_matrix
from drakegait.measured.table import Table, numbers, read_text
from drakegait.walker.coordinates import TO_OPENSIM


def read_csv_table(path: str | Path, columns: ColumnMap, wanted: Callable[[str], bool]) -> Table:
    """Columns by our names where the map names them, else by their own.

    Lines that begin with # are skipped, and so is a line of units below the headings.

    Args:
        wanted: whether a column of the map must be in this file; the map may speak of two.

    Raises:
        BadFile: no headings, a row that is not numeric, no time.
        UnknownName: a wanted column has a heading that the file does not have.
    """
    lines = [line for line in read_text(path).splitlines() if not line.startswith("#")]
    while lines and not lines[0].strip(" ,;\t"):
        lines.pop(0)
    if len(lines) < 3:
        raise BadFile(path, "has no heading with rows of numbers below it.")
    separator = max(",;\t", key=lines[0].count)
    if separator == ";":  # a decimal comma comes with semicolons
        lines = [line.replace(",", ".").replace(";", ",") for line in lines]
    elif separator == "\t":
        lines = [line.replace("\t", ",") for line in lines]
    headings = [heading.strip() for heading in next(csv.reader([lines[0]]))]
    first = 1 if _numeric(lines[1]) else 2
    values = numbers(path, lines[first:], first + 1, len(headings), comma=True)
    if len(set(headings)) < len(headings):
        twice = next(x for x in headings if headings.count(x) > 1)
        raise BadFile(path, f"has the column {twice!r} more than once.")
    found = {heading: values[:, k] for k, heading in enumerate(headings)}
    for name, (heading, _) in columns.columns.items():
        if wanted(name) and heading not in found:
            raise UnknownName(f"heading of {name} in {path}", heading, found)
    named = _named(found, columns)
    table = Table(path=str(path), columns=named, degrees=columns.degrees, sides=columns.sides)
    if columns.axes is not None:
        table = replace(table, columns=_turned(table, columns.axes))
    return table


def _numeric(line: str) -> bool:
    for cell in line.split(","):
        try:
            float(cell)
            return True
        except ValueError:
            continue
    return False


def _named(found: dict[str, np.ndarray], columns: ColumnMap) -> dict[str, np.ndarray]:
    """Columns under our names."""
    there = {name: x for name, x in columns.columns.items() if x[0] in found}
    taken = {heading for heading, _ in there.values()}
    named = {
        ("time" if heading.lower() in ("time", "time [s]", "time (s)") else heading): values
        for heading, values in found.items()
        if heading not in taken
    }
    named |= {name: factor * found[heading] for name, (heading, factor) in there.items()}
    if "time" in named:
        named = {"time": named.pop("time"), **named}
    return named


def _turned(table: Table, axes: tuple[str, str]) -> dict[str, np.ndarray]:
    """Vectors in OpenSim's axes, from the axes that the map names."""
    turn = TO_OPENSIM @ axes_matrix(axes)
    columns = dict(table.columns)
    stems = {name[:-1] for name in columns if name.endswith(("vx", "px", "pelvis_tx"))}
    for stem in stems:
        names = [f"{stem}{axis}" for axis in "xyz"]
        if all(name in columns for name in names):
            vectors = np.stack([columns[name] for name in names], axis=-1) @ turn.T
            columns |= dict(zip(names, vectors.T, strict=True))
    return columns
