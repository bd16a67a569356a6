"""The page of a comparison: figures, tables and sentences in the template `compare.html`."""

from __future__ import annotations

import datetime
import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from drakegait.report import comparison_curves as curves_of
from drakegait.report import comparison_style as look
from drakegait.report.comparison_bars import cost_figure
from drakegait.report.comparison_figures import cycle_figure, excitation_figure, trunk_figure
from drakegait.report.comparison_sticks import sticks_figure
from drakegait.report.comparison_tables import Row
from drakegait.report.comparison_words import allowed, headline, troubles
from drakegait.report.curves import GaitCurves
from drakegait.report.measures import NONE, number_text
from drakegait.report.study_words import differences, who

if TYPE_CHECKING:
    from drakegait.report.compare import Comparison

TEMPLATE = "compare.html"


@dataclass(frozen=True)
class TableRow:
    """A row as it is shown: texts; `first` of a pair carries the label for both sides."""

    label: str
    unit: str
    side: str
    values: tuple[str, ...]
    changes: tuple[str, ...]
    span: int


def render(comparison: Comparison) -> str:
    """The page of a comparison, as HTML."""
    import jinja2
    from markupsafe import Markup

    import drakegait

    environment = jinja2.Environment(
        loader=jinja2.PackageLoader("drakegait.report"), autoescape=True,
        undefined=jinja2.StrictUndefined, trim_blocks=True, lstrip_blocks=True,
    )  # fmt: skip
    environment.filters["allowed"] = allowed
    numbers, labels = comparison.numbers, comparison.labels
    base = comparison.gaits[0].study
    return environment.get_template(TEMPLATE).render(
        title="Comparison of gaits" if len(labels) > 1 else "Gait report",
        labels=labels,
        colours=look.GAIT_COLOURS,
        spatial=base.skeleton_kind == "spatial",
        troubles=troubles(numbers),
        headline=headline(numbers),
        walkers=[
            {
                "who": who(item.curves.gait.study),
                "differs": differences(base, item.curves.gait.study),
                "gait": item.curves.gait,
                "passed": item.report.passed,
                "work": _residual_share(item.report),
            }
            for item in numbers
        ],
        reports=[item.report for item in numbers],
        tables={topic: shown(table) for topic, table in comparison.rows.items()},
        figures={name: Markup(svg) for name, svg in figures(comparison).items()},
        band=curves_of.BAND_MEANING if comparison.reference else "",
        line=curves_of.LINE_MEANING if _has_line(comparison) else "",
        reference=_reference_words(base),
        replay=Markup(as_attribute(_replay(comparison))),
        version=drakegait.__version__,
        date=datetime.date.today().isoformat(),
    )


def figures(comparison: Comparison) -> dict[str, str]:
    """All figures as SVG, by name."""
    drawn = [GaitCurves(gait, label) for gait, label in
             zip(comparison.gaits, comparison.labels, strict=True)]  # fmt: skip
    band, table = comparison.reference, comparison.rows

    def there(items):
        return [item for item in items if item.values(drawn[0], "right") is not None]

    with look.look():
        found = {
            "cost_by_muscle": cost_figure(table["cost_by_muscle"], comparison.labels),
            "cost_by_phase": cost_figure(table["cost_by_phase"], comparison.labels),
            "angles": cycle_figure(curves_of.SAGITTAL_ANGLES, drawn, band),
            "trunk": trunk_figure(drawn, band),
            "moments": cycle_figure(curves_of.MOMENTS[:3], drawn, band),
            "powers": cycle_figure(curves_of.POWERS, drawn, band),
            "forces": cycle_figure(there(curves_of.FORCES), drawn, band),
            "excitations": excitation_figure(drawn),
            "sticks": sticks_figure(drawn),
        }
        if there(curves_of.OTHER_ANGLES):
            found["other_angles"] = cycle_figure(curves_of.OTHER_ANGLES, drawn, band)
            found["other_moments"] = cycle_figure(curves_of.MOMENTS[3:], drawn, band)
        return {name: look.as_svg(figure, name) for name, figure in found.items()}


def shown(table: Sequence[Row]) -> list[TableRow]:
    """Rows as texts; the label of a pair of sides spans both."""
    found = []
    for number, row in enumerate(table):
        pair = row.side == "right" and number + 1 < len(table) and (
            table[number + 1].name == row.name
        )  # fmt: skip
        after = row.side == "left" and number > 0 and table[number - 1].name == row.name
        found.append(
            TableRow(
                label=row.label,
                unit=row.unit,
                side=row.side,
                values=tuple(number_text(value, row.digits) for value in row.values),
                changes=tuple(
                    change_text(change, share, row.digits)
                    for change, share in zip(row.changes, row.shares, strict=True)
                ),
                span=2 if pair else 0 if after else 1,
            )
        )
    return found


def change_text(change: float, share: float, digits: int) -> str:
    """A change with its sign, and in per cent if that says something."""
    text = number_text(change, digits, sign=True)
    if not math.isfinite(share) or text == NONE:
        return text
    return f"{text} ({number_text(share, 1, sign=True)} %)"


def as_attribute(page: str) -> str:
    """A page for the attribute `srcdoc` of a frame, in double quotes."""
    return page.replace("&", "&amp;").replace('"', "&quot;")


def _replay(comparison: Comparison) -> str:
    from drakegait.replay_together import replay_together

    return replay_together(
        comparison.gaits, comparison.labels, look.GAIT_COLOURS[: len(comparison.gaits)]
    )


def _reference_words(study) -> str:
    name = study.reference_walk.name
    if study.reference is None:
        return f'embedded stride "{name}" of one adult, scaled to height and mass'
    return f'"{name}"'


def _has_line(comparison: Comparison) -> bool:
    forces = comparison.gaits[0].study.reference_walk.forces
    return comparison.reference and forces is not None


def _residual_share(report) -> str:
    return report.item("residual_work_J").where
