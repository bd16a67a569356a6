"""Stick figures of the walker along its stride (in kind: figure 5 of the paper)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from drakegait.report import style
from drakegait.report.curves import SIDES, GaitCurves
from drakegait.report.footprints import draw_footprints
from drakegait.report.legend import legend
from drakegait.walker import feet

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from drakegait.gait import Gait

NUM_STROBE = 21
"""Instants of the stroboscopic picture, both ends of the stride counted."""
_PITCH = 1.03  # distance of the eight figures of the events [m at 1.80 m of height]
_FORCE_SCALE = 0.8  # length of an arrow of one body weight [m at 1.80 m of height]
_LEAST_LOAD = 0.03  # share of body weight below which a foot gets no arrow
_SHOULDERS, _HEAD, _HEAD_RADIUS = 0.28, 0.395, 0.058  # above the hips, shares of body height


@dataclass(frozen=True, eq=False)
class Sticks:
    """Points of the stick figures at K instants, world axes [m].

    Attributes:
        legs: hip, knee, ankle, heel, toe, ankle of the right and the left leg (K, 2, 6, 3).
        trunk: midpoint of the hips and of the shoulders, centre of the head (K, 3, 3).
    """

    legs: np.ndarray
    trunk: np.ndarray

    @classmethod
    def of(cls, gait: Gait, tau: np.ndarray) -> Sticks:
        """The walker at fractions tau (K,) of the stride."""
        skeleton, height = gait.study.walker.skeleton, gait.study.subject.height
        q = gait.motion(tau).q
        poses, points = skeleton.body_poses(q), skeleton.contact_points(q)
        legs = []
        for foot, side in enumerate("rl"):
            ankle = poses[f"foot_{side}"][1]
            heel, toe = points[:, 2 * foot], points[:, 2 * foot + 1]
            chain = [poses[f"thigh_{side}"][1], poses[f"shank_{side}"][1], ankle, heel, toe, ankle]
            legs.append(np.stack(chain, axis=1))
        rotation, origin = poses["hat"]
        up = rotation[:, :, 2] * height
        trunk = np.stack([origin, origin + _SHOULDERS * up, origin + _HEAD * up], axis=1)
        return cls(np.stack(legs, axis=1), trunk)


def stick_figure(all_curves: Sequence[GaitCurves]) -> Figure:
    """The walker at the eight events, along its stride, and its footprints from above.

    Args:
        all_curves: the gait; others are not drawn, a figure on a figure cannot be read.
    """
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    curves = all_curves[0]
    spatial = curves.coordinate("hat_y") is not None
    width, height = 10.8, 9.7 if spatial else 8.3
    figure = Figure(figsize=(width, height), facecolor="white")
    FigureCanvasAgg(figure)
    left = 0.3 / width
    figure.text(left, 1 - 0.16 / height, "Stick figures", fontsize=12, weight="bold", va="top")
    figure.text(
        left, 1 - 0.40 / height, style.subtitle_of(curves), fontsize=8, color="#555555", va="top"
    )
    legend(figure, [curves], None, toe_off=False)

    def panel(x: float, y: float, wide: float, high: float) -> Axes:
        """Axes whose lower left corner and size are given in inches."""
        return figure.add_axes((x / width, y / height, wide / width, high / height))

    draw_events(panel(0.3, height - 3.10, 10.2, 2.25), curves)
    stride = panel(0.3 if spatial else 1.9, 1.75 if spatial else 0.35, 7.0, 4.35)
    _draw_strobe(stride, curves)
    if spatial:
        _draw_from_behind(panel(7.5, 1.75, 3.0, 4.35), curves)
        draw_footprints(panel(0.3, 0.3, 7.0, 1.15), curves, stride.get_xlim())
    return figure


def draw_events(axes: Axes, curves: GaitCurves) -> None:
    """The walker at each event, side by side, with the forces on its feet."""
    gait = curves.gait
    size = gait.study.subject.height / 1.80
    events = np.asarray(gait.values.events)
    sticks = Sticks.of(gait, events)
    rows = np.rint(events * (curves.samples - 1)).astype(int)
    for number, name in enumerate(feet.EVENT_NAMES):
        shift = number * _PITCH * size - sticks.trunk[number, 0, 0]
        _draw_walker(axes, sticks, number, shift)
        _draw_forces(axes, curves, rows[number], shift)
        axes.text(
            number * _PITCH * size, -0.07 * size,
            f"{name}\n{100 * events[number]:.0f} %", ha="center", va="top", fontsize=7.5,
        )  # fmt: skip
    axes.axhline(0.0, color="#8a8a8a", lw=0.8, zorder=0)
    axes.set_title("Events of the stride, with the ground reactions", fontsize=8.5)
    _bare(axes, (-0.55 * size, (7 * _PITCH + 0.55) * size), (-0.12 * size, 1.83 * size))


def _draw_strobe(axes: Axes, curves: GaitCurves) -> None:
    """The walker at equal distances in time along one stride."""
    gait = curves.gait
    size = gait.study.subject.height / 1.80
    tau = np.linspace(0.0, 1.0, NUM_STROBE)
    sticks = Sticks.of(gait, tau)
    for number in range(NUM_STROBE):
        ends = number in (0, NUM_STROBE - 1)
        _draw_walker(axes, sticks, number, 0.0, thin=not ends)
    axes.axhline(0.0, color="#8a8a8a", lw=0.8, zorder=0)
    axes.set_title(
        f"One stride, every {1000 * gait.values.stride_time / (NUM_STROBE - 1):.0f} ms; "
        "position in m", fontsize=8.5,
    )  # fmt: skip
    middle = sticks.trunk[:, 0, 0].mean()
    _bare(axes, (middle - 1.45 * size, middle + 1.45 * size), (-0.02 * size, 1.80 * size))
    axes.set_xticks(np.arange(np.ceil((middle - 1.45 * size) * 2) / 2, middle + 1.45 * size, 0.5))
    axes.tick_params(axis="x", length=2.5, labelsize=7.5)


def _draw_from_behind(axes: Axes, curves: GaitCurves) -> None:
    """The walker in the middle of both single supports, seen from behind."""
    gait = curves.gait
    size = gait.study.subject.height / 1.80
    events = np.append(np.asarray(gait.values.events), 1.0)
    middles = [0.5 * (events[2] + events[4]), 0.5 * (events[6] + events[8])]
    sticks = Sticks.of(gait, np.array(middles))
    for number, side in enumerate(SIDES):
        shift = (number - 0.5) * 0.75 * size
        _draw_walker(axes, sticks, number, shift, across=True)
        axes.text(
            shift, -0.05 * size, f"{side} single support", fontsize=7.5, ha="center", va="top"
        )
    axes.axhline(0.0, color="#8a8a8a", lw=0.8, zorder=0)
    axes.set_title("From behind", fontsize=8.5)
    _bare(axes, (-0.62 * size, 0.62 * size), (-0.02 * size, 1.80 * size))


def _draw_walker(
    axes: Axes, sticks: Sticks, number: int, shift: float, thin: bool = False, across: bool = False
) -> None:
    """One stick figure from its right side, or `across` the walkway from behind."""
    from matplotlib.patches import Circle

    width, alpha = (0.7, 0.55) if thin else (1.8, 1.0)
    view = np.array([[0.0, -1.0, 0.0], [0.0, 0.0, 1.0]]) if across else np.eye(3)[[0, 2]]
    trunk = sticks.trunk[number] @ view.T + [shift, 0.0]
    for leg, side, order in ((1, "left", 2), (0, "right", 4)):
        points = sticks.legs[number, leg] @ view.T + [shift, 0.0]
        axes.plot(
            *points.T, color=style.SIDE_COLOURS[side], lw=width, alpha=alpha, zorder=order,
            solid_joinstyle="round", gid=f"{side} leg",
        )  # fmt: skip
    axes.plot(*trunk[:2].T, color=style.BODY_COLOUR, lw=1.3 * width, alpha=alpha, zorder=3)
    neck = trunk[2] + (trunk[1] - trunk[2]) * _HEAD_RADIUS / (_HEAD - _SHOULDERS)
    axes.plot(*np.stack([trunk[1], neck]).T, color=style.BODY_COLOUR, lw=0.7 * width, alpha=alpha)
    if across:
        hips = sticks.legs[number, :, 0] @ view.T + [shift, 0.0]
        axes.plot(*hips.T, color=style.BODY_COLOUR, lw=width, zorder=3)
    head = np.linalg.norm(sticks.trunk[number, 2] - sticks.trunk[number, 0])
    axes.add_patch(
        Circle(
            tuple(trunk[2]), head * _HEAD_RADIUS / _HEAD, fill=not thin, facecolor="white",
            edgecolor=style.BODY_COLOUR, lw=0.7 * width, alpha=alpha, zorder=3,
        )
    )  # fmt: skip


def _draw_forces(axes: Axes, curves: GaitCurves, row: int, shift: float) -> None:
    """Arrows of the ground reactions at the centres of pressure of the loaded feet."""
    size = curves.gait.study.subject.height / 1.80
    for side in SIDES:
        foot = curves.data.isel(time=row).sel(foot=side, axis=["x", "z"])
        start = foot.centre_of_pressure.values + [shift, 0.0]
        force = foot.ground_reaction_force.values / curves.body_weight
        if force[1] < _LEAST_LOAD or not np.isfinite(start).all():
            continue
        axes.annotate(
            "", xy=tuple(start + _FORCE_SCALE * size * force), xytext=tuple(start), zorder=5,
            arrowprops={"arrowstyle": "-|>", "color": "#2f8f4e", "lw": 1.2, "shrinkA": 0,
                        "shrinkB": 0, "mutation_scale": 7},
        )  # fmt: skip


def _bare(axes: Axes, x: tuple[float, float], y: tuple[float, float]) -> None:
    axes.set_aspect("equal", adjustable="box", anchor="S")
    axes.set_xlim(*x)
    axes.set_ylim(*y)
    axes.set_xticks([])
    axes.set_yticks([])
    for spine in axes.spines.values():
        spine.set_visible(False)
