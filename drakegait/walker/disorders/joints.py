"""Joints that are stiff, damped, or move in a smaller range; orthoses."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar

from drakegait.errors import InvalidInput
from drakegait.quantities import check_number
from drakegait.walker.disorders.base import (
    SIDE_WORDS,
    Disorder,
    check_side,
    full_joint,
)
from drakegait.walker.joint_springs import JointSpring
from drakegait.walker.subject import AddedMass

_MOST_STIFFNESS = 1000.0  # [N m/rad]


@dataclass(frozen=True)
class _OfJoint(Disorder):
    """A disorder of one joint angle.

    Attributes:
        joint: `"hip_flexion"`, `"hip_adduction"`, `"hip_rotation"`, `"knee_flexion"` or
            `"ankle_dorsiflexion"`, in short `"hip"`, `"knee"`, `"ankle"`.
        side: `"r"`, `"l"` or `"both"`.
    """

    joint: str
    side: str

    def __post_init__(self) -> None:
        object.__setattr__(self, "joint", full_joint(self.joint))
        check_side(self.side)

    @property
    def target(self) -> tuple[str, ...]:
        return (self.joint,)

    def named_joints(self) -> tuple[str, ...]:
        return tuple(f"{self.joint}_{side}" for side in self.sides)

    @property
    def _who(self) -> str:
        where = "on both sides" if self.side == "both" else SIDE_WORDS[self.side]
        return f"{self.joint.replace('_', ' ')} {where}"


@dataclass(frozen=True)
class JointStiffness(_OfJoint):
    """A joint with a linear spring and a linear damper in addition to its normal structures.

        M = -stiffness (angle - neutral) - damping (angular velocity)

    It stands for arthrosis, scar tissue or a brace. The passive moments of the healthy joint
    (Riener & Edrich 1999) stay.

    Attributes:
        stiffness: 0 to 1000 [N m/rad]; 1 N m/degree is 57.3 N m/rad.
        neutral: angle without moment, anatomical sense [degrees].
        damping: 0 to 50 [N m s/rad].
    """

    kind: ClassVar[str] = "stiffness"
    units: ClassVar[Mapping[str, str]] = {
        "stiffness": "N m/rad",
        "neutral": "degrees",
        "damping": "N m s/rad",
    }
    stiffness: float = 0.0
    neutral: float = 0.0
    damping: float = 0.0

    def __post_init__(self) -> None:
        super().__post_init__()
        check_number(f"stiffness of {self.joint}", self.stiffness, 0.0, _MOST_STIFFNESS,
                     "N m/rad")  # fmt: skip
        check_number(f"neutral angle of {self.joint}", self.neutral, -60.0, 120.0, "degrees")
        check_number(f"damping of {self.joint}", self.damping, 0.0, 50.0, "N m s/rad")

    def describe(self) -> str:
        damper = f" and {self.damping:g} N m s/rad" if self.damping else ""
        return (
            f"{self._who} stiffened by {self.stiffness:g} N m/rad{damper} "
            f"about {self.neutral:g} degrees"
        )

    def springs(self) -> tuple[JointSpring, ...]:
        if self.stiffness == self.damping == 0.0:
            return ()
        neutral = math.radians(self.neutral)
        return tuple(
            JointSpring(name, self.stiffness, self.stiffness, neutral, self.damping)
            for name in self.named_joints()
        )


@dataclass(frozen=True)
class LimitedRange(_OfJoint):
    """A joint that the walker keeps within a range: a limit of the movement, not a spring.

    It becomes rows of the program at every control point, like `GaitStudy.with_limit`. A joint
    that pushes back at its end is better described by `Contracture` or `JointStiffness`.

    Attributes:
        low, high: range in anatomical sense [degrees]; infinite where open.
    """

    kind: ClassVar[str] = "range"
    units: ClassVar[Mapping[str, str]] = {"low": "degrees", "high": "degrees"}
    low: float = -math.inf
    high: float = math.inf

    def __post_init__(self) -> None:
        super().__post_init__()
        number = all(
            isinstance(end, (int, float)) and not isinstance(end, bool) and not math.isnan(end)
            for end in (self.low, self.high)
        )
        if not number or not self.low < self.high:
            allowed = "two numbers in degrees, low < high"
            raise InvalidInput(f"range of {self.joint}", (self.low, self.high), allowed)
        if math.isinf(self.low) and math.isinf(self.high):
            raise InvalidInput(f"range of {self.joint}", (self.low, self.high), "closed at one end")

    def describe(self) -> str:
        return f"{self._who} from {self.low:g} to {self.high:g} degrees"

    def limits(self) -> tuple[tuple[str, float, float], ...]:
        low, high = math.radians(self.low), math.radians(self.high)
        return tuple((name, low, high) for name in self.named_joints())


@dataclass(frozen=True)
class Orthosis(Disorder):
    """An ankle-foot orthosis: a spring at the ankle, and its weight.

        M = -stiffness (dorsiflexion - neutral) - damping (rate)

    with `plantar_stiffness` in place of `stiffness` below the neutral angle, where one differs:
    0 for a dorsal leaf that only resists dorsiflexion. Orthoses as rotational springs, and
    energy cost against their stiffness: Bregman, van der Krogt, de Groot, Harlaar, Wisse & Collins
    (2011), Clin. Biomech. 26, 955-961; Waterval et al. (2023), J. NeuroEng. Rehabil. 20 simulate
    0.9 to 8.7 N m/degree, which is 50 to 500 N m/rad.

    Attributes:
        side: `"r"`, `"l"` or `"both"`.
        stiffness: against dorsiflexion beyond the neutral angle, 0 to 1000 [N m/rad].
        neutral: dorsiflexion without moment, -30 to 30 [degrees].
        plantar_stiffness: against plantarflexion, default `stiffness` [N m/rad].
        damping: 0 to 10 [N m s/rad].
        mass: of the orthosis, 0 to 2 [kg]; half of it on the shank, half on the foot, each at the
            segment's mass centre.
    """

    kind: ClassVar[str] = "orthosis"
    units: ClassVar[Mapping[str, str]] = {
        "stiffness": "N m/rad",
        "neutral": "degrees",
        "plantar_stiffness": "N m/rad",
        "damping": "N m s/rad",
        "mass": "kg",
    }
    side: str
    stiffness: float
    neutral: float = 0.0
    plantar_stiffness: float | None = None
    damping: float = 0.0
    mass: float = 0.0

    def __post_init__(self) -> None:
        check_side(self.side)
        most, unit = _MOST_STIFFNESS, "N m/rad"
        check_number("stiffness of the orthosis", self.stiffness, 0.0, most, unit)
        if self.plantar_stiffness is not None:
            name = "plantar stiffness of the orthosis"
            check_number(name, self.plantar_stiffness, 0.0, most, unit)
        check_number("neutral angle of the orthosis", self.neutral, -30.0, 30.0, "degrees")
        check_number("damping of the orthosis", self.damping, 0.0, 10.0, "N m s/rad")
        check_number("mass of the orthosis", self.mass, 0.0, 2.0, "kg")

    def describe(self) -> str:
        where = "on both ankles" if self.side == "both" else f"on the {SIDE_WORDS[self.side]} ankle"
        return f"orthosis {where}, {self.stiffness:g} N m/rad about {self.neutral:g} degrees"

    def named_joints(self) -> tuple[str, ...]:
        return tuple(f"ankle_dorsiflexion_{side}" for side in self.sides)

    def springs(self) -> tuple[JointSpring, ...]:
        below = self.stiffness if self.plantar_stiffness is None else self.plantar_stiffness
        if self.stiffness == below == self.damping == 0.0:
            return ()
        neutral = math.radians(self.neutral)
        return tuple(
            JointSpring(name, below, self.stiffness, neutral, self.damping)
            for name in self.named_joints()
        )

    def added_masses(self) -> tuple[AddedMass, ...]:
        if self.mass == 0.0:
            return ()
        return tuple(
            AddedMass(f"{segment}_{side}", 0.5 * self.mass)
            for side in self.sides
            for segment in ("shank", "foot")
        )
