"""Statements of a study that exclude each other, refused before anything is solved."""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from drakegait.errors import InvalidInput
from drakegait.program.design import RANGES
from drakegait.program.formulation import JointLimit

if TYPE_CHECKING:
    from drakegait.study import GaitStudy

_OTHER = {"_r": "_l", "_l": "_r"}
_BOTH = "the same on both sides of a symmetric model; take spatial or planar"


def check_limits(limits: Sequence[JointLimit]) -> None:
    """Refuse limits of one joint that leave it no angle.

    Raises:
        InvalidInput: naming the joint.
    """
    open_ranges: dict[str, tuple[float, float]] = {}
    for limit in limits:
        base = limit.coordinate.removesuffix("_r").removesuffix("_l")
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
        point = item.point and (item.point[0], -item.point[1], item.point[2])
        image = dataclasses.replace(item, segment=_mirror_name(item.segment), point=point)
        if image not in study.added_masses:
            raise InvalidInput("added mass", f"{item.mass:g} kg on {item.segment}", _BOTH)
    for what, stated in (
        ("strength", study.strength), ("muscle_changes", study.muscle_changes),
    ):  # fmt: skip
        for name, value in stated.items():
            if stated.get(_mirror_name(name)) != value:
                raise InvalidInput(what, f"{value} for {name}", _BOTH)
    for item in study.limits:
        image = dataclasses.replace(item, coordinate=_mirror_name(item.coordinate))
        if image not in study.limits:
            given = f"{item.low:g} to {item.high:g} of {item.coordinate}"
            raise InvalidInput("limit", given, _BOTH)


def check_number(name: str, value: Any, low: float, high: float, unit: str) -> None:
    """Refuse anything but a number from `low` to `high`."""
    kinds = (int, float, np.integer, np.floating)
    number = isinstance(value, kinds) and not isinstance(value, bool)
    if not number or not low <= value <= high:  # nan is in no range
        raise InvalidInput(name, value, f"a number from {low:g} to {high:g} [{unit}]")


def _mirror_name(name: str) -> str:
    return name[:-2] + _OTHER.get(name[-2:], name[-2:])
