"""One legend for a whole figure: beside its title, or where it does not fit, in rows below it."""

from __future__ import annotations

import textwrap
from collections.abc import Sequence
from typing import TYPE_CHECKING

from drakegait.report.curves import GaitCurves
from drakegait.report.style import BODY_COLOUR, OTHER_STYLES, REFERENCE_COLOUR, SIDE_COLOURS

if TYPE_CHECKING:
    from matplotlib.figure import Figure
    from matplotlib.legend import Legend
    from matplotlib.lines import Line2D

_MARGIN = 0.1  # [inch] to the right end of the figure
_LONGEST = 105  # characters of a name: a row of the narrowest figure
_LINE = 0.14  # [inch] of a further line of the subtitle
_NOTE = "shaded: contact phases 1 to 8 of the right leg; each leg from its own heel strike"


def legend(
    figure: Figure, all_curves: Sequence[GaitCurves], reference: str | None,
    body: bool = False, toe_off: bool = True,
) -> None:  # fmt: skip
    """Add the legend to a figure that has its title, its subtitle and its panels.

    Args:
        all_curves: the gaits, which are named if there are several.
        reference: what the reference is called; None if it is not drawn.
        body: whether curves of the trunk are drawn.
        toe_off: whether phases and toe off are drawn.
    """
    fixed, gaits = _handles(all_curves, reference, body, toe_off)
    width, height = figure.get_size_inches()
    beside = (1 - _MARGIN / width, 1 - 0.08 / height)
    found = _drawn(figure, [*fixed, *gaits], "upper right", beside, len(fixed) + len(gaits))
    below = _LINE * figure.texts[-1].get_text().count("\n")  # of the subtitle
    if not _is_free(figure, found):
        found.remove()
        for handles in (fixed, gaits):
            below += _below_subtitle(figure, handles, 0.56 + below) if handles else 0.0
    if below > 0.0:
        _make_room(figure, below)
    width, height = figure.get_size_inches()
    if toe_off:
        figure.text(
            1 - 0.15 / width, 1 - (0.62 + below) / height, _NOTE, fontsize=7, color="#7a8796",
            ha="right", va="top",
        )  # fmt: skip


def _handles(
    all_curves: Sequence[GaitCurves], reference: str | None, body: bool, toe_off: bool
) -> tuple[list[Line2D], list[Line2D]]:
    """What all figures have, and the gaits if there are several."""
    from matplotlib.lines import Line2D

    def line(label: str, **looks: object) -> Line2D:
        return Line2D([], [], label=label, **looks)

    found = [line(f"{side} leg", color=colour, lw=1.8) for side, colour in SIDE_COLOURS.items()]
    if body:
        found.append(line("trunk", color=BODY_COLOUR, lw=1.8))
    if reference:
        found.append(line(reference, color=REFERENCE_COLOUR, lw=4.0))
    if toe_off:
        found.append(line("toe off", color="#777777", lw=0.7, ls=(0, (4, 2))))
    gaits = [
        line(
            textwrap.shorten(curves.label, _LONGEST, placeholder=" ..."), color=BODY_COLOUR, lw=1.2,
            ls="-" if k == 0 else OTHER_STYLES[(k - 1) % len(OTHER_STYLES)],
        )
        for k, curves in enumerate(all_curves if len(all_curves) > 1 else ())
    ]  # fmt: skip
    return found, gaits


def _drawn(
    figure: Figure, handles: list[Line2D], corner: str, place: tuple[float, float], columns: int
) -> Legend:
    return figure.legend(
        handles=handles, loc=corner, bbox_to_anchor=place, ncols=columns, fontsize=7.5,
        frameon=False, handlelength=1.8, columnspacing=1.2, borderaxespad=0.0,
    )  # fmt: skip


def _is_free(figure: Figure, found: Legend) -> bool:
    """Whether nothing else is written where the legend is."""
    place = found.get_window_extent()
    return place.x0 >= 0.0 and not any(
        text.get_window_extent().overlaps(place) for text in figure.texts
    )


def _below_subtitle(figure: Figure, handles: list[Line2D], top: float) -> float:
    """Draw it in as few rows as fit, `top` inches below the upper end; its height [inch]."""
    width, height = figure.get_size_inches()
    left = figure.texts[0].get_position()[0]
    for columns in range(len(handles), 0, -1):
        found = _drawn(figure, handles, "upper left", (left, 1 - top / height), columns)
        place = found.get_window_extent()
        if columns == 1 or place.x1 <= figure.bbox.x1 - _MARGIN * figure.dpi:
            break
        found.remove()
    return float(place.height / figure.dpi) + 0.02


def _make_room(figure: Figure, more: float) -> None:
    """Make the header `more` inches higher: panels keep their size, texts their place in it."""
    width, height = figure.get_size_inches()
    higher = height + more
    boxes = [axes.get_position() for axes in figure.axes]
    figure.set_size_inches(width, higher)
    for axes, box in zip(figure.axes, boxes, strict=True):
        low, high = box.y0 * height / higher, box.y1 * height / higher
        axes.set_position((box.x0, low, box.width, high - low))
    for text in figure.texts:
        x, y = text.get_position()
        text.set_position((x, 1.0 - (1.0 - y) * height / higher))
    for found in figure.legends:
        anchor = found.get_bbox_to_anchor().transformed(figure.transFigure.inverted())
        y = 1.0 - (1.0 - anchor.y0) * height / higher
        found.set_bbox_to_anchor((anchor.x0, y), transform=figure.transFigure)
