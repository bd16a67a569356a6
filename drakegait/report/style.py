"""One look for all figures: colours of the sides, phases behind the curves, files.

Figures are made through Matplotlib's object-oriented interface, so nothing is changed in a
program that draws figures of its own.
"""

from __future__ import annotations

import textwrap
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from drakegait.report.curves import GaitCurves
from drakegait.report.study_words import who
from drakegait.whole_file import beside

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

SIDE_COLOURS = {"right": "#1b62a5", "left": "#c0311f"}
"""Blue for the right side, red for the left, in figures and replay."""
BODY_COLOUR = "#333333"
REFERENCE_COLOUR = "#c3c3c3"
# Loading, foot flat in double support, single support, heel rise; the same for the other foot.
PHASE_COLOURS = 2 * ("#dde4ec", "#e8edf2", "#f6f8fa", "#eff3f6")
OTHER_STYLES = ("--", ":", "-.", (0, (1, 2)))
FORMATS = ("svg", "png")
PNG_DPI = 130  # widths of texts change with it
_CHARACTERS = 16.0  # of a subtitle, per inch
_LONGEST_SUBTITLE = 110  # characters of who walks
_LOOK = {
    "font.size": 8,
    "font.family": "sans-serif",
    "svg.fonttype": "none",
    "svg.hashsalt": "drakegait",
    "axes.titlesize": 8.5,
    "axes.titlelocation": "left",
    "axes.titlepad": 4.0,
    "axes.linewidth": 0.6,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "xtick.major.width": 0.6,
    "ytick.major.width": 0.6,
    "xtick.major.size": 2.5,
    "ytick.major.size": 2.5,
    "lines.solid_capstyle": "round",
}


@contextmanager
def look() -> Iterator[None]:
    """The settings of all figures; those of the program are back afterwards."""
    from matplotlib import rc_context

    with rc_context(_LOOK):
        yield


def panel_figure(
    rows: int, columns: int, title: str, subtitle: str, panel: tuple[float, float] = (3.0, 1.75)
) -> tuple[Figure, np.ndarray]:
    """A figure with a grid of panels of one size [inch], and its axes (rows, columns)."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    left, right, top, bottom, gap_x, gap_y = 0.5, 0.15, 0.95, 0.42, 0.42, 0.42
    width = left + right + columns * panel[0] + (columns - 1) * gap_x
    longest = round(_CHARACTERS * width)
    subtitle = "\n".join(textwrap.fill(line, longest) for line in subtitle.splitlines())
    height = top + bottom + rows * panel[1] + (rows - 1) * gap_y
    figure = Figure(figsize=(width, height), dpi=PNG_DPI, facecolor="white")
    FigureCanvasAgg(figure)
    axes = figure.subplots(
        rows, columns, squeeze=False,
        gridspec_kw={
            "left": left / width, "right": 1 - right / width,
            "bottom": bottom / height, "top": 1 - top / height,
            "wspace": gap_x / panel[0], "hspace": gap_y / panel[1],
        },
    )  # fmt: skip
    figure.text(left / width, 1 - 0.16 / height, title, fontsize=12, weight="bold", va="top")
    figure.text(left / width, 1 - 0.40 / height, subtitle, fontsize=8, color="#555555", va="top")
    return figure, axes


def subtitle_of(curves: GaitCurves) -> str:
    """Who walks, in a line."""
    gait = curves.gait
    cadence = 120.0 / float(gait.values.stride_time)
    state = "" if gait.converged else "   NOT CONVERGED"
    return (
        f"{who(gait.study, _LONGEST_SUBTITLE)}; "
        f"{gait.speed:.2f} m/s, {cadence:.0f} steps/min, stride {gait.stride_length:.2f} m{state}"
    )


def cycle_axes(axes: Axes, curves: GaitCurves, numbers: bool = False, label: bool = False) -> None:
    """Prepare a panel over the gait cycle: phases behind, stance and swing marked.

    Args:
        numbers: write the numbers of the phases above the panel.
        label: write the label of the horizontal axis.
    """
    edges = curves.phase_edges("right")
    spans = list(zip(edges[:-1], np.diff(edges), strict=True))
    place = axes.get_xaxis_transform()
    axes.broken_barh(
        spans, (0.0, 1.0), facecolors=PHASE_COLOURS, lw=0, zorder=-3, transform=place, gid="phases"
    )
    for side, colour in SIDE_COLOURS.items():
        axes.axvline(curves.toe_off(side), color=colour, lw=0.7, ls=(0, (4, 2)), zorder=-1)
    axes.set_xlim(0.0, 100.0)
    axes.set_xticks(range(0, 101, 20))
    if numbers:
        _phase_numbers(axes, edges)
    if label:
        axes.set_xlabel("% of the gait cycle of each leg", fontsize=7.5, labelpad=2)


def _phase_numbers(axes: Axes, edges: np.ndarray) -> None:
    place = axes.get_xaxis_transform()
    for number, centre in enumerate(0.5 * (edges[:-1] + edges[1:])):
        axes.text(
            centre, 0.985, str(number + 1), fontsize=5.5, color="#7a8796", ha="center", va="top",
            transform=place,
        )  # fmt: skip


def zero_line(axes: Axes) -> None:
    """A thin line at zero, if zero is in view."""
    low, high = axes.get_ylim()
    if low < 0.0 < high:
        axes.axhline(0.0, color="#8a8a8a", lw=0.5, zorder=0)


def draw_reference(axes: Axes, percent: np.ndarray, values: np.ndarray) -> None:
    """The measured walk: a soft band behind the simulated curves."""
    axes.plot(percent, values, color=REFERENCE_COLOUR, lw=4.0, alpha=0.75, zorder=1)


def draw_gait(
    axes: Axes, number: int, colour: str, percent: np.ndarray, values: np.ndarray
) -> None:
    """A curve of gait `number`: 0 is the gait itself, the others are compared with it."""
    if number == 0:
        axes.plot(percent, values, color=colour, lw=1.4, zorder=4)
    else:
        style = OTHER_STYLES[(number - 1) % len(OTHER_STYLES)]
        axes.plot(percent, values, color=colour, lw=1.0, ls=style, alpha=0.85, zorder=3)


def save(figure: Figure, folder: Path, name: str) -> list[Path]:
    """Write a figure in all formats, each beside its place and then renamed.

    Raises:
        BadFile: the folder cannot be written.
    """
    paths = []
    for kind in FORMATS:
        path = folder / f"{name}.{kind}"
        with beside(path) as part:
            if kind == "png":
                compressed = {"compress_level": 3}
                figure.savefig(part, format=kind, dpi=PNG_DPI, pil_kwargs=compressed)
            else:
                figure.savefig(part, format=kind, metadata={"Date": None})
        paths.append(path)
    return paths
