"""Speed from 0.8 to 1.8 m/s: is there a cheapest one?"""

from __future__ import annotations

from drakegait.paper import charts, tables, verdict
from drakegait.paper.bases import SMALL, chain, small
from drakegait.paper.chapter import Chapter, Studies
from drakegait.paper.claim import Claim
from drakegait.paper.numbers import Gaits, Missing, Numbers

SPEEDS = (0.8, 0.9, 1.0, 1.1, 1.2, 1.3, 1.4, 1.5, 1.6, 1.7, 1.8)
DEFAULT = 1.2
PREFERRED = (1.1, 1.5)
"""Where people are found to walk cheapest, about 1.3 m/s (general literature) [m/s]."""


def name_of(speed: float) -> str:
    """Name of the study at a speed [m/s]."""
    return SMALL if speed == DEFAULT else f"{speed:g} m per s"


NAMES = tuple(name_of(speed) for speed in SPEEDS)
_START = NAMES.index(SMALL)


def studies() -> Studies:
    """One for each speed."""
    return {name_of(v): small(speed=v) for v in SPEEDS}


def energies(n: Numbers) -> dict[float, float]:
    """Speed [m/s] -> cost of transport [J/m] of what was solved."""
    found = {v: n.energy(name_of(v)) for v in SPEEDS if n.solved(name_of(v))}
    if len(found) < 5:
        raise Missing("Fewer than five speeds are known.")
    return found


def cheapest(n: Numbers) -> float:
    """Speed with the least cost of transport [m/s]."""
    found = energies(n)
    return min(found, key=found.__getitem__)


def _text(n: Numbers) -> str:
    found = energies(n)
    ends = f"{found[min(found)]:.0f} at {min(found)} and {found[max(found)]:.0f} at {max(found)}"
    return f"least {found[cheapest(n)]:.0f} J/m at {cheapest(n)} m/s; {ends} m/s"


def _judge(n: Numbers) -> verdict.Verdict:
    found, best = energies(n), cheapest(n)
    if best in (min(found), max(found)):
        return verdict.Verdict.NO
    inside = PREFERRED[0] <= best <= PREFERRED[1]
    return verdict.Verdict.YES if inside else verdict.Verdict.PARTLY


def _figure(gaits: Gaits, n: Numbers) -> str:
    found = energies(n)
    least = cheapest(n)
    energy = {"drakegait": (list(found), list(found.values()))}
    deviation = {"drakegait": (list(found), [n.deviation(name_of(v)) for v in found])}
    return charts.lines(
        [charts.Panel("E^t [J/m]", "speed [m/s]", energy, {"least": (least, found[least])}),
         charts.Panel("J_dev [s]", "speed [m/s]", deviation)],
        "Energy and deviation over speed",
    )  # fmt: skip


CHAPTER = Chapter(
    name="speeds",
    title="Speed",
    place="-",
    about="Symmetric in the plane, 19 nodes, 0.8 to 1.8 m/s, each walk from that of the next speed "
    "towards 1.2 m/s. The reference is one stride, measured at 1.35 m/s for 1.80 m, at all speeds.",
    studies=studies,
    warm=chain(list(NAMES[_START:])) | chain(list(NAMES[_START::-1])),
    claims=(
        Claim(
            "Is walking cheapest near the preferred speed?",
            "-", "the paper does not say; people: about 1.3 m/s", _text, _judge,
            "yes: the least cost of transport is at 1.1 to 1.5 m/s and not at an end; partly: not "
            "at an end, but elsewhere",
            "Only muscles are counted. The energy that a body uses at rest, which makes slow "
            "walking dear per metre, is not in E^t (`basal`, rulings), and one reference stride "
            "serves all speeds.",
        ),
    ),
    tables=lambda n: [tables.studies(n, NAMES, f"{SMALL} is 1.2 m/s", base=SMALL)],
    figures={"Energy and deviation over speed": _figure},
)  # fmt: skip
