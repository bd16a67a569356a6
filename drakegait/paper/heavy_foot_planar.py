"""Figures 6 to 8: 2 kg on the right foot, in the plane, against a symmetric reference."""

from __future__ import annotations

from drakegait.gait import Gait
from drakegait.paper import charts, tables, verdict
from drakegait.paper.bases import WEIGHT
from drakegait.paper.chapter import Chapter, Studies
from drakegait.paper.claim import Claim
from drakegait.paper.convergence import FINEST
from drakegait.paper.heavy_foot import (
    FORCE,
    LIFTS_LESS,
    SENSE,
    SHARED,
    SILENT,
    energy_and_deviation,
    measure_of,
    pair,
)  # fmt: skip
from drakegait.paper.numbers import Gaits, Numbers
from drakegait.paper.own_reference import reference_of
from drakegait.study import GaitStudy

NORMAL, HEAVY = "planar", "planar 2 kg"
NODES = 18
_SIMILAR = 5.0  # change of a force that counts as quite similar, root mean square [% BW]
_WALKS = ("normal", "heavy")


def studies(symmetric: Gait) -> Studies:
    """Both walks; the reference is the symmetric gait with 35 nodes."""
    normal = GaitStudy.planar(nodes=NODES, reference=reference_of(symmetric, FINEST))
    return {NORMAL: normal, HEAVY: normal.with_added_mass("foot_r", WEIGHT)}


def _both(gaits: Gaits) -> dict[str, Gait]:
    return {"no weight": gaits[NORMAL], "2 kg on the right foot": gaits[HEAVY]}


def _adapts(n: Numbers) -> str:
    knee, ankle = n["change of knee_flexion_l"], n["change of ankle_dorsiflexion_l"]
    return f"knee {knee:.1f}, ankle {ankle:.1f} degrees (root mean square)"


CHAPTER = Chapter(
    name="heavy-foot-planar",
    title="A heavy foot in the plane",
    place="4.2, figures 6 to 8",
    about="The planar walker with independent legs and 18 nodes, with and without 2 kg on the "
    "right foot. The reference is the symmetric gait with 35 nodes, which cannot bring asymmetry. "
    "Each walk starts from the usual guess or from the unweighted one.",
    studies=studies,
    after=(FINEST,),
    names=(NORMAL, HEAVY),
    warm={HEAVY: NORMAL},
    measures=(measure_of(NORMAL, HEAVY),),
    claims=(
        *energy_and_deviation(
            NORMAL, HEAVY, "4.2", {"energy": (374.94, 418.49), "deviation": (2.11, 3.07)}
        ),
        LIFTS_LESS,
        Claim(
            "Right ankle dorsiflexion in phases 4 to 6 rises",
            "4.2, figure 6", "",
            pair("right dorsiflexion phases 4-6", "degrees"),
            lambda n: verdict.grows(n["right dorsiflexion phases 4-6 normal"],
                                    n["right dorsiflexion phases 4-6 heavy"], SENSE),
            "yes: its mean over these phases grows by more than 1 degree",
        ),
        Claim(
            "The left knee and ankle adapt",
            "4.2, figure 6", "", _adapts,
            lambda n: verdict.every(*(
                verdict.grows(0.0, n[f"change of {name}_l"], SENSE)
                for name in ("knee_flexion", "ankle_dorsiflexion"))),
            "yes: both change by more than 1 degree (root mean square over the stride)",
            "Not robust: of three runs whose walks ended in optima up to 3 % apart, the ankle "
            "changed by more than 1 degree in one only.",
        ),
        Claim(
            "The left knee is extended in left stance",
            "4.2, figure 6", "",
            pair("left knee flexion in left stance", "degrees"),
            lambda n: verdict.grows(n["left knee flexion in left stance heavy"],
                                    n["left knee flexion in left stance normal"], SENSE),
            "yes: mean flexion in left stance falls by more than 1 degree",
            "Ours hardly changes its mean posture in left stance; it keeps close to its reference. "
            "We know no reason for certain.",
        ),
        Claim(
            "Left ankle flexion grows in left stance",
            "4.2, figure 6", "",
            pair("left dorsiflexion in left stance", "degrees"),
            lambda n: verdict.grows(n["left dorsiflexion in left stance normal"],
                                    n["left dorsiflexion in left stance heavy"], SENSE),
            "yes: mean dorsiflexion in left stance grows by more than 1 degree",
            "Ours hardly changes its mean posture in left stance; it keeps close to its reference. "
            "We know no reason for certain.",
        ),
        Claim(
            "Right muscles work wider",
            "4.2, figure 8", "", pair("right excitation width", "% of the stride"),
            lambda n: verdict.rises(n["right excitation width normal"],
                                    n["right excitation width heavy"]),
            "yes: time with an excitation above 0.1, mean of the right muscles, grows by over 1 %",
        ),
        Claim(
            "Right muscles work higher",
            "4.2, figure 8", "", pair("right excitation height", "", 3),
            lambda n: verdict.rises(n["right excitation height normal"],
                                    n["right excitation height heavy"]),
            "yes: largest excitation, mean of the right muscles, grows by over 1 %",
        ),
        Claim(
            "The right normal force rises at the end of right stance",
            "4.2, figure 7", "", pair("right late stance force", "% BW"),
            lambda n: verdict.grows(n["right late stance force normal"],
                                    n["right late stance force heavy"], FORCE),
            "yes: its mean over the last quarter of stance grows by more than 0.5 % of body weight",
        ),
        Claim(
            "Left contact forces stay quite similar",
            "4.2, figure 7", "",
            lambda n: f"change on the left {n['change of left reactions']:.1f}, on the right "
            f"{n['change of right reactions']:.1f} % BW (root mean square)",
            lambda n: verdict.every(
                verdict.falls(n["change of right reactions"], n["change of left reactions"], 0.05),
                verdict.below(n["change of left reactions"], _SIMILAR)),
            "yes: root mean square change of vertical and fore-aft force below 5 % of body weight, "
            "and smaller than on the right by over 5 %",
            "They stay similar; so do those of the right foot but for the end of its stance.",
        ),
        Claim(
            "In the first 20 % tibialis anterior and the calf co-contract",
            "4.2, figure 8", "", pair("shared by tibialis anterior and calf", "", 3),
            lambda n: verdict.every(*(
                verdict.grows(0.0, n[f"shared by tibialis anterior and calf {when}"], SHARED)
                for when in _WALKS)),
            "yes: in both walks TA and SOL or GAS are excited above 0.05 at the same time",
        ),
        Claim(
            "At the peak of tibialis anterior soleus and gastrocnemius are silent",
            "4.2, figure 8", "", pair("calf at the peak of tibialis anterior", "", 3),
            lambda n: verdict.every(*(
                verdict.below(n[f"calf at the peak of tibialis anterior {when}"], SILENT)
                for when in _WALKS)),
            "yes: in both walks both are excited below 0.1 when TA is excited most",
        ),
        Claim(
            "With the weight, hamstrings are silent at the late peak of rectus femoris",
            "4.2, figure 8", "", pair("hamstrings at the late peak of rectus femoris", "", 3),
            lambda n: verdict.below(n["hamstrings at the late peak of rectus femoris heavy"],
                                    SILENT),
            "yes: excited below 0.1 when RF is excited most in the last 40 % of the stride",
        ),
    ),
    tables=lambda n: [tables.studies(n, [FINEST, NORMAL, HEAVY])],
    figures={
        "Joint angles (figure 6)": lambda gaits, _: charts.joint_angles(_both(gaits)),
        "Ground reactions (figure 7)": lambda gaits, _: charts.ground_reactions(_both(gaits)),
        "Excitations (figure 8)": lambda gaits, _: charts.excitations(_both(gaits)),
    },
)  # fmt: skip
