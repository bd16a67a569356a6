"""OpenSim's tables (`.sto`, `.mot`) and our CSV files: time in the first column."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import numpy as np

from drakegait.whole_file import write_text

DIGITS = 12


def write_storage(
    path: Path, title: str, time: np.ndarray, columns: Mapping[str, np.ndarray], degrees: bool
) -> None:
    """A table of OpenSim 4.

    Args:
        path: `.sto` or `.mot`.
        title: first line.
        time: (K,) [s].
        columns: (K,) each, by heading.
        degrees: whether angles are in degrees; else rad.

    Raises:
        BadFile: it cannot be written.
    """
    table = np.column_stack([time, *columns.values()])
    lines = [
        title,
        "version=1",
        f"nRows={len(table)}",
        f"nColumns={table.shape[1]}",
        f"inDegrees={'yes' if degrees else 'no'}",
        "endheader",
        "\t".join(["time", *columns]),
        *("\t".join(shown(x) for x in row) for row in table),
    ]
    write_text(path, "\n".join(lines) + "\n")


def shown(number: float) -> str:
    """A number as all tables spell it."""
    return f"{number:.{DIGITS}g}"
