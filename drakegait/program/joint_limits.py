"""Constraint: optional named limits of coordinates (item 7 of the paper's section 3.3).

low <= q_i <= high at every control point, for instance a largest knee flexion
in swing or hip extension in stance.
"""

from __future__ import annotations

import numpy as np

from drakegait.program.chain import Partials, Pattern, no_dependence
from drakegait.program.control_points import ControlPoints
from drakegait.program.formulation import Formulation
from drakegait.program.local_rows import DenseRows
from drakegait.program.local_state import LocalState
from drakegait.walker import coordinates

_TYPICAL = 0.1  # [rad] or [m]


class JointLimits(DenseRows):
    """One row per limit, in units of 0.1 rad or 0.1 m, plant signs."""

    kind = "joint limit"

    def __init__(self, formulation: Formulation, points: ControlPoints):
        super().__init__(formulation, points)
        kind = formulation.walker.skeleton.kind
        limits = formulation.limits
        self._which = coordinates.positions(kind, [limit.coordinate for limit in limits])
        signs = coordinates.anatomical_signs(kind)[self._which]
        ends = np.array([[limit.low, limit.high] for limit in limits]).reshape(-1, 2)
        ends = np.sort(ends * signs[:, None], axis=1)
        self.row_names = tuple(limit.coordinate for limit in limits)
        self.scale = np.full(len(limits), _TYPICAL)
        self.units = tuple(
            "rad" if coordinates.rotations(kind)[i] else "m" for i in self._which
        )
        self.lower, self.upper = ends[:, 0] / _TYPICAL, ends[:, 1] / _TYPICAL
        self.applies = np.ones((points.num, len(limits)), dtype=bool)
        masks = no_dependence(len(limits), points.layout)
        masks["coordinates"][range(len(limits)), self._which] = True
        masks["time"][:, [2, 3]] = True
        self._declare(Pattern(**masks))

    def values(self, state: LocalState) -> np.ndarray:
        return state.motion.value[:, self._which] / self.scale

    def partials(self, state: LocalState) -> Partials:
        q = np.zeros((state.points.num, self.num_rows, state.q.shape[1]))
        q[:, range(self.num_rows), self._which] = 1.0
        return Partials(q=q)
