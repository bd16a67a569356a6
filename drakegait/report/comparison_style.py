"""The look of the figures in a comparison: a colour and a dash for each gait, SVG for the page."""

from __future__ import annotations

import io
import re
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

# Of M. Okabe and K. Ito, "Color universal design" (2008): told apart by all kinds of colour vision.
GAIT_COLOURS = ("#222222", "#d55e00", "#009e73", "#0072b2", "#cc79a7", "#b58900")
GAIT_DASHES = ("-", (0, (5, 1.6)), (0, (1.4, 1.2)), (0, (6, 1.5, 1.5, 1.5)), "-", (0, (3, 1)))
BAND_COLOUR = "#d9d9d9"
LINE_COLOUR = "#b5b5b5"
WIDTH = 7.4
"""Width of all figures [inch]: that of the text on a sheet of A4."""
_LETTERS, _HANDLE = 108, 8  # letters in a row of a legend, and as many as a handle is wide
_LOOK = {
    "font.family": "sans-serif",
    "font.sans-serif": ["Arial", "Liberation Sans", "Helvetica", "DejaVu Sans"],
    "font.size": 7.5,
    "svg.fonttype": "none",
    "axes.titlesize": 8.0,
    "xtick.labelsize": 7.0,
    "ytick.labelsize": 7.0,
}


def look():
    """The settings of these figures; those of the program are back afterwards."""
    from contextlib import ExitStack

    from matplotlib import rc_context

    from drakegait.report import style

    stack = ExitStack()
    stack.enter_context(style.look())
    stack.enter_context(rc_context(_LOOK))
    return stack


def new_figure(
    rows: int, columns: int, panel_height: float, *, left: float = 0.52, top: float = 0.42,
    bottom: float = 0.36, gap: float = 0.36, between: float = 0.4, **options,
) -> tuple[Figure, np.ndarray]:  # fmt: skip
    """A figure of `WIDTH` with a grid of panels; margins, gaps and heights in inches."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    height = top + bottom + rows * panel_height + (rows - 1) * gap
    panel = (WIDTH - left - 0.1 - (columns - 1) * between) / columns
    figure = Figure(figsize=(WIDTH, height), facecolor="white")
    FigureCanvasAgg(figure)
    axes = figure.subplots(
        rows, columns, squeeze=False,
        gridspec_kw={
            "left": left / WIDTH, "right": 1 - 0.1 / WIDTH, "bottom": bottom / height,
            "top": 1 - top / height, "wspace": between / panel, "hspace": gap / panel_height,
        }, **options,
    )  # fmt: skip
    return figure, axes


def draw(axes: Axes, number: int, percent: np.ndarray, values: np.ndarray, thin: bool = False):
    """A curve of gait `number`."""
    axes.plot(
        percent, values, color=GAIT_COLOURS[number], ls=GAIT_DASHES[number],
        lw=0.9 if thin else 1.4, zorder=5 - 0.1 * number, gid=f"gait {number + 1}",
    )  # fmt: skip


def line_legend(figure: Figure, labels: Sequence[str], extra: Sequence = ()) -> None:
    """The gaits' lines on top of a figure, then what else is drawn."""
    from matplotlib.lines import Line2D

    handles = [
        Line2D([], [], color=GAIT_COLOURS[number], ls=GAIT_DASHES[number], lw=1.6, label=label)
        for number, label in enumerate(labels)
    ]
    _legend(figure, [*handles, *extra])


def bar_legend(figure: Figure, labels: Sequence[str], extra: Sequence = ()) -> None:
    """The gaits' colours on top of a figure."""
    from matplotlib.patches import Patch

    handles = [
        Patch(color=GAIT_COLOURS[number], label=label) for number, label in enumerate(labels)
    ]
    _legend(figure, [*handles, *extra])


def _legend(figure: Figure, handles: list) -> None:
    rows = legend_rows([handle.get_label() for handle in handles])
    columns = -(-len(handles) // rows)
    figure.legend(
        handles=handles, loc="upper left", bbox_to_anchor=(0.0, 1.0), ncols=columns,
        fontsize=7.5, frameon=False, handlelength=2.6, columnspacing=1.4, borderaxespad=0.1,
    )  # fmt: skip


def legend_rows(texts: Sequence[str]) -> int:
    """Rows that a legend of these texts needs, with room for the wider letters of some browsers."""
    return -(-sum(len(text) + _HANDLE for text in texts) // _LETTERS)


def legend_height(labels: Sequence[str], more: Sequence[str] = ()) -> float:
    """Margin above the panels for the legend and their titles [inch]."""
    return 0.24 + 0.17 * legend_rows([*labels, *more])


def toe_off_handle():
    """The legend's entry for the lines at toe off."""
    from matplotlib.lines import Line2D

    return Line2D([], [], color="#666666", lw=0.7, ls=(0, (2, 2)), label="toe off")


def as_svg(figure: Figure, description: str) -> str:
    """A figure as an SVG element that fills the width of its place in a page.

    Identifiers are left out unless something refers to them: a page has many figures.
    """
    buffer = io.StringIO()
    figure.savefig(buffer, format="svg", metadata={"Date": None})
    text = buffer.getvalue()
    text = text[text.index("<svg") :]
    text = re.sub(r"<metadata>.*?</metadata>", "", text, flags=re.S)
    used = set(re.findall(r"#([\w-]+)", text))
    text = re.sub(r' id="([^"]*)"', lambda m: m[0] if m[1] in used else "", text)
    # Three decimals of a point are enough for paper.
    text = re.sub(r"(\d\.\d{3})\d+", r"\1", text)
    width, height = figure.get_size_inches()
    opening = (
        f'<svg xmlns="http://www.w3.org/2000/svg" xmlns:xlink="http://www.w3.org/1999/xlink" '
        f'viewBox="0 0 {72 * width:g} {72 * height:g}" role="img" aria-label="{description}">'
    )
    return opening + text[text.index(">") + 1 :]
