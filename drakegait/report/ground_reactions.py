"""Figure of the ground reactions (in kind: figures 7 and 11 of the paper)."""

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

_AXES = {
    "vertical": "Vertical force [% body weight]",
    "fore-aft": "Fore-aft force [% body weight]   + propels / − brakes",
    "medial": "Side force [% body weight]   + medial / − lateral",
}
_VECTOR_PANEL = (3.1, 2.0)  # width and height of a panel [inch]
_VECTOR_STEP = 1.5  # % of the cycle between two force vectors
_LEAST_LOAD = 5.0  # % of body weight that a force vector must have to be drawn
VECTOR_SCALE = 0.004
"""Length of a drawn force [m per % of body weight]."""


def ground_reactions(all_curves: Sequence[GaitCurves]) -> Figure:
    """Forces and free moment on both feet, and the force vectors along the sole.

    Args:
        all_curves: the gait, then those it is compared with.
    """
    first = all_curves[0]
    spatial = first.coordinate("hat_y") is not None
    shown = list(_AXES) if spatial else ["vertical", "fore-aft"]
    figure, grid = style.panel_figure(
        2, len(shown), "Ground reactions", style.subtitle_of(first), panel=_VECTOR_PANEL
    )
    has_reference = first.ground_reaction("right", "vertical", reference=True) is not None
    legend(figure, all_curves, "reference" if has_reference else None)
    for axes, axis in zip(grid[0], shown, strict=True):
        style.cycle_axes(axes, first, numbers=True)
        _draw_force(axes, all_curves, axis)
    if spatial:
        style.cycle_axes(grid[1, 2], first, label=True)
        _draw_free_moment(grid[1, 2], all_curves)
    for axes, side in zip(grid[1], SIDES, strict=False):
        _draw_vectors(axes, first, side)
    return figure


def _draw_force(axes: Axes, all_curves: Sequence[GaitCurves], axis: str) -> None:
    axes.set_title(_AXES[axis])
    for side in SIDES:
        first = all_curves[0]
        reference = first.ground_reaction(side, axis, reference=True)
        if reference is not None:
            style.draw_reference(axes, *first.own_cycle(side, reference))
        for number, curves in enumerate(all_curves):
            force = curves.ground_reaction(side, axis)
            style.draw_gait(axes, number, style.SIDE_COLOURS[side], *curves.own_cycle(side, force))
    if axis == "vertical":
        axes.axhline(100.0, color="#8a8a8a", lw=0.5, ls=":", zorder=0)
        axes.set_ylim(bottom=min(-5.0, axes.get_ylim()[0]))
    style.zero_line(axes)


def _draw_free_moment(axes: Axes, all_curves: Sequence[GaitCurves]) -> None:
    axes.set_title("Free moment [N m]   + toes in / − out")
    for side in SIDES:
        for number, curves in enumerate(all_curves):
            style.draw_gait(
                axes, number, style.SIDE_COLOURS[side],
                *curves.own_cycle(side, curves.free_moment(side)),
            )  # fmt: skip
    style.zero_line(axes)


def _draw_vectors(axes: Axes, curves: GaitCurves, side: str) -> None:
    """Force vectors in the sagittal plane at the centre of pressure (Pedotti 1977)."""
    from matplotlib.collections import LineCollection

    feet = curves.data.sel(foot=side)
    step = max(1, round(_VECTOR_STEP * (curves.samples - 1) / 100.0))
    picked = slice(0, curves.samples - 1, step)
    start = feet.centre_of_pressure.sel(axis=["x", "z"]).values[picked].copy()
    heel = heel_of_print(curves, side)
    start[:, 0] = wrap(start[:, 0] - heel, curves.gait.stride_length)
    load = 100.0 * feet.ground_reaction_force.sel(axis=["x", "z"]).values[picked]
    load /= curves.body_weight
    loaded = (load[:, 1] > _LEAST_LOAD) & np.isfinite(start).all(axis=1)
    ends = start + VECTOR_SCALE * load
    segments = np.stack([start, ends], axis=1)[loaded]
    colour = style.SIDE_COLOURS[side]
    axes.add_collection(LineCollection(list(segments), colors=colour, linewidths=0.6, alpha=0.8))
    order = np.argsort((curves.percent[picked][loaded] - curves.heel_strike(side)) % 100.0)
    axes.plot(*ends[loaded][order].T, color=colour, lw=1.2)
    length = float(curves.gait.study.walker.foot.length)
    axes.plot([0.0, length], [0.0, 0.0], color=style.BODY_COLOUR, lw=3.0, solid_capstyle="butt")
    axes.set_title(f"Force vectors, {side} foot")
    axes.set_aspect("equal")
    highest = max(curves.ground_reaction(side, "vertical").max() for side in SIDES)
    low, high = -0.02, VECTOR_SCALE * max(120.0, 1.08 * highest)
    half = 0.5 * (high - low) * _VECTOR_PANEL[0] / _VECTOR_PANEL[1]
    axes.set_xlim(0.5 * length - half, 0.5 * length + half)
    axes.set_ylim(low, high)
    axes.set_yticks([VECTOR_SCALE * load for load in (0, 50, 100)], ["0", "50", "100"])
    axes.set_ylabel("% of body weight", fontsize=7.5, labelpad=1)
    axes.set_xlabel("along the foot, from the heel [m]", fontsize=7.5, labelpad=2)


def heel_of_print(curves: GaitCurves, side: str) -> float:
    """x of the heel's point of the footprint at the beginning of the side's stance [m]."""
    placement, foot = curves.gait.values.placement, curves.gait.study.walker.foot
    ankle = 0.0 if side == "right" else float(placement[1])
    return ankle + foot.heel * float(np.cos(placement[2 if side == "right" else 3]))


def wrap(x: np.ndarray, period: float) -> np.ndarray:
    """x moved by whole strides into [-period/2, period/2)."""
    return (x + 0.5 * period) % period - 0.5 * period
