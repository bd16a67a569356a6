"""Derivatives of inverse dynamics in closed form, over many instants at once.

Drake supplies poses and joint axes in double precision; what remains are a few
products of arrays. AutoDiffXd gives the same numbers (a test compares them) at
about eight times the price for the instants of a gait, twice for a single one.

All spatial vectors are taken at the world origin in world axes, angular part
first: the twist S_j = (w_j, v_j) of a coordinate, momentum and force (n, f).
With V, A the velocity and acceleration of a body (gravity as an upward
acceleration of the ground), I its inertia and x, x* the products of twists with
twists and forces (Featherstone 2008, chapter 2),

    F_b = I_b A_b + V_b x* I_b V_b,        tau_i = S_i . sum of F_b over the bodies that i moves.

A change of q_j carries all that j moves along the twist S_j. Seen from there only the
motion of j's parent p changes, by psi1_j = V_p x S_j and psi2_j = A_p x S_j + V_p x psi1_j, so
(Carpentier & Mansard 2018; Singh, Russell & Wensing 2022), with sums I_c, D_c, F_c over the
bodies moved by the outer one of i and j,

    d tau_i / d q_j  = S_i . (I_c psi2_j + D_c psi1_j  [+ S_j x* F_c where i lies inside of j])
    d tau_i / d q'_j = S_i . (2 I_c psi1_j + D_c S_j)
    D X = I (X x V) + X x* (I V) + V x* (I X).
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np


def _skew_tensor() -> np.ndarray:
    """E such that (a @ E)[i, j] = [a x]_ij."""
    tensor = np.zeros((3, 3, 3))
    for i, j, k in ((0, 1, 2), (1, 2, 0), (2, 0, 1)):
        tensor[i, k, j], tensor[i, j, k] = 1.0, -1.0
    return tensor


_SKEW = _skew_tensor()


def _block(rows: list[tuple[int, int, int, float]]) -> np.ndarray:
    """Tensor (6, 36) that fills 6x6 matrices with the skew matrices of a spatial vector's parts."""
    tensor = np.zeros((6, 6, 6))
    for part, row, column, sign in rows:
        i, j, k = 3 * part, 3 * row, 3 * column
        tensor[i : i + 3, j : j + 3, k : k + 3] += sign * _SKEW
    return tensor.reshape(6, 36)


_MOTION = _block([(0, 0, 0, 1.0), (1, 1, 0, 1.0), (0, 1, 1, 1.0)])
_FORCE = _block([(0, 0, 0, -1.0), (1, 0, 1, -1.0), (1, 1, 0, -1.0)])


def skew(vectors: np.ndarray) -> np.ndarray:
    """Matrices (..., 3, 3) of the cross product with vectors (..., 3)."""
    return (vectors @ _SKEW.reshape(3, 9)).reshape(*vectors.shape[:-1], 3, 3)


def cross(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Cross products (..., 3); several times faster than np.cross, and for AutoDiffXd too."""
    return np.stack(
        [
            a[..., 1] * b[..., 2] - a[..., 2] * b[..., 1],
            a[..., 2] * b[..., 0] - a[..., 0] * b[..., 2],
            a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0],
        ],
        axis=-1,
    )


def cross_motion(x: np.ndarray) -> np.ndarray:
    """Matrix of Y -> X x Y; that of F -> X x* F is minus its transpose."""
    return (x @ _MOTION).reshape(*x.shape[:-1], 6, 6)


def cross_onto(force: np.ndarray) -> np.ndarray:
    """Matrix of X -> X x* F for a given F."""
    return (force @ _FORCE).reshape(*force.shape[:-1], 6, 6)


def _apply(matrices: np.ndarray, vectors: np.ndarray) -> np.ndarray:
    return (matrices @ vectors[..., None])[..., 0]


@dataclass(frozen=True, eq=False)
class Motion:
    """Where the bodies and axes are at some instants; leading axes (...) are instants.

    Attributes:
        twists: (..., n, 6) twist of each coordinate, unit speed, at the world origin.
        rotations: (..., bodies, 3, 3) from body to world axes.
        origins: (..., bodies, 3) body origins [m].
    """

    twists: np.ndarray
    rotations: np.ndarray
    origins: np.ndarray


@dataclass(frozen=True, eq=False)
class Tree:
    """What does not change with the posture.

    Attributes:
        names: of the bodies with mass.
        inner: (n, n) 1 where coordinate i lies on the way from the ground to j, or is j itself.
        moves: (n, bodies) 1 where coordinate i moves the body.
        masses: (bodies,) [kg].
        coms: (bodies, 3) in body axes [m].
        inertias: (bodies, 3, 3) about the mass centre, in body axes [kg m^2].
        gravity: [m/s^2], downwards.
    """

    names: tuple[str, ...]
    inner: np.ndarray
    moves: np.ndarray
    masses: np.ndarray
    coms: np.ndarray
    inertias: np.ndarray
    gravity: float

    @property
    def strictly_inner(self) -> np.ndarray:
        """`inner` without the diagonal."""
        return self.inner - np.eye(len(self.inner))


@lru_cache(maxsize=4)
def spatial_inertias(tree: Tree, motion: Motion) -> np.ndarray:
    """Inertia matrices (..., bodies, 6, 6) about the world origin; kept for the last motions."""
    rotations = motion.rotations
    coms = motion.origins + _apply(rotations, tree.coms)
    first = tree.masses[:, None, None] * skew(coms)
    result = np.zeros((*coms.shape[:-1], 6, 6))
    inertia = rotations @ tree.inertias @ np.swapaxes(rotations, -1, -2)
    result[..., :3, :3] = inertia - first @ skew(coms)
    result[..., :3, 3:] = first
    result[..., 3:, :3] = -first
    result[..., 3:, 3:] = tree.masses[:, None, None] * np.eye(3)
    return result


def inverse_dynamics(tree: Tree, motion: Motion, v: np.ndarray, a: np.ndarray) -> np.ndarray:
    """tau = M a + bias - gravity forces (..., n), without derivatives.

    Args:
        v, a: (..., n) velocities and accelerations of the coordinates.
    """
    twists = motion.twists
    steps = twists * v[..., None]
    parent_velocity = tree.strictly_inner.T @ steps
    accelerations = twists * a[..., None] + _spatial_cross(parent_velocity, steps)
    ground = np.array([0.0, 0.0, 0.0, 0.0, 0.0, tree.gravity])
    velocity = tree.moves.T @ steps
    acceleration = tree.moves.T @ accelerations + ground
    gained = spatial_inertias(tree, motion) @ np.stack([velocity, acceleration], axis=-1)
    momentum, force = gained[..., 0], gained[..., 1]
    spin, linear = velocity[..., :3], velocity[..., 3:]
    force[..., :3] += cross(spin, momentum[..., :3]) + cross(linear, momentum[..., 3:])
    force[..., 3:] += cross(spin, momentum[..., 3:])
    return np.sum(twists * (tree.moves @ force), axis=-1)


def _spatial_cross(x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """X x Y."""
    angular = cross(x[..., :3], y[..., :3])
    linear = cross(x[..., :3], y[..., 3:]) + cross(x[..., 3:], y[..., :3])
    return np.concatenate([angular, linear], axis=-1)


def inverse_dynamics_derivatives(
    tree: Tree, motion: Motion, v: np.ndarray, a: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """tau = M a + bias - gravity forces with its derivatives.

    Args:
        v, a: (..., n) velocities and accelerations of the coordinates.

    Returns:
        tau (..., n), dtau/dq (..., n, n), dtau/dv (..., n, n) and M = dtau/da (..., n, n).
    """
    twists = motion.twists
    inward = tree.strictly_inner.T
    lead = twists.shape[:-2]

    steps = twists * v[..., None]
    parent_velocity = inward @ steps
    parent_cross = cross_motion(parent_velocity)
    psi1 = _apply(parent_cross, twists)
    accelerations = twists * a[..., None] + psi1 * v[..., None]
    ground = np.array([0.0, 0.0, 0.0, 0.0, 0.0, tree.gravity])
    parent_acceleration = inward @ accelerations + ground
    psi2 = _apply(cross_motion(parent_acceleration), twists) + _apply(parent_cross, psi1)

    velocity = tree.moves.T @ steps
    acceleration = tree.moves.T @ accelerations + ground
    inertia = spatial_inertias(tree, motion)
    momentum = _apply(inertia, velocity)
    cross = cross_motion(velocity)
    dual = -np.swapaxes(cross, -1, -2)
    force = _apply(inertia, acceleration) + _apply(dual, momentum)
    gyration = dual @ inertia - inertia @ cross + cross_onto(momentum)

    bodies = inertia.shape[-3]
    inertia = (tree.moves @ inertia.reshape(*lead, bodies, 36)).reshape(*lead, -1, 6, 6)
    gyration = (tree.moves @ gyration.reshape(*lead, bodies, 36)).reshape(*lead, -1, 6, 6)
    force = tree.moves @ force

    tau = np.sum(twists * force, axis=-1)
    # i outside of j (or i = j): the sums belong to row i; i inside of j: to column j.
    outer_inertia = _apply(inertia, twists)
    outer_gyration = (twists[..., None, :] @ gyration)[..., 0, :]
    columns_q = _apply(inertia, psi2) + _apply(gyration, psi1)
    columns_q += _apply(cross_onto(force), twists)
    columns_v = 2.0 * _apply(inertia, psi1) + _apply(gyration, twists)

    def transposed(x: np.ndarray) -> np.ndarray:
        return np.swapaxes(x, -1, -2)

    row, column = tree.inner.T, tree.strictly_inner
    dtau_dq = row * (outer_inertia @ transposed(psi2) + outer_gyration @ transposed(psi1))
    dtau_dq += column * (twists @ transposed(columns_q))
    dtau_dv = row * (2.0 * outer_inertia @ transposed(psi1) + outer_gyration @ transposed(twists))
    dtau_dv += column * (twists @ transposed(columns_v))
    lower = row * (outer_inertia @ transposed(twists))
    mass = lower + column * (twists @ transposed(outer_inertia))
    return tau, dtau_dq, dtau_dv, mass
