"""Masses worn on one foot, both feet, shank, thigh and waist."""

from __future__ import annotations

import numpy as np

from drakegait.paper import charts, tables, verdict
from drakegait.paper.bases import WEIGHT, chain
from drakegait.paper.chapter import Chapter, Studies
from drakegait.paper.claim import Claim
from drakegait.paper.numbers import Gaits, Missing, Numbers
from drakegait.study import GaitStudy

BASE = "planar 18"
MASSES = (1.0, 2.0, 3.0, 4.0)  # [kg] on each place that wears one
WAIST = (0.0, 0.0, 0.10)
"""Above the hips, in the frame of the trunk [m]."""
PLACES = {
    "right foot": "foot",
    "each foot": "both feet",
    "right shank": "shank",
    "right thigh": "thigh",
    "waist": "waist",
}
"""Where masses are worn, in the names of studies and in tables."""
FAR_TO_NEAR = ("right foot", "right shank", "right thigh", "waist")


def _name(place: str, kg: float) -> str:
    return f"{kg:g} kg {place}"


HEAVY = _name("right foot", WEIGHT)
"""The study with the paper's weight."""
_CHAINS = {place: [BASE, *(_name(place, kg) for kg in MASSES)] for place in PLACES}


def _worn(base: GaitStudy, place: str, kg: float) -> GaitStudy:
    if place == "each foot":
        return base.with_added_mass("foot_r", kg).with_added_mass("foot_l", kg)
    if place == "waist":
        return base.with_added_mass("hat", kg, WAIST)
    return base.with_added_mass(f"{PLACES[place]}_r", kg)


def studies() -> Studies:
    """None, one foot, both feet, and other places."""
    base = GaitStudy.planar(nodes=18)
    found = {BASE: base}
    for place in PLACES:
        found |= {_name(place, kg): _worn(base, place, kg) for kg in MASSES}
    return found


def _rise(place: str):
    def energies(n: Numbers) -> list[float]:
        return [n.energy(name) for name in _CHAINS[place]]

    return (
        lambda n: " ".join(f"{e:.0f}" for e in energies(n)) + " J/m",
        lambda n: verdict.falls_always([-e for e in energies(n)], 0.01),
    )


def price(n: Numbers, place: str) -> float:
    """E^t for each kilogram [J/m/kg]: slope of the line through the walk without mass that fits
    those with mass best; raises Missing if none was solved."""
    names = zip(MASSES, _CHAINS[place][1:], strict=True)
    known = [(kg, n.energy(name) - n.energy(BASE)) for kg, name in names if n.solved(name)]
    if not known:
        raise Missing(f"No walk with a mass on {place} is known.")
    kg, more = np.array(known).T
    return float(kg @ more / (kg @ kg))


def _prices(n: Numbers) -> str:
    texts = [f"{PLACES[place]} {price(n, place):+.1f}" for place in FAR_TO_NEAR]
    return f"{', '.join(texts)} J/m for each kilogram"


def _figure(gaits: Gaits, n: Numbers) -> str:
    panels = []
    for title, read in (("E^t [J/m]", n.energy), ("J_dev [s]", n.deviation)):
        curves = {}
        for place, names in _CHAINS.items():
            known = [(kg, read(name)) for kg, name in zip((0.0, *MASSES), names, strict=True)
                     if n.solved(name)]  # fmt: skip
            curves[PLACES[place]] = tuple(zip(*known, strict=True)) if known else ((), ())
        panels.append(charts.Panel(title, "kg on each place that wears one", curves))
    return charts.lines(panels, "Energy and deviation over worn mass")


CHAPTER = Chapter(
    name="worn-masses",
    title="Masses worn on the body",
    place="-",
    about="The planar walker with 18 nodes against the embedded stride: 0 to 4 kg on the right "
    "foot, on each foot, on right shank, right thigh and waist, each walk from that with 1 kg less "
    "at the same place.",
    studies=studies,
    warm={key: guess for names in _CHAINS.values() for key, guess in chain(names).items()},
    claims=(
        Claim("Does energy rise with every kilogram on the right foot?", "-", "the paper has 2 kg",
              *_rise("right foot"),
              "yes: at every step; partly: it falls by no more than 1 % anywhere"),
        Claim("Does energy rise with every kilogram on both feet?", "-", "", *_rise("each foot"),
              "as for one foot"),
        Claim(
            "Is a mass dearer the farther from the trunk it is worn?", "-",
            "the paper does not say; people: yes", _prices,
            lambda n: verdict.falls_always([price(n, place) for place in FAR_TO_NEAR], 0.1),
            "yes: foot > shank > thigh > waist for each kilogram, over all masses that were "
            "solved; partly: steps back of no more than a tenth",
            "One mass on one side. Thigh and waist differ by less than unrelated optima scatter.",
        ),
    ),
    tables=lambda n: [tables.studies(n, list(studies()), base=BASE)],
    figures={"Energy and deviation": _figure},
)  # fmt: skip
