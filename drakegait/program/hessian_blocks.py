"""Second derivatives at control points as small dense blocks, and where they go.

The local variables of a control point fall into groups: coefficients of
coordinates (c) and of muscle forces (f), *late* variables (stride time, three
events, five placement parameters), contact multipliers and residuals. Only
some pairs of groups are coupled; each pair has one array with the control
point as its leading axis.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from drakegait.program.excitation import MuscleChain
from drakegait.program.local_state import LocalState

NUM_TIME = 4  # stride time and three events
NUM_LATE = NUM_TIME + 5  # and the placement
_HEELS = np.array([0, 1, 2, 7, 8, 9])  # contact rows of the heels; the toes' are three further


class HessianBlocks:
    """The blocks at the control points of `state`, zero at first, to be added to.

    Attributes:
        b, b_tau, b_tau_tau: basis rows over T^order for orders 0, 1, 2 (num, 3, width), and
            their derivatives by tau.
        tau_by_time: derivatives of tau by stride time and events (num, 4).
        cc, ff, fc, late_c, late_f, late, multiplier_c, multiplier_time, multipliers,
            heel_toe, residual_c, residual_time: the blocks; `fc` holds one window by window
            block for each coordinate that a muscle spans, `multipliers` the diagonal and
            `heel_toe` what couples the two points of a foot.
    """

    def __init__(self, state: LocalState):
        self.state = state
        layout, num = state.points.layout, state.points.num
        width, n, m = layout.width, layout.num_coordinates, layout.num_muscles
        period = state.stride_time[:, 0]
        scale = np.stack([np.ones(num), 1.0 / period, 1.0 / period**2], axis=1)[:, :, None]
        splines = state.formulation.splines
        fourth = splines.windowed_basis(state.tau, state.points.first, width, 4)
        rows = np.swapaxes(np.concatenate([state.basis, fourth[None]]), 0, 1)
        self.b, self.b_tau, self.b_tau_tau = (rows[:, k : k + 3] * scale for k in range(3))
        self.tau_by_time = np.zeros((num, NUM_TIME))
        self.tau_by_time[:, 2] = 1.0 - state.points.shares
        self.tau_by_time[:, 3] = state.points.shares
        self.cc = np.zeros((num, n, width, n, width))
        self.ff = np.zeros((num, m, width, width))
        self.fc = np.zeros((num, 0, width, width))
        self.late_c = np.zeros((num, NUM_LATE, n, width))
        self.late_f = np.zeros((num, NUM_LATE, m, width))
        self.late = np.zeros((num, NUM_LATE, NUM_LATE))
        self.multiplier_c = np.zeros((num, layout.num_rows, n, width))
        self.multiplier_time = np.zeros((num, layout.num_rows, NUM_TIME))
        self.multipliers = np.zeros((num, layout.num_rows))
        self.heel_toe = np.zeros((num, len(_HEELS)))
        self.residual_c = np.zeros((num, n, n, width))
        self.residual_time = np.zeros((num, n, NUM_TIME))

    def values(self) -> np.ndarray:
        """All entries (num, entries) in the order of `places`."""
        num = self.state.points.num
        side = self.cc.shape[1] * self.cc.shape[2]
        rows, columns = np.tril_indices(side)
        low = np.tril_indices(self.cc.shape[2])
        late = np.tril_indices(NUM_LATE)
        parts = [
            self.cc.reshape(num, side, side)[:, rows, columns],
            self.ff[:, :, low[0], low[1]],
            self.fc,
            self.late_c,
            self.late_f,
            self.late[:, late[0], late[1]],
            self.multiplier_c,
            self.multiplier_time,
            self.multipliers,
            self.heel_toe,
            self.residual_c,
            self.residual_time,
        ]
        return np.concatenate([part.reshape(num, -1) for part in parts], axis=1)


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
    yield multipliers[_HEELS + 3], multipliers[_HEELS]
    yield grid(residuals, c)
    yield grid(residuals, time)
