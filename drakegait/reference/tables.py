"""Read one measured stride from a CSV file or from named arrays, and doubt it.

Nothing is repaired silently: whatever does not look like one stride of a walking person in the
stated units is refused with a sentence that says what and where.
"""

from __future__ import annotations

import dataclasses
import math
import re
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from drakegait.errors import InvalidInput, UnknownName
from drakegait.quantities import GRAVITY
from drakegait.reference.csv_file import read_csv
from drakegait.reference.plausibility import (
    check_advance,
    check_angles,
    check_forces,
    check_height,
    check_sideways,
)
from drakegait.transcription.foot_placement import FootPlacement
from drakegait.walker.coordinates import SPATIAL, Coordinate, coordinates
from drakegait.walker.subject import Subject

FORCE_COLUMNS = ("right_x", "right_y", "right_z", "left_x", "left_y", "left_z")
TIME_COLUMNS = ("percent", "time")
UNITS = {
    "angle": {"rad": 1.0, "deg": math.pi / 180.0},
    "length": {"m": 1.0, "cm": 0.01, "mm": 0.001},
    "force": {"N": 1.0, "kN": 1000.0, "BW": math.nan},  # body weight: known with the subject
}
PLACEMENT = tuple(field.name for field in dataclasses.fields(FootPlacement))
FACTS = ("stride_time", "phase_fractions", "foot_placement",
         "angle_unit", "length_unit", "force_unit")  # fmt: skip

_LARGEST_STEP = 0.1  # of the stride between neighbouring rows
_HEADING = re.compile(r"^\s*([^\[\]]*?)\s*(?:\[\s*([^\]]*?)\s*\])?\s*$")


@dataclasses.dataclass(frozen=True, eq=False, kw_only=True)
class StrideTable:
    """One stride in SI units and plant signs.

    Attributes:
        name: where it came from.
        tau: (K,) normalised times, exactly 0 to 1.
        coordinates: (K, num_coordinates); hat_x without the advance of the walker.
        forces: (K, 6) right x, y, z, left x, y, z [N], or None.
        stride_time: [s].
        phase_fractions: eight, with sum 1.
        foot_placement: where the feet stand.
    """

    name: str
    tau: np.ndarray
    coordinates: np.ndarray
    forces: np.ndarray | None
    stride_time: float
    phase_fractions: tuple[float, ...]
    foot_placement: FootPlacement


def read_stride(
    table: str | Path | Mapping[str, Any], *, kind: str, subject: Subject, **facts: Any
) -> StrideTable:
    """Read and validate one stride; the columns are described in `Reference.from_table`.

    Args:
        table: path of a CSV file, or mapping of column names to arrays.
        kind: `"spatial"` or `"planar"`.
        subject: the person measured.
        facts: any of
            stride_time [s]: needed with a `percent` column;
            phase_fractions: eight durations of the contact phases over the stride time;
            foot_placement: a `FootPlacement`; a file gives its fields instead, one a line;
            angle_unit `"rad"` (default), `"deg"`; length_unit `"m"` (default), `"cm"`, `"mm"`;
            force_unit `"N"` (default), `"kN"`, `"BW"` (body weights): for columns that do not
            name their unit.

    Raises:
        BadFile, UnknownName, InvalidInput: as `Reference.from_table`.
    """
    wanted = coordinates(kind)
    for fact in facts:
        if fact not in FACTS:
            raise UnknownName("fact", fact, FACTS)
    if isinstance(table, Mapping):
        name, headings = "table", {str(key): value for key, value in table.items()}
    else:
        name = Path(table).name
        headings, written = read_csv(table)
        facts = _merge(written, facts)
    columns, units = _columns(headings)
    tau, stride_time = _times(columns, units, facts.get("stride_time"))
    fractions = _fractions(facts.get("phase_fractions"))
    placement = facts.get("foot_placement")
    if not isinstance(placement, FootPlacement):
        raise InvalidInput("foot_placement", placement, "a FootPlacement (step lengths, ...)")
    if kind == "planar":
        placement = dataclasses.replace(
            placement, toe_angle_right=0.0, toe_angle_left=0.0, step_width=0.0
        )
    motion = np.column_stack([_coordinate(c, columns, units, facts) for c in wanted])
    where = {c.name: i for i, c in enumerate(wanted)}
    check_angles(wanted, motion)
    check_height(motion[:, where["hat_z"]], subject)
    if "hat_y" in where:
        check_sideways(motion[:, where["hat_y"]])
    advance = check_advance(motion[:, where["hat_x"]], placement.stride_length)
    motion[:, where["hat_x"]] -= advance * tau
    return StrideTable(
        name=name,
        tau=tau,
        coordinates=motion,
        forces=_forces(columns, units, facts, kind, subject),
        stride_time=stride_time,
        phase_fractions=fractions,
        foot_placement=placement,
    )


def _merge(written: Mapping[str, str], given: Mapping[str, Any]) -> dict[str, Any]:
    """Facts of the file's leading lines; the arguments win."""
    facts: dict[str, Any] = {}
    placement = {}
    for key, text in written.items():
        if key in PLACEMENT or key in ("stride_time", "phase_fractions"):
            try:
                numbers = tuple(float(word) for word in text.replace(",", " ").split())
            except ValueError:
                raise InvalidInput(key, text, "written in numbers") from None
            if key == "phase_fractions":
                facts[key] = numbers
            elif len(numbers) != 1:
                raise InvalidInput(key, text, "one number")
            elif key == "stride_time":
                facts[key] = numbers[0]
            else:
                placement[key] = numbers[0]
        elif key in FACTS:
            facts[key] = text
        else:
            raise UnknownName("line '# name = value'", key, (*FACTS, *PLACEMENT))
    if placement:
        missing = [key for key in PLACEMENT[:2] if key not in placement]
        if missing:
            raise InvalidInput(missing[0], None, "given together with the other step length")
        facts["foot_placement"] = FootPlacement(**placement)
    return {**facts, **given}


def _columns(headings: Mapping[str, Any]) -> tuple[dict[str, np.ndarray], dict[str, str | None]]:
    """Columns and stated units by our names; every value finite, all of one length."""
    alias = {c.paper_name: c.name for c in SPATIAL}
    known = (*TIME_COLUMNS, *(c.name for c in SPATIAL), *FORCE_COLUMNS)
    columns, units = {}, {}
    length = None
    for heading, data in headings.items():
        match = _HEADING.match(heading)
        word, unit = match.groups() if match else (heading, None)
        name = alias.get(word, word)
        if name not in known:
            raise UnknownName("column", word, (*known, *alias))
        if name in columns:
            raise InvalidInput("column", word, f"given once ({name} is already there)")
        try:
            values = np.array(data, dtype=float)
        except (TypeError, ValueError):
            raise InvalidInput(f"column {word}", "not numeric", "a row of numbers") from None
        length = values.size if length is None else length
        if values.ndim != 1 or values.size != length:
            raise InvalidInput(f"shape of column {word}", values.shape, f"({length},)")
        bad = np.flatnonzero(~np.isfinite(values))
        if bad.size:
            value = float(values[bad[0]])
            raise InvalidInput(f"row {bad[0] + 1} of column {word}", value, "a finite number")
        if word in alias:  # the paper's symbols carry the signs of the plant
            values = values * next(c.anatomical_sign for c in SPATIAL if c.name == name)
        columns[name], units[name] = values, unit
    return columns, units


def _times(
    columns: Mapping[str, np.ndarray], units: Mapping[str, str | None], stride_time: Any
) -> tuple[np.ndarray, float]:
    present = [name for name in TIME_COLUMNS if name in columns]
    if len(present) != 1 or next(iter(columns)) != present[0]:
        first = next(iter(columns), None)
        raise InvalidInput("first column", first, "'percent' or 'time', and only one of them")
    column = columns[present[0]]
    expected = {"percent": "%", "time": "s"}[present[0]]
    if units[present[0]] not in (None, expected):
        raise UnknownName(f"unit of {present[0]}", str(units[present[0]]), [expected])
    step = np.diff(column)
    if column.size < 2 or (step <= 0.0).any():
        row = int(np.argmax(step <= 0.0)) + 2 if column.size > 1 else 1
        raise InvalidInput(f"row {row} of {present[0]}", float(column[row - 1]),
                           "larger than the row before")  # fmt: skip
    span = float(column[-1] - column[0])
    if present[0] == "percent":
        if abs(column[0]) > 1e-6 or abs(column[-1] - 100.0) > 1e-6:
            ends = (float(column[0]), float(column[-1]))
            raise InvalidInput("percent of first and last row", ends, "0 and 100, one full stride")
    elif stride_time is None:
        stride_time = span
    elif isinstance(stride_time, (int, float)) and abs(stride_time - span) > 0.01 * span:
        raise InvalidInput("stride_time", stride_time, f"the span of the time column, {span:g} s")
    plausible = isinstance(stride_time, (int, float)) and 0.3 <= stride_time <= 5.0
    if not plausible:
        raise InvalidInput("stride_time", stride_time, "a number from 0.3 to 5 [s]")
    widest = int(np.argmax(step))
    if step[widest] > _LARGEST_STEP * span:
        allowed = f"at most {_LARGEST_STEP * span:.3g}, a tenth of the stride"
        raise InvalidInput(
            f"gap in {present[0]} after row {widest + 1}", float(step[widest]), allowed
        )
    tau = (column - column[0]) / span
    tau[-1] = 1.0
    return tau, float(stride_time)


def _fractions(values: Any) -> tuple[float, ...]:
    allowed = ("eight durations of the contact phases, right heel strike first, as fractions of "
               "the stride: all above 0, with sum 1")  # fmt: skip
    try:
        fractions = np.array([] if values is None else list(values), dtype=float)
    except (TypeError, ValueError):
        raise InvalidInput("phase_fractions", values, allowed) from None
    whole = fractions.shape == (8,) and np.isfinite(fractions).all()
    if not whole or (fractions <= 0.0).any() or abs(fractions.sum() - 1.0) > 2e-3:
        raise InvalidInput("phase_fractions", values, allowed)
    return tuple((fractions / fractions.sum()).tolist())


def _scale(name: str, quantity: str, unit: str | None, facts: Mapping[str, Any]) -> float:
    unit = unit or facts.get(f"{quantity}_unit") or next(iter(UNITS[quantity]))
    if unit not in UNITS[quantity]:
        raise UnknownName(f"unit of {name}", unit, UNITS[quantity])
    return UNITS[quantity][unit]


def _coordinate(
    c: Coordinate,
    columns: Mapping[str, np.ndarray],
    units: Mapping[str, str | None],
    facts: Mapping[str, Any],
) -> np.ndarray:
    if c.name not in columns:
        raise InvalidInput(f"column {c.name}", None, f"in the table (or as {c.paper_name})")
    quantity = "angle" if c.is_rotation else "length"
    return c.anatomical_sign * columns[c.name] * _scale(c.name, quantity, units[c.name], facts)


def _forces(
    columns: Mapping[str, np.ndarray],
    units: Mapping[str, str | None],
    facts: Mapping[str, Any],
    kind: str,
    subject: Subject,
) -> np.ndarray | None:
    if not any(name in columns for name in FORCE_COLUMNS):
        return None
    body_weight = subject.mass * GRAVITY
    forces = np.zeros((next(iter(columns.values())).size, 6))
    for k, name in enumerate(FORCE_COLUMNS):
        if kind == "planar" and name.endswith("_y"):
            continue
        if name not in columns:
            raise InvalidInput(f"column {name}", None, "in the table, as other forces are")
        scale = _scale(name, "force", units[name], facts)
        forces[:, k] = columns[name] * (body_weight if math.isnan(scale) else scale)
    check_forces(forces, body_weight)
    return forces
