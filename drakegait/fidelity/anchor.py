"""A number that is read off each leg of the default walk and was published for people."""

from __future__ import annotations

from dataclasses import dataclass

from drakegait.fidelity.leg import Read
from drakegait.fidelity.published import Place, Range
from drakegait.fidelity.section import Line
from drakegait.paper.numbers import Numbers

ANGLE, CYCLE, SHARE = 5.0, 5.0, 0.20
"""Allowances around single published numbers: degrees, percent of the cycle, and the share of a
force, moment or power. A number of one adult or one mean says nothing about the spread between
people. 5 degrees are the error between sessions that gait laboratories accept (J. L. McGinley et
al., The reliability of three-dimensional kinematic gait measurements, Gait & Posture 29 (2009));
the others are our choice."""

SIDES = ("right", "left")


@dataclass(frozen=True, kw_only=True)
class Anchor:
    """A quantity of level walking.

    Attributes:
        name: key of the measured numbers.
        quantity: what it is, in words.
        unit: of all numbers.
        published: number -> source; one number, or several.
        within: lowest and highest, where a range was published instead.
        allowance, share: how far the range reaches beyond single numbers.
        read: the number of one leg.
        sides: False for what both legs share; then `read` gets the right one.
        digits: after the decimal point.
        why: what may put ours outside.
    """

    name: str
    quantity: str
    unit: str
    read: Read
    why: str
    published: tuple[tuple[float, str], ...] = ()
    within: tuple[float, float, str] | None = None
    allowance: float = 0.0
    share: float = 0.0
    sides: bool = True
    digits: int = 1

    @property
    def range(self) -> Range:
        """What counts as inside."""
        if self.within is not None:
            return Range(self.within[0], self.within[1])
        values = [value for value, _ in self.published]
        return Range.around(values, self.allowance, self.share)

    @property
    def keys(self) -> tuple[str, ...]:
        """Names of its measured numbers."""
        return tuple(f"{self.name} {side}" for side in SIDES) if self.sides else (self.name,)

    @property
    def line(self) -> Line:
        """Its row of the page."""
        return Line(
            quantity=f"{self.quantity} [{self.unit}]", published=self._printed(),
            source=self._sources(), read=self._judge, why=self.why,
        )  # fmt: skip

    def _printed(self) -> str:
        if self.within is not None:
            return self.range.text(self.digits)
        # As many digits as were printed.
        printed = ", ".join(f"{value:g}" for value, _ in self.published)
        return f"{printed}; range {self.range.text(self.digits)}"

    def _sources(self) -> str:
        if self.within is not None:
            return self.within[2]
        return ", ".join(dict.fromkeys(source for _, source in self.published))

    def _judge(self, numbers: Numbers) -> tuple[str, Place, str]:
        values = [numbers[key] for key in self.keys]
        ours = " / ".join(f"{value:.{self.digits}f}" for value in values)
        return ours, self.range.place(values), distance(self.range, values, self.digits)


def distance(published: Range, values: list[float], digits: int) -> str:
    """How far outside the farthest value is, with its sign; empty if all are inside."""
    beyond = published.farthest(values)
    if beyond == 0.0:
        return ""
    return f"{beyond:+.{digits}f}" if abs(beyond) >= 0.5 * 10.0**-digits else f"{beyond:+.1g}"
