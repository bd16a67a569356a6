"""A claim of the paper and what our gaits say about it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from drakegait.paper.numbers import Missing, Numbers
from drakegait.paper.verdict import Verdict


@dataclass(frozen=True)
class Claim:
    """One statement.

    Attributes:
        what: the statement, in our words.
        where: section, table or figure of the paper; `"-"` for a question of our own.
        paper: its number, if it gives one.
        ours: our numbers as text, made from what was measured.
        judge: the verdict on what was measured; None where the paper is silent.
        rule: when the verdict is yes, in words, with its tolerance.
        why: what we know of the reason where the numbers or the direction differ.
    """

    what: str
    where: str
    paper: str
    ours: Callable[[Numbers], str]
    judge: Callable[[Numbers], Verdict] | None
    rule: str = ""
    why: str = ""

    @property
    def of_the_paper(self) -> bool:
        """Whether the paper says so; else it is a question of our own."""
        return self.where != "-"

    def on(self, numbers: Numbers) -> Finding:
        """The claim judged by a chapter's numbers."""
        try:
            ours = self.ours(numbers)
            verdict = self.judge(numbers) if self.judge else Verdict.SILENT
        except Missing as missing:
            return Finding(self, f"- ({missing})", Verdict.NOT_RUN)
        return Finding(self, ours, verdict)


@dataclass(frozen=True)
class Finding:
    """A claim with our numbers and the verdict."""

    claim: Claim
    ours: str
    verdict: Verdict


def change(before: float, after: float, unit: str = "", digits: int = 1) -> str:
    """`before -> after unit (+x %)`."""
    share = 100.0 * (after - before) / abs(before) if before else float("nan")
    text = f"{before:.{digits}f} -> {after:.{digits}f}{' ' if unit else ''}{unit}"
    return f"{text} ({share:+.1f} %)"
