"""The front of cost and deviation: w_E from 0 to 10."""

from __future__ import annotations

import numpy as np

from drakegait.paper import charts, tables, verdict
from drakegait.paper.bases import SMALL, chain, small
from drakegait.paper.chapter import Chapter, Studies
from drakegait.paper.claim import Claim
from drakegait.paper.numbers import Gaits, Missing, Numbers

WEIGHTS = (0.0, 0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0)


def name_of(weight: float) -> str:
    """Name of the study with this w_E; w_J is 1."""
    return SMALL if weight == 1.0 else f"w_E {weight:g}"


NAMES = tuple(name_of(weight) for weight in WEIGHTS)
_MIDDLE = NAMES.index(SMALL)


def studies() -> Studies:
    """One for each weight."""
    return {name_of(w): small(energy_weight=w) for w in WEIGHTS}


def front(n: Numbers) -> tuple[list[str], np.ndarray]:
    """Names of the solved studies, and their energy and deviation (num, 2)."""
    names = [name for name in NAMES if n.solved(name)]
    if len(names) < 3:
        raise Missing("Fewer than three points of the front are known.")
    return names, np.array([[n.energy(name), n.deviation(name)] for name in names])


def knee(n: Numbers) -> str:
    """The study at the knee: farthest below the line between the ends of the front.

    Energy and deviation are divided by their ranges first. w_E = 0 is left out: an energy that
    has no price is as large as it happens to be, and would decide where the line is.
    """
    names, points = front(n)
    priced = [row for row, name in enumerate(names) if name != name_of(0.0)]
    points = points[priced]
    low, high = points.min(axis=0), points.max(axis=0)
    unit = (points - low) / (high - low)
    start, end = unit[0], unit[-1]
    along = (end - start) / np.linalg.norm(end - start)
    offset = unit - start
    distance = np.abs(offset[:, 0] * along[1] - offset[:, 1] * along[0])
    return names[priced[int(np.argmax(distance))]]


def _text(n: Numbers) -> str:
    names, points = front(n)
    return "; ".join(f"{name}: {e:.0f} J/m, {d:.2f} s" for name, (e, d) in
                     zip(names, points, strict=True)).replace(SMALL, name_of_base())  # fmt: skip


def name_of_base() -> str:
    """What the base is called in this chapter."""
    return "w_E 1"


def _judge(n: Numbers) -> verdict.Verdict:
    _, points = front(n)
    return verdict.every(
        verdict.falls_always(points[:, 0], 0.01), verdict.falls_always(-points[:, 1], 0.01)
    )


def _figure(gaits: Gaits, n: Numbers) -> str:
    names, points = front(n)
    at = names.index(knee(n))
    priced = [row for row, name in enumerate(names) if name != name_of(0.0)]
    mark = {f"knee: {names[at].replace(SMALL, name_of_base())}": tuple(points[at])}
    curve = {"w_E 0.1 to 10": (points[priced, 0], points[priced, 1])}
    weights = [1.0 if name == SMALL else float(name.split()[1]) for name in names]
    over = {"w_E 0.1 to 10": ([np.log10(weights[row]) for row in priced], points[priced, 0])}
    return charts.lines(
        [charts.Panel("J_dev [s]", "E^t [J/m]", curve, mark),
         charts.Panel("E^t [J/m]", "log10 of w_E", over)],
        "Front of energy and deviation",
    )  # fmt: skip


CHAPTER = Chapter(
    name="cost-front",
    title="Energy against deviation",
    place="4.1, eq. (13)",
    about="Symmetric in the plane, 19 nodes, w_J = 1 and w_E from 0 to 10, each walk from that of "
    "the next weight towards 1. The knee is the point farthest from the line between the ends.",
    studies=studies,
    warm=chain(list(NAMES[_MIDDLE:])) | chain(list(NAMES[_MIDDLE::-1])),
    claims=(
        Claim(
            "Other weights lead to other values of E^t and J_dev",
            "4.1", "", _text, _judge,
            "yes: with growing w_E energy falls and deviation rises at every step; partly: "
            "steps back of at most 1 %, or only one of them",
        ),
        Claim("Where is the knee of the front?", "-", "",
              lambda n: knee(n).replace(SMALL, name_of_base()), None),
    ),
    tables=lambda n: [tables.studies(n, NAMES, f"{SMALL} is w_E = 1", base=SMALL)],
    figures={"The front": _figure},
)  # fmt: skip
