"""What an interior-point iterate is made of, and how far it may go."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np


@dataclass
class Multipliers:
    """Dual unknowns: of all rows, and of lower and upper bounds of x and slacks."""

    rows: np.ndarray
    lower: np.ndarray
    upper: np.ndarray


@dataclass(frozen=True)
class Errors:
    """Scaled violations of the KKT conditions, (5), (6)."""

    dual: float
    primal: float
    complementarity: float

    @property
    def worst(self) -> float:
        """E_mu."""
        return max(self.dual, self.primal, self.complementarity)


def inside(x: np.ndarray, low: np.ndarray, high: np.ndarray, push: float) -> np.ndarray:
    """`x` moved into the interior of its bounds (section 3.6)."""
    with np.errstate(invalid="ignore"):
        below = np.minimum(push * np.maximum(1.0, np.abs(low)), push * (high - low))
        above = np.minimum(push * np.maximum(1.0, np.abs(high)), push * (high - low))
        x = np.where(np.isfinite(low), np.maximum(x, low + below), x)
        return np.where(np.isfinite(high), np.minimum(x, high - above), x)


def longest_step(
    low: np.ndarray, high: np.ndarray, change: np.ndarray, fraction: float
) -> float:
    """The longest step, at most 1, that keeps 1 - `fraction` of every distance to a bound."""
    with np.errstate(divide="ignore", invalid="ignore"):
        down = np.where(change < 0.0, -fraction * low / change, np.inf).min()
        up = np.where(change > 0.0, fraction * high / change, np.inf).min()
    return float(min(1.0, down, up))
