"""Statements of a study that exclude each other, refused before anything is solved."""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from drakegait.errors import InvalidInput
from drakegait.program.design import RANGES
from drakegait.program.formulation import JointLimit
from drakegait.walker.coordinates import TRANSLATIONS, other_side, without_side
from drakegait.walker.subject import AddedMass

if TYPE_CHECKING:
    from drakegait.study import GaitStudy

_BOTH = "the same on both sides of a symmetric model; take spatial or planar"


def check_limits(limits: Sequence[JointLimit]) -> None:
    """Refuse limits of one joint that leave it no angle.

    Raises:
        InvalidInput: naming the joint.
    """
    open_ranges: dict[str, tuple[float, float]] = {}
    for limit in limits:
        base = without_side(limit.coordinate)
        if base not in RANGES:
            continue
        low, high = open_ranges.get(limit.coordinate, RANGES[base])
        low, high = max(low, limit.low), min(high, limit.high)
        if not low < high:
            degrees = [np.degrees(x) for x in (limit.low, limit.high, *RANGES[base])]
            allowed = (
                "a range that leaves angles together with other limits of this joint and "
                f"{degrees[2]:.0f} to {degrees[3]:.0f} degrees"
            )
            given = f"{degrees[0]:.3g} to {degrees[1]:.3g} degrees"
            raise InvalidInput(f"limit of {limit.coordinate}", given, allowed)
        open_ranges[limit.coordinate] = low, high


def check_both_sides(study: GaitStudy) -> None:
    """Refuse what a symmetric walker can only have on both sides, but has on one.

    Raises:
        InvalidInput: naming the first of them.
    """
    if not study.symmetric:
        return
    for item in study.added_masses:
        if mirrored_mass(item) not in study.added_masses:
            raise InvalidInput("added mass", f"{item.mass:g} kg on {item.segment}", _BOTH)
    for what, stated in (
        ("strength", study.strength), ("muscle_changes", study.muscle_changes),
    ):  # fmt: skip
        for name, value in stated.items():
            if stated.get(other_side(name)) != value:
                raise InvalidInput(what, f"{value} for {name}", _BOTH)
    for item in study.limits:
        if mirrored_limit(item) not in study.limits:
            turn = item.coordinate not in TRANSLATIONS
            low, high = (np.degrees(x) if turn else x for x in (item.low, item.high))
            unit = "degrees" if turn else "m"
            given = f"{low:.4g} to {high:.4g} {unit} of {item.coordinate}"
            raise InvalidInput("limit", given, _BOTH)


def mirrored_mass(item: AddedMass) -> AddedMass:
    """The same mass on the other side of the body."""
    point = item.point and (item.point[0], -item.point[1], item.point[2])
    return dataclasses.replace(item, segment=other_side(item.segment), point=point)


def mirrored_limit(item: JointLimit) -> JointLimit:
    """The same limit on the other side of the body."""
    return dataclasses.replace(item, coordinate=other_side(item.coordinate))
