"""Weighted second derivatives of laws and energy by physical quantities.

At each control point the Lagrangian is seen as a function of coordinates and
muscle forces with their first two time derivatives, contact multipliers and
residuals; muscle lengths are folded into the coordinates.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from drakegait.program.equations_of_motion import EquationsOfMotion
from drakegait.program.excitation import Excitation, excitation_rows, excitation_weights
from drakegait.program.foot_contact import Clearance, FootContact
from drakegait.program.joint_limits import JointLimits
from drakegait.program.least_squares_multipliers import LeastSquaresMultipliers
from drakegait.program.local_rows import LocalRows
from drakegait.program.local_state import LocalState
from drakegait.walker import feet
from drakegait.walker.corners import CornerSlopes
from drakegait.walker.dynamics_curvature import DynamicsCurvature, Weights

LawWeights = Callable[[type[LocalRows]], np.ndarray | None]
"""Multipliers of one law over physical rows (num, num_rows); None if it is not stated."""


@dataclass(frozen=True)
class PhysicalHessian:
    """Second and first derivatives of the Lagrangian; orders 0, 1, 2 of time have an axis.

    Attributes:
        motion, motion_first: by coordinates (num, n, 3, n, 3) and (num, n, 3).
        force, force_first: by muscle forces (num, m, 3, 3) and (num, m, 3).
        cross: by a muscle's force and its length (num, m, 3, 3).
        multipliers, residuals: by those and the coordinates (num, 14, n), (num, n, n).
        muscles: what the muscles contribute to `motion`, `force` and `cross`, by their inputs f,
            f', f'', l, l', l'' and without springs (num, m, 6, 6).
    """

    motion: np.ndarray
    motion_first: np.ndarray
    force: np.ndarray
    force_first: np.ndarray
    cross: np.ndarray
    multipliers: np.ndarray
    residuals: np.ndarray
    muscles: np.ndarray


def physical_hessian(
    state: LocalState,
    curvature: DynamicsCurvature,
    weights: LawWeights,
    power: np.ndarray,
    springs: np.ndarray | None = None,
    corners: CornerSlopes | None = None,
) -> PhysicalHessian:
    """All laws by their multipliers, and the muscles' power by the weight `power` (num,).

    With `springs` w (num, 2 num_muscles) on the excitation rows g, w g_y^T g_y is added; with
    `corners` those of the muscles curve as steps need (`walker.corners`).
    """
    walker = state.formulation.walker
    balance = weights(EquationsOfMotion)
    contact = weights(FootContact).copy()
    contact[:, list(feet.VERTICAL_ROWS)] += weights(Clearance)
    velocities = weights(LeastSquaresMultipliers)
    blocks = curvature.evaluate(
        state.q, state.v, state.motion.acceleration, state.multipliers, state.residuals,
        Weights(balance, velocities, contact),
    )  # fmt: skip
    num, n = state.q.shape
    motion = np.zeros((num, n, 3, n, 3))
    motion[:, :, 0, :, 0] = blocks.qq - walker.passive.curvature(state.q, balance)
    motion[:, :, 0, :, 1] = blocks.qv
    motion[:, :, 1, :, 0] = np.swapaxes(blocks.qv, 1, 2)
    motion[:, :, 1, :, 1] = blocks.vv
    motion[:, :, 0, :, 2] = blocks.qa
    motion[:, :, 2, :, 0] = np.swapaxes(blocks.qa, 1, 2)
    first = _first_derivatives(state, balance, velocities, contact, weights(JointLimits))
    excitation = excitation_weights(walker, weights(Excitation))
    curved, by_muscle = _muscles(state, excitation, power, corners)
    muscles = curved
    if springs is not None:
        slopes = excitation_rows(walker, state.muscles[1][:, :, :2])
        stiff = springs.reshape(*slopes.shape[:3], 1) * slopes
        muscles = curved + np.swapaxes(slopes, 2, 3) @ stiff
    arms = walker.muscles.moment_arms
    motion += _by_lengths(muscles, arms)
    first -= arms.T @ by_muscle[:, :, 3:]
    force_first = by_muscle[:, :, :3].copy()
    force_first[:, :, 0] -= balance @ arms.T
    return PhysicalHessian(
        motion, first, muscles[:, :, :3, :3], force_first, muscles[:, :, :3, 3:],
        np.swapaxes(blocks.ql, 1, 2), np.swapaxes(blocks.qe, 1, 2), curved,
    )  # fmt: skip


def hessian_of_muscles(
    physical: PhysicalHessian, muscles: np.ndarray, arms: np.ndarray
) -> PhysicalHessian:
    """As `physical`, with second derivatives by the muscles' inputs (num, m, 6, 6) and no others.

    Args:
        arms: moment arms (m, n).
    """
    rest = {
        name: np.zeros_like(getattr(physical, name))
        for name in ("motion_first", "force_first", "multipliers", "residuals")
    }
    return PhysicalHessian(
        motion=_by_lengths(muscles, arms),
        force=muscles[:, :, :3, :3],
        cross=muscles[:, :, :3, 3:],
        muscles=muscles,
        **rest,
    )


def _by_lengths(muscles: np.ndarray, arms: np.ndarray) -> np.ndarray:
    """By coordinates and orders (num, n, 3, n, 3): muscle lengths are l0 - arms q."""
    num, (m, n) = len(muscles), arms.shape
    pairs = (arms[:, :, None] * arms[:, None]).reshape(m, n * n)
    lengths = muscles[:, :, 3:, 3:].transpose(0, 2, 3, 1) @ pairs
    return lengths.reshape(num, 3, 3, n, n).transpose(0, 3, 1, 4, 2)


def _first_derivatives(
    state: LocalState,
    balance: np.ndarray,
    velocities: np.ndarray,
    contact: np.ndarray,
    limits: np.ndarray | None,
) -> np.ndarray:
    """Gradient of the weighted laws by coordinates, velocities, accelerations (num, n, 3)."""
    dynamics, formulation = state.dynamics, state.formulation

    def along(weights: np.ndarray, rows: np.ndarray) -> np.ndarray:
        return (weights[:, None] @ rows)[:, 0]

    by_q = along(balance, dynamics.by_q)
    by_q += along(velocities, state.contact_turning)
    by_q += along(contact, state.contact_positions[1])
    if limits is not None:
        names = formulation.walker.coordinate_names
        for k, limit in enumerate(formulation.limits):
            by_q[:, names.index(limit.coordinate)] += limits[:, k]
    by_v, by_a = along(balance, dynamics.by_v), along(balance, dynamics.mass_matrix)
    return np.stack([by_q, by_v, by_a], axis=-1)


def _muscles(
    state: LocalState, excitation: np.ndarray, power: np.ndarray, corners: CornerSlopes | None
) -> tuple[np.ndarray, np.ndarray]:
    """Weighted Hessian (num, m, 6, 6) and gradient (num, m, 6) by the muscles' inputs."""
    functions = state.formulation.walker.muscle_functions
    num, m = state.muscle_inputs.shape[:2]
    weights = np.concatenate(
        [excitation.reshape(num, m, 2), np.broadcast_to(power[:, None, None], (num, m, 1))], axis=2
    )
    hessian = functions.hessian(state.muscle_inputs, weights, state.smoothing, corners)
    return hessian, (weights[:, :, None] @ state.muscles[1])[:, :, 0]
