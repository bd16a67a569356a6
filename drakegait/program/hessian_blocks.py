"""Second derivatives at control points as small dense blocks, and where they go.

The local variables of a control point fall into groups: coefficients of
coordinates and of muscle forces, *late* variables (stride time, three
events, five placement parameters), contact multipliers and residuals. Only
some pairs of groups are coupled; each pair has one array with the control
point as its leading axis. Coefficients are only seen through the basis rows
of a few orders of the time derivative, so blocks are held by *order*:
coefficient j of a function has the part sum_k rows_jk (entry of order k).
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import lru_cache

import numpy as np

from drakegait.program.excitation import MuscleChain
from drakegait.program.local_state import LocalState

NUM_TIME = 4  # stride time and three events
NUM_LATE = NUM_TIME + 5  # and the placement
HEELS = np.array([0, 1, 2, 7, 8, 9])  # contact rows of the heels; the toes' are three further


class HessianBlocks:
    """The blocks at the control points of `state`, zero at first, to be added to.

    Attributes:
        rows: basis rows over T^order for orders 0 to 3 (num, 4, width).
        b_tau_tau: second derivatives by tau of those of the orders 0, 1, 2 (num, 3, width).
        tau_by_time: derivatives of tau by stride time and events (num, 4).
        motion: by coordinates and orders (num, n, 3, n, 3).
        force: by a muscle's force and orders (num, m, 3, 3).
        cross: by a muscle's force and its length, and orders (num, m, 3, 3).
        late_motion, late_force: by late variables, and by coordinates or forces and orders
            (num, 9, n, 4), (num, 9, m, 4).
        late: (num, 9, 9).
        multiplier_motion, residual_motion: and by coordinates, order 0 (num, rows, n), (num, n, n).
        multiplier_time, residual_time: and by stride time and events (num, ..., 4).
        multipliers: the diagonal (num, rows).
        heel_toe: what couples the two points of a foot (num, 6), see `HEELS`.
    """

    def __init__(self, state: LocalState):
        self.state = state
        layout, num = state.points.layout, state.points.num
        n, m = layout.num_coordinates, layout.num_muscles
        powers = state.stride_time[:, :, None] ** -np.arange(4.0)[:, None]  # (num, 4, 1)
        splines = state.formulation.splines
        fourth = splines.windowed_basis(state.tau, state.points.first, layout.width, 4)
        self.rows = np.swapaxes(state.basis, 0, 1) * powers
        bent = np.stack([state.basis[2], state.basis[3], fourth], axis=1)
        self.b_tau_tau = bent * powers[:, :3]
        self.tau_by_time = np.zeros((num, NUM_TIME))
        self.tau_by_time[:, 2] = 1.0 - state.points.shares
        self.tau_by_time[:, 3] = state.points.shares
        self.motion = np.zeros((num, n, 3, n, 3))
        self.force = np.zeros((num, m, 3, 3))
        self.cross = np.zeros((num, m, 3, 3))
        self.late_motion = np.zeros((num, NUM_LATE, n, 4))
        self.late_force = np.zeros((num, NUM_LATE, m, 4))
        self.late = np.zeros((num, NUM_LATE, NUM_LATE))
        self.multiplier_motion = np.zeros((num, layout.num_rows, n))
        self.multiplier_time = np.zeros((num, layout.num_rows, NUM_TIME))
        self.multipliers = np.zeros((num, layout.num_rows))
        self.heel_toe = np.zeros((num, len(HEELS)))
        self.residual_motion = np.zeros((num, n, n))
        self.residual_time = np.zeros((num, n, NUM_TIME))

    def values(self, spans: MuscleChain) -> np.ndarray:
        """All entries by local variables (num, entries) in the order of `places`."""
        num, n = self.motion.shape[:2]
        rows, width = self.rows, self.rows.shape[2]
        b, b0 = rows[:, :3], rows[:, None, None, 0]
        bt = np.swapaxes(b, 1, 2)[:, None]
        inner = (self.motion.reshape(num, n * 3 * n, 3) @ b).reshape(num, n, 3, -1)
        low, low_late = _triangle(width), _triangle(NUM_LATE)
        crossed = bt @ self.cross @ b[:, None]  # by force and length
        parts = [
            (bt @ inner).reshape(num, -1)[:, _triangle(n * width)],
            (bt @ self.force @ b[:, None]).reshape(num, -1, width * width)[..., low],
            -spans.arm_of_span[:, None, None] * crossed[:, spans.muscle_of_span],
            self.late_motion @ rows[:, None],
            self.late_force @ rows[:, None],
            self.late.reshape(num, -1)[:, low_late],
            self.multiplier_motion[..., None] * b0,
            self.multiplier_time,
            self.multipliers,
            self.heel_toe,
            self.residual_motion[..., None] * b0,
            self.residual_time,
        ]
        return np.concatenate([part.reshape(num, -1) for part in parts], axis=1)


@lru_cache(maxsize=16)
def _triangle(size: int) -> np.ndarray:
    """Places of the lower triangle in a flattened matrix."""
    rows, columns = np.tril_indices(size)
    return rows * size + columns


def places(state: LocalState, chain: MuscleChain) -> tuple[np.ndarray, np.ndarray]:
    """Local row and column of each of `HessianBlocks.values`; one triangle of each pair."""
    pairs = list(_places(state, chain))
    return np.concatenate([pair[0] for pair in pairs]), np.concatenate([p[1] for p in pairs])


def _places(state: LocalState, chain: MuscleChain) -> Iterator[tuple[np.ndarray, np.ndarray]]:
    layout = state.points.layout
    width, window = layout.width, np.arange(layout.width)
    c = np.arange(layout.forces)
    f = layout.forces + np.arange(layout.num_muscles * width).reshape(-1, width)
    late = np.arange(layout.time, layout.multipliers)
    time = late[:NUM_TIME]
    multipliers = np.arange(layout.multipliers, layout.residuals)
    residuals = np.arange(layout.residuals, layout.size)
    low, low_c, low_late = (np.tril_indices(k) for k in (width, len(c), NUM_LATE))

    def grid(rows: np.ndarray, columns: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        shape = (*rows.shape, columns.shape[-1])
        left = np.broadcast_to(rows[..., None], shape)
        right = np.broadcast_to(columns[..., None, :], shape)
        return left.ravel(), right.ravel()

    yield c[low_c[0]], c[low_c[1]]
    yield f[:, low[0]].ravel(), f[:, low[1]].ravel()
    yield grid(f[chain.muscle_of_span], chain.coordinate_of_span[:, None] * width + window)
    yield grid(late, c)
    yield grid(late, f.ravel())
    yield late[low_late[0]], late[low_late[1]]
    yield grid(multipliers, c)
    yield grid(multipliers, time)
    yield multipliers, multipliers
    yield multipliers[HEELS + 3], multipliers[HEELS]
    yield grid(residuals, c)
    yield grid(residuals, time)
