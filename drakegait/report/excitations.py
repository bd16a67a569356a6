"""Figure of the muscles' neural excitations (in kind: figures 8, 12 and 13 of the paper)."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from drakegait.report import style
from drakegait.report.curves import SIDES, GaitCurves
from drakegait.report.legend import legend

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

TYPICAL_BURSTS = {
    "tibialis_anterior": ((0, 10), (60, 100)),
    "vasti": ((0, 20), (90, 100)),
    "hamstrings": ((0, 10), (90, 100)),
    "gluteus_maximus": ((0, 20),),
    "gluteus_medius": ((0, 40),),
    "soleus": ((15, 50),),
    "gastrocnemius": ((15, 50),),
    "iliopsoas": ((50, 70),),
    "rectus_femoris": ((0, 10), (55, 70)),
}
"""When a muscle is usually active in level walking [% of the cycle], by the beginning of its name.

Rounded textbook values of electromyography; for orientation, no measurement behind a curve.
"""
_BURST_COLOUR = "#9a9a9a"


def excitations(all_curves: Sequence[GaitCurves]) -> Figure:
    """Excitation of each muscle group of both legs, 0 to 1, with its activation.

    Args:
        all_curves: the gait, then those it is compared with.
    """
    first = all_curves[0]
    groups = list(dict.fromkeys(name[:-2] for name in first.data.muscle.values))
    columns = 4
    rows = -(-len(groups) // columns)
    figure, grid = style.panel_figure(
        rows, columns, "Muscle excitations",
        style.subtitle_of(first) + "\nline: excitation, tint: activation, "
        "grey bar: when electromyography usually shows bursts", panel=(2.3, 1.15),
    )  # fmt: skip
    legend(figure, all_curves, None)
    cells = list(grid.flat)
    for number, (axes, group) in enumerate(zip(cells, groups, strict=False)):
        last = number >= len(groups) - columns
        style.cycle_axes(axes, first, numbers=number < columns, label=last)
        _draw_group(axes, all_curves, group)
    for axes in cells[len(groups) :]:
        axes.remove()
    return figure


def bursts(group: str) -> tuple[tuple[int, int], ...]:
    """Usual bursts of a muscle group [% of the cycle]; empty if not known."""
    for beginning, when in TYPICAL_BURSTS.items():
        if group.startswith(beginning):
            return when
    return ()


def _draw_group(axes: Axes, all_curves: Sequence[GaitCurves], group: str) -> None:
    axes.set_title(group.replace("_", " "))
    for low, high in bursts(group):
        axes.plot(
            [low, high], [-0.11, -0.11], color=_BURST_COLOUR, lw=3.0, solid_capstyle="butt",
            gid="usual burst",
        )  # fmt: skip
    for side in SIDES:
        name, colour = f"{group}_{side[0]}", style.SIDE_COLOURS[side]
        activation = all_curves[0].muscle(name, "activation")
        if activation is not None:  # a leg with a prosthesis has fewer muscles
            percent, activation = all_curves[0].own_cycle(side, activation)
            axes.fill_between(percent, activation, color=colour, alpha=0.14, lw=0, zorder=2)
        for number, curves in enumerate(all_curves):
            excitation = curves.muscle(name)
            if excitation is not None:
                style.draw_gait(axes, number, colour, *curves.own_cycle(side, excitation))
    axes.set_ylim(-0.18, 1.18)
    axes.set_yticks([0.0, 0.5, 1.0])
    style.zero_line(axes)
