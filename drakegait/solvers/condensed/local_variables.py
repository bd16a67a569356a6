"""Changes of all unknowns as seen at the control points, and back.

At a control point a change of the unknowns is one of its functions by order (coordinates and
forces by the basis rows over T^order), of its late variables, and of its contact multipliers
and residuals, all in physical units.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from drakegait.program.gait_program import GaitProgram
from drakegait.program.hessian_blocks import HEELS, NUM_LATE, HessianBlocks
from drakegait.walker import feet


@dataclass
class Change:
    """A change, or what multiplies one.

    Attributes:
        functions: (num, n + m, orders), orders 0 to 3 or fewer.
        late: (num, 9).
        local: contact multipliers and residuals (num, 14 + n); zero where a point has none.
    """

    functions: np.ndarray
    late: np.ndarray
    local: np.ndarray


class LocalVariables:
    """The linear map from all unknowns to `Change` at all control points of `program`."""

    def __init__(self, program: GaitProgram):
        layout, index = program.points.layout, program.selection.index
        self._layout, self._num, self._size = layout, program.points.num, program.num_variables
        used = index >= 0
        self._factor = np.where(used, program.selection.factor, 0.0)
        self._take = np.where(used, index, 0)
        self._put = self._take.ravel()
        local = slice(layout.multipliers, layout.size)
        self.used = used[:, local]
        self.scale = np.where(self.used, program.selection.factor[:, local], 1.0)
        self.index = index[:, local]

    def of(self, x: np.ndarray, rows: np.ndarray) -> Change:
        """The change that x (num_variables,) makes; `rows` (num, orders, width)."""
        z = x[self._take] * self._factor
        layout, num = self._layout, self._num
        coefficients = z[:, : layout.time].reshape(num, -1, layout.width)
        functions = coefficients @ np.swapaxes(rows, 1, 2)
        return Change(
            functions, z[:, layout.time : layout.multipliers], z[:, layout.multipliers :]
        )

    def transposed(self, change: Change, rows: np.ndarray) -> np.ndarray:
        """The unknowns' share (num_variables,) in what multiplies a change."""
        num = self._num
        by_coefficient = (change.functions @ rows).reshape(num, -1)
        z = np.concatenate([by_coefficient, change.late, change.local], axis=1)
        z *= self._factor
        return np.bincount(self._put, z.ravel(), self._size)

    def shared(self, x: np.ndarray, rows: np.ndarray) -> np.ndarray:
        """Shared unknowns as `LocalElimination` knows them (num, shared); `rows` of 3 orders."""
        change, n = self.of(x, rows), self._layout.num_coordinates
        motion = change.functions[:, :n].reshape(self._num, -1)
        return np.concatenate([motion, change.functions[:, n:, 0], change.late], axis=1)

    def by_shared(self, shares: np.ndarray, rows: np.ndarray) -> np.ndarray:
        """The transpose of `shared`: the unknowns' share (num_variables,) in what multiplies it."""
        n, m, num = self._layout.num_coordinates, self._layout.num_muscles, self._num
        functions = np.zeros((num, n + m, 3))
        functions[:, :n] = shares[:, : 3 * n].reshape(num, n, 3)
        functions[:, n:, 0] = shares[:, 3 * n : 3 * n + m]
        none = np.zeros(self.used.shape)
        return self.transposed(Change(functions, shares[:, 3 * n + m :], none), rows)

    def local(self, x: np.ndarray) -> np.ndarray:
        """What multiplies local unknowns, from physical by unknown (num, 14 + n)."""
        start = self._layout.multipliers
        return np.where(self.used, x[self._take[:, start:]] / self.scale, 0.0)

    def into(self, x: np.ndarray, local: np.ndarray) -> None:
        """Set the local unknowns in `x` to the physical `local`."""
        x[self.index[self.used]] = local[self.used] / self.scale[self.used]

    def hessian(self, blocks: HessianBlocks, diagonal: np.ndarray) -> np.ndarray:
        """Second derivatives by local unknowns (num, 14 + n, 14 + n), physical units, with the
        barrier's `diagonal` (num_variables,)."""
        num, count = self.used.shape
        out = np.zeros((num, count, count))
        which, rows = np.arange(count), np.arange(feet.NUM_ROWS)
        out[:, rows, rows] = blocks.multipliers
        out[:, HEELS, HEELS + 3] = out[:, HEELS + 3, HEELS] = blocks.heel_toe
        out *= self.used[:, :, None] & self.used[:, None]
        safe = np.where(self.used, self.index, 0)
        scale = np.where(self.used, self.scale, np.inf)
        out[:, which, which] += diagonal[safe] / scale**2
        return out

    def mixed_hessian(self, blocks: HessianBlocks, shared: int) -> np.ndarray:
        """Second derivatives by local and shared unknowns (num, 14 + n, shared)."""
        num, count = self.used.shape
        n, late = count - feet.NUM_ROWS, shared - NUM_LATE
        out = np.zeros((num, count, shared))
        out[:, : feet.NUM_ROWS, : 3 * n : 3] = blocks.multiplier_motion
        out[:, feet.NUM_ROWS :, : 3 * n : 3] = blocks.residual_motion
        time = slice(late, late + blocks.multiplier_time.shape[2])
        out[:, : feet.NUM_ROWS, time] = blocks.multiplier_time
        out[:, feet.NUM_ROWS :, time] = blocks.residual_time
        out *= self.used[:, :, None]
        return out


def hessian_times(blocks: HessianBlocks, arms: np.ndarray, change: Change) -> Change:
    """The Hessian of `blocks` times a change of all four orders."""
    num, n = blocks.motion.shape[:2]
    motion, force = change.functions[:, :n], change.functions[:, n:]
    late, local = change.late[..., None], change.local
    out = np.empty_like(change.functions)
    count = blocks.multipliers.shape[1]
    for block, part in ((blocks.late_motion, out[:, :n]), (blocks.late_force, out[:, n:])):
        flat = block.reshape(num, late.shape[1], -1)
        part[...] = (np.swapaxes(flat, 1, 2) @ late).reshape(part.shape)
    own = motion[..., :3].reshape(num, -1, 1)
    out[:, :n, :3] += (blocks.motion.reshape(num, 3 * n, 3 * n) @ own).reshape(num, n, 3)
    lengths = -arms @ motion[..., :3]
    out[:, n:, :3] += (blocks.force @ force[..., :3, None] + blocks.cross @ lengths[..., None])[
        ..., 0
    ]
    by_length = (force[..., None, :3] @ blocks.cross)[..., 0, :]
    out[:, :n, :3] -= arms.T @ by_length
    multipliers, residuals = local[:, :count, None], local[:, count:, None]
    by_time = np.swapaxes(blocks.multiplier_time, 1, 2) @ multipliers
    by_time += np.swapaxes(blocks.residual_time, 1, 2) @ residuals
    posture = np.swapaxes(blocks.multiplier_motion, 1, 2) @ multipliers
    posture += np.swapaxes(blocks.residual_motion, 1, 2) @ residuals
    out[:, :n, 0] += posture[..., 0]
    out_late = blocks.late @ late
    out_late += blocks.late_motion.reshape(num, -1, n * 4) @ motion.reshape(num, -1, 1)
    out_late += blocks.late_force.reshape(num, out_late.shape[1], -1) @ force.reshape(num, -1, 1)
    time = by_time.shape[1]
    out_late[:, :time] += by_time
    out_local = np.empty_like(local)
    now, times = motion[:, :, :1], late[:, :time]
    out_local[:, :count] = (blocks.multiplier_motion @ now + blocks.multiplier_time @ times)[..., 0]
    out_local[:, count:] = (blocks.residual_motion @ now + blocks.residual_time @ times)[..., 0]
    out_local[:, :count] += blocks.multipliers * local[:, :count]
    out_local[:, HEELS] += blocks.heel_toe * local[:, HEELS + 3]
    out_local[:, HEELS + 3] += blocks.heel_toe * local[:, HEELS]
    return Change(out, out_late[..., 0], out_local)
