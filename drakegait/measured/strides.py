"""Which strides a recording holds, and which one is the best."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from drakegait.errors import BadFile, InvalidInput
from drakegait.measured.contacts import Contact
from drakegait.measured.notes import Notes
from drakegait.measured.posture import Posture

DURATIONS = (0.6, 2.5)
"""Shortest and longest stride that is taken for one [s]."""


@dataclass(frozen=True, eq=False, kw_only=True)
class Stride:
    """From one heel strike of the leading foot to its next.

    Attributes:
        lead: `"r"` or `"l"`.
        start, end: heel strikes of the leading foot [s].
        other_off, other_strike, lead_off: the events between, in their order [s].
        gap: root mean square difference of the joint angles between start and end [rad].
        loaded: how many of the two stances have a complete force of their own.
        score: smaller is better.
    """

    lead: str
    start: float
    end: float
    other_off: float
    other_strike: float
    lead_off: float
    gap: float
    loaded: int
    score: float

    @property
    def duration(self) -> float:
        """[s]."""
        return self.end - self.start

    @property
    def right_strike(self) -> float:
        """Right heel strike in the stride [s]."""
        return self.start if self.lead == "r" else self.other_strike

    @property
    def _other(self) -> str:
        return "l" if self.lead == "r" else "r"

    @property
    def stances(self) -> dict[str, tuple[float, ...]]:
        """Heel strikes of the stances of each foot that lie in the stride, wholly or in part [s].

        The other foot may stand when the stride begins: that stance and its next share the cycle.
        """
        return {
            self.lead: (self.start,),
            self._other: (self.other_strike, self.other_strike - self.duration),
        }

    def share(self, time: float) -> float:
        """Fraction of the cycle since right heel strike, from 0 to 1, of an instant [s]."""
        return (time - self.right_strike) / self.duration % 1.0

    @property
    def strikes_and_offs(self) -> dict[str, tuple[float, float]]:
        """Heel strike and toe off of each foot as fractions of the cycle; toe off may be > 1."""
        times = {
            self.lead: (self.start, self.lead_off),
            self._other: (self.other_strike, self.other_off),
        }
        shares = {side: (self.share(a), self.share(b)) for side, (a, b) in times.items()}
        return {side: (a, b if b > a else b + 1.0) for side, (a, b) in shares.items()}


def choose_stride(
    posture: Posture, contacts: Sequence[Contact], number: int | None, notes: Notes
) -> tuple[Stride, list[Stride]]:
    """The best stride, or that of a number, and all that there are.

    Strides that begin with the right foot are preferred, as the model's cycle does. Left ones serve
    where there is no right one; they are closed and turned to begin at right heel strike. The
    best is the one whose end is closest to its beginning, with complete forces, in the middle
    of the trial.

    Args:
        number: 1 for the first; None for the best.

    Raises:
        BadFile: there is no whole stride.
        InvalidInput: there is no stride of this number.
    """
    strides = _strides(posture, contacts, "r")
    if not strides:
        strides = _strides(posture, contacts, "l")
        if strides:
            notes.say(
                "The file holds no whole stride of the right foot; a stride of the left foot was "
                "closed and turned to begin at right heel strike."
            )
    if not strides:
        raise BadFile(f"the motion from {posture.time[0]:.2f} to {posture.time[-1]:.2f} s",
                      "holds no whole stride, from one heel strike to the next of the same foot "
                      "without long gaps.")  # fmt: skip
    if number is None:
        return min(strides, key=lambda stride: stride.score), strides
    if not 1 <= number <= len(strides):
        raise InvalidInput("stride", number, f"1 to {len(strides)}, the strides that were found")
    return strides[number - 1], strides


def _strides(posture: Posture, contacts: Sequence[Contact], lead: str) -> list[Stride]:
    own = [c for c in contacts if c.side == lead]
    other = [c for c in contacts if c.side != lead]
    strikes = [c for c in own if c.whole or c.start > c.record.series.time[0] + 0.01]
    middle = 0.5 * (posture.time[0] + posture.time[-1])
    extent = posture.time[-1] - posture.time[0]
    strides = []
    for first, second in zip(strikes[:-1], strikes[1:], strict=True):
        start, end = first.start, second.start
        between = [c.end for c in other if start < c.end < first.end]
        strike = [c for c in other if start < c.start < end]
        fits = DURATIONS[0] < end - start < DURATIONS[1] and first.end < end
        if not (fits and posture.series.covers(start, end) and strike):
            continue
        after = strike[0].start
        # where the other foot's push-off was not seen: that of its next stance, a stride later
        off = between[0] if between else strike[0].end - (end - start)
        if not start < off < after < first.end:
            continue
        ends = posture.series.at(np.array([start, end]))[:, 3:]
        gap = float(np.sqrt(np.mean((ends[1] - ends[0]) ** 2)))
        loaded = sum(bool(c.record is not None and c.whole) for c in (first, strike[0]))
        away = abs(0.5 * (start + end) - middle) / extent
        score = np.degrees(gap) + 2.0 * (2 - loaded) + away
        strides.append(
            Stride(lead=lead, start=start, end=end, other_off=off, other_strike=after,
                   lead_off=first.end, gap=gap, loaded=loaded, score=float(score))
        )  # fmt: skip
    return strides
