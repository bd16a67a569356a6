"""Figures of the page as SVG, drawn from numbers alone."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

from drakegait.fidelity.bursts import Bursts
from drakegait.fidelity.published import Range
from drakegait.paper.numbers import Missing, Numbers
from drakegait.report import comparison_style as look
from drakegait.report.measures import MINUS
from drakegait.report.style import SIDE_COLOURS

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from drakegait.fidelity.anchor import Anchor

_BAND, _PUBLISHED, _OURS = "#d3d7dc", "#8d949c", "#d55e00"
_ROW = 0.19  # [inch]
_FAR = 1.2  # widths of a range beyond its middle that are drawn; what is farther sits at the edge


def ranges(anchors: Sequence[Anchor], numbers: Numbers) -> str:
    """Each number against its range, all ranges drawn from -0.5 to 0.5."""
    shown = [anchor for anchor in anchors if all(key in numbers.found for key in anchor.keys)]
    if not shown:
        raise Missing("No number of the default walk is known.")
    half = -(-len(shown) // 2)
    with look.look():
        figure, grid = look.new_figure(
            1, 2, _ROW * half + 0.1, left=2.0, between=2.25, top=0.22, bottom=0.3
        )
        for axes, part in zip(grid[0], (shown[:half], shown[half:]), strict=True):
            axes.axvspan(-0.5, 0.5, color=_BAND, lw=0)
            for row, anchor in enumerate(part):
                for key, colour in zip(anchor.keys, SIDE_COLOURS.values(), strict=False):
                    _mark(axes, row, _relative(anchor.range, numbers[key]), colour)
            axes.set_yticks(range(len(part)), [anchor.quantity for anchor in part])
            axes.set_ylim(half - 0.4, -0.6)
            axes.set_xlim(-_FAR - 0.12, _FAR + 0.12)
            axes.set_xticks([-0.5, 0.5], ["lowest", "highest"])
            axes.tick_params(axis="y", length=0)
            axes.spines["left"].set_visible(False)
        return look.as_svg(figure, "numbers of the default walk against published ranges")


def _relative(published: Range, value: float) -> float:
    width = published.high - published.low
    return (value - 0.5 * (published.low + published.high)) / width


def _mark(axes: Axes, row: int, place: float, colour: str) -> None:
    """A point, or an arrow at the edge for what is farther out."""
    if abs(place) <= _FAR:
        axes.plot([place], [row], marker="o", ms=4.0, color=colour, alpha=0.85, lw=0)
    else:
        edge, marker = (_FAR, ">") if place > 0.0 else (-_FAR, "<")
        axes.plot([edge], [row], marker=marker, ms=5.5, color=colour, alpha=0.85, lw=0)


def timing(
    ours: Mapping[str, Mapping[str, Bursts]], published: Mapping[str, Bursts]
) -> str:  # fmt: skip
    """Bars for each muscle: published above right above left."""
    with look.look():
        figure, grid = look.new_figure(
            1, 1, 2.3 * _ROW * len(ours), left=1.75, top=0.12, bottom=0.42
        )
        axes = grid[0][0]
        for row, (group, sides) in enumerate(ours.items()):
            _bars(axes, row - 0.27, published[group], _PUBLISHED)
            for number, (side, times) in enumerate(sides.items()):
                _bars(axes, row + 0.27 * number, times, SIDE_COLOURS[side])
        axes.set_yticks(range(len(ours)), [group.replace("_", " ") for group in ours])
        axes.set_ylim(len(ours) - 0.5, -0.5)
        axes.set_xlim(0.0, 100.0)
        axes.set_xlabel("% of the leg's own cycle", labelpad=2)
        axes.tick_params(axis="y", length=0)
        axes.grid(axis="x", color="#e3e6ea", lw=0.5)
        axes.set_axisbelow(True)
        return look.as_svg(figure, "on and off times of muscles, published and ours")


def _bars(axes: Axes, y: float, times: Bursts, colour: str) -> None:
    for begin, end in times:
        axes.barh(y, end - begin, left=begin, height=0.22, color=colour, lw=0)


def costs(values: Mapping[str, tuple[float, float]], net: Range, gross: Range) -> str:
    """Net and gross cost of each walk as two panels of bars, over the published ranges."""
    with look.look():
        figure, grid = look.new_figure(
            1, 2, 1.3 * _ROW * len(values) + 0.25, left=1.95, sharey=True, top=0.3, bottom=0.42
        )
        panels = (("net [J/(kg m)]", net), ("gross [J/(kg m)]", gross))
        for place, (axes, (title, published)) in enumerate(zip(grid[0], panels, strict=True)):
            axes.axvspan(published.low, published.high, color=_BAND, lw=0)
            shown = [pair[place] for pair in values.values()]
            axes.barh(range(len(shown)), shown, height=0.5, color=_OURS, alpha=0.85)
            for row, value in enumerate(shown):
                axes.text(value + 0.1, row, f"{value:.1f}", va="center", fontsize=7)
            axes.set_xlim(0.0, 1.15 * max(*shown, published.high))
            axes.set_title(title)
        grid[0][0].set_yticks(range(len(values)), list(values))
        grid[0][0].invert_yaxis()
        return look.as_svg(figure, "cost of walking against published ranges")


def pairs(values: Mapping[str, tuple[float, float]], allowed: float) -> str:
    """Published and our change for each load [%], with the allowed distance."""
    with look.look():
        figure, grid = look.new_figure(
            1, 1, 1.7 * _ROW * len(values) + 0.1, left=1.0, top=0.34, bottom=0.42
        )
        axes = grid[0][0]
        for row, (published, ours) in enumerate(values.values()):
            axes.barh(row - 0.19, published, height=0.34, color=_PUBLISHED,
                      xerr=allowed, error_kw={"lw": 0.8, "ecolor": "#333333"})  # fmt: skip
            axes.barh(row + 0.19, ours, height=0.34, color=_OURS)
            axes.text(max(ours, 0.0) + 0.8, row + 0.21, f"{ours:+.0f} %".replace("-", MINUS),
                      va="center", fontsize=7)  # fmt: skip
        axes.axvline(0.0, color="#8a8a8a", lw=0.6)
        axes.set_yticks(range(len(values)), list(values))
        axes.set_ylim(len(values) - 0.45, -0.55)
        axes.set_xlabel("change against no load [%]", labelpad=2)
        _pair_legend(figure, allowed)
        return look.as_svg(figure, "change of energy by worn masses, published and ours")


def _pair_legend(figure, allowed: float) -> None:
    from matplotlib.patches import Patch

    labels = {f"Browning et al. 2007, \N{PLUS-MINUS SIGN}{allowed:g} points": _PUBLISHED,
              "ours": _OURS}  # fmt: skip
    figure.legend(
        handles=[Patch(color=colour, label=label) for label, colour in labels.items()],
        loc="upper left", bbox_to_anchor=(0.0, 1.0), ncols=2, frameon=False, fontsize=7.5,
    )  # fmt: skip
