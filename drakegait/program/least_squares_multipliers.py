"""Constraint: lifted contact multipliers are those of eq. (17).

The pseudo-inverse picks the multipliers that leave the smallest residual e; they
are characterised by

    C e = 0

in the rows that are loaded (19), docs/formulation.md 6.4. Without these rows the bound on e
would hold for *some* multipliers, and the residual of (17) could be twice as large.
"""

from __future__ import annotations

import numpy as np

from drakegait.program.chain import Partials, Pattern, no_dependence
from drakegait.program.control_points import ControlPoints
from drakegait.program.formulation import Formulation
from drakegait.program.local_rows import DenseRows
from drakegait.program.local_state import LocalState
from drakegait.walker import feet
from drakegait.walker.coordinates import TRANSLATIONS


class LeastSquaresMultipliers(DenseRows):
    """One row per loaded contact row, C e in units of the force tolerance."""

    kind = "least-squares contact forces"

    def __init__(self, formulation: Formulation, points: ControlPoints):
        super().__init__(formulation, points)
        num = points.layout.num_rows
        self.row_names = (*feet.ROW_NAMES, *feet.TORQUE_NAMES)[:num]
        self.scale = np.full(num, formulation.tolerances.force_tolerance)
        turns = (*feet.YAW_ROWS, *feet.ROLL_ROWS, *feet.PITCH_ROWS)
        self.units = tuple("N m" if row in turns else "N" for row in range(num))
        self.lower = self.upper = np.zeros(num)
        self.applies = points.loaded
        masks = no_dependence(num, points.layout)
        for row, row_name in enumerate(self.row_names):
            other = "_l" if row_name.split()[0].endswith("_r") else "_r"
            for i, name in enumerate(formulation.walker.coordinate_names):
                masks["residuals"][row, i] = not name.endswith(other)
                translates = name in TRANSLATIONS
                masks["coordinates"][row, i] = not name.endswith(other) and not translates
        masks["time"][:, [2, 3]] = True
        self._declare(Pattern(**masks))

    def values(self, state: LocalState) -> np.ndarray:
        return np.einsum("pri,pi->pr", state.contact_jacobian, state.residuals) / self.scale

    def partials(self, state: LocalState) -> Partials:
        return Partials(q=state.contact_turning, residuals=state.contact_jacobian)
