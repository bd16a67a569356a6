"""Masses worn on both legs or the waist, against Browning et al. (2007)."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from drakegait.fidelity import figures
from drakegait.fidelity.anchor import distance
from drakegait.fidelity.cost import NET
from drakegait.fidelity.published import Place, Range
from drakegait.fidelity.section import Line, Section
from drakegait.paper import tables
from drakegait.paper.chapter import Studies
from drakegait.paper.numbers import Numbers
from drakegait.paper.worn_masses import WAIST
from drakegait.study import GaitStudy

SPEED = 1.25
"""Of all walks, as in the experiment [m/s]."""
BASE = f"spatial at {SPEED:g}"
SCATTER = 5.0
"""By how many percentage points ours may miss a published change: unrelated local optima scatter by
several per cent (benchmarks/robustness.py)."""


@dataclass(frozen=True)
class Load:
    """One condition of the experiment.

    Attributes:
        place: `"foot"`, `"shank"`, `"thigh"` or `"waist"`.
        mass: on both sides together [kg].
        published: change of the net metabolic rate against walking without load [%].
    """

    place: str
    mass: float
    published: float

    @property
    def name(self) -> str:
        """Of its study."""
        return f"{self.mass:g} kg {self.place}"

    def worn(self, base: GaitStudy) -> GaitStudy:
        """The study of it: half on each leg, at the segment's mass centre, or all on the waist."""
        if self.place == "waist":
            return base.with_added_mass("hat", self.mass, WAIST)
        half = 0.5 * self.mass
        right = base.with_added_mass(f"{self.place}_r", half)
        return right.with_added_mass(f"{self.place}_l", half)


LOADS = (
    Load("foot", 4.0, 34.5),
    Load("foot", 8.0, 68.0),
    Load("shank", 4.0, 16.6),
    Load("thigh", 8.0, 29.9),
    Load("waist", 4.0, 7.8),
    Load("waist", 8.0, 14.0),
)
"""Published changes of Browning et al. (2007)."""

_DEAR = "The walk without load is too dear, so that the same joules are a smaller share. "
_WHY = {
    "foot": "In joules it is more than measured: swinging and stopping a heavy foot is dear.",
    "shank": "Worn at the mass centre of the shank; where exactly the men wore it counts.",
    "thigh": "In joules, too, it is less than measured: a point mass near the hip, without straps.",
    "waist": "A point on a stiff trunk, which needs neither balance nor straps.",
}


def studies() -> Studies:
    """Without load, and all loads."""
    base = GaitStudy.spatial(nodes=18, speed=SPEED)
    return {BASE: base, **{load.name: load.worn(base) for load in LOADS}}


def change(numbers: Numbers, load: Load) -> float:
    """Change of muscle energy per time at equal speed, which is that of E^t [%]."""
    return percent_change(numbers.energy(BASE), numbers.energy(load.name))


def percent_change(before: float, after: float) -> float:
    """100 (after / before - 1)."""
    return 100.0 * (after / before - 1.0)


def in_joules(numbers: Numbers) -> tables.Table:
    """The changes in J/(kg m): the published ones as shares of the usual net cost of walking."""
    mass = GaitStudy.spatial(nodes=18).subject.mass
    rows = []
    for load in LOADS:
        low, high = (0.01 * load.published * end for end in (NET.low, NET.high))
        known = numbers.solved(BASE) and numbers.solved(load.name)
        ours = (numbers.energy(load.name) - numbers.energy(BASE)) / mass if known else None
        rows.append((load.name, f"{low:.2f} to {high:.2f}", "-" if ours is None else f"{ours:.2f}"))
    return tables.Table(
        "The same in J/(kg m)", ("load", "published", "ours"), tuple(rows),
        f"Published: the percentage of a net cost of {NET.text(1)} J/(kg m).",
    )  # fmt: skip


def _load_line(load: Load) -> Line:
    allowed = Range.around((load.published,), SCATTER)

    def read(n: Numbers) -> tuple[str, Place, str]:
        ours = change(n, load)
        return f"{ours:+.1f}", allowed.place([ours]), distance(allowed, [ours], 1)

    half = "" if load.place == "waist" else f", {0.5 * load.mass:g} kg each side"
    return Line(
        quantity=f"{load.mass:g} kg on the {load.place}{half} [%]",
        published=f"{load.published:+.1f}; range {allowed.text(1)}",
        source="Browning 2007", read=read, why=_DEAR + _WHY[load.place],
    )  # fmt: skip


def _trend(quantity: str, loads: tuple[Load, ...], why: str) -> Line:
    """The published order of changes for each kilogram worn, from the dearest to the cheapest."""

    def per_kilogram(change_of: Callable[[Load], float]) -> str:
        return ", ".join(f"{x.place} {change_of(x) / x.mass:+.1f}" for x in loads)

    def read(n: Numbers) -> tuple[str, Place, str]:
        found = [change(n, load) / load.mass for load in loads]
        steps = [later - before for before, later in zip(found, found[1:], strict=False)]
        worst = max(steps)
        text = per_kilogram(lambda load: change(n, load))
        if worst < 0.0:
            return text, Place.INSIDE, ""
        return text, Place.OUTSIDE, f"{worst:+.1f} where it should fall"

    return Line(quantity=quantity, published=per_kilogram(lambda load: load.published),
                source="Browning 2007", read=read, why=why)  # fmt: skip


_BY_NAME = {load.name: load for load in LOADS}
_TRENDS = (
    _trend("Dearer the farther from the trunk, 4 kg [% for each kg]",
           tuple(_BY_NAME[f"4 kg {place}"] for place in ("foot", "shank", "waist")),
           "Differences below the scatter of optima mean little."),
    _trend("Dearer the farther from the trunk, 8 kg [% for each kg]",
           tuple(_BY_NAME[f"8 kg {place}"] for place in ("foot", "thigh", "waist")),
           "Differences below the scatter of optima mean little."),
)  # fmt: skip

SECTION = Section(
    name="worn",
    title="Masses on legs and waist",
    place="-",
    about=f"In space, 18 nodes, {SPEED:g} m/s, mass shared evenly by both legs. Published is the "
    "change of the net metabolic rate (walking minus standing). Ours is the change of the muscles' "
    "energy per time, which leaves out the body at rest as well; all walks have the same speed, so "
    "that it is the change of E^t. Each walk starts from the one without load, 8 kg from 4 kg "
    "where both are there. Our base is too dear, and percentages are of it; the second table has "
    "joules.",
    studies=studies,
    warm=dict.fromkeys((load.name for load in LOADS), BASE)
    | {"8 kg foot": "4 kg foot", "8 kg waist": "4 kg waist"},
    rule=f"inside: within {SCATTER:g} percentage points of the published change, as local optima "
    "scatter by several per cent; for an order: each place is cheaper for each kilogram than the "
    "one before it",
    lines=(*map(_load_line, LOADS), *_TRENDS),
    tables=lambda n: [
        in_joules(n),
        tables.studies(n, [BASE, *(load.name for load in LOADS)], base=BASE),
    ],
    pictures={
        "fidelity_worn": (
            "Change of energy by masses worn: published and ours",
            lambda n: figures.pairs(
                {load.name: (load.published, change(n, load)) for load in LOADS}, SCATTER
            ),
        ),
    },
)  # fmt: skip
