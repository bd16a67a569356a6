"""Masses worn on one foot, both feet, shank, thigh and waist."""

from __future__ import annotations

from drakegait.paper import charts, tables, verdict
from drakegait.paper.bases import WEIGHT, chain
from drakegait.paper.chapter import Chapter, Studies
from drakegait.paper.claim import Claim
from drakegait.paper.numbers import Gaits, Numbers
from drakegait.study import GaitStudy

BASE = "planar 18"
MASSES = (1.0, 2.0, 3.0, 4.0)  # [kg] on each foot that wears one
WAIST = (0.0, 0.0, 0.10)
"""Above the hips, in the frame of the trunk [m]."""


def _one(kg: float) -> str:
    return f"{kg:g} kg right foot"


def _both(kg: float) -> str:
    return f"{kg:g} kg each foot"


HEAVY = _one(WEIGHT)
"""The study with the paper's weight."""
PLACES = {
    HEAVY: "foot",
    f"{WEIGHT:g} kg right shank": "shank",
    f"{WEIGHT:g} kg right thigh": "thigh",
    f"{WEIGHT:g} kg waist": "waist",
}
"""Studies with the same mass from far to near."""


def studies() -> Studies:
    """None, one foot, both feet, and other places."""
    base = GaitStudy.planar(nodes=18)
    found = {BASE: base}
    for kg in MASSES:
        found[_one(kg)] = base.with_added_mass("foot_r", kg)
        found[_both(kg)] = base.with_added_mass("foot_r", kg).with_added_mass("foot_l", kg)
    for name, place in PLACES.items():
        if place in ("shank", "thigh"):
            found[name] = base.with_added_mass(f"{place}_r", WEIGHT)
        elif place == "waist":
            found[name] = base.with_added_mass("hat", WEIGHT, WAIST)
    return found


_ONE = [BASE, *(_one(kg) for kg in MASSES)]
_TWO = [BASE, *(_both(kg) for kg in MASSES)]
_OTHERS = [name for name, place in PLACES.items() if place != "foot"]


def _energies(n: Numbers, names) -> list[float]:
    return [n.energy(name) for name in names]


def _rise(names):
    return (
        lambda n: " ".join(f"{e:.0f}" for e in _energies(n, names)) + " J/m",
        lambda n: verdict.falls_always([-e for e in _energies(n, names)], 0.01),
    )


def _figure(gaits: Gaits, n: Numbers) -> str:
    panels = []
    for title, read in (("E^t [J/m]", n.energy), ("J_dev [s]", n.deviation)):
        curves = {}
        for label, names in (("one foot", _ONE), ("both feet", _TWO)):
            known = [(kg, read(name)) for kg, name in zip((0.0, *MASSES), names, strict=True)
                     if n.solved(name)]  # fmt: skip
            curves[label] = tuple(zip(*known, strict=True)) if known else ((), ())
        panels.append(charts.Panel(title, "kg on each foot that wears one", curves))
    return charts.lines(panels, "Energy and deviation over worn mass")


CHAPTER = Chapter(
    name="worn-masses",
    title="Masses worn on the body",
    place="-",
    about="The planar walker with 18 nodes against the embedded stride: 0 to 4 kg on the right "
    "foot and on each foot, each from the walk with 1 kg less, and 2 kg on right shank, right "
    "thigh and waist.",
    studies=studies,
    warm=chain(_ONE) | chain(_TWO) | dict.fromkeys(_OTHERS, BASE),
    claims=(
        Claim("Does energy rise with every kilogram on the right foot?", "-", "the paper has 2 kg",
              *_rise(_ONE), "yes: at every step; partly: it falls by no more than 1 % anywhere"),
        Claim("Does energy rise with every kilogram on both feet?", "-", "", *_rise(_TWO),
              "as for one foot"),
        Claim(
            "Is a mass dearer the farther from the trunk it is worn?", "-",
            "the paper does not say; people: yes",
            lambda n: ", ".join(f"{place} {n.energy(name) - n.energy(BASE):+.1f} J/m"
                                for name, place in PLACES.items()),
            lambda n: verdict.falls_always(_energies(n, PLACES), 0.002),
            "yes: foot > shank > thigh > waist; partly: steps back of no more than 0.2 %",
            "One mass on one side. Thigh and waist differ by less than unrelated optima scatter.",
        ),
    ),
    tables=lambda n: [tables.studies(n, list(studies()), base=BASE)],
    figures={"Energy and deviation": _figure},
)  # fmt: skip
