"""Bars of a comparison: what each muscle and each part of the cycle costs, and what has changed."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from drakegait.report import comparison_style as look
from drakegait.report import style
from drakegait.report.curves import SIDES

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from drakegait.report.comparison_tables import Row

_CHANGES = ("change, right", "change, left")
_BAR = 0.8  # share of a row that its bars fill


def cost_figure(table: Sequence[Row], labels: Sequence[str]) -> Figure:
    """Cost of transport of rows that both legs have, with the changes to the first gait.

    Args:
        table: right and left row of each muscle group or part, in turn.
        labels: of the gaits.
    """
    names = [row.label for row in table if row.side == "right"]
    by_side = {side: np.array([r.values for r in table if r.side == side]) for side in SIDES}
    others = len(labels) - 1
    columns = 2 + min(1, others)
    bars = max(len(labels), 2 * others)
    height = len(names) * max(0.2, 0.085 * bars + 0.06)
    top = look.legend_height(labels, _CHANGES if others else ())
    figure, grid = look.new_figure(
        1, columns, height, left=1.55, between=0.22, top=top, sharey=True
    )
    for axes, side in zip(grid[0], SIDES, strict=False):
        _bars(axes, by_side[side], [look.GAIT_COLOURS[n] for n in range(len(labels))])
        axes.set_title(f"{side.capitalize()} leg [J/m]", color=style.SIDE_COLOURS[side])
    high = max(axes.get_xlim()[1] for axes in grid[0, :2])
    low = min(axes.get_xlim()[0] for axes in grid[0, :2])
    for axes in grid[0, :2]:
        axes.set_xlim(low, high)
    extra = []
    if others:
        extra = _changes(grid[0, 2], by_side, labels)
    grid[0, 0].set_yticks(range(len(names)), names)
    grid[0, 0].invert_yaxis()
    for axes in grid[0]:
        axes.tick_params(axis="y", length=0)
        axes.grid(axis="x", color="#e6e6e6", lw=0.5)
        axes.set_axisbelow(True)
        axes.margins(y=0.01)
    look.bar_legend(figure, labels, extra)
    return figure


def _bars(axes: Axes, values: np.ndarray, colours: Sequence[str], **options) -> None:
    """Bars (rows, bars) below each other within each row."""
    count = values.shape[1]
    for number in range(count):
        place = np.arange(len(values)) + _BAR * ((number + 0.5) / count - 0.5)
        each = {name: of[number] for name, of in options.items()}
        axes.barh(
            place, np.nan_to_num(values[:, number]), height=_BAR / count, color=colours[number],
            lw=0, **each,
        )  # fmt: skip
    axes.axvline(0.0, color="#8a8a8a", lw=0.6)


def _changes(axes: Axes, by_side: dict[str, np.ndarray], labels: Sequence[str]) -> list:
    """Later gaits minus the first; the sides in their colours, more gaits in paler ones."""
    from matplotlib.patches import Patch

    others = len(labels) - 1
    values, colours, alphas = [], [], []
    for number in range(1, others + 1):
        for side in SIDES:
            values.append(by_side[side][:, number] - by_side[side][:, 0])
            colours.append(style.SIDE_COLOURS[side])
            alphas.append(1.0 - 0.6 * (number - 1) / max(1, others))
    _bars(axes, np.array(values).T, colours, alpha=alphas)
    axes.set_title("Change [J/m]")
    if others > 1:
        axes.set_title("Change to the first [J/m],\npaler for later gaits")
    return [
        Patch(color=style.SIDE_COLOURS[side], label=label)
        for side, label in zip(SIDES, _CHANGES, strict=True)
    ]
