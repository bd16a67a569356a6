"""A CSV file of numbers, with every damaged cell named by line and column."""

from __future__ import annotations

import csv
from pathlib import Path

import numpy as np

from drakegait.errors import BadFile


def read_csv(path: str | Path) -> tuple[dict[str, np.ndarray], dict[str, str]]:
    """Columns of a CSV file by heading, and the `# name = value` lines before them.

    Raises:
        BadFile: missing, not text, ragged, or a cell that is not a number.
    """
    try:
        lines = Path(path).read_text(encoding="utf-8-sig").splitlines()
    except OSError as error:
        raise BadFile(path, f"cannot be read ({error.strerror}).") from None
    except UnicodeDecodeError:
        raise BadFile(path, "is not a text file.") from None
    notes = {}
    for line in lines:
        if line.startswith("#") and "=" in line:
            key, value = line[1:].split("=", 1)
            notes[key.strip()] = value.strip()
    numbered = [(i, x) for i, x in enumerate(lines, 1) if x.strip() and not x.startswith("#")]
    if len(numbered) < 2:
        raise BadFile(path, "has no heading with rows of numbers below it.")
    rows = list(csv.reader(text for _, text in numbered))
    heading = [name.strip() for name in rows[0]]
    if len(set(heading)) < len(heading):
        twice = next(x for x in heading if heading.count(x) > 1)
        raise BadFile(path, f"has the column {twice!r} more than once.")
    values = np.empty((len(rows) - 1, len(heading)))
    for (number, _), row, target in zip(numbered[1:], rows[1:], values, strict=True):
        if len(row) != len(heading):
            raise BadFile(path, f"line {number} has {len(row)} cells, but {len(heading)} columns.")
        for k, cell in enumerate(row):
            try:
                target[k] = float(cell)
            except ValueError:
                what = repr(cell) if cell.strip() else "empty"
                problem = f"line {number}, column {heading[k]!r} is {what}, not a number."
                raise BadFile(path, problem) from None
    return dict(zip(heading, values.T, strict=True)), notes
