"""What a walker wants besides: unequal steps, and less load on what hurts."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar

from drakegait.errors import UnknownName
from drakegait.quantities import check_number
from drakegait.walker.disorders.base import (
    JOINTS,
    SIDE_WORDS,
    Disorder,
    check_side,
    full_joint,
)

QUANTITIES = {"step_length": (0.5, 2.0), "stance_time": (0.8, 1.25)}
"""What may be asymmetric, and the allowed ratios right over left."""


@dataclass(frozen=True)
class Asymmetry(Disorder):
    """A walk whose right and left steps or stances stand in a given ratio.

        step length:  L_R = ratio L_L
        stance time:  (right toe off - right heel strike) = ratio (left toe off - left heel strike)

    It is a target that the walk meets exactly, not a cause: use it to ask what a measured
    asymmetry costs, or what symmetric steps cost someone who has another disorder. Step lengths as
    in `FootPlacement`: how far the right ankle lands beyond the left. The ratio is the simplest of
    the symmetry indices in use (Patterson, Gage, Brooks, Black & McIlroy 2010, Gait & Posture 31,
    241-246 compare them).

    Attributes:
        quantity: `"step_length"` or `"stance_time"`.
        ratio: right over left [-]; 0.5 to 2 for steps, 0.8 to 1.25 for stances.
    """

    kind: ClassVar[str] = "asymmetry"
    units: ClassVar[Mapping[str, str]] = {"ratio": "-"}
    quantity: str
    ratio: float

    def __post_init__(self) -> None:
        if self.quantity not in QUANTITIES:
            raise UnknownName("asymmetric quantity", self.quantity, tuple(QUANTITIES))
        name = f"ratio of {self.quantity.replace('_', ' ')}s, right over left"
        check_number(name, self.ratio, *QUANTITIES[self.quantity], "-")

    @property
    def target(self) -> tuple[str, ...]:
        return (self.quantity,)

    def mirrored(self) -> Asymmetry:
        return dataclasses.replace(self, ratio=1.0 / self.ratio)

    def describe(self) -> str:
        return f"{self.quantity.replace('_', ' ')} right over left {self.ratio:g}"


@dataclass(frozen=True)
class Pain(Disorder):
    """A foot or joint that the walker spares: its load is one more part of the cost.

        foot:   weight * mean over the stride of |F|^2 / (body weight)^2
        joint:  weight * mean over the stride of M^2 / (m * 1 N m/kg)^2

    F is the whole force of the ground on the foot, M the moment of the muscles that span the
    joint (what ligaments, an orthosis or a stiff joint bear does not count), m the body mass
    without added masses. The square makes peaks count most. In a normal planar walk a weight of 1
    adds 0.5 (foot), 0.4 (ankle), 0.15 (hip) or 0.04 (knee) to the f of 4 to 5 of eq. (13). An
    antalgic gait as the outcome of a cost for load is a modelling assumption; there is no measured
    value of the weight.

    Attributes:
        where: `"foot"` or a joint (`"knee_flexion"`, in short `"knee"`).
        side: `"r"`, `"l"` or `"both"`.
        weight: 0 to 100 [-].
    """

    kind: ClassVar[str] = "pain"
    units: ClassVar[Mapping[str, str]] = {"weight": "-"}
    where: str
    side: str
    weight: float = 1.0

    def __post_init__(self) -> None:
        if self.where != "foot":
            try:
                object.__setattr__(self, "where", full_joint(self.where))
            except UnknownName:
                raise UnknownName("where it hurts", self.where, ("foot", *JOINTS)) from None
        check_side(self.side)
        check_number(f"weight of pain in {self.where}", self.weight, 0.0, 100.0, "-")

    @property
    def target(self) -> tuple[str, ...]:
        return (self.where,)

    def named_joints(self) -> tuple[str, ...]:
        return () if self.where == "foot" else tuple(f"{self.where}_{side}" for side in self.sides)

    def describe(self) -> str:
        where = "on both sides" if self.side == "both" else SIDE_WORDS[self.side]
        return f"pain in {self.where.replace('_', ' ')} {where} (weight {self.weight:g})"
