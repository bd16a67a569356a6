"""Muscles that are weak, short or never silent."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from drakegait.errors import InvalidInput
from drakegait.quantities import check_number
from drakegait.walker import coordinates
from drakegait.walker.disorders.base import (
    SIDE_WORDS,
    Band,
    Disorder,
    check_side,
)
from drakegait.walker.muscles import STRENGTH_LIMITS, MuscleSet

# Passive tension f_max (exp(k (x - 1) / strain) - 1) / (exp(k) - 1) of Thelen (2003) for young
# adults, x = length / length at which it begins.
_SHAPE, _STRAIN = 5.0, 0.6
# In normal walking healthy fibres are stretched to this many of those lengths (our estimate: the
# triceps surae then pulls with 3 % of f_max at the end of stance).
_NORMAL_STRETCH = 1.2
# Six instants of normal walking [degrees]: hip flexion, knee flexion, ankle dorsiflexion; rounded
# from the embedded reference. The longest path of a muscle among them is its normal stretch.
_POSTURES = ((27, 6, 0), (5, 12, 8), (-14, 10, 14), (-10, 40, -18), (18, 60, -2), (28, 12, 3))


@dataclass(frozen=True)
class _OfMuscle(Disorder):
    """A disorder of one muscle group.

    Attributes:
        muscle: name of the group without side (`"soleus"`) or the paper's (`"SOL"`).
        side: `"r"`, `"l"` or `"both"`.
    """

    muscle: str
    side: str

    def __post_init__(self) -> None:
        check_side(self.side)

    @property
    def target(self) -> tuple[str, ...]:
        return (self.muscle,)

    @property
    def _who(self) -> str:
        where = "on both sides" if self.side == "both" else SIDE_WORDS[self.side]
        return f"{self.muscle.replace('_', ' ')} {where}"

    def named_muscles(self, muscles: MuscleSet) -> list[int]:
        return [i for side in self.sides for i in muscles.find(self.muscle, side)]


@dataclass(frozen=True)
class Weakness(_OfMuscle):
    """A muscle that has lost strength: its largest force is `strength` times the normal.

    The factor acts on f_max, which is the physiological cross-section times a specific tension;
    fibres and tendon keep their lengths, the muscle's mass follows its force (atrophy), and with
    it its heat. Weakness as a scaled maximal isometric force is the usual model, for example in
    van der Krogt, Delp & Schwartz (2012), Gait & Posture 36, 113-119. More than normal strength:
    `GaitStudy(strength=...)`.

    Attributes:
        strength: share of the force that is left, 0.01 to 1 [-].
    """

    kind: ClassVar[str] = "weakness"
    units: ClassVar[Mapping[str, str]] = {"strength": "-"}
    strength: float = 0.5

    def __post_init__(self) -> None:
        super().__post_init__()
        name = f"strength left in a weak {self.muscle}"
        check_number(name, self.strength, STRENGTH_LIMITS[0], 1.0, "-")

    def describe(self) -> str:
        return f"{self._who} with {100.0 * self.strength:.3g} % of its strength"

    def changed_muscles(self, muscles: MuscleSet) -> MuscleSet:
        f_max = muscles.f_max.copy()
        f_max[self.named_muscles(muscles)] *= self.strength
        return dataclasses.replace(muscles, f_max=f_max)


@dataclass(frozen=True)
class Contracture(_OfMuscle):
    """A muscle whose fibres have become short: it is taut in postures where others are slack.

    Two things follow, as in simulations of contracture by Delp, Statler & Carroll (1995), J.
    Orthop. Res. 13, 96-104. The optimal fibre length is `length` times the normal, so that active
    force is largest in more flexed postures (f_max and the tendon stay; the muscle's mass becomes
    less). And passive tension begins earlier: along the path it follows the exponential of Thelen
    (2003), J. Biomech. Eng. 125, 70-77,

        f = f_max (exp(5 (x - 1) / 0.6) - 1) / (exp(5) - 1),   x = fibres / (length * onset).

    The onset is NOT tied to the table's optimal lengths, of which walking uses 0.8 in soleus and
    1.8 in adductor magnus, but to normal walking: healthy fibres reach 1.2 onsets in the longest
    posture of a normal stride (our estimate). Only the *excess* over the healthy tension is added,
    to the passive joint moments, since those already hold that of a healthy muscle; the tendon
    counts as rigid in it, and its metabolic cost is none.

    Attributes:
        length: length of the fibres relative to normal, 0.5 to 1 [-].
    """

    kind: ClassVar[str] = "contracture"
    units: ClassVar[Mapping[str, str]] = {"length": "-"}
    length: float = 0.9

    def __post_init__(self) -> None:
        super().__post_init__()
        check_number(f"fibre length of a short {self.muscle}", self.length, 0.5, 1.0, "-")

    def describe(self) -> str:
        return f"{self._who} shortened to {100.0 * self.length:.3g} %"

    def changed_muscles(self, muscles: MuscleSet) -> MuscleSet:
        l_opt = muscles.l_opt.copy()
        l_opt[self.named_muscles(muscles)] *= self.length
        return dataclasses.replace(muscles, l_opt=l_opt)

    def bands(self, muscles: MuscleSet) -> tuple[Band, ...]:
        found = []
        for i in self.named_muscles(muscles):
            slack = muscles.l_slack[i]
            onset = (_longest_path(muscles, i) - slack) / _NORMAL_STRETCH
            for share, sign in ((self.length, 1.0), (1.0, -1.0)):
                rate = _SHAPE / _STRAIN / (share * onset)
                offset = -_SHAPE / _STRAIN - rate * slack
                tension = sign * muscles.f_max[i] / math.expm1(_SHAPE)
                found.append(Band(muscles.names[i], tension, offset, rate))
        return tuple(found) if self.length < 1.0 else ()


@dataclass(frozen=True)
class Spasticity(_OfMuscle):
    """A muscle that cannot be switched off: its excitation is never below `excitation`.

    A constant floor of the excitation stands for overactivity through the whole stride, of
    whatever origin. The stretch reflex that defines spasticity (Lance 1980: a velocity-dependent
    increase of tonic stretch reflexes) is not modelled; that needs delayed feedback, as in van der
    Krogt, Bar-On, Kindt, Desloovere & Harlaar (2016), J. NeuroEng. Rehabil. 13, 64.

    Attributes:
        excitation: smallest excitation, 0 to 0.5 [-].
    """

    kind: ClassVar[str] = "spasticity"
    units: ClassVar[Mapping[str, str]] = {"excitation": "-"}
    excitation: float = 0.1

    def __post_init__(self) -> None:
        super().__post_init__()
        name = f"smallest excitation of a spastic {self.muscle}"
        check_number(name, self.excitation, 0.0, 0.5, "-")

    def describe(self) -> str:
        return f"{self._who} excited to {100.0 * self.excitation:.3g} % at least"

    def lowest_excitation(self, muscles: MuscleSet) -> np.ndarray:
        lowest = np.zeros(muscles.num_muscles)
        lowest[self.named_muscles(muscles)] = self.excitation
        return lowest


def _longest_path(muscles: MuscleSet, which: int) -> float:
    """Longest path [m] of a muscle in normal walking."""
    side = muscles.names[which][-1]
    joints = [f"{name}_{side}" for name in ("hip_flexion", "knee_flexion", "ankle_dorsiflexion")]
    q = np.zeros((len(_POSTURES), muscles.moment_arms.shape[1]))
    q[:, coordinates.positions(muscles.kind, joints)] = np.radians(_POSTURES)
    lengths = muscles.lengths(coordinates.to_plant(muscles.kind, q))[:, which]
    longest = float(lengths.max())
    if not longest > muscles.l_slack[which]:
        name = muscles.names[which]
        raise InvalidInput("muscle of a contracture", name, "one whose fibres have a length")
    return longest
