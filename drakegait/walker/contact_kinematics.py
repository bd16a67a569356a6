"""Contact rows of both feet, their Jacobian and its derivatives, in closed form.

Rows of a foot: heel x, y, z, toe x, y, z in world axes [m], and the rotation about the vertical
[rad]. The yaw row is e_z . angular velocity of the foot, so that its multiplier is a pure
vertical moment; it is not the derivative of the heading angle where the foot rolls and pitches.

With w_i the axis of coordinate i (0 if it is a translation) and J_i the velocity of a point per
unit speed of i, the second derivative of a point that both i and j move is

    d2 p / dq_i dq_j = w_i x J_j      for i on the way from the ground to j (or i = j),

and d w_j / dq_i = w_i x w_j for i strictly inside of j, else 0.
All functions are vectorised over leading axes (...).
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from drakegait.walker.dynamics_derivatives import Motion, cross, cross_motion, cross_onto, skew


@dataclass(frozen=True, eq=False)
class FeetGeometry:
    """Contact points and the coordinates that move them.

    Attributes:
        inner: (n, n) as in `Tree`.
        moves: (2, n) 1 where the coordinate moves the right, the left foot.
        feet: (2,) position of the feet in the bodies of a `Motion`.
        points: (2, 2, 3) heel and toe in the axes of their foot [m].
        tilts: whether four rows follow, the rotations of both feet about x and y.
    """

    inner: np.ndarray
    moves: np.ndarray
    feet: np.ndarray
    points: np.ndarray
    tilts: bool = False

    def contact_points(self, motion: Motion) -> np.ndarray:
        """World positions (..., 2, 2, 3) of heel and toe of both feet [m]."""
        turned = self.points @ np.swapaxes(motion.rotations[..., self.feet, :, :], -1, -2)
        return turned + motion.origins[..., self.feet, None, :]

    def jacobian(self, motion: Motion) -> np.ndarray:
        """Contact Jacobian (..., 14, n)."""
        axes, columns = _axes_and_columns(self, motion)
        rows = _rows(np.swapaxes(columns, -1, -2), self.moves * axes[..., None, :, 2])
        if not self.tilts:
            return rows
        return _with_tilts(rows, self.moves[:, None] * np.swapaxes(axes[..., None, :, :2], -1, -2))

    def force_derivative(self, motion: Motion, multipliers: np.ndarray) -> np.ndarray:
        """Derivative (..., n, n) with respect to q of C(q)^T multipliers, these held constant.

        Args:
            multipliers: (..., 14) forces [N] and yaw moments [N m] on the feet.
        """
        axes, columns = _axes_and_columns(self, motion)
        by_foot = multipliers[..., :14].reshape(*multipliers.shape[:-1], 2, 7)
        forces = by_foot[..., :6].reshape(*by_foot.shape[:-1], 2, 3)
        # lambda . (w_i x J_j) = (lambda x w_i) . J_j, summed over the four points
        arms = axes[..., None, None, :, :] @ np.swapaxes(skew(forces), -1, -2)
        pairs = np.sum(arms @ np.swapaxes(columns, -1, -2), axis=(-3, -4))
        outer = self.inner * pairs
        strict = self.inner - np.eye(len(self.inner))
        result = outer + np.swapaxes(strict * pairs, -1, -2)
        # row i, column j: m e_z . (w_j x w_i), j strictly inside of i
        moments = by_foot[..., 6] @ self.moves
        vertical = _component_of_cross(axes, 2)
        result = result + moments[..., :, None] * np.swapaxes(strict * vertical, -1, -2)
        if not self.tilts:
            return result
        tilting = multipliers[..., 14:].reshape(*multipliers.shape[:-1], 2, 2)
        for axis in range(2):
            moments = tilting[..., axis] @ self.moves
            across = strict * _component_of_cross(axes, axis)
            result = result + moments[..., :, None] * np.swapaxes(across, -1, -2)
        return result

    def velocity_derivative(self, motion: Motion, speeds: np.ndarray) -> np.ndarray:
        """Derivative (..., 14, n) with respect to q of C(q) speeds, these held constant.

        Args:
            speeds: (..., n).
        """
        axes, columns = _axes_and_columns(self, motion)
        strict = self.inner - np.eye(len(self.inner))
        spin = axes * speeds[..., None]
        carried = self.inner @ (columns * speeds[..., None, None, :, None])
        inward = strict.T @ spin
        rate = cross(axes[..., None, None, :, :], carried)
        rate = self.moves[:, None, :, None] * rate
        rate = rate + cross(inward[..., None, None, :, :], columns)
        spin_beyond = strict @ (spin[..., None, :, :] * self.moves[..., None])
        turned = cross(axes[..., None, :, :], spin_beyond)
        rows = _rows(np.swapaxes(rate, -1, -2), turned[..., 2] * self.moves)
        if not self.tilts:
            return rows
        return _with_tilts(rows, self.moves[:, None] * np.swapaxes(turned[..., :2], -1, -2))

    def power_curvature(
        self, motion: Motion, speeds: np.ndarray, multipliers: np.ndarray
    ) -> np.ndarray:
        """Second derivatives (..., n, n) of multipliers . C(q) speeds, both held constant.

        In the words of `dynamics_curvature`: with F the forces f at points p and the moment m of
        a foot as one spatial force, u the velocity of p and Omega the spin of the foot at the
        speeds, and omega_i = W_p x S_i, for i on the way to j or j itself

            omega_i . (S_j x* F + G w_j) + w_i . (G^T omega_j + K w_j)
            G = ([p x][f x] + [m x], [f x]),     K = u f^T - u . f + Omega m^T - Omega . m.
        """
        axes, twists = motion.twists[..., :3], motion.twists
        by_foot = multipliers[..., :14].reshape(*multipliers.shape[:-1], 2, 7)
        forces = by_foot[..., :6].reshape(*by_foot.shape[:-1], 2, 3)
        moments = np.zeros((*by_foot.shape[:-1], 3))
        moments[..., 2] = by_foot[..., 6]
        if self.tilts:
            moments[..., :2] = multipliers[..., 14:].reshape(*moments.shape[:-1], 2)
        points = self.contact_points(motion)
        weighted = twists * speeds[..., None]
        virtual = self.moves @ weighted
        spin = virtual[..., None, :3]
        velocities = virtual[..., None, 3:] + cross(spin, points)
        by_force = skew(forces)
        # Of each foot, then summed over the feet that a coordinate moves.
        wrench = np.concatenate(
            [cross(points, forces).sum(axis=-2) + moments, forces.sum(axis=-2)], axis=-1
        )
        turned = np.concatenate(
            [(skew(points) @ by_force).sum(axis=-3) + skew(moments), by_force.sum(axis=-3)],
            axis=-2,
        )
        bent = np.swapaxes(velocities, -1, -2) @ forces
        bent = bent + np.swapaxes(spin, -1, -2) * moments[..., None, :]
        bent = bent - np.trace(bent, axis1=-2, axis2=-1)[..., None, None] * np.eye(3)
        lead = speeds.shape[:-1]
        wrench = self.moves.T @ wrench
        turned = (self.moves.T @ turned.reshape(*lead, 2, 18)).reshape(*lead, -1, 6, 3)
        bent = (self.moves.T @ bent.reshape(*lead, 2, 9)).reshape(*lead, -1, 3, 3)
        strict = self.inner - np.eye(len(self.inner))
        omega = (cross_motion(strict.T @ weighted) @ twists[..., None])[..., 0]
        along = (cross_onto(wrench) @ twists[..., None] + turned @ axes[..., None])[..., 0]
        inside = np.swapaxes(turned, -1, -2) @ omega[..., None] + bent @ axes[..., None]
        pairs = omega @ np.swapaxes(along, -1, -2) + axes @ np.swapaxes(inside[..., 0], -1, -2)
        pairs = self.inner * pairs
        return pairs + np.swapaxes(strict * pairs, -1, -2)

    def position_curvature(self, motion: Motion, weights: np.ndarray) -> np.ndarray:
        """Second derivatives (..., n, n) of the weighted contact positions.

        Args:
            weights: (..., 14) of the points' x, y, z and of the headings of the feet.
        """
        points = self.contact_points(motion)
        along = points[..., 1, :] - points[..., 0, :]
        x, y = along[..., 0], along[..., 1]
        square = x * x + y * y
        by_foot = weights.reshape(*weights.shape[:-1], 2, 7)
        heading = by_foot[..., 6]
        # The heading's gradient acts like two opposite forces on heel and toe.
        pair = np.stack([-y * heading / square, x * heading / square, 0.0 * x], axis=-1)
        forces = by_foot.copy()
        forces[..., 0:3] -= pair
        forces[..., 3:6] += pair
        forces[..., 6] = 0.0
        multipliers = forces.reshape(weights.shape)
        if self.tilts:
            none = np.zeros((*weights.shape[:-1], 4))
            multipliers = np.concatenate([multipliers, none], axis=-1)
        columns = _axes_and_columns(self, motion)[1]
        change = columns[..., 1, :, :2] - columns[..., 0, :, :2]
        bend = np.stack([2.0 * x * y, y * y - x * x, y * y - x * x, -2.0 * x * y], axis=-1)
        bend = (bend * (heading / square**2)[..., None]).reshape(*x.shape, 2, 2)
        bent = (change @ bend @ np.swapaxes(change, -1, -2)).sum(axis=-3)
        return self.force_derivative(motion, multipliers) + bent


@lru_cache(maxsize=4)
def _axes_and_columns(geometry: FeetGeometry, motion: Motion) -> tuple[np.ndarray, np.ndarray]:
    """Axes (..., n, 3) and velocities (..., 2, 2, n, 3) of the points per unit speed.

    Kept for the last motions: all rows and derivatives of an evaluation ask for them.
    """
    axes, at_origin = motion.twists[..., :3], motion.twists[..., 3:]
    points = geometry.contact_points(motion)
    # v + w x p = v + w @ [p x]: row vector times the matrix of p
    columns = axes[..., None, None, :, :] @ skew(points) + at_origin[..., None, None, :, :]
    return axes, columns * geometry.moves[:, None, :, None]


def _rows(point_rows: np.ndarray, yaw_rows: np.ndarray) -> np.ndarray:
    """(..., 2, 2, 3, n) and (..., 2, n) -> (..., 14, n)."""
    lead, n = yaw_rows.shape[:-2], yaw_rows.shape[-1]
    points = point_rows.reshape(*lead, 2, 6, n)
    return np.concatenate([points, yaw_rows[..., None, :]], axis=-2).reshape(*lead, 14, n)


def _with_tilts(rows: np.ndarray, tilts: np.ndarray) -> np.ndarray:
    """(..., 14, n) and rotations (..., 2 feet, 2 axes, n) -> (..., 18, n)."""
    tilts = tilts.reshape(*rows.shape[:-2], 4, rows.shape[-1])
    return np.concatenate([rows, tilts], axis=-2)


def _component_of_cross(axes: np.ndarray, which: int) -> np.ndarray:
    """e . (w_i x w_j) for all pairs (..., n, n), e the world axis `which`."""
    x, y = axes[..., (which + 1) % 3], axes[..., (which + 2) % 3]
    return x[..., :, None] * y[..., None, :] - y[..., :, None] * x[..., None, :]
