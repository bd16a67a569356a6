"""Contact forces and residuals eliminated at every control point.

At a control point the equations of motion and C e = 0, linearised,

    de = R dy - C^T dlambda + c_1,      C de + Q dq = -c_2,

determine the local unknowns lambda, e by what the control points share, y (motion, muscle
forces, timing, placement):

    dlambda = G^-1 (C R dy + Q dq + C c_1 + c_2),      G = C C^T,

which is the pseudo-inverse of eq. (17). What the Lagrangian has in the local unknowns thus
becomes a dense block in y.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from drakegait.program.chain import Partials
from drakegait.program.hessian_blocks import NUM_LATE
from drakegait.program.lagrangian_hessian import LocalCurvature
from drakegait.program.local_state import LocalState
from drakegait.walker import feet


@dataclass(frozen=True)
class LocalElimination:
    """The linear map from shared to local unknowns at all control points, physical units.

    Shared unknowns y are, in this order, coordinates with their two time derivatives
    (3 num_coordinates), muscle forces, and the nine late variables of `HessianBlocks`.

    Attributes:
        contact: C, zero in rows that are not loaded (num, 14, num_coordinates).
        inverse: G^-1 (num, 14, 14).
        by_shared: d(lambda, e)/dy (num, 14 + num_coordinates, shared).
        late: change of motion and forces with the late variables (num, 3n + m, 9).
    """

    contact: np.ndarray
    inverse: np.ndarray
    by_shared: np.ndarray
    late: np.ndarray

    @classmethod
    def at(cls, state: LocalState, curvature: LocalCurvature) -> LocalElimination:
        """The elimination at `state`."""
        walker, loaded = state.formulation.walker, state.points.loaded
        dynamics, (num, n) = state.dynamics, state.q.shape
        contact = state.contact_jacobian * loaded[:, :, None]
        gram = contact @ np.swapaxes(contact, 1, 2)
        rows = np.arange(feet.NUM_ROWS)
        gram[:, rows, rows] += ~loaded
        inverse = np.linalg.inv(gram)
        arms = walker.muscles.moment_arms
        motion = np.stack([dynamics.by_q, dynamics.by_v, dynamics.mass_matrix], axis=-1)
        forces = np.broadcast_to(-arms.T, (num, n, len(arms)))
        balance = np.concatenate([motion.reshape(num, n, 3 * n), forces], axis=2)
        needed = contact @ balance
        needed[:, :, : 3 * n : 3] += state.contact_turning * loaded[:, :, None]
        multipliers = inverse @ needed
        residuals = balance - np.swapaxes(contact, 1, 2) @ multipliers
        local = np.concatenate([multipliers, residuals], axis=1)
        directions = curvature.directions
        by_direction = np.concatenate(
            [directions.motion.reshape(num, 3, 3 * n), directions.force[..., 0]], axis=2
        )
        late = np.swapaxes(by_direction, 1, 2) @ directions.by_late
        return cls(contact, inverse, np.concatenate([local, local @ late], axis=2), late)

    def local(self, balance: np.ndarray, least: np.ndarray) -> np.ndarray:
        """dlambda, de for right-hand sides c_1 (num, n), c_2 (num, 14) at fixed y."""
        along = self.contact @ balance[..., None] + least[..., None]
        multipliers = self.inverse @ along
        carried = np.swapaxes(self.contact, 1, 2) @ multipliers
        return np.concatenate([multipliers[..., 0], balance - carried[..., 0]], axis=1)

    def rows(self, multipliers: np.ndarray, residuals: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """The transposed problem: weights of both laws for local right-hand sides b."""
        along = self.contact @ residuals[..., None] - multipliers[..., None]
        least = self.inverse @ along
        carried = np.swapaxes(self.contact, 1, 2) @ least
        return carried[..., 0] - residuals, least[..., 0]

    def rows_by_shared(
        self, partials: Partials, num_rows: int, tau_by_time: np.ndarray
    ) -> np.ndarray:
        """Derivatives of rows by y at fixed local unknowns (num, num_rows, shared)."""
        num, _, n = self.contact.shape
        shared = self.by_shared.shape[2]
        own = shared - NUM_LATE
        out = np.zeros((num, num_rows, shared))
        for order, partial in enumerate((partials.q, partials.v, partials.a)):
            if partial is not None:
                out[:, :, order : 3 * n : 3] += partial
        if partials.f is not None:
            out[:, :, 3 * n : own] += partials.f
        late = out[:, :, own:]
        late += out[:, :, :own] @ self.late
        if partials.tau is not None:
            late[:, :, : tau_by_time.shape[1]] += partials.tau[:, :, None] * tau_by_time[:, None]
        if partials.stride_time is not None:
            late[:, :, 0] += partials.stride_time
        if partials.events is not None:
            late[:, :, 1:4] += partials.events
        if partials.placement is not None:
            late[:, :, 4:] += partials.placement
        return out
