"""What the two chapters on the heavy foot have in common."""

from __future__ import annotations

from collections.abc import Mapping

from drakegait.gait import Gait
from drakegait.paper import measures, verdict
from drakegait.paper.claim import Claim, change
from drakegait.paper.numbers import Gaits, Numbers

SENSE = 1.0
"""Least change of an angle that counts [degree]."""
SILENT, SHARED = 0.1, 0.05
"""Excitations below which an antagonist counts as silent, above which two muscles co-contract."""
_CALF = ("soleus_r", "gastrocnemius_r")
FORCE = 0.5
"""Least change of a mean force that counts [% of body weight]."""


def measured(normal: Gait, heavy: Gait) -> dict[str, float]:
    """Everything that the claims of 4.2 and 4.3 are about."""
    found: dict[str, float] = {}
    for when, gait in (("normal", normal), ("heavy", heavy)):
        found |= {
            f"right foot lift {when}": measures.foot_lift(gait, "right"),
            f"right dorsiflexion phases 4-6 {when}": measures.mean_angle(
                gait, "ankle_dorsiflexion_r", (4, 5, 6)
            ),
            f"largest right dorsiflexion {when}": measures.largest_angle(
                gait, "ankle_dorsiflexion_r"
            ),
            f"largest right dorsiflexion in swing {when}": measures.largest_angle(
                gait, "ankle_dorsiflexion_r", (7, 8)
            ),
            f"left knee flexion in left stance {when}": measures.mean_angle(
                gait, "knee_flexion_l", (5, 6, 7, 8)
            ),
            f"left dorsiflexion in left stance {when}": measures.mean_angle(
                gait, "ankle_dorsiflexion_l", (5, 6, 7, 8)
            ),
            f"right excitation height {when}": measures.excitation_height(gait, "right"),
            f"right excitation width {when}": measures.excitation_width(gait, "right"),
            f"left excitation height {when}": measures.excitation_height(gait, "left"),
            f"right late stance force {when}": measures.late_stance_force(gait, "right"),
            f"tibialis anterior 60-70 {when}": measures.excitation_peak(
                gait, "tibialis_anterior_r", 60.0, 70.0
            ),
            f"calf at the peak of tibialis anterior {when}": measures.excitation_at_peak(
                gait, "tibialis_anterior_r", _CALF, 0.0, 100.0
            ),
            f"shared by tibialis anterior and calf {when}": measures.shared_excitation(
                gait, "tibialis_anterior_r", _CALF, 0.0, 20.0
            ),
            f"hamstrings at the late peak of rectus femoris {when}": measures.excitation_at_peak(
                gait, "rectus_femoris_r", ("hamstrings_r",), 60.0, 100.0
            ),
        }
    names = measures.angle_names(normal)
    changes = measures.angle_changes(normal, heavy, names)
    found |= {f"change of {name}": value for name, value in zip(names, changes, strict=True)}
    return found | {
        "angles": len(names),
        "mean change of angles": changes.mean(),
        "largest change of an angle": changes.max(),
        "angles that share the change": measures.spread(changes),
        "change of reactions": measures.reaction_change(normal, heavy),
        "change of left reactions": measures.reaction_change(normal, heavy, ["left"]),
        "change of right reactions": measures.reaction_change(normal, heavy, ["right"]),
        "change of pitch, first half": measures.angle_change(normal, heavy, "hat_tilt", 0.0, 50.0),
        "change of pitch, second half": measures.angle_change(
            normal, heavy, "hat_tilt", 50.0, 100.0
        ),
        "change of left excitations": measures.excitation_change(normal, heavy, "left"),
        "change of right excitations": measures.excitation_change(normal, heavy, "right"),
    }


def measure_of(normal: str, heavy: str, prefix: str = ""):
    """A measure of a pair of studies, its names preceded by `prefix`."""

    def measure(gaits: Gaits) -> dict[str, float]:
        found = measured(gaits[normal], gaits[heavy])
        return {prefix + name: value for name, value in found.items()}

    return measure


def pair(name: str, unit: str, digits: int = 1):
    """Text of a number of the normal and the heavy walk."""

    def text(n: Numbers) -> str:
        return change(n[f"{name} normal"], n[f"{name} heavy"], unit, digits)

    return text


def energy_and_deviation(
    normal: str, heavy: str, where: str, printed: Mapping[str, tuple[float, float]]
) -> tuple[Claim, Claim]:
    """The claims that energy and deviation rise."""
    e, d = printed["energy"], printed["deviation"]
    return (
        Claim(
            "The weight raises the metabolic cost of transport",
            where, change(*e, "J/m", 2),
            lambda n: change(n.energy(normal), n.energy(heavy), "J/m"),
            lambda n: verdict.rises(n.energy(normal), n.energy(heavy)),
            "yes: by more than 1 %",
            "Another subject, speed and reference; the paper's splines have fewer freedoms.",
        ),
        Claim(
            "The weight raises the deviation from the reference",
            where, change(*d, "", 2),
            lambda n: change(n.deviation(normal), n.deviation(heavy), "s", 3),
            lambda n: verdict.rises(n.deviation(normal), n.deviation(heavy)),
            "yes: by more than 1 %",
            "J_dev of another reference is not comparable in number.",
        ),
    )  # fmt: skip


LIFTS_LESS = Claim(
    "The heavy right foot is lifted less",
    "4.2 and 4.3", "",
    pair("right foot lift", "mm"),
    lambda n: verdict.grows(n["right foot lift heavy"], n["right foot lift normal"], 1.0),
    "yes: the highest point of the middle of the foot falls by more than 1 mm",
    "The paper gives a curve and no number. Where our foot is lifted as high as before, we know no "
    "reason for certain; the muscles that lift it pay instead. A change of 1 mm is at the edge of "
    "what counts.",
)  # fmt: skip
