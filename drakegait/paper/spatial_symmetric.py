"""The spatial-symmetric model of the conclusions."""

from __future__ import annotations

from drakegait.paper import charts, measures, tables, verdict
from drakegait.paper.chapter import Chapter, Studies
from drakegait.paper.claim import Claim
from drakegait.paper.numbers import Gaits, Numbers
from drakegait.study import GaitStudy

SYMMETRIC = "spatial-symmetric 19"
FREER = "spatial-symmetric 19, w_J 0.1"
ASIDE = {"hat_list": "degrees", "hat_rotation": "degrees", "hat_y": "m"}
"""Motion of the trunk out of the sagittal plane."""
_WORDS = {"hat_list": "list", "hat_rotation": "rotation", "hat_y": "sway"}
SMALL = 0.5
"""Share of the reference's range below which a motion counts as very small."""


def studies() -> Studies:
    """The walk, and one that hardly minds how far it is from the reference."""
    walk = GaitStudy.spatial_symmetric(nodes=19)
    return {SYMMETRIC: walk, FREER: walk.replace(deviation_weight=0.1)}


def _measure(gaits: Gaits) -> dict[str, float]:
    found = {}
    for name in ASIDE:
        ours, reference = measures.ranges(gaits[SYMMETRIC], name)
        found |= {f"range of {name}": ours, f"range of {name} in the reference": reference}
    return found


def _measure_freer(gaits: Gaits) -> dict[str, float]:
    return {f"range of {name}, w_J 0.1": measures.ranges(gaits[FREER], name)[0] for name in ASIDE}


def _ours(n: Numbers) -> str:
    texts = []
    for name, unit in ASIDE.items():
        digits = 3 if unit == "m" else 1
        ours, reference = n[f"range of {name}"], n[f"range of {name} in the reference"]
        text = f"{_WORDS[name]} {ours:.{digits}f} of {reference:.{digits}f} {unit}"
        freer = n.found.get(f"range of {name}, w_J 0.1")
        texts.append(text if freer is None else f"{text} ({freer:.{digits}f} with w_J = 0.1)")
    return ", ".join(texts)


def _judge(n: Numbers):
    return verdict.every(*(
        verdict.below(n[f"range of {name}"], SMALL * n[f"range of {name} in the reference"])
        for name in ASIDE
    ))  # fmt: skip


CHAPTER = Chapter(
    name="spatial-symmetric",
    title="A symmetric walker in space",
    place="5",
    about="Three dimensions, mirrored legs, 19 nodes, trunk and pelvis as one body, as in the "
    "paper; range of the trunk's motion out of the sagittal plane beside that of the reference.",
    studies=studies,
    warm={FREER: SYMMETRIC},
    measures=(_measure, _measure_freer),
    claims=(
        Claim(
            "With one pelvis-trunk body the trunk moves very little out of the sagittal plane",
            "5", "very small", _ours, _judge,
            "yes: list, rotation and sway each below half of their range in the reference",
            "The paper says neither how much nor against what. Our reference is the motion of a "
            "pelvis, and to deviate from it has a price. In brackets: the motion where it has a "
            "tenth of that price; what does not shrink then is not due to the reference alone.",
        ),
    ),
    tables=lambda n: [tables.studies(n, [SYMMETRIC, FREER])],
    figures={
        "Trunk": lambda gaits, _: charts.trunk({"spatial-symmetric": gaits[SYMMETRIC]}),
        "Hips": lambda gaits, _: charts.other_angles({"spatial-symmetric": gaits[SYMMETRIC]}),
    },
)  # fmt: skip
