"""A section of the page: studies and measures of a chapter, and rows in place of claims."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

from drakegait.fidelity.published import Place, Row
from drakegait.paper.chapter import Chapter
from drakegait.paper.numbers import Missing, Numbers
from drakegait.paper.results import Results


@dataclass(frozen=True, kw_only=True)
class Line:
    """What one row is made of.

    Attributes:
        quantity, published, source, why: as in `Row`.
        read: our numbers as text, where they lie and by how much; raises Missing.
    """

    quantity: str
    published: str
    source: str
    read: Callable[[Numbers], tuple[str, Place, str]]
    why: str

    def on(self, numbers: Numbers) -> Row:
        """The row for these numbers; the reason only where it is needed."""
        try:
            ours, place, by = self.read(numbers)
        except Missing as missing:
            ours, place, by = f"- ({missing})", Place.NOT_KNOWN, ""
        why = self.why if place is Place.OUTSIDE else ""
        return Row(self.quantity, self.published, self.source, ours, place, by, why)


@dataclass(frozen=True, kw_only=True)
class Section(Chapter):
    """A chapter whose numbers are held against published ones.

    Attributes:
        rule: when a number is called inside, in words.
        lines: in the order of the page.
        pictures: file name without ending -> (caption, SVG from the numbers alone).
    """

    rule: str
    lines: tuple[Line, ...]
    pictures: dict[str, tuple[str, Callable[[Numbers], str]]] = field(default_factory=dict)

    def rows(self, numbers: Numbers) -> list[Row]:
        """All lines, judged."""
        return [line.on(numbers) for line in self.lines]

    def judged(self, results: Results) -> list[Row]:
        """The rows for a run; not known where this section was not run."""
        return self.rows(results.numbers.get(self.name, Numbers()))
