"""One study of the paper: what to solve, what to measure, what to judge, what to draw."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from drakegait.gait import Gait
from drakegait.paper.claim import Claim, Finding
from drakegait.paper.numbers import Gaits, Missing, Numbers
from drakegait.solvers.options import SolverOptions
from drakegait.study import GaitStudy

if TYPE_CHECKING:
    from drakegait.paper.tables import Table

Studies = dict[str, GaitStudy]


@dataclass(frozen=True, kw_only=True)
class Chapter:
    """A study of the paper, or a question that it leaves open.

    Attributes:
        name: for `--only` and for the address on the page.
        title: what it is called.
        place: where in the paper.
        about: what is done and compared, in two or three sentences.
        studies: what to solve, by names that are unique among all chapters (equal names are equal
            studies); called with the gaits of `after`.
        warm: name of a study -> name of the one whose gait it starts from.
        options: of the solver, by name of study; default those of `SolverOptions`.
        refine: whether control points are added where a check fails.
        after: names of studies of other chapters whose gaits `studies` needs.
        names: of its studies, where they cannot be made without the gaits of `after`.
        compares: names of studies of other chapters that are only measured.
        measures: of the gaits; a measure whose gaits are missing is left out.
        claims: in the order of the paper.
        tables: what the page shows besides the table of studies.
        figures: title -> SVG, from the gaits.
    """

    name: str
    title: str
    place: str
    about: str
    studies: Callable[..., Studies] = dict
    warm: Mapping[str, str] = field(default_factory=dict)
    options: Mapping[str, SolverOptions] = field(default_factory=dict)
    refine: bool = True
    after: tuple[str, ...] = ()
    names: tuple[str, ...] = ()
    compares: tuple[str, ...] = ()
    measures: tuple[Callable[[Gaits], Mapping[str, float]], ...] = ()
    claims: tuple[Claim, ...] = ()
    tables: Callable[[Numbers], Sequence[Table]] | None = None
    figures: Mapping[str, Callable[[Gaits, Numbers], str]] = field(default_factory=dict)

    @property
    def program(self) -> str:
        """The file in examples/paper/ that runs it alone."""
        return f"{self.name.replace('-', '_')}.py"

    @property
    def own_names(self) -> tuple[str, ...]:
        """Names of its studies."""
        return self.names if self.after else tuple(self.studies())

    @property
    def all_names(self) -> tuple[str, ...]:
        """Names of the studies whose numbers it reads."""
        return (*self.own_names, *self.after, *self.compares)

    def measure(self, gaits: Mapping[str, Gait]) -> dict[str, float]:
        """All that can be measured on these gaits."""
        found: dict[str, float] = {}
        for measure in self.measures:
            try:
                found |= measure(Gaits(gaits))
            except Missing:
                continue
        return {name: float(value) for name, value in found.items()}

    def findings(self, numbers: Numbers) -> list[Finding]:
        """All claims, judged."""
        return [claim.on(numbers) for claim in self.claims]
