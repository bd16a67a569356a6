"""Figures 9 to 13: 2 kg on the right foot, in space, against the measured stride."""

from __future__ import annotations

from drakegait.gait import Gait
from drakegait.paper import charts, heavy_foot_planar, tables, verdict, worn_masses
from drakegait.paper.bases import WEIGHT
from drakegait.paper.chapter import Chapter, Studies
from drakegait.paper.claim import Claim
from drakegait.paper.heavy_foot import (
    LIFTS_LESS,
    SENSE,
    energy_and_deviation,
    measure_of,
    pair,
)  # fmt: skip
from drakegait.paper.numbers import Gaits, Numbers
from drakegait.study import GaitStudy

NORMAL, HEAVY = "spatial", "spatial 2 kg"
NODES = 18
_NOTICED = 0.5  # change of the trunk's tilt that can be noticed, root mean square [degree]
_PLANAR = (heavy_foot_planar.NORMAL, heavy_foot_planar.HEAVY)
_MEASURED = (worn_masses.BASE, worn_masses.HEAVY)  # in the plane, against the measured stride


def studies() -> Studies:
    """Both walks, against the embedded measured stride."""
    normal = GaitStudy.spatial(nodes=NODES)
    return {NORMAL: normal, HEAVY: normal.with_added_mass("foot_r", WEIGHT)}


def _both(gaits: Gaits) -> dict[str, Gait]:
    return {"no weight": gaits[NORMAL], "2 kg on the right foot": gaits[HEAVY]}


def _less(name: str, unit: str, digits: int = 1):
    """Text and verdict of: in space smaller than in the plane."""

    def text(n: Numbers) -> str:
        return (
            f"plane {n['planar: ' + name]:.{digits}f} ({n['measured: ' + name]:.{digits}f}), "
            f"space {n[name]:.{digits}f}{' ' if unit else ''}{unit}"
        )

    return text, lambda n: verdict.falls(n["planar: " + name], n[name], 0.05)


def _shared(n: Numbers) -> str:
    return (
        f"plane {n['planar: angles that share the change']:.1f} "
        f"({n['measured: angles that share the change']:.1f}) of {n['planar: angles']:.0f}, "
        f"space {n['angles that share the change']:.1f} of {n['angles']:.0f}"
    )


def _dorsiflexion(n: Numbers) -> str:
    text = "largest right dorsiflexion"
    over, swing = pair(text, "degrees")(n), pair(f"{text} in swing", "degrees")(n)
    return f"{over}; in swing {swing}"


_FLEXIONS = ("left knee flexion in left stance", "left dorsiflexion in left stance")


def _rise(n: Numbers, name: str) -> float:
    return n[f"{name} heavy"] - n[f"{name} normal"]


def _flexions(n: Numbers) -> str:
    return "; ".join(
        f"{name.split(' in ')[0]}: plane {_rise(n, 'planar: ' + name):+.1f}, space "
        f"{_rise(n, name):+.1f} degrees"
        for name in _FLEXIONS
    )


def _rise_less(n: Numbers) -> verdict.Verdict:
    rise = verdict.every(*(verdict.grows(0.0, _rise(n, name), SENSE) for name in _FLEXIONS))
    if rise is not verdict.Verdict.YES:
        return rise
    return verdict.every(
        *(verdict.grows(_rise(n, name), _rise(n, "planar: " + name), 0.0) for name in _FLEXIONS)
    )


def _share(n: Numbers, normal: str, heavy: str) -> float:
    return 100.0 * (n.energy(heavy) / n.energy(normal) - 1.0)


def _costs(n: Numbers) -> str:
    plane, space = _share(n, *_MEASURED), _share(n, NORMAL, HEAVY)
    return f"energy in the plane {plane:+.1f} %, in space {space:+.1f} %"


_REFERENCES = (
    "The planar pair of 4.2 follows a reference that its own model has made, the spatial pair a "
    "measured one. In brackets: the planar pair against the measured stride, which compares the "
    "models alone. Not robust: of three runs whose walks ended in optima up to 3 % apart, one said "
    "yes about reactions, and one about the spread."
)
_REACTIONS = _less("change of reactions", "% BW")
_SMALLER = _less("mean change of angles", "degrees")
_LEFT = _less("change of left excitations", "", 3)

CHAPTER = Chapter(
    name="heavy-foot-spatial",
    title="A heavy foot in space",
    place="4.3, figures 9 to 13",
    about="The three-dimensional walker with independent legs and 18 nodes, with and without 2 kg "
    "on the right foot; the reference is the embedded measured stride. Changes are compared with "
    "those of the planar walker (4.2).",
    studies=studies,
    warm={HEAVY: NORMAL},
    compares=(*_PLANAR, *_MEASURED),
    measures=(
        measure_of(NORMAL, HEAVY),
        measure_of(*_PLANAR, prefix="planar: "),
        measure_of(*_MEASURED, prefix="measured: "),
    ),
    claims=(
        *energy_and_deviation(
            NORMAL, HEAVY, "4.3", {"energy": (569.56, 631.14), "deviation": (3.06, 3.40)}
        ),
        LIFTS_LESS,
        Claim(
            "The largest right dorsiflexion rises",
            "4.3, figure 10", "", _dorsiflexion,
            lambda n: verdict.grows(n["largest right dorsiflexion normal"],
                                    n["largest right dorsiflexion heavy"], SENSE),
            "yes: over the stride, by more than 1 degree",
            "Ours is largest late in stance, which the weight hardly touches. The paper's figure "
            "may count plantarflexion as positive, as its Table 3 does; its maximum is then that "
            "of push-off.",
        ),
        Claim(
            "Tibialis anterior is excited more between 60 and 70 % of the stride",
            "4.3, figure 12", "", pair("tibialis anterior 60-70", "", 2),
            lambda n: verdict.grows(n["tibialis anterior 60-70 normal"],
                                    n["tibialis anterior 60-70 heavy"], 0.02),
            "yes: its largest excitation there grows by more than 0.02",
        ),
        Claim(
            "The weight shows in the trunk's pitch in the second half of the stride",
            "4.3, figure 9", "",
            lambda n: f"change in the first half {n['change of pitch, first half']:.2f}, in the "
            f"second {n['change of pitch, second half']:.2f} degrees (root mean square)",
            lambda n: verdict.every(
                verdict.rises(n["change of pitch, first half"],
                              n["change of pitch, second half"], 0.05),
                verdict.grows(0.0, n["change of pitch, second half"], _NOTICED)),
            "yes: root mean square change of tilt larger than in the first half by over 5 %, and "
            "above half a degree",
            "Ours keeps its trunk close to the reference.",
        ),
        Claim(
            "Left knee and ankle flexion rise, less than in the plane",
            "4.3, figure 9", "", _flexions, _rise_less,
            "yes: mean of both in left stance grows by more than 1 degree, and less than in the "
            "plane",
            "As in the plane, ours hardly changes its mean posture in left stance.",
        ),
        Claim(
            "Ground reactions change less than in the planar model",
            "4.3 and 5", "", *_REACTIONS,
            "yes: root mean square change of vertical and fore-aft forces smaller by over 5 %",
            _REFERENCES,
        ),
        Claim(
            "Left excitations change less than in the planar model",
            "4.3, figure 13", "", *_LEFT,
            "yes: root mean square change smaller by over 5 %",
            _REFERENCES + " In space more left muscles are there to change.",
        ),
        Claim(
            "Variations of the coordinates are smaller than in the plane",
            "5", "", *_SMALLER,
            "yes: root mean square change, mean of all angles, smaller by over 5 %",
        ),
        Claim(
            "The adaptation is spread over more coordinates",
            "4.3 and 5", "", _shared,
            lambda n: verdict.rises(n["planar: angles that share the change"],
                                    n["angles that share the change"], 0.05),
            "yes: (sum d^2)^2 / sum d^4 of the changes d of all angles is larger by over 5 %",
            _REFERENCES,
        ),
        Claim(
            "The planar model may still be used: it tells what a weight costs",
            "5", "", _costs,
            lambda n: verdict.every(
                verdict.rises(n.energy(_MEASURED[0]), n.energy(_MEASURED[1])),
                verdict.rises(n.energy(NORMAL), n.energy(HEAVY)),
                verdict.alike(_share(n, NORMAL, HEAVY), _share(n, *_MEASURED), 0.5)),
            "yes: against the measured stride, energy rises in both models, by shares that differ "
            "by no more than half of that in space",
        ),
    ),
    tables=lambda n: [tables.studies(n, [NORMAL, HEAVY, *_PLANAR, *_MEASURED])],
    figures={
        "Joint angles (figures 9, 10)": lambda gaits, _: charts.joint_angles(_both(gaits)),
        "Out of the sagittal plane": lambda gaits, _: charts.other_angles(_both(gaits)),
        "Trunk": lambda gaits, _: charts.trunk(_both(gaits)),
        "Ground reactions (figure 11)": lambda gaits, _: charts.ground_reactions(_both(gaits)),
        "Excitations (figures 12, 13)": lambda gaits, _: charts.excitations(_both(gaits)),
    },
)  # fmt: skip
