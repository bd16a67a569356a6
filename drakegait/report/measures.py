"""A number about a gait with its name, unit and side, and the table of such numbers."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

MINUS, NONE = "\N{MINUS SIGN}", "\N{EN DASH}"
"""A true minus sign, and what stands for no value."""


@dataclass(frozen=True)
class Measure:
    """One number that is read from a gait.

    Attributes:
        name: key in tables, the same for both sides.
        label: what it is, in words.
        unit: of the value.
        value: nan where there is no such thing.
        side: `"right"`, `"left"` or nothing.
        digits: after the decimal point, for readers.
    """

    name: str
    label: str
    unit: str
    value: float
    side: str = ""
    digits: int = 2

    @property
    def key(self) -> tuple[str, str]:
        """What identifies it among the measures of a gait."""
        return self.name, self.side


def find(measures: Sequence[Measure], name: str, side: str = "") -> float:
    """The value of a measure; raises KeyError if there is none of that name and side."""
    for measure in measures:
        if measure.key == (name, side):
            return measure.value
    raise KeyError((name, side))


def both_sides(
    name: str, label: str, unit: str, right: float, left: float, digits: int = 2
) -> list[Measure]:
    """A measure that each leg has, right first."""
    return [
        Measure(name, label, unit, float(value), side, digits)
        for side, value in (("right", right), ("left", left))
    ]


def number_text(value: float, digits: int, sign: bool = False) -> str:
    """A number with a true minus sign, a dash for none, and no minus before nothing but zeros."""
    if not math.isfinite(value):
        return NONE
    text = f"{value:{'+' if sign else ''}.{digits}f}"
    if not any(digit in "123456789" for digit in text):
        return text.lstrip("+-")
    return text.replace("-", MINUS)
