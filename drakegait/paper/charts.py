"""Figures of the page, as SVG."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from drakegait.gait import Gait
from drakegait.report import comparison_curves as quantities
from drakegait.report import comparison_style as look
from drakegait.report.comparison_figures import cycle_figure, excitation_figure, trunk_figure
from drakegait.report.curves import GaitCurves
from drakegait.report.stick_figure import stick_figure

_HEIGHT = 2.1  # of a panel [inch]


@dataclass(frozen=True)
class Panel:
    """One panel of `lines`.

    Attributes:
        title: with its unit.
        x: label of the horizontal axis.
        curves: label -> (x, y).
        marks: text -> (x, y) of points to be pointed out.
    """

    title: str
    x: str
    curves: Mapping[str, tuple[Sequence[float], Sequence[float]]]
    marks: Mapping[str, tuple[float, float]] = field(default_factory=dict)


def lines(panels: Sequence[Panel], description: str) -> str:
    """Curves with their points, one panel beside the other."""
    with look.look():
        labels = list(dict.fromkeys(label for panel in panels for label in panel.curves))
        figure, grid = look.new_figure(
            1, len(panels), _HEIGHT, top=look.legend_height(labels), bottom=0.45
        )
        for axes, panel in zip(grid[0], panels, strict=True):
            for label, (x, y) in panel.curves.items():
                number = labels.index(label)
                axes.plot(x, y, marker="o", ms=3.0, lw=1.2, color=look.GAIT_COLOURS[number],
                          ls=look.GAIT_DASHES[number])  # fmt: skip
            for text, (x, y) in panel.marks.items():
                axes.plot([x], [y], marker="o", ms=9.0, mfc="none", mec="#c0311f")
                axes.annotate(text, (x, y), xytext=(8, 8), textcoords="offset points", fontsize=7)
            axes.set_title(panel.title)
            axes.set_xlabel(panel.x, labelpad=2)
        look.line_legend(figure, labels)
        return look.as_svg(figure, description)


def bars(values: Mapping[str, tuple[float, float]], labels: tuple[str, str], title: str) -> str:
    """Two horizontal bars for each name, side by side in two panels."""
    with look.look():
        names = list(values)
        figure, grid = look.new_figure(1, 2, 0.17 * len(names) + 0.2, left=1.9, sharey=True)
        for place, (axes, label) in enumerate(zip(grid[0], labels, strict=True)):
            shown = [values[name][place] for name in names]
            colours = ["#d55e00" if value > 0.0 else "#0072b2" for value in shown]
            axes.barh(range(len(names)), shown, color=colours, height=0.7)
            axes.axvline(0.0, color="#8a8a8a", lw=0.6)
            axes.set_title(label)
        grid[0][0].set_yticks(range(len(names)), names)
        grid[0][0].invert_yaxis()
        return look.as_svg(figure, title)


def sticks(gait: Gait) -> str:
    """The walker along its stride."""
    with look.look():
        return look.as_svg(stick_figure([GaitCurves(gait)]), "stick figure")


def joint_angles(gaits: Mapping[str, Gait]) -> str:
    """Hip, knee and ankle of both legs, each over its own cycle, with the reference band."""
    return _drawn(gaits, lambda all_curves: cycle_figure(quantities.SAGITTAL_ANGLES, all_curves))


def other_angles(gaits: Mapping[str, Gait]) -> str:
    """Hip adduction and rotation, spatial walkers only."""
    return _drawn(gaits, lambda all_curves: cycle_figure(quantities.OTHER_ANGLES, all_curves))


def trunk(gaits: Mapping[str, Gait]) -> str:
    """Angles of the trunk."""
    return _drawn(gaits, trunk_figure)


def ground_reactions(gaits: Mapping[str, Gait]) -> str:
    """Forces on both feet."""

    def draw(all_curves: Sequence[GaitCurves]):
        planar = all_curves[0].gait.study.skeleton_kind == "planar"
        items = [item for item in quantities.FORCES if not (planar and "medial" in item.name)]
        there = [item for item in items if item.values(all_curves[0], "right") is not None]
        return cycle_figure(there, all_curves)

    return _drawn(gaits, draw)


def excitations(gaits: Mapping[str, Gait]) -> str:
    """All muscle groups of both legs."""
    return _drawn(gaits, excitation_figure)


def _drawn(gaits: Mapping[str, Gait], draw) -> str:
    with look.look():
        figure = draw([GaitCurves(gait, name) for name, gait in gaits.items()])
        return look.as_svg(figure, ", ".join(gaits))
