"""Constraint: the equations of motion within a tolerance, eqs (26)-(28).

In every coordinate i and at every control point

    -eps_i <= e_i <= eps_i,    e = M q'' + k - q_r - B A f^m - C^T lambda

with eps the moment tolerance [N m] for rotations and the force tolerance [N]
for translations. With lifted multipliers e is a variable with these bounds and
the row is an equality; `LeastSquaresMultipliers` adds what makes lambda that of
eq. (17). On an event only the forces that both neighbouring phases
can bear enter (see `feet.loaded_rows_at_start`).
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


class EquationsOfMotion(DenseRows):
    """One row per coordinate, in units of its tolerance."""

    kind = "equations of motion"

    def __init__(self, formulation: Formulation, points: ControlPoints):
        super().__init__(formulation, points)
        walker = formulation.walker
        num = walker.skeleton.num_coordinates
        self.row_names = walker.coordinate_names
        self.scale = formulation.row_tolerances
        self.units = tuple("N m" if turns else "N" for turns in walker.is_rotation)
        slack = 0.0 if formulation.lifted else 1.0
        self.lower, self.upper = np.full(num, -slack), np.full(num, slack)
        self.applies = np.ones((points.num, num), dtype=bool)
        masks = no_dependence(num, points.layout)
        masks["coordinates"][:] = walker.coupling
        masks["forces"][:] = walker.muscles.moment_arms.T != 0.0
        masks["multipliers"][:] = _loads(walker.coordinate_names)[:, : points.layout.num_rows]
        if formulation.lifted:
            masks["residuals"][range(num), range(num)] = True
        masks["time"][:, [0, 2, 3]] = True
        masks["placement"][:, :2] = True
        self._declare(Pattern(**masks))

    def values(self, state: LocalState) -> np.ndarray:
        unexplained = state.residuals if self.formulation.lifted else 0.0
        return (state.residual - unexplained) / self.scale

    def partials(self, state: LocalState) -> Partials:
        dynamics, num = state.dynamics, state.points.num
        arms = self.formulation.walker.muscles.moment_arms
        return Partials(
            q=dynamics.by_q,
            v=dynamics.by_v,
            a=dynamics.mass_matrix,
            f=np.broadcast_to(-arms.T, (num, *arms.T.shape)),
            multipliers=-np.swapaxes(state.contact_jacobian, 1, 2)
            * state.points.loaded[:, None, :],
            residuals=(
                np.broadcast_to(-np.eye(self.num_rows), (num, self.num_rows, self.num_rows))
                if self.formulation.lifted
                else None
            ),
        )


def _loads(names: tuple[str, ...]) -> np.ndarray:
    """Which contact row loads which coordinate: the trunk's and its own leg's."""
    side = np.array([row.split()[0][-2:] for row in (*feet.ROW_NAMES, *feet.TORQUE_NAMES)])
    mask = np.ones((len(names), len(side)), dtype=bool)
    for i, name in enumerate(names):
        if name[-2:] in ("_r", "_l"):
            mask[i] = side == name[-2:]
        else:
            # A torque has no share in the force that moves the trunk.
            mask[i, feet.NUM_ROWS :] = name not in TRANSLATIONS
    return mask
