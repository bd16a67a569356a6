"""What was published about a quantity, and where ours lies."""

from __future__ import annotations

import enum
from collections.abc import Sequence
from dataclasses import dataclass

from drakegait.errors import InvalidInput


class Place(enum.Enum):
    """Where our number lies."""

    INSIDE = "inside"
    OUTSIDE = "outside"
    NOT_KNOWN = "not known"


@dataclass(frozen=True)
class Range:
    """A published range, both ends included.

    Attributes:
        low, high: in the unit of the quantity.

    Raises:
        InvalidInput: if `low` is above `high`.
    """

    low: float
    high: float

    def __post_init__(self) -> None:
        if not self.low <= self.high:
            raise InvalidInput("low end of a range", self.low, f"at most its high end {self.high}")

    @classmethod
    def around(cls, values: Sequence[float], allowance: float = 0.0, share: float = 0.0) -> Range:
        """From the least to the greatest published value, widened on both sides.

        Args:
            values: as printed.
            allowance: in the unit of the quantity.
            share: of each value's size; the values nearest to the ends decide.
        """
        lows = [value - allowance - share * abs(value) for value in values]
        highs = [value + allowance + share * abs(value) for value in values]
        return cls(min(lows), max(highs))

    def beyond(self, value: float) -> float:
        """By how much a value is above the high end (> 0) or below the low end (< 0), or 0."""
        return max(value - self.high, 0.0) + min(value - self.low, 0.0)

    def farthest(self, values: Sequence[float]) -> float:
        """`beyond` of the value that is farthest out."""
        return max((self.beyond(value) for value in values), key=abs)

    def place(self, values: Sequence[float]) -> Place:
        """Inside if all values are."""
        return Place.INSIDE if self.farthest(values) == 0.0 else Place.OUTSIDE

    def text(self, digits: int) -> str:
        """`low to high`."""
        return f"{self.low:.{digits}f} to {self.high:.{digits}f}"


@dataclass(frozen=True)
class Row:
    """A line of the page.

    Attributes:
        quantity: with its unit.
        published: numbers as printed, with the range that is made of them.
        source: key of `drakegait.fidelity.sources.SOURCES`.
        ours: our numbers; two for right and left.
        place: inside, outside or not known.
        by: by how much ours is outside; empty if it is not.
        why: what we know of the reason, for what is outside.
    """

    quantity: str
    published: str
    source: str
    ours: str
    place: Place
    by: str = ""
    why: str = ""
