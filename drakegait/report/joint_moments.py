"""Figure of the joint moments and powers of both legs."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from drakegait.report import style
from drakegait.report.curves import SIDES, GaitCurves
from drakegait.report.legend import legend

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_MOMENTS = {
    "hip_flexion": "Hip   + flexor / − extensor",
    "knee_flexion": "Knee   + flexor / − extensor",
    "ankle_dorsiflexion": "Ankle   + dorsi- / − plantarflexor",
    "hip_adduction": "Hip   + adductor / − abductor",
    "hip_rotation": "Hip   + internal / − external rotator",
}
JOINT_AXES = {
    "Hip": ("hip_flexion", "hip_adduction", "hip_rotation"),
    "Knee": ("knee_flexion",),
    "Ankle": ("ankle_dorsiflexion",),
}


def joint_moments(all_curves: Sequence[GaitCurves]) -> Figure:
    """Moments of muscles and passive structures [N m/kg], and powers [W/kg].

    Args:
        all_curves: the gait, then those it is compared with.
    """
    first = all_curves[0]
    spatial = moment(first, "hip_adduction_r") is not None
    figure, grid = style.panel_figure(
        3 if spatial else 2, 3, "Joint moments and powers",
        style.subtitle_of(first) + "; internal moments, thin: passive part",
    )  # fmt: skip
    legend(figure, all_curves, None)
    cells = [*grid[0], *(grid[2, :2] if spatial else ())]
    for number, (axes, (name, title)) in enumerate(zip(cells, _MOMENTS.items(), strict=False)):
        style.cycle_axes(axes, first, numbers=number < 3, label=number > 2)
        axes.set_title(f"{title} [N m/kg]")
        for side in SIDES:
            _draw(axes, all_curves, side, lambda c, s, n=name: moment(c, f"{n}_{s[0]}"))
            passive = moment(first, f"{name}_{side[0]}", passive_only=True)
            axes.plot(*first.own_cycle(side, passive), color=style.SIDE_COLOURS[side], lw=0.5)
        style.zero_line(axes)
    for axes, joint in zip(grid[1], JOINT_AXES, strict=True):
        style.cycle_axes(axes, first, label=not spatial)
        axes.set_title(f"{joint} power [W/kg]   + generated / − absorbed")
        for side in SIDES:
            _draw(axes, all_curves, side, lambda c, s, j=joint: power(c, j, s))
        style.zero_line(axes)
    if spatial:
        _draw_metabolic(grid[2, 2], all_curves)
    return figure


def moment(curves: GaitCurves, name: str, passive_only: bool = False) -> np.ndarray | None:
    """Moment at a joint in anatomical sense (num_samples,) [N m/kg], None if there is none."""
    variable = "joint_moment_passive" if passive_only else "joint_moment"
    found = curves.joint(name, variable)
    return None if found is None else found / curves.mass


def power(curves: GaitCurves, joint: str, side: str) -> np.ndarray:
    """Power of muscles and passive structures at all axes of a joint (num_samples,) [W/kg]."""
    parts = [curves.joint(f"{name}_{side[0]}", "joint_power") for name in JOINT_AXES[joint]]
    return sum(part for part in parts if part is not None) / curves.mass


def _draw(axes: Axes, all_curves: Sequence[GaitCurves], side: str, values) -> None:
    for number, curves in enumerate(all_curves):
        found = values(curves, side)
        if found is not None:
            style.draw_gait(axes, number, style.SIDE_COLOURS[side], *curves.own_cycle(side, found))


def _draw_metabolic(axes: Axes, all_curves: Sequence[GaitCurves]) -> None:
    style.cycle_axes(axes, all_curves[0], label=True)
    axes.set_title("Metabolic power of the leg's muscles [W/kg]")
    for side in SIDES:
        _draw(axes, all_curves, side, metabolic_power)
    style.zero_line(axes)


def metabolic_power(curves: GaitCurves, side: str) -> np.ndarray:
    """Metabolic power of the muscles of one leg (num_samples,) [W per kg of body mass]."""
    names = [name for name in curves.data.muscle.values if name.endswith(f"_{side[0]}")]
    return curves.data.muscle_power.sel(muscle=names).sum("muscle").values / curves.mass
