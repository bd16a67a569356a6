"""What walking costs, against measured oxygen."""

from __future__ import annotations

from collections.abc import Callable

from drakegait.fidelity import figures
from drakegait.fidelity.anchor import distance
from drakegait.fidelity.published import Place, Range
from drakegait.fidelity.section import Line, Section
from drakegait.fidelity.walking import WALK
from drakegait.paper import tables
from drakegait.paper.chapter import Studies
from drakegait.paper.numbers import Numbers
from drakegait.study import GaitStudy
from drakegait.walker.metabolics import EnergySettings

GROSS, NET = Range(3.0, 3.5), Range(2.0, 2.5)
"""Of level walking at usual speed [J/(kg m)]: all of it, and without that of standing."""
COARSE, FINE = "planar-symmetric 19 nodes", "planar-symmetric 35 nodes"
NAMES = {
    WALK: "in space, 18 nodes",
    COARSE: "symmetric in the plane, 19 nodes",
    FINE: "symmetric in the plane, 35 nodes",
}
_WHY = {
    WALK: "Hip abductors saturate, and what opposes their helpers works too; few nodes.",
    COARSE: "Few nodes: the coarser the splines, the dearer the walk.",
    FINE: "Nodes are still few, the reference holds the walk to one stride, and Umberger's law "
    "charges heat to muscles that hold and brake.",
}


def studies() -> Studies:
    """The default walk, and the plane with few and many nodes."""
    return {
        WALK: GaitStudy.spatial(nodes=18),
        COARSE: GaitStudy.planar_symmetric(nodes=19),
        FINE: GaitStudy.planar_symmetric(nodes=35),
    }


def net(numbers: Numbers, name: str) -> float:
    """What muscles use for each metre and kilogram of body mass [J/(kg m)]."""
    return numbers.energy(name) / studies()[name].subject.mass


def gross(numbers: Numbers, name: str) -> float:
    """With `basal_rate` of the whole body, which goes on at all speeds [J/(kg m)]."""
    return net(numbers, name) + EnergySettings().basal_rate / studies()[name].speed


def _line(kind: str, name: str, published: Range, of: Callable[[Numbers, str], float]) -> Line:
    def read(n: Numbers) -> tuple[str, Place, str]:
        ours = of(n, name)
        return f"{ours:.2f}", published.place([ours]), distance(published, [ours], 2)

    return Line(quantity=f"{kind}, {NAMES[name]} [J/(kg m)]", published=published.text(1),
                source="textbooks", read=read, why=_WHY[name])  # fmt: skip


SECTION = Section(
    name="cost",
    title="What walking costs",
    place="-",
    about="Measured walking includes the body at rest (gross) or has the rate of standing "
    "subtracted (net). E^t counts muscles only, from their first twitch: it is compared with the "
    "net cost, and with the gross cost after the rate of the resting body, "
    f"{EnergySettings().basal_rate:g} W/kg (`basal_rate`), is added.",
    studies=studies,
    rule="inside: within the published range",
    lines=tuple(
        _line(kind, name, published, of)
        for name in NAMES
        for kind, published, of in (("Net", NET, net), ("Gross", GROSS, gross))
    ),
    tables=lambda n: [tables.studies(n, list(NAMES))],
    pictures={
        "fidelity_cost": (
            "Cost of walking, published ranges in grey",
            lambda n: figures.costs(
                {label: (net(n, name), gross(n, name)) for name, label in NAMES.items()},
                NET, GROSS,
            ),
        ),
    },
)  # fmt: skip
