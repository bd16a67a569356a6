"""A measurement as columns of numbers, before anyone knows what they mean."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from drakegait.errors import BadFile


@dataclass(frozen=True, eq=False, kw_only=True)
class Table:
    """Columns of one file, all of one length.

    Attributes:
        path: of the file, for messages.
        columns: values by heading; `time` [s] is one of them; nan where nothing was measured.
        degrees: whether angles are in degrees; None if the file does not say.
        sides: foot (`"r"`, `"l"`) by name of a group of force columns, where the user said so.
    """

    path: str
    columns: Mapping[str, np.ndarray]
    degrees: bool | None = None
    sides: Mapping[str, str] = field(default_factory=dict)

    def __post_init__(self) -> None:
        if "time" not in self.columns:
            names = ", ".join(list(self.columns)[:20])
            raise BadFile(self.path, f"has no column 'time'; it has {names}.")
        if self.time.size < 20:
            raise BadFile(self.path, f"has {self.time.size} rows, too few for a stride.")
        if not np.isfinite(self.time).all():
            row = int(np.argmax(~np.isfinite(self.time))) + 1
            raise BadFile(self.path, f"has no time in row {row}.")

    @property
    def time(self) -> np.ndarray:
        """Instants of the rows (K,) [s]."""
        return self.columns["time"]


def read_text(path: str | Path) -> str:
    """Text of a file; raises BadFile."""
    try:
        return Path(path).read_text(encoding="utf-8-sig")
    except OSError as error:
        raise BadFile(path, f"cannot be read ({error.strerror}).") from None
    except UnicodeDecodeError:
        raise BadFile(path, "is not a text file.") from None


def numbers(path: str | Path, lines: list[str], first: int, width: int, comma: bool) -> np.ndarray:
    """Rows of numbers (K, width); empty cells of comma- or tab-separated rows become nan.

    Args:
        lines: the rows below the heading.
        first: number of the first of them in the file, for messages.
        width: columns of the heading.
        comma: whether commas separate the cells; else white space.

    Raises:
        BadFile: a row of another length or a cell that is not a number, by line.
    """
    delimiter = "," if comma else None
    try:
        values = np.loadtxt(lines, delimiter=delimiter, ndmin=2, comments=None)
    except ValueError:
        values = None
    if values is not None and values.shape[1] == width:
        return values
    return np.array([_row(path, text, number, width, comma)
                     for number, text in enumerate(lines, first) if text.strip()])  # fmt: skip


def _row(path: str | Path, text: str, number: int, width: int, comma: bool) -> list[float]:
    if comma or text.count("\t") >= width - 1:
        cells = [cell.strip() for cell in text.rstrip("\r\n").split("," if comma else "\t")]
        while len(cells) > width and not cells[-1]:
            cells.pop()  # separators at the end of the line
    else:
        cells = text.split()
    if len(cells) != width:
        raise BadFile(path, f"line {number} has {len(cells)} cells, but {width} columns.")
    row = []
    for cell in cells:
        try:
            row.append(float(cell) if cell else np.nan)
        except ValueError:
            if cell.lower() not in ("na", "n/a", "none", "null"):
                raise BadFile(path, f"line {number}: {cell!r} is not a number.") from None
            row.append(np.nan)
    return row
