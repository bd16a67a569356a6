"""Footprints from above, with the path of the centre of pressure."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from drakegait.report import style
from drakegait.report.curves import SIDES, GaitCurves

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from drakegait.gait import Gait

# Outline of a right shoe: along the foot (0 heel, 1 toe tip) and to the outside, in foot lengths.
_OUTLINE = np.array([
    (0.00, 0.00), (0.02, 0.07), (0.08, 0.115), (0.20, 0.12), (0.40, 0.125), (0.60, 0.155),
    (0.75, 0.17), (0.88, 0.135), (0.96, 0.06), (1.00, -0.03), (0.99, -0.10), (0.90, -0.155),
    (0.75, -0.16), (0.60, -0.125), (0.42, -0.085), (0.20, -0.11), (0.08, -0.105), (0.02, -0.06),
])  # fmt: skip
_TOE_SHARE = 0.738  # the metatarsal line, where the toe point lies, in foot lengths from the heel


def footprint_outline(length: float, side: str) -> np.ndarray:
    """Outline of a shoe (num_points, 2): x forward from the ankle's projection, y to the left [m].

    A decoration without meaning for the mechanics, where a foot touches at heel and toe point only.

    Args:
        length: distance of heel and toe point [m].
    """
    along, outside = (_OUTLINE * length / _TOE_SHARE).T
    return np.column_stack([along, outside if side == "left" else -outside])


def prints(gait: Gait, strides: int = 1) -> dict[str, np.ndarray]:
    """Where the feet stand: x, y [m] of the ankles' projections and headings [rad], (num, 3).

    By side, in order of time; the left foot's first print is the one before the first step.
    """
    placement = np.asarray(gait.values.placement)
    step, width = placement[1], placement[4]
    if gait.study.skeleton_kind == "planar":
        # It has no step width; its feet are where the hips are, which the mechanics do not feel.
        skeleton = gait.study.walker.skeleton
        width = -2.0 * skeleton.contact_points(np.zeros(skeleton.num_coordinates))[0, 1]
    found = {}
    for side, first, start, sign in (("right", 0, 0.0, -1.0), ("left", -1, step, 1.0)):
        numbers = np.arange(first, strides + 1 if side == "right" else strides)
        x = start + numbers * gait.stride_length
        rest = np.array([sign * 0.5 * width, placement[2 if side == "right" else 3]])
        found[side] = np.column_stack([x, np.tile(rest, (len(x), 1))])
    return found


def placed_outline(gait: Gait, side: str, where: np.ndarray) -> np.ndarray:
    """Outline (num_points, 2) of the footprint at `where` = (x, y, heading) on the ground [m]."""
    foot = gait.study.walker.foot
    outline = footprint_outline(foot.length, side) + [foot.heel, 0.0]
    cos, sin = np.cos(where[2]), np.sin(where[2])
    return outline @ np.array([[cos, sin], [-sin, cos]]) + where[:2]


def draw_footprints(axes: Axes, curves: GaitCurves, x_range: tuple[float, float]) -> None:
    """Prints of the stride seen from above, with the centres of pressure and the centre of mass."""
    gait = curves.gait
    placed = prints(gait)
    for side in SIDES:
        colour = style.SIDE_COLOURS[side]
        for where in placed[side]:
            outline = placed_outline(gait, side, where)
            axes.fill(*outline.T, facecolor=colour, alpha=0.12, edgecolor=colour, lw=0.8)
        path = curves.data.centre_of_pressure.sel(foot=side).values[:, :2]
        axes.plot(*_open_jumps(path).T, color=colour, lw=1.4)
    mass = curves.data.centre_of_mass.values[:, :2]
    axes.plot(*mass.T, color=style.BODY_COLOUR, lw=0.9, ls="--")
    step_right, step_left, angle_right, angle_left, width = np.asarray(gait.values.placement)
    out_right, out_left = -np.degrees(angle_right), np.degrees(angle_left)
    axes.set_title(
        "From above, dashed: centre of mass, line: centre of pressure.   "
        f"Steps R {step_right:.2f} L {step_left:.2f} m, width {100 * width:.0f} cm, "
        f"toe-out R {out_right:.0f}° L {out_left:.0f}°",
        fontsize=8.0,
    )
    axes.set_aspect("equal", adjustable="box")
    axes.set_xlim(*x_range)
    axes.set_ylim(-0.2, 0.2)
    axes.axis("off")


def _open_jumps(path: np.ndarray) -> np.ndarray:
    """The path with a gap where it jumps to the next footprint."""
    jump = np.flatnonzero(np.abs(np.diff(path[:, 0])) > 0.3)
    return np.insert(path, jump + 1, np.nan, axis=0)
