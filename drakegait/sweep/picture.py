"""`sweep.svg`, `sweep.png`: energy and deviation over the grid."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from drakegait.report.style import look, panel_figure, save
from drakegait.sweep import axes as sweep_axes
from drakegait.sweep.table import TABLE, rows

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from drakegait.sweep.result import SweepResult

PANELS = {
    "cost_of_transport_J_per_m": "metabolic cost of transport [J/m]",
    "deviation_s": "deviation from the reference [s]",
}
_COLOURS = ("#1b62a5", "#c0311f", "#3a8f4a", "#8a5aa8", "#c98a1b", "#4a9aa8", "#7a7a7a", "#a8456f")
_MOST_LINES = len(_COLOURS)
_MOST_DOTS = 60
_MOST_TICKS = 8


def draw(result: SweepResult, folder: Path) -> list[Path]:
    """Draw into `folder`.

    Over numbers: a line along the axis with most values, one for each combination of the others;
    with many lines over two numbers: a map. Else a dot for each study, by name.

    Raises:
        BadFile: the folder cannot be written.
    """
    table = rows(result)
    along, lines = _lines(result, table)
    grid, title = sweep_axes.grid(result.axes), f"Sweep {result.folder.name}"
    with look():
        if along is not None and len(lines) <= _MOST_LINES:
            figure = _line_figure(title, table, along, lines)
        elif grid is not None and len(grid) == 2 and all(map(sweep_axes.numeric, grid.values())):
            figure = _map_figure(title, table, grid)
        else:
            figure = _dot_figure(title, table)
        return save(figure, folder, TABLE)


def _subtitle(table: list[dict[str, Any]]) -> str:
    failed = sum(row["status"] != "done" for row in table)
    return f"{len(table)} studies" + (f", {failed} failed" if failed else "")


def _lines(
    result: SweepResult, table: list[dict[str, Any]]
) -> tuple[str | None, dict[str, list[dict[str, Any]]]]:
    """The axis along which to draw, and its rows by the words for the other axes."""
    places = result.axes
    names = list(next(iter(places.values())))
    numbers = {}
    for axis in names:
        values = sweep_axes.levels(axis, places)
        if len(values) > 1 and sweep_axes.numeric(values):
            numbers[axis] = len(values)
    if not numbers:
        return None, {}
    along = max(numbers, key=lambda axis: numbers[axis])
    lines: dict[str, list[dict[str, Any]]] = {}
    for row in table:
        others = [f"{axis} {_short(row[axis])}" for axis in names if axis != along]
        lines.setdefault(", ".join(others), []).append(row)
    return along, {name: sorted(line, key=lambda row: row[along]) for name, line in lines.items()}


def _line_figure(
    title: str,
    table: list[dict[str, Any]],
    along: str,
    lines: dict[str, list[dict[str, Any]]],
) -> Figure:
    figure, panels = panel_figure(1, 2, title, _subtitle(table), panel=(3.4, 2.5))
    for axes, (column, heading) in zip(panels[0], PANELS.items(), strict=True):
        for (name, line), colour in zip(lines.items(), _COLOURS, strict=False):
            _draw_line(axes, along, line, column, colour, name)
        axes.set_title(heading)
        axes.set_xlabel(_with_unit(along), fontsize=7.5)
        axes.margins(0.06)
        ticks = sorted({float(row[along]) for row in table})
        if len(ticks) <= _MOST_TICKS:
            axes.set_xticks(ticks)
        if any(row[column] is None for row in table):
            axes.text(1.0, 1.03, "x: failed", fontsize=6.5, color="#555555", ha="right",
                      transform=axes.transAxes)  # fmt: skip
    if len(lines) > 1:
        panels[0][0].legend(fontsize=6.5, frameon=False, handlelength=1.6)
    return figure


def _draw_line(
    axes: Axes, along: str, line: list[dict[str, Any]], column: str, colour: str, name: str
) -> None:
    x = np.array([float(row[along]) for row in line])
    y = np.array([_number(row[column]) for row in line])
    axes.plot(x, y, color=colour, lw=1.4, marker="o", ms=3.5, label=name or None, zorder=3)
    lost = x[np.isnan(y)]
    axes.plot(
        lost, np.full(len(lost), 0.03), color=colour, ls="", marker="x", ms=5, zorder=4,
        transform=axes.get_xaxis_transform(),
    )  # fmt: skip


def _map_figure(
    title: str, table: list[dict[str, Any]], grid: dict[str, list[Any]]
) -> Figure:
    (across, columns), (up, levels) = grid.items()
    figure, panels = panel_figure(1, 2, title, _subtitle(table), panel=(3.4, 2.6))
    for axes, (column, heading) in zip(panels[0], PANELS.items(), strict=True):
        values = np.full((len(levels), len(columns)), np.nan)
        for row in table:
            values[levels.index(row[up]), columns.index(row[across])] = _number(row[column])
        axes.set_facecolor("#dddddd")  # where a study failed
        place = axes.get_position()  # leaves room for the scale inside the panel
        axes.set_position((place.x0, place.y0, 0.84 * place.width, place.height))
        image = axes.pcolormesh(values, cmap="viridis")
        scale = figure.colorbar(image, cax=axes.inset_axes((1.03, 0.0, 0.04, 1.0)))
        scale.ax.tick_params(labelsize=6.5)
        axes.set_xticks(np.arange(len(columns)) + 0.5, map(_short, columns), fontsize=6.5)
        axes.set_yticks(np.arange(len(levels)) + 0.5, map(_short, levels), fontsize=6.5)
        axes.set_xlabel(_with_unit(across), fontsize=7.5)
        axes.set_title(f"{heading}, over {_with_unit(up)}", fontsize=7.5)
    return figure


def _dot_figure(title: str, table: list[dict[str, Any]]) -> Figure:
    shown = table[:_MOST_DOTS]
    subtitle = _subtitle(table)
    if len(shown) < len(table):
        subtitle += f"; the first {len(shown)} of them, all are in sweep.csv"
    height = max(1.0, 0.17 * len(shown))
    figure, panels = panel_figure(1, 3, title, subtitle, panel=(2.6, height))
    rows_up = np.arange(len(shown))
    for axes in panels[0]:
        axes.set_ylim(len(shown) - 0.4, -0.6)
    names = panels[0][0]
    names.set_axis_off()
    for y, row in zip(rows_up, shown, strict=True):
        names.text(1.08, y, row["study"], ha="right", va="center", fontsize=7,
                   transform=names.get_yaxis_transform())  # fmt: skip
    for axes, (column, heading) in zip(panels[0][1:], PANELS.items(), strict=True):
        values = np.array([_number(row[column]) for row in shown])
        axes.plot(values, rows_up, color=_COLOURS[0], ls="", marker="o", ms=4, zorder=3)
        lost = rows_up[np.isnan(values)]
        axes.plot(np.full(len(lost), 0.03), lost, color=_COLOURS[1], ls="", marker="x", ms=4,
                  transform=axes.get_yaxis_transform())  # fmt: skip
        axes.set_yticks(rows_up, [])
        axes.grid(axis="y", color="#ececec", lw=0.6, zorder=0)
        axes.margins(x=0.08)
        axes.set_title(heading)
    return figure


def _with_unit(axis: str) -> str:
    unit = sweep_axes.unit(axis)
    return axis.replace("_", " ") + (f" [{unit}]" if unit not in ("", "-") else "")


def _number(value: Any) -> float:
    return np.nan if value is None else float(value)


def _short(value: Any) -> str:
    return f"{value:g}" if isinstance(value, float) else str(value)
