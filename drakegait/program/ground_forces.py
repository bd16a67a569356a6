"""Constraints: the ground only pushes, and grips no better than Coulomb allows.

Items 3 and 4 of the paper's section 3.3; docs/formulation.md 6.8, 6.9. For each loaded foot, with
N = N_A + N_B the vertical force and F the horizontal force of the whole foot,

    friction:     mu^2 N^2 - F_x^2 - F_y^2 - 1e-6 W^2 >= 0    (with N >= 0; W body weight)
    free moment:  |M_z| <= mu (r_s N_A + (AB + r_s) N_B)  where the heel is down,
                  |M_z| <= mu r_s N_B                      on the toe alone
    normal force: N_A >= 0, N_B >= 0

Heel and toe of a flat foot share the horizontal force in a way that a rigid
foot cannot tell, hence the total. With lifted multipliers the normal forces
are bounds of variables, and so are the torques at the toe, if the study has them.
"""

from __future__ import annotations

import numpy as np

from drakegait.program.chain import Partials, Pattern, no_dependence
from drakegait.program.control_points import ControlPoints
from drakegait.program.formulation import Formulation
from drakegait.program.local_rows import DenseRows
from drakegait.program.local_state import LocalState
from drakegait.walker import feet
from drakegait.walker.feet import ContactSettings

FRICTION_REGULARISATION = 1e-6  # of squared body weight, docs/formulation.md 6.9
_USUAL = ContactSettings().friction


def _foot_rows(foot: int, *rows: int) -> list[int]:
    return [foot * feet.ROWS_PER_FOOT + row for row in rows]


class Friction(DenseRows):
    """One quadratic cone per foot, divided by squared body weight.

    On a ground more slippery than usual the divisor shrinks with the squared friction: what a
    solver leaves of a row (1e-3) would else be more than such a ground bears.
    """

    kind = "friction"
    row_names = ("foot_r", "foot_l")
    units = ("N^2",) * 2

    def __init__(self, formulation: Formulation, points: ControlPoints):
        super().__init__(formulation, points)
        slippery = min(1.0, formulation.contact.friction / _USUAL)
        self.scale = np.full(2, (slippery * formulation.body_weight) ** 2)
        self._least = FRICTION_REGULARISATION / slippery**2
        self.lower, self.upper = np.zeros(2), np.full(2, np.inf)
        loaded = points.loaded[:, : feet.NUM_ROWS]
        by_foot = loaded.reshape(points.num, 2, feet.ROWS_PER_FOOT)
        self.applies = by_foot.any(axis=2)
        masks = no_dependence(2, points.layout)
        for foot in range(2):
            masks["multipliers"][foot, _foot_rows(foot, 0, 1, 2, 3, 4, 5)] = True
        self._declare(Pattern(**masks))

    def values(self, state: LocalState) -> np.ndarray:
        force = state.ground_reactions
        grip = (self.formulation.contact.friction * force[:, :, 2]) ** 2
        slip = force[:, :, 0] ** 2 + force[:, :, 1] ** 2
        return (grip - slip) / self.scale - self._least

    def partials(self, state: LocalState) -> Partials:
        force = state.ground_reactions
        out = np.zeros((state.points.num, 2, feet.NUM_ROWS))
        factors = (-2.0, -2.0, 2.0 * self.formulation.contact.friction**2)
        for foot in range(2):
            for axis, factor in enumerate(factors):
                for row in _foot_rows(foot, axis, 3 + axis):
                    out[:, foot, row] = factor * force[:, foot, axis]
        return Partials(multipliers=out * state.points.loaded[:, None, : feet.NUM_ROWS])


class FreeMoment(DenseRows):
    """Grip left for twisting, both ways, per foot [10 N m]."""

    kind = "free moment"
    row_names = tuple(
        f"foot_{side} turned {way}" for side in ("r", "l") for way in ("left", "right")
    )
    units = ("N m",) * 4

    def __init__(self, formulation: Formulation, points: ControlPoints):
        super().__init__(formulation, points)
        self.scale = np.full(4, 10.0)
        self.lower, self.upper = np.zeros(4), np.full(4, np.inf)
        yaw = points.loaded[:, list(feet.YAW_ROWS)]
        self.applies = np.repeat(yaw, 2, axis=1)
        masks = no_dependence(4, points.layout)
        for foot in range(2):
            for k in range(2):
                masks["multipliers"][2 * foot + k, _foot_rows(foot, 2, 5, 6)] = True
        self._declare(Pattern(**masks))
        self._matrix = self._grip_matrix(points)

    def _grip_matrix(self, points: ControlPoints) -> np.ndarray:
        contact, length = self.formulation.contact, self.formulation.walker.foot.length
        matrix = np.zeros((self.points.num, 4, feet.NUM_ROWS))
        for foot in range(2):
            heel, toe, yaw = _foot_rows(foot, 2, 5, 6)
            heel_down = points.loaded[:, heel]
            for k, sign in enumerate((-1.0, 1.0)):
                row = 2 * foot + k
                matrix[:, row, heel] = contact.friction * contact.patch_radius
                matrix[:, row, toe] = contact.friction * (
                    contact.patch_radius + np.where(heel_down, length, 0.0)
                )
                matrix[:, row, yaw] = sign
        return matrix * points.loaded[:, None, : feet.NUM_ROWS]

    def _matrix_at(self, state: LocalState) -> np.ndarray:
        return self._matrix[state.points.numbers]

    def values(self, state: LocalState) -> np.ndarray:
        multipliers = state.multipliers[:, : feet.NUM_ROWS]
        return np.einsum("prk,pk->pr", self._matrix_at(state), multipliers) / self.scale

    def partials(self, state: LocalState) -> Partials:
        return Partials(multipliers=self._matrix_at(state))


class NormalForce(DenseRows):
    """Vertical forces of the four points by eq. (17), as rows [body weight]."""

    kind = "normal force"
    row_names = feet.POINT_NAMES
    units = ("N",) * 4

    def __init__(self, formulation: Formulation, points: ControlPoints):
        super().__init__(formulation, points)
        self.scale = np.full(4, formulation.body_weight)
        self.lower, self.upper = np.zeros(4), np.full(4, np.inf)
        self._rows = list(feet.VERTICAL_ROWS)
        self.applies = points.loaded[:, self._rows]
        masks = no_dependence(4, points.layout)
        masks["multipliers"][range(4), self._rows] = True
        self._declare(Pattern(**masks))

    def values(self, state: LocalState) -> np.ndarray:
        return state.multipliers[:, self._rows] / self.scale

    def partials(self, state: LocalState) -> Partials:
        out = np.zeros((state.points.num, 4, feet.NUM_ROWS))
        out[:, range(4), self._rows] = 1.0
        return Partials(multipliers=out)


class ToeTorque(DenseRows):
    """Torques at the toe of the foot that stands alone, by eq. (17), as rows [their limit]."""

    kind = "toe torque"
    row_names = feet.TORQUE_NAMES
    units = ("N m",) * len(row_names)

    def __init__(self, formulation: Formulation, points: ControlPoints):
        super().__init__(formulation, points)
        num, self._rows = self.num_rows, list(range(feet.NUM_ROWS, feet.NUM_ROWS_WITH_TORQUES))
        self.scale = np.full(num, formulation.contact.toe_torque_limit)
        self.lower, self.upper = -np.ones(num), np.ones(num)
        self.applies = points.loaded[:, self._rows]
        masks = no_dependence(num, points.layout)
        masks["multipliers"][range(num), self._rows] = True
        self._declare(Pattern(**masks))

    def values(self, state: LocalState) -> np.ndarray:
        return state.multipliers[:, self._rows] / self.scale

    def partials(self, state: LocalState) -> Partials:
        out = np.zeros((state.points.num, self.num_rows, state.points.layout.num_rows))
        out[:, range(self.num_rows), self._rows] = 1.0
        return Partials(multipliers=out)
