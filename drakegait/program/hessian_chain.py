"""The chain rule of second derivatives, from physical quantities to local variables.

With y the motion and the forces as functions of coefficients, tau, T and the
stride length L,

    H_z = Y_z^T l_yy Y_z + l_y . Y_zz

where Y_zz couples coefficients with tau and T (c b'(tau) / T^k) and those among
themselves.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from drakegait.program.hessian_blocks import NUM_LATE, HessianBlocks
from drakegait.program.local_state import LocalState
from drakegait.program.physical_hessian import PhysicalHessian

_ORDER = np.arange(3.0)  # of the time derivative: y_k carries 1 / T^k


@dataclass(frozen=True)
class Directions:
    """How motion and forces change with tau, T and L, in this order.

    Attributes:
        motion: (num, 3 directions, n, 3 orders).
        force: (num, 3 directions, m, 3 orders).
        by_late: (tau, T, L) by stride time, events and placement (num, 3, 9).
    """

    motion: np.ndarray
    force: np.ndarray
    by_late: np.ndarray

    @classmethod
    def of(cls, state: LocalState, blocks: HessianBlocks) -> Directions:
        """The directions at the control points of `state`."""
        num, period = len(state.q), state.stride_time[:, :, None]
        y = np.stack([state.q, state.v, state.motion.acceleration], axis=-1)
        f = np.stack([state.forces.value, state.forces.rate, state.forces.acceleration], axis=-1)
        by_tau = np.moveaxis(state.motion.by_tau, 0, -1).copy()
        by_tau[:, 0, 0] += state.stride_length  # hat_x advances steadily
        by_length = np.zeros_like(y)
        by_length[:, 0, 0] = state.tau
        by_length[:, 0, 1] = 1.0 / period[:, 0, 0]
        by_late = np.zeros((num, 3, NUM_LATE))
        by_late[:, 0, :4] = blocks.tau_by_time
        by_late[:, 1, 0] = 1.0
        by_late[:, 2, 4:6] = 1.0
        return cls(
            np.stack([by_tau, -_ORDER * y / period, by_length], axis=1),
            np.stack(
                [
                    np.moveaxis(state.forces.by_tau, 0, -1),
                    -_ORDER * f / period,
                    np.zeros_like(f),
                ],
                axis=1,
            ),
            by_late,
        )


def carry(
    blocks: HessianBlocks, physical: PhysicalHessian, directions: Directions, arms: np.ndarray
) -> None:
    """Add the local second derivatives of `physical` to `blocks`."""
    blocks.motion += physical.motion
    blocks.force += physical.force
    blocks.cross += physical.cross
    _late(blocks, physical, directions, arms)
    _posture(blocks, physical, directions)


def _late(
    blocks: HessianBlocks, physical: PhysicalHessian, directions: Directions, arms: np.ndarray
) -> None:
    """With tau, T and L, hence with the late variables."""
    state, motion, force = blocks.state, physical.motion, physical.force
    (num, n), m = motion.shape[:2], force.shape[1]
    first, force_first = physical.motion_first, physical.force_first
    period = state.stride_time[:, :, None]
    dy, df = directions.motion.reshape(num, 3, -1), directions.force
    lengths = -arms @ directions.motion
    slope = (dy @ motion.reshape(num, n * 3, n * 3)).reshape(directions.motion.shape)
    by_muscle, by_length = (np.swapaxes(part, 1, 2) for part in (df, lengths))  # (num, m, 3, 3)
    slope -= arms.T @ np.swapaxes(by_muscle @ physical.cross, 1, 2)
    slope_f = by_muscle @ force + by_length @ np.swapaxes(physical.cross, 2, 3)
    slope_f = np.swapaxes(slope_f, 1, 2).reshape(num, 3, -1)
    small = slope.reshape(num, 3, -1) @ np.swapaxes(dy, 1, 2)
    small += slope_f @ np.swapaxes(df.reshape(num, 3, -1), 1, 2)
    by_motion, by_force = np.zeros((num, 3, n, 4)), np.zeros((num, 3, m, 4))
    by_motion[..., :3], by_force[..., :3] = slope, slope_f.reshape(num, 3, m, 3)
    # y itself bends: coefficients with tau, whose rows are those of the next order times T ...
    by_motion[:, 0, :, 1:] += first * period
    by_force[:, 0, :, 1:] += force_first * period
    # ... and with T ...
    by_motion[:, 1, :, :3] -= first * (_ORDER / period)
    by_force[:, 1, :, :3] -= force_first * (_ORDER / period)
    # ... and tau, T, L among themselves.
    small += _own_bending(blocks, physical, directions)
    late = np.swapaxes(directions.by_late, 1, 2)
    blocks.late += late @ small @ directions.by_late
    for block, part in ((blocks.late_motion, by_motion), (blocks.late_force, by_force)):
        block += (late @ part.reshape(num, 3, -1)).reshape(block.shape)


def _own_bending(
    blocks: HessianBlocks, physical: PhysicalHessian, directions: Directions
) -> np.ndarray:
    """l_y . Y_zz for z = (tau, T, L), (num, 3, 3)."""
    state = blocks.state
    first, force_first = physical.motion_first, physical.force_first
    period = state.stride_time[:, 0]
    out = np.zeros((len(period), 3, 3))
    y_bend, f_bend = state.bending(blocks.b_tau_tau)
    out[:, 0, 0] = _dot(first, y_bend) + _dot(force_first, f_bend)
    steady = np.moveaxis(state.motion.by_tau, 0, -1)  # without the advance, which has no 1 / T^k
    mixed = _dot(first * _ORDER, steady) + _dot(force_first * _ORDER, directions.force[:, 0])
    out[:, 0, 1] = out[:, 1, 0] = -mixed / period
    rise = -(_ORDER + 1.0)
    falling = _dot(first * rise, directions.motion[:, 1])
    falling += _dot(force_first * rise, directions.force[:, 1])
    out[:, 1, 1] = falling / period
    out[:, 0, 2] = out[:, 2, 0] = first[:, 0, 0]
    out[:, 1, 2] = out[:, 2, 1] = -first[:, 0, 1] / period**2
    return out


def _posture(blocks: HessianBlocks, physical: PhysicalHessian, directions: Directions) -> None:
    """Multipliers and residuals, which meet the motion through the posture only."""
    by_tau = directions.motion[:, 0, :, 0, None]
    for rows, by_motion, by_time in (
        (physical.multipliers, blocks.multiplier_motion, blocks.multiplier_time),
        (physical.residuals, blocks.residual_motion, blocks.residual_time),
    ):
        by_motion += rows
        by_time += (rows @ by_tau) * blocks.tau_by_time[:, None]


def _dot(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    return np.einsum("pia,pia->p", a, b)
