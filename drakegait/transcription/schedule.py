"""Control points: the instants at which the laws of walking are enforced.

The stride of duration T is cut into phases by events at the fractions
theta_1 = 0 < theta_2 < ... < theta_P of the cycle. A control point sits at a
fixed share s of its phase,

    tau = t/T = (1 - s) theta_p + s theta_(p+1),

so it moves with the phase durations and never leaves its phase. One point
lies on each event (s = 0).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from drakegait.errors import InvalidInput


@dataclass(frozen=True)
class Schedule:
    """Where the control points lie.

    Attributes:
        interior_points: number of points strictly inside each phase.
        num_phases: phases that are enforced; 8, or 4 if the second half of the
            stride is the mirror image of the first.
    """

    interior_points: tuple[int, ...]

    def __post_init__(self) -> None:
        if len(self.interior_points) not in (4, 8) or min(self.interior_points) < 0:
            raise InvalidInput(
                "interior_points", self.interior_points, "4 or 8 counts, none negative"
            )

    @property
    def num_phases(self) -> int:
        """Number of enforced phases."""
        return len(self.interior_points)

    @property
    def num_points(self) -> int:
        """Number of control points, boundaries included."""
        return self.num_phases + sum(self.interior_points)

    @property
    def phases(self) -> np.ndarray:
        """Phase of each control point (num_points,)."""
        return np.repeat(np.arange(self.num_phases), np.array(self.interior_points) + 1)

    @property
    def shares(self) -> np.ndarray:
        """Share s of the phase at each control point (num_points,), 0 on an event."""
        return np.concatenate([np.arange(n + 1) / (n + 1) for n in self.interior_points])

    def instants(self, events: np.ndarray) -> np.ndarray:
        """Fractions tau of the cycle at the control points.

        Args:
            events: starts of the phases and the end of the last, (num_phases + 1,).
        """
        phases, shares = self.phases, self.shares
        return (1.0 - shares) * events[phases] + shares * events[phases + 1]

    def integration_weights(self) -> np.ndarray:
        """Trapezoidal weights by (start of the previous phase, of this, of the next).

        The share of the cycle that a control point stands for is this (num_points, 3)
        array times those three events; the integral over the enforced part of the
        stride is T times the weighted sum.
        """
        gaps = np.array(self.interior_points) + 1
        weights = np.zeros((self.num_points, 3))
        for k, (phase, share) in enumerate(zip(self.phases, self.shares, strict=True)):
            step = 1.0 / gaps[phase]
            if share > 0.0:
                weights[k] = 0.0, -step, step
            else:
                before = 1.0 / gaps[phase - 1]
                weights[k] = -0.5 * before, 0.5 * (before - step), 0.5 * step
        return weights

    def refined(self, phases: set[int], factor: float = 1.5) -> Schedule:
        """A denser schedule where `phases` (0-based) get `factor` times more points."""
        counts = tuple(
            int(np.ceil(factor * (n + 1))) - 1 if phase in phases else n
            for phase, n in enumerate(self.interior_points)
        )
        return Schedule(counts)
