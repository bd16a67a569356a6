"""Curves of a comparison over the gait cycle: right leg on the left side, left leg beside it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from drakegait.report import comparison_style as look
from drakegait.report import style
from drakegait.report.comparison_curves import TRUNK_ANGLES, Quantity, excitation, muscle_groups
from drakegait.report.curves import SIDES, GaitCurves
from drakegait.report.excitations import bursts

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_LEAST_RANGE = {"°": 8.0, "% BW": 10.0, "N m/kg": 0.3, "W/kg": 0.5}
"""What a panel covers at least, lest noise look like a difference."""
_BURST_COLOUR = "#e3e9dc"
_USUAL = "usual activity (electromyography)"
_LEGEND = ("reference ± σ/4", "toe off")
_LINE = "reference, inverse dynamics"


def cycle_figure(
    items: Sequence[Quantity], all_curves: Sequence[GaitCurves], band: bool = True
) -> Figure:
    """A row for each quantity, both legs with one scale.

    Args:
        items: quantities of legs that the walkers have.
        all_curves: the gaits, the first with its reference.
        band: whether to draw the reference where there is one, a band or a line.
    """
    labels = [curves.label for curves in all_curves]
    figure, grid = look.new_figure(
        len(items), 2, 1.22, left=0.62, gap=0.42, top=look.legend_height(labels, [*_LEGEND, _LINE]),
        sharey="row",
    )  # fmt: skip
    drawn: set[str] = set()
    for row, item in zip(grid, items, strict=True):
        for axes, side in zip(row, SIDES, strict=True):
            drawn |= draw_panel(axes, item, all_curves, side, band)
            _name_side(axes, side)
        _title(row[0], item)
        _widen(row[0], item)
        for axes in row:
            style.zero_line(axes)
            axes.tick_params(labelleft=True)
    for axes in grid[-1]:
        axes.set_xlabel("% of the leg's gait cycle", labelpad=2)
    look.line_legend(figure, labels, [*_reference_handles(drawn), look.toe_off_handle()])
    return figure


def trunk_figure(all_curves: Sequence[GaitCurves], band: bool = True) -> Figure:
    """Angles of the trunk over the right leg's cycle, in one row."""
    items = [item for item in TRUNK_ANGLES if item.values(all_curves[0], "right") is not None]
    columns = max(2, len(items))
    labels = [curves.label for curves in all_curves]
    # Titles have two lines.
    top = look.legend_height(labels, _LEGEND) + 0.14
    figure, grid = look.new_figure(1, columns, 1.3, left=0.42, between=0.36, top=top)
    drawn: set[str] = set()
    for axes, item in zip(grid[0], items, strict=False):
        drawn |= draw_panel(axes, item, all_curves, "right", band)
        axes.set_title(f"{item.title} [°]\n+ {item.up} / − {item.down}")
        _widen(axes, item)
        style.zero_line(axes)
        axes.set_xlabel("% of the right leg's gait cycle", labelpad=2)
    for axes in grid[0][len(items) :]:
        axes.remove()
    look.line_legend(figure, labels, [*_reference_handles(drawn), look.toe_off_handle()])
    return figure


def excitation_figure(all_curves: Sequence[GaitCurves]) -> Figure:
    """Excitations of all muscle groups, two groups in a row, each with its right and left muscle.

    Behind them: when electromyography usually finds the muscle active.
    """
    from matplotlib.patches import Patch

    groups = muscle_groups(all_curves)
    rows = -(-len(groups) // 2)
    labels = [curves.label for curves in all_curves]
    figure, grid = look.new_figure(
        rows, 4, 0.62, left=0.32, gap=0.34, between=0.27,
        top=look.legend_height(labels, [_USUAL, "toe off"]), sharey=True,
    )  # fmt: skip
    pairs = [row[place : place + 2] for row in grid for place in (0, 2)]
    for pair, group in zip(pairs, groups, strict=False):
        item = excitation(group)
        for axes, side in zip(pair, SIDES, strict=True):
            draw_panel(axes, item, all_curves, side, False)
            for low, high in bursts(group):
                axes.axvspan(low, high, color=_BURST_COLOUR, lw=0, zorder=-2, gid="usual burst")
            axes.set_ylim(-0.05, 1.05)
            axes.set_yticks([0.0, 0.5, 1.0])
            axes.set_xticks([0, 50, 100])
            axes.set_xticks([25, 75], minor=True)
            axes.tick_params(labelleft=side == "right", pad=2.0)
            axes.set_title(side, loc="right", color=style.SIDE_COLOURS[side], fontsize=6.5, pad=2.5)
        pair[0].set_title(item.title, fontsize=7.5, pad=2.5)
    for pair in pairs[len(groups) :]:
        for axes in pair:
            axes.remove()
    for axes in grid[-1]:
        if axes.figure is not None:
            axes.set_xlabel("% of the leg's gait cycle", fontsize=6.5, labelpad=2)
    handles = [
        Patch(color=_BURST_COLOUR, label=_USUAL),
        look.toe_off_handle(),
    ]
    look.line_legend(figure, labels, handles)
    return figure


def draw_panel(
    axes: Axes, item: Quantity, all_curves: Sequence[GaitCurves], side: str, band: bool
) -> set[str]:
    """The curves of one side, toe off and the reference; what of that there is: band, line."""
    drawn = set()
    edges = item.band(all_curves[0], side) if band else None
    if edges is not None:
        axes.fill_between(*edges, color=look.BAND_COLOUR, lw=0, zorder=-1, gid="reference band")
        drawn.add("band")
    line = item.line(all_curves[0], side) if band else None
    if line is not None:
        axes.plot(*line, color=look.LINE_COLOUR, lw=2.2, zorder=-1, gid="reference line")
        drawn.add("line")
    for number, curves in enumerate(all_curves):
        found = item.own(curves, side)
        if found is None:
            continue
        look.draw(axes, number, *found)
        colour = look.GAIT_COLOURS[number]
        axes.axvline(curves.toe_off(side), color=colour, lw=0.6, ls=(0, (2, 2)), zorder=0)
    axes.set_xlim(0.0, 100.0)
    axes.set_xticks(range(0, 101, 20))
    return drawn


def _reference_handles(drawn: set[str]) -> list:
    from matplotlib.lines import Line2D
    from matplotlib.patches import Patch

    handles: list = []
    if "band" in drawn:
        handles.append(Patch(color=look.BAND_COLOUR, label=_LEGEND[0]))
    if "line" in drawn:
        handles.append(Line2D([], [], color=look.LINE_COLOUR, lw=2.2, label=_LINE))
    return handles


def _name_side(axes: Axes, side: str) -> None:
    axes.set_title(side, loc="right", color=style.SIDE_COLOURS[side], weight="bold")


def _title(axes: Axes, item: Quantity) -> None:
    axes.set_title(f"{item.title} [{item.unit}]")
    if item.down:
        axes.set_ylabel(f"− {item.down}   + {item.up}", fontsize=6.3, color="#5c6570", labelpad=2)


def _widen(axes: Axes, item: Quantity) -> None:
    low, high = axes.get_ylim()
    least = _LEAST_RANGE.get(item.unit, 0.0)
    if high - low < least:
        middle = 0.5 * (low + high)
        axes.set_ylim(middle - 0.5 * least, middle + 0.5 * least)
