"""Legs of different length, and legs that end below the knee."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from drakegait.errors import InvalidInput, UnknownName
from drakegait.quantities import check_number
from drakegait.walker import coordinates
from drakegait.walker.disorders.base import SIDE_WORDS, Disorder, check_side
from drakegait.walker.joint_springs import JointSpring
from drakegait.walker.muscles import MuscleSet
from drakegait.walker.segment_edits import LengthEdit, MassEdit, SegmentEdit

CATEGORIES = tuple(range(1, 10))
"""Stiffness categories of prosthetic feet."""
_MIDDLE, _STIFFNESS, _STEP = 4, 290.0, 1.12  # category, its forefoot [N m/rad], factor of a step
_HEEL = 0.5  # stiffness of the heel relative to the forefoot
_DAMPING = 1.0  # [N m s/rad]


@dataclass(frozen=True)
class LegLength(Disorder):
    """A thigh or shank that is longer or shorter than the other one.

    The joint at its far end moves by `change` along the segment; its mass stays, its mass centre
    keeps its share of the length, its transverse moments of inertia go with the square of the
    length. Moment arms, path lengths and l_0 of the muscles do not change: in this model a
    muscle's path depends on joint angles only, so that the muscles count as grown along. A leg
    difference of 20 mm and more is usually called relevant for gait (Kaufman, Miller & Sutherland
    1996, J. Pediatr. Orthop. 16, 144-150).

    Attributes:
        segment: `"thigh"` or `"shank"`.
        side: `"r"`, `"l"` or `"both"`.
        change: -0.08 to 0.08 [m].
    """

    kind: ClassVar[str] = "leg_length"
    units: ClassVar[Mapping[str, str]] = {"change": "m"}
    segment: str
    side: str
    change: float

    def __post_init__(self) -> None:
        if self.segment not in ("thigh", "shank"):
            raise UnknownName("segment of another length", self.segment, ("thigh", "shank"))
        check_side(self.side)
        check_number(f"change of length of {self.segment}", self.change, -0.08, 0.08, "m")

    @property
    def target(self) -> tuple[str, ...]:
        return (self.segment,)

    def describe(self) -> str:
        word = "longer" if self.change >= 0.0 else "shorter"
        where = "both sides" if self.side == "both" else SIDE_WORDS[self.side]
        return f"{self.segment} {where} {1e3 * abs(self.change):g} mm {word}"

    def segment_edits(self) -> tuple[SegmentEdit, ...]:
        if self.change == 0.0:
            return ()
        return tuple(LengthEdit(f"{self.segment}_{side}", self.change) for side in self.sides)


@dataclass(frozen=True)
class Prosthesis(Disorder):
    """A transtibial prosthesis with a passive foot.

    Every muscle that spans the ankle is gone on that side: gastrocnemius as a whole, since its
    attachment beyond the knee is. So are the ligaments of the ankle and their coupling to the
    knee. Shank and foot have the mass of stump, socket, pylon and prosthetic foot. The ankle is a
    spring with a damper,

        M = -[heel or forefoot stiffness] (dorsiflexion - alignment) - damping (rate),

    the heel's below and the forefoot's above the angle of alignment. One hinge at the place of
    the ankle stands for all bending of the foot, and heel and toe are where they were; Hansen,
    Childress, Miff, Gard & Mesplay (2004), J. Biomech. 37, 1467-1474 show how a spring at the ankle
    comes near to the moment-angle curve of level walking.

    Manufacturers sell feet in stiffness categories by body mass and activity and rarely publish
    stiffness; measured stiffness rises with the category, but unevenly (Turner et al. 2022, PLoS
    ONE 17, e0268136). Here category 4 has 290 N m/rad (5.1 N m/degree, about the quasi-stiffness of
    a natural ankle: Shamaei, Sawicki & Dollar 2013, PLoS ONE 8, e59935), each further one is 12 %
    stiffer, heels have half of the forefoot's stiffness and the damping is 1 N m s/rad: all OUR
    ESTIMATES, as are the masses. Prostheses weigh less than the limb they replace (Mattes, Martin &
    Royer 2000, Arch. Phys. Med. Rehabil. 81, 561-568).

    Attributes:
        side: `"r"`, `"l"` or `"both"`.
        category: stiffness category, 1 (soft) to 9 (stiff).
        alignment: dorsiflexion without moment, -10 to 10 [degrees].
        stiffness: of the forefoot, in place of the category's, 50 to 1000 [N m/rad].
        shank_mass: mass of stump, socket and pylon relative to the natural shank [-].
        shank_centre: distance of their mass centre from the knee, likewise [-].
        foot_mass: mass of the prosthetic foot relative to the natural one [-].
    """

    kind: ClassVar[str] = "prosthesis"
    units: ClassVar[Mapping[str, str]] = {
        "alignment": "degrees",
        "stiffness": "N m/rad",
        "shank_mass": "-",
        "shank_centre": "-",
        "foot_mass": "-",
    }
    side: str
    category: int = _MIDDLE
    alignment: float = 0.0
    stiffness: float | None = None
    shank_mass: float = 0.65
    shank_centre: float = 0.8
    foot_mass: float = 0.6

    def __post_init__(self) -> None:
        check_side(self.side)
        if isinstance(self.category, bool) or self.category not in CATEGORIES:
            allowed = f"a whole number from {CATEGORIES[0]} (soft) to {CATEGORIES[-1]} (stiff)"
            raise InvalidInput("category of the prosthesis", self.category, allowed)
        check_number("alignment of the prosthesis", self.alignment, -10.0, 10.0, "degrees")
        if self.stiffness is not None:
            name = "stiffness of the prosthesis"
            check_number(name, self.stiffness, 50.0, 1000.0, "N m/rad")
        for name in ("shank_mass", "shank_centre", "foot_mass"):
            words = f"{name.replace('_', ' ')} with a prosthesis"
            check_number(words, getattr(self, name), 0.3, 1.5, "-")

    @property
    def forefoot_stiffness(self) -> float:
        """[N m/rad]."""
        if self.stiffness is not None:
            return self.stiffness
        return _STIFFNESS * _STEP ** (self.category - _MIDDLE)

    @property
    def numbers(self) -> dict[str, float]:
        return {**super().numbers, "stiffness": self.forefoot_stiffness}

    def describe(self) -> str:
        where = "on both sides" if self.side == "both" else SIDE_WORDS[self.side]
        return (
            f"transtibial prosthesis {where}, category {self.category} "
            f"({self.forefoot_stiffness:.0f} N m/rad)"
        )

    def removed_muscles(self, muscles: MuscleSet) -> np.ndarray:
        """Mask (num_muscles,) of the muscles that span an ankle which is not there."""
        ankles = coordinates.positions(muscles.kind, self.bare_joints())
        return np.any(muscles.moment_arms[:, ankles] != 0.0, axis=1)

    def changed_muscles(self, muscles: MuscleSet) -> MuscleSet:
        return muscles.without(self.removed_muscles(muscles))

    def bare_joints(self) -> tuple[str, ...]:
        return tuple(f"ankle_dorsiflexion_{side}" for side in self.sides)

    def springs(self) -> tuple[JointSpring, ...]:
        above, neutral = self.forefoot_stiffness, math.radians(self.alignment)
        return tuple(
            JointSpring(name, _HEEL * above, above, neutral, _DAMPING)
            for name in self.bare_joints()
        )

    def segment_edits(self) -> tuple[SegmentEdit, ...]:
        return tuple(
            edit
            for side in self.sides
            for edit in (
                MassEdit(f"shank_{side}", self.shank_mass, self.shank_centre),
                MassEdit(f"foot_{side}", self.foot_mass),
            )
        )
