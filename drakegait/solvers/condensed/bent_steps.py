"""Steps that bend at bounds instead of ending there.

Of thousands of bounds a few, wrongly judged, end most steps early (8). Where a step would use up
more than half of a distance to a bound, the distance is divided instead of taken from: to first
order both are the same, as both linearise distance * multiplier = mu. So a step may overshoot a
bound by a multiple of the distance to it, and every distance stays positive.
"""

from __future__ import annotations

import numpy as np

OVERSHOOT = 5.0  # at most so many times a distance
_STRAIGHT = 0.5  # of a distance: up to here the step is straight
_LEAST = 0.1  # of a distance that is left; one that became too small is slow to grow again


def bent(change: np.ndarray) -> np.ndarray:
    """1 + `change`, relative changes of positive quantities, bent so that it stays positive.

    1 + c for c >= -1/2, beyond it the hyperbola that continues it smoothly, at least 1/10.
    """
    rest = 1.0 - _STRAIGHT
    hyperbola = rest**2 / np.maximum(rest - change - _STRAIGHT, rest)
    return np.where(change > -_STRAIGHT, 1.0 + change, np.maximum(_LEAST, hyperbola))


def along(
    w: np.ndarray, change: np.ndarray, low: np.ndarray, high: np.ndarray
) -> np.ndarray:
    """`w` + `change`, bent at the bounds.

    Args:
        low, high: distances of w to its bounds, infinite where there is none.
    """
    out = w + change
    for distance, sign in ((low, 1.0), (high, -1.0)):
        near = np.flatnonzero(sign * change < -_STRAIGHT * distance)
        share = bent(sign * change[near] / distance[near])
        out[near] = w[near] - sign * distance[near] * (1.0 - share)
    return out
