"""Tornado plots: which numbers of a study its optimum hangs on most, by first-order answers."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from drakegait.errors import BadFile
from drakegait.report import style

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from drakegait.sensitivities import Sensitivities, Sensitivity

MORE_COLOUR, LESS_COLOUR = "#c8742b", "#4b8a8c"
"""Ends of the bars where the parameter is larger and where it is smaller."""
_ROW, _PANEL, _LABELS = 0.235, 2.7, 3.05  # height of a bar's row, width of panel and labels [inch]
_TOP, _BOTTOM, _RIGHT = 1.0, 0.5, 0.25  # [inch]


def plot_tornado(answers: Sensitivities, folder: str | Path, count: int = 15) -> list[Path]:
    """Write `sensitivities.svg` and `.png`; returns the paths.

    Raises:
        BadFile: the folder cannot be written.
    """
    folder = Path(folder)
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise BadFile(folder, f"cannot be made ({error.strerror or error}).") from None
    with style.look():
        return style.save(tornado(answers, count), folder, "sensitivities")


def tornado(answers: Sensitivities, count: int = 15) -> Figure:
    """The `count` largest answers of the cost f and of the cost of transport, as a figure."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    panels: list[tuple[str, Callable[[Sensitivity], float], float]] = [
        ("change of the cost f [-]", lambda entry: entry.cost_change, answers.cost),
        ("change of the cost of transport [J/m]", lambda entry: entry.energy_change,
         answers.energy),
    ]  # fmt: skip
    known = [panel for panel in panels if all(np.isfinite(panel[1](e)) for e in answers.entries)]
    rows = min(count, len(answers.entries))
    width = len(known) * (_LABELS + _PANEL + _RIGHT)
    height = _TOP + _BOTTOM + rows * _ROW
    figure = Figure(figsize=(width, height), facecolor="white")
    FigureCanvasAgg(figure)
    for number, (label, change, total) in enumerate(known):
        left = number * (_LABELS + _PANEL + _RIGHT) + _LABELS
        axes = figure.add_axes(
            (left / width, _BOTTOM / height, _PANEL / width, rows * _ROW / height)
        )
        largest = sorted(answers.entries, key=lambda entry: -abs(change(entry)))[:count]
        _bars(axes, largest, change)
        axes.set_xlabel(label, fontsize=8)
        axes.set_title(f"{label.removeprefix('change of the ')}: {total:.4g}", fontsize=8.5, pad=20)
        _percent(axes, total)
    figure.text(
        0.15 / width, 1 - 0.14 / height, "What the optimum hangs on", fontsize=12, weight="bold",
        va="top",
    )  # fmt: skip
    figure.text(
        0.15 / width, 1 - 0.37 / height, answers.title, fontsize=8, color="#555555", va="top"
    )
    _legend(figure, width, height)
    return figure


def _bars(axes: Axes, entries: list[Sensitivity], change: Callable[[Sensitivity], float]) -> None:
    places = np.arange(len(entries))[::-1]
    sizes = np.array([change(entry) for entry in entries])
    for sign, colour in ((1.0, MORE_COLOUR), (-1.0, LESS_COLOUR)):
        axes.barh(places, sign * sizes, height=0.72, color=colour, lw=0)
    axes.axvline(0.0, color="#444444", lw=0.6)
    axes.set_ylim(-0.6, len(entries) - 0.4)
    axes.set_yticks(places, [_label(entry) for entry in entries], fontsize=7.5)
    axes.tick_params(axis="y", length=0)
    axes.spines["left"].set_visible(False)
    reach = 1.08 * float(np.abs(sizes).max(initial=0.0)) or 1.0
    axes.set_xlim(-reach, reach)
    axes.grid(axis="x", color="#e3e3e3", lw=0.5)
    axes.set_axisbelow(True)


def _percent(axes: Axes, total: float) -> None:
    """A second axis above, relative to the whole."""
    if total <= 0.0:
        return
    above = axes.secondary_xaxis(
        "top", functions=(lambda x: 100.0 * x / total, lambda x: x * total / 100.0)
    )
    above.xaxis.get_major_locator().set_params(nbins=4)
    above.tick_params(labelsize=6.5, colors="#777777", length=2)
    above.xaxis.set_major_formatter(lambda value, _: f"{value:+g} %" if value else "0")
    above.spines["top"].set_visible(False)


def _label(entry: Sensitivity) -> str:
    unit = "" if entry.unit in ("-", "") else f" {entry.unit}"
    value = f"{entry.value:.0f}" if abs(entry.value) >= 1000.0 else f"{entry.value:.3g}"
    step = f"{entry.step:.0f}" if abs(entry.step) >= 100.0 else f"{entry.step:.2g}"
    return f"{entry.parameter}: {value} \u00b1 {step}{unit}"


def _legend(figure: Figure, width: float, height: float) -> None:
    from matplotlib.patches import Patch

    handles = [
        Patch(color=MORE_COLOUR, label="parameter larger by its step"),
        Patch(color=LESS_COLOUR, label="smaller"),
    ]
    figure.legend(
        handles=handles, loc="upper right", bbox_to_anchor=(1 - 0.1 / width, 1 - 0.06 / height),
        ncols=2, fontsize=7.5, frameon=False, handlelength=1.0, columnspacing=1.2,
    )  # fmt: skip
