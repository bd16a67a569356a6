"""Stick figures of a comparison: a row for each gait, at the events of its stride."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from drakegait.report import comparison_style as look
from drakegait.report.curves import GaitCurves
from drakegait.report.footprints import draw_footprints
from drakegait.report.stick_figure import draw_events

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_EVENTS, _NAMES, _PRINTS = 1.7, 0.25, 0.95  # heights [inch]


def sticks_figure(all_curves: Sequence[GaitCurves]) -> Figure:
    """The walkers at the eight events, with the ground reactions, and their footprints."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    spatial = all_curves[0].coordinate("hat_y") is not None
    block = 0.2 + _EVENTS + _NAMES + (_PRINTS if spatial else 0.0) + 0.1
    width, height = look.WIDTH, block * len(all_curves)
    figure = Figure(figsize=(width, height), facecolor="white")
    FigureCanvasAgg(figure)
    for number, curves in enumerate(all_curves):
        top = height - number * block
        figure.text(
            0.0, (top - 0.02) / height, curves.label, fontsize=9, weight="bold", va="top",
            color=look.GAIT_COLOURS[number],
        )  # fmt: skip
        low = top - 0.2 - _EVENTS
        events = figure.add_axes((0.0, low / height, 1.0, _EVENTS / height))
        draw_events(events, curves)
        events.set_title("")
        for text in events.texts:
            text.set_fontsize(6.8)
        if spatial:
            low -= _NAMES + _PRINTS
            prints = figure.add_axes((0.0, low / height, 1.0, (_PRINTS - 0.25) / height))
            middle = 0.5 * curves.gait.stride_length
            draw_footprints(prints, curves, (middle - 1.9, middle + 1.9))
            prints.title.set_fontsize(7.0)
    return figure
