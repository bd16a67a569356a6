"""Tables of the page and of docs/paper.md: texts under heads."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from drakegait.paper.numbers import Numbers


@dataclass(frozen=True)
class Table:
    """A table; the first column is text, the others are numbers.

    Attributes:
        title: above it.
        heads: of the columns.
        rows: texts.
        note: below it.
    """

    title: str
    heads: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]
    note: str = ""


_COLUMNS = {
    "f": ("cost", ".3f"),
    "E^t [J/m]": ("cost_of_transport_J_per_m", ".1f"),
    "J_dev [s]": ("deviation_s", ".3f"),
    "iterations": ("iterations", ".0f"),
    "time [s]": ("wall_time_s", ".1f"),
}


def studies(
    numbers: Numbers, names: Sequence[str], title: str = "Solved", base: str | None = None,
    note: str = "",
) -> Table:  # fmt: skip
    """A row for each study: cost, energy, deviation, iterations, time, and how it ended; of one
    that did not converge the law that its last gait holds least.

    Args:
        base: a study; the changes of energy and deviation against it get columns.
    """
    heads = ["study", *_COLUMNS]
    if base is not None:
        heads += ["E^t against base", "J_dev against base"]
    rows = []
    for name in names:
        row = numbers.rows.get(name, {})
        cells = [name, *(_text(row.get(key), form) for key, form in _COLUMNS.values())]
        if base is not None:
            start = numbers.rows.get(base, {})
            for key in ("cost_of_transport_J_per_m", "deviation_s"):
                cells.append(_share(start.get(key), row.get(key)))
        rows.append((*cells, _ended(row)))
    return Table(title, (*heads, "ended, check"), tuple(rows), note)


def _text(value: object, form: str) -> str:
    return "-" if value is None else format(float(value), form)  # type: ignore[arg-type]


def _share(before: float | None, after: float | None) -> str:
    if before is None or after is None or before == 0.0:
        return "-"
    return f"{100.0 * (after - before) / before:+.1f} %"


def _ended(row: dict) -> str:
    if not row:
        return "not run"
    if row.get("status") != "done":
        ended = row.get("solver_status")
        if ended is None:  # no gait at all
            return f"failed: {row.get('reason') or 'for an unknown reason'}"
        held = row.get("not_held")
        text = str(ended).replace("_", " ")
        return f"{text}; does not hold: {held}" if held else text
    return "converged" + ("" if row.get("check_passed") else ", check not passed")
