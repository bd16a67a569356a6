"""When a muscle is on, by a stated rule, and how that agrees with published times.

All times are percentages of the leg's own cycle, which is cut into `BINS` equal parts.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

PEAK_SHARE = 0.20
"""A muscle is on where its excitation is at least this share of its greatest in the stride."""
FLOOR = 0.05
"""Excitation below which it is off in any case."""
ROUNDING = 5.0
"""How far outside a published burst ours may reach without being astray [% of the cycle]: published
times are rounded to 5 or 10 %."""
BINS = 200

Bursts = Sequence[tuple[float, float]]
"""(on, off) each; no burst passes 100 %."""


def bursts(percent: np.ndarray, excitation: np.ndarray) -> list[tuple[float, float]]:
    """When a muscle is on, by `PEAK_SHARE` and `FLOOR`.

    Args:
        percent: (num,) of the leg's cycle, rising from 0 to 100.
        excitation: (num,), 0 to 1.
    """
    middles = (np.arange(BINS) + 0.5) * 100.0 / BINS
    values = np.interp(middles, percent, excitation)
    return _edges(values >= max(FLOOR, PEAK_SHARE * float(np.max(excitation))))


def mask(times: Bursts) -> np.ndarray:
    """Whether a muscle is on in each part of the cycle (BINS,)."""
    middles = (np.arange(BINS) + 0.5) * 100.0 / BINS
    on = np.zeros(BINS, dtype=bool)
    for begin, end in times:
        on |= (middles >= begin) & (middles < end)
    return on


def widened(times: Bursts, by: float = ROUNDING) -> np.ndarray:
    """The same with each burst longer on both sides, beyond 100 % into the next cycle."""
    on, reach = mask(times), round(by * BINS / 100.0)
    return np.any([np.roll(on, shift) for shift in range(-reach, reach + 1)], axis=0)


@dataclass(frozen=True)
class Agreement:
    """How ours agrees with published times [%].

    Attributes:
        covered: of the published time, how much ours is on; nan if nothing was published.
        astray: of our time, how much is outside of the widened published bursts; 0 if never on.
        alike: of the cycle, how much both say the same.
    """

    covered: float
    astray: float
    alike: float

    @property
    def inside(self) -> bool:
        """At least half covered, at most half astray."""
        return self.covered >= 50.0 and self.astray <= 50.0


def agreement(ours: Bursts, published: Bursts) -> Agreement:
    """Compare two sets of bursts."""
    on, theirs = mask(ours), mask(published)
    return Agreement(
        covered=_share(on & theirs, theirs),
        astray=_share(on & ~widened(published), on) if on.any() else 0.0,
        alike=100.0 * float(np.mean(on == theirs)),
    )


def _share(part: np.ndarray, whole: np.ndarray) -> float:
    return 100.0 * float(part.sum() / whole.sum()) if whole.any() else float("nan")


def _edges(on: np.ndarray) -> list[tuple[float, float]]:
    padded = np.concatenate([[False], on, [False]]).astype(int)
    steps = np.diff(padded)
    begins, ends = np.flatnonzero(steps == 1), np.flatnonzero(steps == -1)
    return [(100.0 * begin / BINS, 100.0 * end / BINS)
            for begin, end in zip(begins.tolist(), ends.tolist(), strict=True)]  # fmt: skip
