"""What a comparison says in sentences: what differs, what happened, what not to trust."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from drakegait.report.comparison_curves import OTHER_ANGLES, SAGITTAL_ANGLES, at_percent
from drakegait.report.comparison_tables import GaitNumbers, Row, rows
from drakegait.report.curves import SIDES
from drakegait.report.measures import number_text
from drakegait.report.study_words import differences, who
from drakegait.report.symmetry import UNIT
from drakegait.walker.disorders import Prosthesis

if TYPE_CHECKING:
    from drakegait.study import GaitStudy

NOISE = 3.0
"""Change of the cost of transport [%] that another start of the solver can make as well."""
_FEWEST = 0.005  # a relative change of steps and times that is worth a word
_WEIGHTS = ("energy_weight", "deviation_weight")


@dataclass(frozen=True)
class Finding:
    """One sentence on top of the report.

    Attributes:
        text: the sentence.
        severe: whether the gait it speaks of cannot be trusted; shown in red.
    """

    text: str
    severe: bool = False


def troubles(numbers: Sequence[GaitNumbers]) -> list[Finding]:
    """Gaits that have not converged or failed their check, and pairs that do not compare."""
    found = []
    for item in numbers:
        gait, label, report = item.curves.gait, item.curves.label, item.report
        if not gait.converged:
            laws = "; ".join(gait.outcome.worst)
            worst = f" Laws that hold least: {laws}." if laws else ""
            status = gait.outcome.status.replace("_", " ")
            text = f"{label}: NOT CONVERGED ({status}). Its numbers are of an unfinished search."
            found.append(Finding(text + worst, True))
        failed = [
            f"{entry.label} {entry.value:.4g} {entry.unit}".rstrip().replace("-", "\N{MINUS SIGN}")
            + f" (allowed {allowed(entry.limit)}{f'; {entry.where}' if entry.where else ''})"
            for entry in report.items
            if not entry.passed
        ]
        if failed:
            found.append(Finding(f"{label}: CHECK NOT PASSED. {'; '.join(failed)}.", True))
    base = numbers[0].curves
    for item in numbers[1:]:
        for reason in incomparable(base.gait.study, item.curves.gait.study):
            found.append(Finding(f"{base.label} and {item.curves.label}: {reason}"))
    return found


def allowed(limit: str) -> str:
    """A limit of the check in the signs of print."""
    return limit.replace("<=", "≤").replace(">=", "≥").replace("-", "\N{MINUS SIGN}")


def cost_hindrances(base: GaitStudy, other: GaitStudy) -> list[str]:
    """Why the costs of transport of two studies must not be compared; empty if they may."""
    found = []
    if base.nodes != other.nodes:
        found.append(
            f"{base.nodes} and {other.nodes} nodes. Energy is comparable only among gaits of equal "
            "nodes: the coarser the splines, the dearer the walk."
        )
    if base.energy != other.energy:
        found.append("different constants of the energy law: their costs do not compare.")
    if base.skeleton_kind == "planar" and base.planar_muscles != other.planar_muscles:
        found.append("different muscle tables: their costs do not compare.")
    if any(getattr(base, name) != getattr(other, name) for name in _WEIGHTS):
        found.append(
            "different weights of energy and deviation: what differs in the walk may come from "
            "what was asked of it."
        )
    return found


def incomparable(base: GaitStudy, other: GaitStudy) -> list[str]:
    """All reasons to read the comparison of two studies with care."""
    found = cost_hindrances(base, other)
    if _artificial(base) != _artificial(other):
        found.append(
            "one walks with a prosthesis: muscles that are not there take no energy, and what the "
            "stump has to bear is not in the model. Do not read the cost of transport as that of "
            "a person."
        )
    if base.symmetric != other.symmetric:
        found.append("one of them was forced to walk with equal sides, the other was free.")
    if base.tolerances != other.tolerances:
        found.append("different tolerances of the laws of motion.")
    alike = base.symmetric == other.symmetric and base.nodes == other.nodes
    if alike and base.schedule != other.schedule:
        counts = base.schedule.num_points, other.schedule.num_points
        found.append(
            f"the laws were enforced at different instants of the stride ({counts[0]} and "
            f"{counts[1]} control points); small differences may come from that."
        )
    if base.multipliers != other.multipliers:
        found.append("contact forces were found in different ways (lifted and projected).")
    if base.subject != other.subject:
        found.append("different height, mass or proportions of the body.")
    first, second = (study.reference_walk for study in (base, other))
    if first.name != second.name:
        found.append("they were held to different reference walks; the band is that of the first.")
    return found


def _artificial(study: GaitStudy) -> bool:
    return any(isinstance(item, Prosthesis) for item in study.disorders)


@dataclass(frozen=True)
class Summary:
    """What to know about one gait: a title and sentences."""

    title: str
    sentences: tuple[str, ...]


def headline(numbers: Sequence[GaitNumbers]) -> list[Summary]:
    """What differs and what happened, for each later gait; who walks, for a single one."""
    first = numbers[0]
    if len(numbers) == 1:
        sentences = (f"{who(first.curves.gait.study)}.", _alone(first))
        return [Summary(first.curves.label, sentences)]
    return [_pair(first, item) for item in numbers[1:]]


def _alone(item: GaitNumbers) -> str:
    cost = {row.name: row.values[0] for row in rows([item.cost]) if not row.side}
    steps = {(row.name, row.side): row.values[0] for row in rows([item.steps])}
    return (
        f"Walking at {item.curves.gait.speed:.2f} m/s takes {cost['cost_of_transport']:.0f} J/m "
        f"({cost['cost_per_mass']:.2f} J/(kg m)). Steps of {steps['step_length', 'right']:.2f} m "
        f"on the right and {steps['step_length', 'left']:.2f} m on the left, stance "
        f"{steps['stance', 'right']:.1f} % and {steps['stance', 'left']:.1f} % of the cycle."
    )


def _pair(base: GaitNumbers, other: GaitNumbers) -> Summary:
    studies = base.curves.gait.study, other.curves.gait.study
    differ = differences(*studies)
    told = "; ".join(differ) if differ else "nothing; only the solutions may differ"
    sentences = [
        f"What differs: {told}.",
        *_cost(base, other, bool(cost_hindrances(*studies))),
        _steps(rows([base.steps, other.steps])),
        _angles(base, other),
        _sides(base, other),
    ]
    title = f"{other.curves.label}, compared with {base.curves.label}"
    return Summary(title, tuple(sentence for sentence in sentences if sentence))


def _cost(base: GaitNumbers, other: GaitNumbers, hindered: bool) -> list[str]:
    theirs, mine = base.split.total, other.split.total
    per_mass = mine / other.curves.mass
    if hindered:
        return [
            f"Cost of transport {mine:.0f} J/m and {theirs:.0f} J/m: not to be compared, see above."
        ]
    change, share = mine - theirs, 100.0 * (mine - theirs) / theirs
    amount = f"{abs(share):.1f} % {'more' if change > 0 else 'less'} than {theirs:.0f} J/m"
    if abs(change) < 0.05:
        return [f"Cost of transport {mine:.0f} J/m, unchanged."]
    text = (
        f"Walking takes {mine:.0f} J of metabolic energy per m ({per_mass:.2f} J/(kg m)), {amount}."
    )
    if abs(share) < NOISE:
        return [
            f"{text} That is within the {NOISE:g} % that solves from different starts differ by."
        ]
    legs = other.split.by_side - base.split.by_side
    groups = tuple(dict.fromkeys((*base.split.groups, *other.split.groups)))
    table = rows([item.cost_by_muscle(groups) for item in (base, other)])
    most = sorted(table, key=lambda row: -abs(row.changes[0]))[:3]
    named = ", ".join(
        f"{row.side} {row.label.lower()} {number_text(row.changes[0], 1, True)}"
        + (" (not there)" if np.isnan(other.split.of_group(row.name, row.side)) else "")
        for row in most
    )
    return [
        text,
        f"Of the {number_text(change, 0, True)} J/m the right leg's muscles make "
        f"{number_text(legs[0], 0, True)} and the left's {number_text(legs[1], 0, True)}. "
        f"Most change: {named} J/m.",
    ]


def _steps(table: Sequence[Row]) -> str:
    told = ("speed", "step_length", "stance_time", "double_support", "step_width")
    found = []
    for row in table:
        if row.name not in told or not np.isfinite(row.values).all():
            continue
        before, after = row.values
        if abs(after - before) <= _FEWEST * abs(before):
            continue
        name = f"{row.side} {row.label}".strip().lower().split(",")[0]
        found.append(f"{name} {before:.{row.digits}f} to {after:.{row.digits}f} {row.unit}")
    if not found:
        return f"Speed, step lengths and stance times change by less than {100 * _FEWEST:g} %."
    return f"Steps: {', '.join(found)}."


def _angles(base: GaitNumbers, other: GaitNumbers) -> str:
    """The largest change of a joint angle of a leg, each on its own cycle."""
    best = None
    for item in (*SAGITTAL_ANGLES, *OTHER_ANGLES):
        for side in SIDES:
            change = at_percent(item, other.curves, side) - at_percent(item, base.curves, side)
            if not np.isfinite(change).all():
                continue
            place = int(np.abs(change).argmax())
            if best is None or abs(change[place]) > abs(best[0]):
                best = (float(change[place]), f"{side} {item.title.lower()}", place)
    if best is None or abs(best[0]) < 0.5:
        return "No joint angle of the legs changes by half a degree."
    change = number_text(best[0], 0, True)
    return f"Largest change of a joint angle: {best[1]} {change}° at {best[2]} % of its cycle."


def _sides(base: GaitNumbers, other: GaitNumbers) -> str:
    """The index that has moved most towards or away from equal legs."""
    table = [row for row in rows([base.symmetry, other.symmetry]) if row.unit == UNIT]
    known = [row for row in table if np.isfinite(row.values).all()]
    if not known:
        return ""
    row = max(known, key=lambda row: abs(row.changes[0]))
    if abs(row.changes[0]) < 2.0:
        return "The symmetry of the legs does not change."
    before, after = row.values
    return (
        f"Symmetry of the legs changes most in: {row.label[0].lower() + row.label[1:]}, "
        f"symmetry index {number_text(before, 0, True)} % to {number_text(after, 0, True)} % "
        "(above 0: more on the right)."
    )
