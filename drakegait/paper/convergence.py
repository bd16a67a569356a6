"""Table 2 and figure 5: more nodes, symmetric in the plane."""

from __future__ import annotations

from drakegait.paper import charts, tables, verdict
from drakegait.paper.bases import chain
from drakegait.paper.chapter import Chapter, Studies
from drakegait.paper.claim import Claim
from drakegait.paper.numbers import Gaits, Numbers
from drakegait.study import GaitStudy

PRINTED = {
    19: (13.33, 626.00, 7.07, 0.55), 21: (7.54, 415.73, 3.38, 1.85), 23: (6.52, 351.01, 3.01, 2.87),
    25: (5.50, 310.62, 2.39, 3.25), 27: (4.99, 283.28, 2.16, 5.65), 29: (4.62, 254.22, 2.08, 8.66),
    31: (4.45, 246.32, 1.99, 9.52), 33: (4.37, 238.57, 1.98, 13.17),
    35: (4.31, 236.10, 1.95, 16.16),
}  # fmt: skip
"""Table 2: nodes -> f, E^t [J/m], J_dev, computation time [h]."""
NODES = tuple(PRINTED)
FINEST = f"nodes {NODES[-1]}"
DRAWN = "nodes 29"


def studies() -> Studies:
    """One for each row of Table 2."""
    return {f"nodes {n}": GaitStudy.planar_symmetric(nodes=n) for n in NODES}


def _values(numbers: Numbers, column: str) -> list[float]:
    return [numbers.of(name, column) for name in studies()]


def _ends(column: str, digits: int, unit: str = ""):
    def text(numbers: Numbers) -> str:
        values = _values(numbers, column)
        return " ".join(f"{value:.{digits}f}" for value in values) + (unit and f" {unit}")

    return text


def _gain(numbers: Numbers) -> str:
    f, half = _values(numbers, "cost"), len(NODES) // 2
    return (
        f"19 to {NODES[half]} nodes: -{f[0] - f[half]:.2f}; {NODES[half]} to 35: "
        f"-{f[half] - f[-1]:.2f}"
    )


def _tables(numbers: Numbers) -> list[tables.Table]:
    heads = ("nodes", "f paper", "f", "E^t paper [J/m]", "E^t [J/m]", "J_dev paper", "J_dev [s]",
             "time paper [h]", "time [s]", "ended, check")  # fmt: skip
    rows = []
    for row, (nodes, paper) in zip(
        tables.studies(numbers, list(studies())).rows, PRINTED.items(), strict=True
    ):
        _, f, energy, deviation, _, time, ended = row
        rows.append((
            str(nodes), f"{paper[0]:.2f}", f, f"{paper[1]:.2f}", energy, f"{paper[2]:.2f}",
            deviation, f"{paper[3]:.2f}", time, ended,
        ))  # fmt: skip
    return [tables.Table("Table 2", heads, tuple(rows), "Times of the paper: 2.40 GHz Xeon.")]


def _curve(gaits: Gaits, numbers: Numbers) -> str:
    names = [name for name in studies() if numbers.solved(name)]
    nodes = [int(name.split()[1]) for name in names]
    panels = []
    for place, (title, column) in enumerate(
        (("f", "cost"), ("E^t [J/m]", "cost_of_transport_J_per_m"), ("J_dev", "deviation_s"))
    ):
        paper = (list(NODES), [PRINTED[n][place] for n in NODES])
        ours = (nodes, [numbers.of(name, column) for name in names])
        panels.append(charts.Panel(title, "nodes", {"drakegait": ours, "the paper": paper}))
    return charts.lines(panels, "Cost, energy and deviation over the number of nodes")


_SUBJECT = "The paper's subject, speed and measured stride are not public, so the numbers differ."

CHAPTER = Chapter(
    name="convergence",
    title="Convergence with the number of nodes",
    place="4.1, Table 2, figure 5",
    about="The symmetric walker in the sagittal plane with 19, 21, ..., 35 nodes per stride, each "
    "solve started from the gait with two nodes less. w_E = w_J = 1.",
    studies=studies,
    warm=chain(list(studies())),
    claims=(
        Claim(
            "Every added pair of nodes lowers the cost f",
            "4.1, Table 2", "13.33 7.54 6.52 5.50 4.99 4.62 4.45 4.37 4.31",
            _ends("cost", 2), lambda n: verdict.falls_always(_values(n, "cost"), 0.01),
            "yes: f falls in all eight steps; partly: it rises by no more than 1 % anywhere",
            _SUBJECT + " With 19 nodes ours is far lower: the unknown curves are periodic splines, "
            "of which (14) would take three freedoms each.",
        ),
        Claim(
            "The cost f falls by ever less",
            "4.1, Table 2", "19 to 27 nodes: -8.34; 27 to 35: -0.68",
            _gain, lambda n: verdict.ever_less(_values(n, "cost")),
            "yes: the last four pairs bring less than half of what the first four bring",
        ),
        Claim(
            "Every added pair of nodes lowers the metabolic cost of transport E^t",
            "4.1, Table 2", "626 416 351 311 283 254 246 239 236 J/m",
            _ends("cost_of_transport_J_per_m", 0, "J/m"),
            lambda n: verdict.falls_always(_values(n, "cost_of_transport_J_per_m"), 0.01),
            "as for f", _SUBJECT,
        ),
        Claim(
            "Every added pair of nodes lowers the deviation J_dev",
            "4.1, Table 2", "7.07 3.38 3.01 2.39 2.16 2.08 1.99 1.98 1.95",
            _ends("deviation_s", 3, "s"),
            lambda n: verdict.falls_always(_values(n, "deviation_s"), 0.01),
            "as for f",
            "J_dev is a small part of f here, and the optimiser trades it for energy. Ours is the "
            "deviation from another stride, one that was made to stand on the ground.",
        ),
    ),
    tables=_tables,
    figures={
        "Cost, energy and deviation": _curve,
        "The walker with 29 nodes (figure 5)": lambda gaits, _: charts.sticks(gaits[DRAWN]),
    },
)  # fmt: skip
