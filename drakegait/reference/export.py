"""Write a reference as the table that `Reference.from_table` reads: a template for own data."""

from __future__ import annotations

import csv
import dataclasses
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from drakegait.errors import BadFile, InvalidInput
from drakegait.walker.coordinates import coordinates, to_anatomical

if TYPE_CHECKING:
    from drakegait.reference.reference import Reference


def table_columns(reference: Reference, rows: int, force_columns: Sequence[str]) -> dict:
    """Columns by heading: percent, coordinates in anatomical signs [deg, m], forces [N].

    hat_x contains the advance of the walker.
    """
    if not isinstance(rows, int) or rows < 12:
        raise InvalidInput("rows", rows, "a whole number of at least 12")
    tau = np.linspace(0.0, 1.0, rows)
    table = coordinates(reference.kind)
    values = to_anatomical(reference.kind, reference.coordinate_values(tau))
    columns = {"percent": 100.0 * tau}
    for k, c in enumerate(table):
        if c.name == "hat_x":
            values[:, k] += reference.foot_placement.stride_length * tau
        heading = f"{c.name} [{'deg' if c.is_rotation else 'm'}]"
        columns[heading] = np.degrees(values[:, k]) if c.is_rotation else values[:, k]
    if reference.forces is not None:
        forces = reference.ground_reactions(tau).reshape(rows, 6)
        columns |= {f"{name} [N]": forces[:, k] for k, name in enumerate(force_columns)}
    return columns


def write_csv(path: str | Path, reference: Reference, columns: dict) -> None:
    """Write the columns below `# name = value` lines with everything else of the reference.

    Raises:
        BadFile: the file cannot be written.
    """
    facts = {
        "stride_time": repr(float(reference.stride_time)),
        "phase_fractions": ", ".join(f"{x:.10g}" for x in reference.phase_fractions),
        **{k: repr(float(x)) for k, x in dataclasses.asdict(reference.foot_placement).items()},
    }
    try:
        with Path(path).open("w", newline="", encoding="utf-8") as file:
            file.writelines(f"# {key} = {text}\n" for key, text in facts.items())
            writer = csv.writer(file, lineterminator="\n")
            writer.writerow(columns)
            for row in zip(*columns.values(), strict=True):
                writer.writerow([f"{x:.9g}" for x in row])
    except OSError as error:
        raise BadFile(path, f"cannot be written ({error.strerror}).") from None
