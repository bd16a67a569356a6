"""Rows that belong to no control point: the average speed and the phase durations.

    (L_R + L_L) - v T = 0                       (item 5 of the paper's section 3.3)
    t_min <= T (theta_(p+1) - theta_p) <= t_max  for every phase
"""

from __future__ import annotations

import numpy as np

from drakegait.program.formulation import Formulation
from drakegait.transcription.design_vector import DesignVector
from drakegait.walker import feet

_LENGTH, _DURATION = 0.1, 0.1  # typical sizes [m], [s]


class TimingRows:
    """The average speed, then one row per phase; entries ordered by row."""

    def __init__(
        self, formulation: Formulation, design: DesignVector, durations: tuple[float, float]
    ):
        self._speed = formulation.speed
        self._timing = design.selection("timing")
        self._placement = design.selection("placement")
        num = formulation.schedule.num_phases
        self.names = ["average speed | stride | hat_x"] + [
            f"phase duration | {feet.PHASE_NAMES[phase]} | time" for phase in range(num)
        ]
        self.scale = np.array([_LENGTH] + [_DURATION] * num)
        self.units = ["m"] + ["s"] * num
        self.lower = np.array([0.0] + [durations[0] / _DURATION] * num)
        self.upper = np.array([0.0] + [durations[1] / _DURATION] * num)
        self._phases = np.arange(num)
        rows, columns = self._entries()
        keep = columns >= 0
        keys = rows[keep] * (design.num_variables + 1) + columns[keep]
        unique, self._entry = np.unique(keys, return_inverse=True)
        self.rows = unique // (design.num_variables + 1)
        self.columns = unique % (design.num_variables + 1)
        self._keep = keep
        timing = self._timing
        ends = [(phase, k) for phase in self._phases for k in (1, 2)]
        free = [(phase, k) for phase, k in ends if timing.index[phase + k] >= 0]
        self._curved = np.array(free, dtype=int).reshape(-1, 2)
        events = timing.index[self._curved.sum(axis=1)]
        self.curved_rows = np.maximum(events, timing.index[0])
        self.curved_columns = np.minimum(events, timing.index[0])

    def _entries(self) -> tuple[np.ndarray, np.ndarray]:
        timing, placement = self._timing.index, self._placement.index
        rows, columns = [0, 0, 0], [placement[0], placement[1], timing[0]]
        for phase in self._phases:
            rows += [phase + 1] * 3
            columns += [timing[0], timing[phase + 1], timing[phase + 2]]
        return np.array(rows), np.array(columns)

    def values(self, x: np.ndarray) -> np.ndarray:
        """Scaled rows."""
        timing, placement = self._timing.values(x), self._placement.values(x)
        speed = placement[0] + placement[1] - self._speed * timing[0]
        return np.concatenate([[speed], timing[0] * np.diff(timing[1:])]) / self.scale

    def jacobian(self, x: np.ndarray) -> np.ndarray:
        """Scaled derivatives at `rows`, `columns`."""
        timing, by_timing = self._timing.values(x), self._timing.factor
        by_placement = self._placement.factor
        entries = [by_placement[0], by_placement[1], -self._speed * by_timing[0]]
        for phase in self._phases:
            entries += [
                (timing[phase + 2] - timing[phase + 1]) * by_timing[0],
                -timing[0] * by_timing[phase + 1],
                timing[0] * by_timing[phase + 2],
            ]
        scaled = np.array(entries) / np.repeat(self.scale, 3)
        return np.bincount(self._entry, scaled[self._keep], len(self.rows))

    def curvature(self, multipliers: np.ndarray) -> np.ndarray:
        """Second derivatives of the weighted rows at `curved_rows`, `curved_columns`.

        T multiplies the events: d2(row)/dT dtheta = +-1.
        """
        phase, end = self._curved[:, 0], self._curved[:, 1]
        sign = np.where(end == 2, 1.0, -1.0)
        factor = self._timing.factor
        product = factor[0] * factor[phase + end]
        return sign * product * multipliers[phase + 1] / self.scale[phase + 1]
