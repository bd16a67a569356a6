"""OpenSim's tables, `.mot` and `.sto`, with old and new headers.

Everything above `endheader` is a header: `nRows=211` or `datarows 211`, `inDegrees=yes` or the
sentence "Angles are in degrees." State files of OpenSim 4 name columns by path
(`/jointset/hip_r/hip_flexion_r/value`); the coordinate's name is taken from it.
"""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np

from drakegait.errors import BadFile
from drakegait.measured.notes import Notes
from drakegait.measured.table import Table, numbers, read_text

_DEGREES = re.compile(r"in\s*degrees\s*=?\s*(yes|no|true|false|1|0)\b", re.IGNORECASE)
_SENTENCE = re.compile(r"angles are in (degrees|radians)", re.IGNORECASE)
_ROWS = re.compile(r"^\s*(?:nRows\s*=|datarows\s)\s*(\d+)", re.IGNORECASE | re.MULTILINE)


def read_opensim(path: str | Path, notes: Notes) -> Table:
    """Columns of a `.mot` or `.sto` file.

    Raises:
        BadFile: no `endheader`, no column `time`, or rows that are not numbers.
    """
    lines = read_text(path).splitlines()
    ends = [i for i, line in enumerate(lines[:200]) if line.strip().lower() == "endheader"]
    if not ends:
        raise BadFile(path, "is no OpenSim table: no line 'endheader' among the first 200.")
    header = "\n".join(lines[: ends[0]])
    start = ends[0] + 1
    while start < len(lines) and not lines[start].strip():
        start += 1
    if start + 1 >= len(lines):
        raise BadFile(path, "has no rows below 'endheader'.")
    headings = [_coordinate(word) for word in lines[start].split()]
    if len(set(headings)) < len(headings):
        twice = next(word for word in headings if headings.count(word) > 1)
        raise BadFile(path, f"has the column {twice!r} more than once.")
    below = lines[start + 1 :]
    while below and not below[-1].strip():
        below.pop()
    values = numbers(path, below, start + 2, len(headings), comma=False)
    promised = _ROWS.search(header)
    if promised and int(promised.group(1)) != len(values):
        notes.say(
            f"{Path(path).name} holds {len(values)} rows, its header says {promised.group(1)}; "
            "the rows were taken as they are."
        )
    columns = {name: values[:, k].copy() for k, name in enumerate(headings)}
    return Table(path=str(path), columns=columns, degrees=_degrees(header))


def _coordinate(heading: str) -> str:
    """`/jointset/hip_r/hip_flexion_r/value` -> `hip_flexion_r`; speeds keep their path."""
    parts = heading.split("/")
    return parts[-2] if len(parts) > 2 and parts[-1] == "value" else heading


def _degrees(header: str) -> bool | None:
    flag = _DEGREES.search(header)
    if flag:
        return flag.group(1).lower() in ("yes", "true", "1")
    sentence = _SENTENCE.search(header)
    return None if sentence is None else sentence.group(1).lower() == "degrees"


def angle_scale(table: Table, largest_knee: float, notes: Notes) -> float:
    """Factor that makes radians of the table's angles.

    A knee reaches 0.9 to 1.3 rad, 50 to 75 degrees, in every walk; what the header says is doubted
    where the knee contradicts it.

    Args:
        largest_knee: largest absolute knee angle as written.
    """
    looks = largest_knee > np.pi
    name = Path(table.path).name
    if table.degrees is None:
        notes.say(f"{name} does not say its unit of angles; {_unit(looks)} by the knee's range.")
    elif table.degrees != looks and (looks or largest_knee < 2.0):
        notes.say(
            f"{name} says that angles are in {_unit(table.degrees)}, but a knee that reaches "
            f"{largest_knee:.3g} is in {_unit(looks)}; read as {_unit(looks)}."
        )
    return np.pi / 180.0 if looks else 1.0


def _unit(degrees: bool) -> str:
    return "degrees" if degrees else "radians"
