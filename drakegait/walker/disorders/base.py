"""What every disorder has in common: sides, words, and the parts of a walker that it may change."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass, fields, replace
from typing import Any, ClassVar

import numpy as np

from drakegait.errors import UnknownName
from drakegait.quantities import plain
from drakegait.walker.joint_springs import JointSpring
from drakegait.walker.muscles import MuscleSet
from drakegait.walker.segment_edits import SegmentEdit
from drakegait.walker.subject import AddedMass

SIDES = ("r", "l", "both")
SIDE_WORDS = {"r": "right", "l": "left", "both": "both"}
OTHER = {"r": "l", "l": "r", "both": "both"}
JOINTS = ("hip_flexion", "hip_adduction", "hip_rotation", "knee_flexion", "ankle_dorsiflexion")
"""Joint angles without side, each named by its positive sense."""
_SHORT = {"hip": "hip_flexion", "knee": "knee_flexion", "ankle": "ankle_dorsiflexion"}


@dataclass(frozen=True)
class Band:
    """Passive tension along a muscle's path.

    Attributes:
        muscle: name with side; its path length l = l0 - A q is that of the tension.
        tension: factor on the exponential [N], negative for one that is taken away.
        offset, rate: tension exp(offset + rate l), rate in [1/m].
    """

    muscle: str
    tension: float
    offset: float
    rate: float


class Disorder(ABC):
    """One thing in which a walker differs. Derived classes are frozen dataclasses.

    Most have a `side`: `"r"`, `"l"` or `"both"`.

    Angles are in degrees and in anatomical signs, like all that a user types; stiffness is in
    N m/rad, damping in N m s/rad, lengths in m. What a disorder does not change it leaves to
    these defaults.

    Attributes:
        kind: name in files.
        units: of the numbers that may differ by a little, by their names.
    """

    kind: ClassVar[str]
    units: ClassVar[Mapping[str, str]] = {}

    @abstractmethod
    def describe(self) -> str:
        """A few words for the sentence that says who walks."""

    @property
    def target(self) -> tuple[str, ...]:
        """What it acts on, without side; two of one kind cannot share target and side."""
        return ()

    @property
    def sides(self) -> tuple[str, ...]:
        """The sides it acts on, of `"r"` and `"l"`."""
        side = getattr(self, "side", "both")
        return ("r", "l") if side == "both" else (side,)

    @property
    def numbers(self) -> dict[str, float]:
        """Values of the numbers that may differ by a little; without those that are left open."""
        stated = {name: getattr(self, name) for name in self.units}
        return {
            name: float(value)
            for name, value in stated.items()
            if value is not None and math.isfinite(value)
        }

    def mirrored(self) -> Disorder:
        """The same on the other side of the body."""
        return replace(self, side=OTHER[self.side])  # type: ignore[type-var, attr-defined]

    # What it changes. -------------------------------------------------------------------------

    def changed_muscles(self, muscles: MuscleSet) -> MuscleSet:
        """Other constants of muscles, or fewer of them."""
        return muscles

    def bands(self, muscles: MuscleSet) -> tuple[Band, ...]:
        """Passive tension along paths; `muscles` are those of the unchanged subject."""
        return ()

    def springs(self) -> tuple[JointSpring, ...]:
        """Springs and dampers at joints."""
        return ()

    def bare_joints(self) -> tuple[str, ...]:
        """Joints without any passive structure of the body."""
        return ()

    def segment_edits(self) -> tuple[SegmentEdit, ...]:
        """Other lengths and masses of segments."""
        return ()

    def added_masses(self) -> tuple[AddedMass, ...]:
        """Point masses."""
        return ()

    def limits(self) -> tuple[tuple[str, float, float], ...]:
        """Ranges of coordinates: name, lowest and highest, anatomical sign [rad]."""
        return ()

    def lowest_excitation(self, muscles: MuscleSet) -> np.ndarray | None:
        """Excitations below which muscles cannot go (num_muscles,), None for all zero."""
        return None

    def named_muscles(self, muscles: MuscleSet) -> list[int]:
        """Positions of the muscles that it is about."""
        return []

    def named_joints(self) -> tuple[str, ...]:
        """Names with side of the joint angles that it is about."""
        return ()


def to_plain(disorder: Disorder) -> dict[str, Any]:
    """As plain types that JSON can hold."""
    values = {item.name: plain(getattr(disorder, item.name)) for item in fields(disorder)}  # type: ignore[arg-type]
    return {"kind": disorder.kind, **values}


# Validation -------------------------------------------------------------------------------------


def check_side(side: str) -> None:
    """Refuse anything but `"r"`, `"l"` and `"both"`."""
    if side not in SIDES:
        raise UnknownName("side", side, SIDES)


def full_joint(joint: str) -> str:
    """The full name of a joint angle; `hip`, `knee` and `ankle` mean flexion, dorsiflexion.

    Raises:
        UnknownName: if there is no such joint.
    """
    name = _SHORT.get(joint, joint)
    if name not in JOINTS:
        raise UnknownName("joint", joint, (*JOINTS, *_SHORT))
    return name
