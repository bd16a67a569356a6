"""Constraint: eq. (29), the form of Ackermann (2007) to which the paper compares its eq. (28).

For each coordinate i one row over all control points j,

    max_j |e_ij| <= eps_i

with e of eq. (18). The same motions obey it as obey (28), but a solver sees only the largest
residual of each coordinate, and a corner where another control point takes its place. (The paper
lets i run over the actuated joints; as its own argument for (26) shows, the rows of the trunk
are needed too.)
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from drakegait.program.control_points import ControlPoints
from drakegait.program.equations_of_motion import EquationsOfMotion
from drakegait.program.formulation import Formulation
from drakegait.program.local_state import LocalState
from drakegait.program.stride_rows import StrideRows
from drakegait.transcription.design_vector import Affine, DesignVector


class LargestResiduals(StrideRows):
    """One row per coordinate, in units of its tolerance.

    With lifted multipliers the residuals are variables without bounds, so that a row depends on
    those of its coordinate alone; else it depends on all that the equations of motion see.
    Derivatives are those of the control point with the largest residual.
    """

    kind = "largest residual"

    def __init__(
        self,
        formulation: Formulation,
        points: ControlPoints,
        design: DesignVector,
        selection: Affine,
    ):
        names = formulation.walker.coordinate_names
        self.names = [f"{self.kind} | stride | {name}" for name in names]
        self.scale = formulation.row_tolerances
        self.units = ["N m" if turns else "N" for turns in formulation.walker.is_rotation]
        self.lower, self.upper = np.full(len(names), -np.inf), np.ones(len(names))
        self._lifted = formulation.lifted
        if self._lifted:
            self._residuals = design.selection("residuals")
            row = np.broadcast_to(np.arange(len(names)), (points.num, len(names)))
            column, self._factor = self._residuals.index, self._residuals.factor
        else:
            self._law = EquationsOfMotion(formulation, points)
            row = np.broadcast_to(self._law.rows, (points.num, len(self._law.rows)))
            column = selection.index[:, self._law.columns]
            self._factor = selection.factor[:, self._law.columns]
        self._row_of_entry = row[0]
        self._kept = column >= 0
        keys = row[self._kept] * design.num_variables + column[self._kept]
        keys, self._entry = np.unique(keys, return_inverse=True)
        self.rows, self.columns = keys // design.num_variables, keys % design.num_variables

    def values(self, x: np.ndarray, state: Callable[[np.ndarray], LocalState]) -> np.ndarray:
        return np.abs(self._scaled(x, state)).max(axis=0)

    def jacobian(self, x: np.ndarray, state: Callable[[np.ndarray], LocalState]) -> np.ndarray:
        residual = self._scaled(x, state)
        largest = np.argmax(np.abs(residual), axis=0)
        here = np.zeros_like(residual)
        here[largest, range(len(largest))] = np.sign(residual[largest, range(len(largest))])
        here = here[:, self._row_of_entry]
        slopes = 1.0 / self.scale if self._lifted else self._law.jacobian(state(x))
        entries = (here * slopes * self._factor)[self._kept]
        return np.bincount(self._entry, entries, len(self.rows))

    def _scaled(self, x: np.ndarray, state: Callable[[np.ndarray], LocalState]) -> np.ndarray:
        """e in units of its tolerance (num_points, num_coordinates)."""
        if self._lifted:
            return self._residuals.values(x) / self.scale
        return self._law.values(state(x))
