"""Rules by which a claim is judged. Each takes numbers and the least change that counts."""

from __future__ import annotations

import enum
from collections.abc import Sequence


class Verdict(enum.Enum):
    """Whether our numbers say what the paper says."""

    YES = "yes"
    PARTLY = "partly"
    NO = "no"
    UNCLEAR = "no clear change"
    NOT_RUN = "not known"
    SILENT = "paper is silent"


LEAST = 0.01
"""Share by which energy or deviation has to change to count as changed. Gaits are compared that
start from each other, so that the scatter of local optima, several per cent, is not in it."""


def rises(before: float, after: float, least: float = LEAST) -> Verdict:
    """Whether a positive number grows by more than the share `least` of itself."""
    return grows(before, after, least * abs(before))


def falls(before: float, after: float, least: float = LEAST) -> Verdict:
    """Whether a positive number falls by more than the share `least` of itself."""
    return rises(-before, -after, least)


def grows(before: float, after: float, least: float) -> Verdict:
    """Whether a number grows by more than `least`, in its own unit."""
    change = after - before
    if change > least:
        return Verdict.YES
    return Verdict.NO if change < -least else Verdict.UNCLEAR


def below(value: float, limit: float) -> Verdict:
    """Whether a number is below a limit that was named beforehand."""
    return Verdict.YES if value < limit else Verdict.NO


def alike(one: float, other: float, share: float) -> Verdict:
    """Whether two positive numbers differ by no more than a share of the first."""
    return Verdict.YES if abs(other - one) <= share * abs(one) else Verdict.NO


def falls_always(values: Sequence[float], slack: float = 0.0) -> Verdict:
    """Whether every value is below the one before; rises of up to the share `slack` are forgiven,
    but then it is only partly so."""
    changes = [(b - a) / abs(a) for a, b in zip(values, values[1:], strict=False)]
    if all(change < 0.0 for change in changes):
        return Verdict.YES
    return Verdict.PARTLY if all(change <= slack for change in changes) else Verdict.NO


def ever_less(values: Sequence[float]) -> Verdict:
    """Whether the second half of the steps brings less than half of what the first half does."""
    middle = len(values) // 2
    first, second = values[0] - values[middle], values[middle] - values[-1]
    return Verdict.YES if first > 0.0 and second < 0.5 * first else Verdict.NO


def every(*verdicts: Verdict) -> Verdict:
    """All of several: yes if all are, no if none is, else partly."""
    if Verdict.NOT_RUN in verdicts:
        return Verdict.NOT_RUN
    kinds = set(verdicts)
    if len(kinds) == 1:
        return verdicts[0]
    if kinds <= {Verdict.NO, Verdict.UNCLEAR}:
        return Verdict.NO
    return Verdict.PARTLY
