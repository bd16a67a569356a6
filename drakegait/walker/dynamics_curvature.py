"""Second derivatives of the equations of motion and of the contact rows, in closed form.

`dynamics_derivatives` continued by one order, with its words and its sums at the world origin.
With virtual velocities w the equations of motion are a sum over bodies (Jourdain's principle),

    phi = w . (M a + k - g) = sum_b W_b . F_b,        W_b the twist of body b at the speeds w.

Seen from what j moves, a change of q_j only moves j's parent p: by psi1_j = V_p x S_j,
omega_j = W_p x S_j, and in acceleration by psi2_j + psi1_j x V; a change of the speed v_j adds S_j
to the velocity and 2 psi1_j + S_j x V to the acceleration. Once more for i, which lies on the
way from the ground to j or is j: with the sums I_c, D_c, F_c, and h_c, e_c, Q_c of

    h = I W,    e = D^T W,    X . Q Y = (X x Y) . h + (W x X) . I Y + (W x Y) . I X

over the bodies moved by j, and S_j x* h_c = g_j,

    d2 phi / dq_i dq_j  = omega_i . r_j + psi2_i . s_j + psi1_i . t_j
    d2 phi / dq_i dv_j  = omega_i . (2 I_c psi1_j + D_c S_j) + psi1_i . u_j
    d2 phi / dv_i dq_j  = 2 psi1_i . s_j + S_i . t_j           (i not j)
    d2 phi / dv_i dv_j  = S_i . u_j
    d2 phi / dq_i da_j  = omega_i . I_c S_j
    d2 phi / da_i dq_j  = S_i . s_j                            (i not j)

    r_j = S_j x* F_c + I_c psi2_j + D_c psi1_j,     s_j = I_c omega_j + g_j
    t_j = D_c^T omega_j + V_p x* g_j + psi1_j x* h_c + S_j x* (e_c - V_p x* h_c) + Q_c^T psi1_j
    u_j = 2 g_j + Q_c^T S_j
"""

from __future__ import annotations

from dataclasses import dataclass, fields

import numpy as np

from drakegait.walker import feet
from drakegait.walker.dynamics_derivatives import (
    Motion,
    Tree,
    cross_motion,
    cross_onto,
    spatial_inertias,
)
from drakegait.walker.skeleton import Skeleton

# Entries that are zero at any posture come out as rounding errors of this share of the block's
# largest entry or less; others of our walkers are above 1e-4 of it.
_NOTHING = 1e-11


@dataclass(frozen=True)
class Weights:
    """Weights of the sum that is differentiated, (num, ...) each.

    Attributes:
        motion: w, of the equations of motion (n,).
        velocities: nu, of the rows C(q) e (14,).
        positions: rho, of the contact positions, yaw by heading (14,).
    """

    motion: np.ndarray
    velocities: np.ndarray
    positions: np.ndarray


@dataclass(frozen=True)
class MotionCurvature:
    """Second derivatives of the weighted sum, (num, n, n) each but `ql` (num, n, 14).

    The letters say by what: coordinates q, velocities v, accelerations a, contact multipliers
    l, residuals e.
    """

    qq: np.ndarray
    qv: np.ndarray
    vv: np.ndarray
    qa: np.ndarray
    ql: np.ndarray
    qe: np.ndarray


class DynamicsCurvature:
    """Curvature of `w.(M a + k - g - C^T lambda) + nu.C e + rho.positions` at many instants."""

    def __init__(self, skeleton: Skeleton):
        self._skeleton = skeleton
        self._zero = self._never_other_than_zero()

    def evaluate(
        self,
        q: np.ndarray,
        v: np.ndarray,
        a: np.ndarray,
        multipliers: np.ndarray,
        residuals: np.ndarray,
        weights: Weights,
    ) -> MotionCurvature:
        """Blocks of second derivatives at instants (num, ...)."""
        blocks = self._evaluate(q, v, a, multipliers, residuals, weights)
        for name, zero in self._zero.items():
            getattr(blocks, name)[:, zero] = 0.0
        return blocks

    def _evaluate(
        self,
        q: np.ndarray,
        v: np.ndarray,
        a: np.ndarray,
        multipliers: np.ndarray,
        residuals: np.ndarray,
        weights: Weights,
    ) -> MotionCurvature:
        motion, geometry = self._skeleton.motion(q), self._skeleton.feet_geometry
        w, nu = weights.motion, weights.velocities
        qq, qv, vv, qa = inverse_dynamics_curvature(self._skeleton.tree, motion, v, a, w)
        qq -= geometry.power_curvature(motion, w, multipliers)
        qq += geometry.power_curvature(motion, residuals, nu)
        qq += geometry.position_curvature(motion, weights.positions)
        ql = -np.swapaxes(geometry.velocity_derivative(motion, w), 1, 2)
        return MotionCurvature(
            qq, qv, vv, qa, ql, np.swapaxes(geometry.force_derivative(motion, nu), 1, 2)
        )

    def _never_other_than_zero(self) -> dict[str, np.ndarray]:
        """Masks of the entries of each block that are zero whatever the motion."""
        n, random = self._skeleton.num_coordinates, np.random.default_rng(0)
        rows = feet.NUM_ROWS_WITH_TORQUES if self._skeleton.toe_torque else feet.NUM_ROWS
        num = 3

        def some(size: int) -> np.ndarray:
            return random.uniform(0.5, 1.5, (num, size)) * random.choice([-1.0, 1.0], (num, size))

        weights = Weights(some(n), some(rows), some(feet.NUM_ROWS))
        blocks = self._evaluate(some(n), some(n), some(n), some(rows), some(n), weights)
        found = {}
        for field in fields(blocks):
            size = np.abs(getattr(blocks, field.name)).max(axis=0)
            found[field.name] = size <= _NOTHING * size.max()
        return found


def inverse_dynamics_curvature(
    tree: Tree, motion: Motion, v: np.ndarray, a: np.ndarray, w: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Second derivatives of w . (M a + bias - gravity forces), w held constant.

    Args:
        v, a, w: (num, n) velocities, accelerations and weights of the coordinates.

    Returns:
        by q and q, by q and v, by v and v, by q and a, (num, n, n) each.
    """
    twists, inward, moves = motion.twists, tree.strictly_inner.T, tree.moves
    steps, weighted = twists * v[..., None], twists * w[..., None]
    ground = np.array([0.0, 0.0, 0.0, 0.0, 0.0, tree.gravity])
    parent_cross = cross_motion(inward @ steps)
    psi1 = _times(parent_cross, twists)
    accelerations = twists * a[..., None] + psi1 * v[..., None]
    psi2 = _times(cross_motion(inward @ accelerations + ground), twists)
    psi2 += _times(parent_cross, psi1)
    omega = _times(cross_motion(inward @ weighted), twists)

    inertia = spatial_inertias(tree, motion)
    velocity = moves.T @ steps
    cross, turning = cross_motion(velocity), cross_motion(moves.T @ weighted)
    gained = inertia @ np.stack(
        [velocity, moves.T @ accelerations + ground, moves.T @ weighted], axis=-1
    )
    momentum, virtual_momentum = gained[..., 0], gained[..., 2]
    carried, turned = inertia @ cross, inertia @ turning
    gyration = cross_onto(momentum) - carried - _transposed(cross) @ inertia
    force = gained[..., 1] - _times(_transposed(cross), momentum)
    pairing = turned + _transposed(turned) - _transposed(cross_onto(virtual_momentum))
    virtual = _times(_transposed(gyration), moves.T @ weighted)

    lead, bodies = inertia.shape[:-3], inertia.shape[-3]
    matrices = np.concatenate(
        [inertia, _transposed(gyration), _transposed(pairing)], axis=-1
    ).reshape(*lead, bodies, 108)
    matrices = (moves @ matrices).reshape(*lead, -1, 6, 18)
    inertia, backward, pairing = (matrices[..., 6 * k : 6 * k + 6] for k in range(3))
    vectors = moves @ np.concatenate([force, virtual_momentum, virtual], axis=-1)
    force, virtual_momentum, virtual = (vectors[..., 6 * k : 6 * k + 6] for k in range(3))

    by_inertia = inertia @ np.stack([twists, psi1, psi2, omega], axis=-1)
    gyrated = _transposed(backward) @ np.stack([twists, psi1], axis=-1)
    paired = pairing @ np.stack([twists, psi1], axis=-1)
    onto = cross_onto(virtual_momentum) @ np.stack([twists, psi1], axis=-1)
    g = onto[..., 0]
    back = _times(-_transposed(parent_cross), g)
    virtual = virtual + _times(_transposed(parent_cross), virtual_momentum)
    r = _times(cross_onto(force), twists) + by_inertia[..., 2] + gyrated[..., 1]
    s = by_inertia[..., 3] + g
    t = _times(backward, omega) + back + onto[..., 1] + paired[..., 1]
    t += _times(cross_onto(virtual), twists)
    u = 2.0 * g + paired[..., 0]
    x = 2.0 * by_inertia[..., 1] + gyrated[..., 0]

    outer, strict = tree.inner, tree.strictly_inner
    qq = outer * (_pairs(omega, r) + _pairs(psi2, s) + _pairs(psi1, t))
    qv = outer * (_pairs(omega, x) + _pairs(psi1, u))
    qv += _transposed(strict * (2.0 * _pairs(psi1, s) + _pairs(twists, t)))
    vv = outer * _pairs(twists, u)
    qa = outer * _pairs(omega, by_inertia[..., 0]) + _transposed(strict * _pairs(twists, s))
    return mirrored(qq, strict), qv, mirrored(vv, strict), qa


def mirrored(pairs: np.ndarray, strict: np.ndarray) -> np.ndarray:
    """Symmetric matrices from what holds where the row lies inwards of the column."""
    return pairs + _transposed(strict * pairs)


def _pairs(rows: np.ndarray, columns: np.ndarray) -> np.ndarray:
    """Products of all rows with all columns (..., n, 6) -> (..., n, n)."""
    return rows @ _transposed(columns)


def _times(matrices: np.ndarray, vectors: np.ndarray) -> np.ndarray:
    return (matrices @ vectors[..., None])[..., 0]


def _transposed(x: np.ndarray) -> np.ndarray:
    return np.swapaxes(x, -1, -2)
