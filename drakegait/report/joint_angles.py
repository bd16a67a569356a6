"""Figure of the joint angles (in kind: figures 6, 9 and 10 of the paper)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from drakegait.report import style
from drakegait.report.curves import SIDES, GaitCurves
from drakegait.report.legend import legend

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


@dataclass(frozen=True)
class AnglePanel:
    """One panel.

    Attributes:
        coordinate: its name, without the side for a leg's.
        title: what it is called.
        up, down: what values above and below zero mean.
        sided: whether each leg has one.
    """

    coordinate: str
    title: str
    up: str
    down: str
    sided: bool = True


PANELS = (
    AnglePanel("hat_tilt", "Trunk tilt", "forward", "backward", sided=False),
    AnglePanel("hat_list", "Trunk list", "to the right", "left", sided=False),
    AnglePanel("hat_rotation", "Trunk rotation", "to the left", "right", sided=False),
    AnglePanel("hip_flexion", "Hip flexion", "flexion", "extension"),
    AnglePanel("hip_adduction", "Hip adduction", "adduction", "abduction"),
    AnglePanel("hip_rotation", "Hip rotation", "internal", "external"),
    AnglePanel("knee_flexion", "Knee flexion", "flexion", "extension"),
    AnglePanel("ankle_dorsiflexion", "Ankle dorsiflexion", "dorsi-", "plantarflexion"),
)
_LEAST_RANGE = 10.0  # degrees that a panel covers at least, lest noise look like motion


def joint_angles(all_curves: Sequence[GaitCurves]) -> Figure:
    """Angles of trunk, hips, knees and ankles [deg] and the path of the hips [cm].

    Args:
        all_curves: the gait, then those it is compared with.
    """
    first = all_curves[0]
    panels = [panel for panel in PANELS if _values(first, panel, "right") is not None]
    columns = 3
    rows = -(-(len(panels) + 1) // columns)
    figure, grid = style.panel_figure(rows, columns, "Joint angles", style.subtitle_of(first))
    legend(figure, all_curves, "reference", body=True)
    cells = list(grid.flat)
    for number, (axes, panel) in enumerate(zip(cells, panels, strict=False)):
        style.cycle_axes(axes, first, numbers=number < columns, label=number >= len(panels) - 2)
        _draw_angle(axes, all_curves, panel)
    style.cycle_axes(cells[len(panels)], first, label=True)
    _draw_path(cells[len(panels)], all_curves)
    for axes in cells[len(panels) + 1 :]:
        axes.remove()
    return figure


def _name(panel: AnglePanel, side: str) -> str:
    return f"{panel.coordinate}_{side[0]}" if panel.sided else panel.coordinate


def _values(curves: GaitCurves, panel: AnglePanel, side: str, variable: str = "coordinates"):
    return curves.coordinate(_name(panel, side), variable)


def _draw_angle(axes: Axes, all_curves: Sequence[GaitCurves], panel: AnglePanel) -> None:
    axes.set_title(f"{panel.title} [°]   + {panel.up} / − {panel.down}")
    for side in SIDES if panel.sided else SIDES[:1]:
        first = all_curves[0]
        reference = _values(first, panel, side, "reference_coordinates")
        if reference is not None:
            style.draw_reference(axes, *first.own_cycle(side, reference))
        colour = style.SIDE_COLOURS[side] if panel.sided else style.BODY_COLOUR
        for number, curves in enumerate(all_curves):
            values = _values(curves, panel, side)
            if values is not None:
                style.draw_gait(axes, number, colour, *curves.own_cycle(side, values))
    low, high = axes.get_ylim()
    if high - low < _LEAST_RANGE:
        middle = 0.5 * (low + high)
        axes.set_ylim(middle - 0.5 * _LEAST_RANGE, middle + 0.5 * _LEAST_RANGE)
    style.zero_line(axes)


def _draw_path(axes: Axes, all_curves: Sequence[GaitCurves]) -> None:
    """How the midpoint of the hips rises and sways about its mean, in centimetres."""
    moves = {"hat_z": "up", "hat_y": "to the left"}
    shown = [name for name in moves if all_curves[0].coordinate(name) is not None]
    axes.set_title("Hip centre [cm]   " + ", ".join(
        f"{'solid' if name == 'hat_z' else 'thin'}: {moves[name]}" for name in shown))  # fmt: skip
    for name in shown:
        mean = all_curves[0].coordinate(name)[:-1].mean()
        reference = all_curves[0].coordinate(name, "reference_coordinates")
        if reference is not None:
            style.draw_reference(axes, all_curves[0].percent, 100.0 * (reference - mean))
        for number, curves in enumerate(all_curves):
            values = curves.coordinate(name)
            if values is not None:
                style.draw_gait(
                    axes, number, style.BODY_COLOUR, curves.percent, 100.0 * (values - mean)
                )
                axes.lines[-1].set_linewidth(1.4 if name == "hat_z" else 0.7)
    style.zero_line(axes)
