"""The forces that move the walker along a known motion.

With the motion and the muscle forces given, the ground reactions follow from the equations of
motion by the pseudo-inverse of the contacts (Garcia-Vallejo & Schiehlen 2012, eqs. 16-18),

    r = M q'' + k - q_r - B A f,    lambda* = (C^T)^+ r,    e = r - C^T lambda*,

where e is what no force of the model explains: the error of the gait.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from drakegait.motion import Motion
from drakegait.walker import feet
from drakegait.walker.walker import Walker


@dataclass(frozen=True, eq=False)
class Loads:
    """Generalised forces (K, num_coordinates) along a motion, plant signs [N, N m].

    inertia = gravity + passive + muscles + contact + residual at every instant.

    Attributes:
        inertia: M q'' + k.
        gravity, passive, muscles: of weight, of ligaments and damping, and B A f.
        contact: C^T lambda*.
        residual: e of eq. (18).
        multipliers: lambda* of the contact rows (K, 14), zero where a row is not loaded [N, N m].
        active: contact rows that bear load (K, 14), mask; both (K, 18) with torques at the toe.
    """

    inertia: np.ndarray
    gravity: np.ndarray
    passive: np.ndarray
    muscles: np.ndarray
    contact: np.ndarray
    residual: np.ndarray
    multipliers: np.ndarray
    active: np.ndarray

    @property
    def ground_reactions(self) -> np.ndarray:
        """Force of the ground on each foot (K, 2, 3) [N]: right, left; x, y, z."""
        return self.point_forces.sum(axis=2)

    @property
    def point_forces(self) -> np.ndarray:
        """Force on heel and toe of each foot (K, 2, 2, 3) [N]."""
        by_foot = self.multipliers[:, : feet.NUM_ROWS].reshape(-1, 2, feet.ROWS_PER_FOOT)
        return by_foot[:, :, :6].reshape(-1, 2, 2, 3)

    @property
    def pivot_moments(self) -> np.ndarray:
        """Moment about the vertical through the pivot point of each foot (K, 2) [N m]."""
        return self.multipliers[:, list(feet.YAW_ROWS)]

    @property
    def toe_torques(self) -> np.ndarray:
        """Torques about x and y on each foot that stands alone (K, 2, 2) [N m], mostly none."""
        torques = self.multipliers[:, feet.NUM_ROWS :]
        if torques.shape[1] == 0:
            return np.zeros((len(torques), 2, 2))
        return torques.reshape(-1, 2, 2)


def loads_along(walker: Walker, motion: Motion, phases: np.ndarray) -> Loads:
    """All forces along `motion` with the contacts of `phases` (K,), 0 to 7."""
    skeleton, q, v = walker.skeleton, motion.q, motion.v
    inertia = np.einsum("kij,kj->ki", skeleton.mass_matrix(q), motion.a) + skeleton.bias(q, v)
    gravity = skeleton.gravity_forces(q)
    passive = walker.passive.forces(q, v)
    muscles = walker.muscles.joint_torques(motion.forces)
    needed = inertia - gravity - passive - muscles
    jacobian = skeleton.contact_jacobian(q)
    planar, torques = skeleton.kind == "planar", skeleton.toe_torque
    active = np.array([feet.active_rows(p, planar, torques) for p in range(8)])[phases]
    multipliers = np.zeros(active.shape)
    for phase in np.unique(phases):
        at = np.flatnonzero(phases == phase)
        rows = np.flatnonzero(active[at[0]])
        transposed = np.swapaxes(jacobian[np.ix_(at, rows)], 1, 2)
        multipliers[np.ix_(at, rows)] = (np.linalg.pinv(transposed) @ needed[at, :, None])[..., 0]
    contact = np.einsum("kri,kr->ki", jacobian, multipliers)
    return Loads(
        inertia, gravity, passive, muscles, contact, needed - contact, multipliers, active
    )


def muscle_inputs(walker: Walker, motion: Motion) -> np.ndarray:
    """f, f', f'', l, l', l'' of every muscle (K, num_muscles, 6), as `MuscleFunctions` wants."""
    muscles = walker.muscles
    return np.stack(
        [
            motion.forces,
            motion.force_rates,
            motion.force_accelerations,
            muscles.lengths(motion.q),
            muscles.length_rates(motion.v),
            muscles.length_rates(motion.a),
        ],
        axis=-1,
    )
