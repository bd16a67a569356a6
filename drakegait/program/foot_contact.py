"""Constraints: the feet stay on their footprints and do not enter the ground.

Contact (item 9 of the paper's section 3.3, docs/formulation.md 6.5): where heel or toe is on the
ground its position, and the heading of its foot, equal those of the footprint
within eps_k = 2 mm and 0.01 rad. Clearance (item 2): elsewhere z >= 0.
"""

from __future__ import annotations

import numpy as np

from drakegait.program.chain import Partials, Pattern, no_dependence
from drakegait.program.control_points import ControlPoints
from drakegait.program.formulation import Formulation
from drakegait.program.local_rows import DenseRows
from drakegait.program.local_state import LocalState
from drakegait.walker import feet


def _position_masks(
    formulation: Formulation, points: ControlPoints, rows: list[int]
) -> dict[str, np.ndarray]:
    """Dependence of contact positions: trunk and own leg, time, placement."""
    masks = no_dependence(len(rows), points.layout)
    for k, row in enumerate(rows):
        other = "_l" if row < feet.ROWS_PER_FOOT else "_r"
        for i, name in enumerate(formulation.walker.coordinate_names):
            masks["coordinates"][k, i] = not name.endswith(other)
        axis = row % feet.ROWS_PER_FOOT
        if axis in (2, 5):  # heights do not see hat_x, hat_y
            for i, name in enumerate(formulation.walker.coordinate_names):
                if name in ("hat_x", "hat_y"):
                    masks["coordinates"][k, i] = False
    masks["time"][:, [2, 3]] = True
    return masks


class FootContact(DenseRows):
    """Contact rows against the footprint, in units of the tolerance."""

    kind = "foot contact"

    def __init__(self, formulation: Formulation, points: ControlPoints):
        super().__init__(formulation, points)
        self.row_names = feet.ROW_NAMES
        self.scale = np.full(feet.NUM_ROWS, formulation.tolerances.contact_tolerance)
        self.scale[list(feet.YAW_ROWS)] = formulation.tolerances.yaw_tolerance
        self.units = tuple("rad" if row in feet.YAW_ROWS else "m" for row in range(feet.NUM_ROWS))
        self.lower, self.upper = -np.ones(feet.NUM_ROWS), np.ones(feet.NUM_ROWS)
        self.applies = points.placed
        masks = _position_masks(formulation, points, list(range(feet.NUM_ROWS)))
        masks["placement"][:] = True
        masks["placement"][list(feet.VERTICAL_ROWS)] = False
        self._declare(Pattern(**masks))

    def values(self, state: LocalState) -> np.ndarray:
        return (state.contact_positions[0] - state.footprints[0]) / self.scale

    def partials(self, state: LocalState) -> Partials:
        return Partials(q=state.contact_positions[1], placement=-state.footprints[1])


class Clearance(DenseRows):
    """Heights of the contact points that are off the ground [cm]."""

    kind = "clearance"

    def __init__(self, formulation: Formulation, points: ControlPoints):
        super().__init__(formulation, points)
        self.row_names = feet.POINT_NAMES
        self.scale = np.full(4, 0.01)
        self.units = ("m",) * 4
        self.lower, self.upper = np.zeros(4), np.full(4, np.inf)
        self.applies = points.free_points
        self._rows = list(feet.VERTICAL_ROWS)
        self._declare(Pattern(**_position_masks(formulation, points, self._rows)))

    def values(self, state: LocalState) -> np.ndarray:
        return state.contact_positions[0][:, self._rows] / self.scale

    def partials(self, state: LocalState) -> Partials:
        return Partials(q=state.contact_positions[1][:, self._rows])
