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

from drakegait.program.excitation import MuscleChain
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
    blocks: HessianBlocks, physical: PhysicalHessian, directions: Directions, spans: MuscleChain
) -> None:
    """Add the local second derivatives of `physical` to `blocks`."""
    _coefficients(blocks, physical, spans)
    _late(blocks, physical, directions, spans.arms)
    _posture(blocks, physical, directions)


def _coefficients(blocks: HessianBlocks, physical: PhysicalHessian, spans: MuscleChain) -> None:
    """Between spline coefficients."""
    b = blocks.b
    num, n, _, _, _ = physical.motion.shape
    bt = np.swapaxes(b, 1, 2)[:, None]
    inner = (physical.motion.reshape(num, n * 3 * n, 3) @ b).reshape(num, n, 3, -1)
    blocks.cc += (bt @ inner).reshape(blocks.cc.shape)
    blocks.ff += bt @ physical.force @ b[:, None]
    block = bt @ physical.cross @ b[:, None]  # by force and length
    blocks.fc = -spans.arm_of_span[:, None, None] * block[:, spans.muscle_of_span]


def _late(
    blocks: HessianBlocks, physical: PhysicalHessian, directions: Directions, arms: np.ndarray
) -> None:
    """With tau, T and L, hence with the late variables."""
    state, motion, force = blocks.state, physical.motion, physical.force
    num, n = motion.shape[:2]
    first, force_first = physical.motion_first, physical.force_first
    period = state.stride_time[:, :, None]
    dy, df = directions.motion, directions.force
    lengths = -np.einsum("mi,pdia->pdma", arms, dy)
    slope = np.einsum("pxy,pdy->pdx", motion.reshape(num, n * 3, n * 3), dy.reshape(num, 3, -1))
    slope = slope.reshape(dy.shape)
    crossed = np.einsum("pmab,pdma->pdmb", physical.cross, df)
    slope -= np.einsum("pdmb,mi->pdib", crossed, arms)
    slope_f = np.einsum("pmab,pdmb->pdma", force, df)
    slope_f += np.einsum("pmab,pdmb->pdma", physical.cross, lengths)
    small = np.einsum("pdia,peia->pde", slope, dy) + np.einsum("pdma,pema->pde", slope_f, df)
    by_c, by_f = slope @ blocks.b[:, None], slope_f @ blocks.b[:, None]
    # y itself bends: coefficients with tau and with T ...
    by_c[:, 0] += first @ blocks.b_tau
    by_f[:, 0] += force_first @ blocks.b_tau
    by_c[:, 1] -= (first * _ORDER) @ blocks.b / period
    by_f[:, 1] -= (force_first * _ORDER) @ blocks.b / period
    # ... and tau, T, L among themselves.
    small += _own_bending(blocks, physical, directions)
    late = directions.by_late
    blocks.late += np.swapaxes(late, 1, 2) @ small @ late
    blocks.late_c += np.einsum("pdl,pdcw->plcw", late, by_c, optimize=True)
    blocks.late_f += np.einsum("pdl,pdcw->plcw", late, by_f, optimize=True)


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


def _posture(
    blocks: HessianBlocks, physical: PhysicalHessian, directions: Directions
) -> None:
    """Multipliers and residuals, which meet the motion through the posture only."""
    b0, by_tau = blocks.b[:, 0], directions.motion[:, 0, :, 0]
    for rows, by_c, by_time in (
        (physical.multipliers, blocks.multiplier_c, blocks.multiplier_time),
        (physical.residuals, blocks.residual_c, blocks.residual_time),
    ):
        by_c += rows[:, :, :, None] * b0[:, None, None, :]
        along = np.einsum("prj,pj->pr", rows, by_tau)
        by_time += along[:, :, None] * blocks.tau_by_time[:, None]


def _dot(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    return np.einsum("pia,pia->p", a, b)
