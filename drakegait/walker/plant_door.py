"""The only door to Drake's plant: one object for one scalar type, in our order of coordinates."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from pydrake.multibody.plant import MultibodyPlant_
from pydrake.multibody.tree import JacobianWrtVariable, MultibodyForces_

from drakegait.walker.dynamics_derivatives import Motion, cross

_FEET = ("foot_r", "foot_l")


class PlantDoor:
    """Drake's plant with its context, called with arrays in our order of coordinates.

    All methods take one instant, except `motion`.

    Args:
        plant: a finalised plant of floats or of `AutoDiffXd`.
        scalar: `float` or `AutoDiffXd`.
        order: (n,) places of our coordinates in Drake's vectors.
        bodies: names of the bodies whose poses `motion` gives.
        moves_right: (n,) whether the coordinate moves the right foot; else it moves the left.
    """

    def __init__(
        self,
        plant: MultibodyPlant_,
        scalar: type,
        order: np.ndarray,
        bodies: Sequence[str],
        moves_right: np.ndarray,
    ):
        self._plant = plant
        self._context = plant.CreateDefaultContext()
        self._forces = MultibodyForces_[scalar](plant)
        self._place = np.argsort(order)
        self._order = order
        self._square = np.ix_(order, order)
        self._bodies = [plant.GetBodyByName(name) for name in bodies]
        self._feet = [plant.GetBodyByName(name).body_frame() for name in _FEET]
        self._world = plant.world_frame()
        self._origin = np.array([scalar(0.0)] * 3)
        # Each coordinate is seen from one foot that it moves: its body, and its column of the two
        # feet's Jacobians side by side.
        body_of_foot = np.array([list(bodies).index(name) for name in _FEET])
        self._seen_from = body_of_foot[np.where(moves_right, 0, 1)]
        self._columns = order + np.where(moves_right, 0, len(order))

    def _set(self, q: np.ndarray, v: np.ndarray | None = None) -> None:
        self._plant.SetPositions(self._context, q[self._place])
        if v is not None:
            self._plant.SetVelocities(self._context, v[self._place])

    def mass_matrix(self, q: np.ndarray) -> np.ndarray:
        """M(q) (n, n)."""
        self._set(q)
        return self._plant.CalcMassMatrix(self._context)[self._square]

    def bias(self, q: np.ndarray, v: np.ndarray) -> np.ndarray:
        """Velocity-dependent forces (n,) on the left-hand side."""
        self._set(q, v)
        return self._plant.CalcBiasTerm(self._context)[self._order]

    def gravity_forces(self, q: np.ndarray) -> np.ndarray:
        """Forces of gravity (n,) on the right-hand side."""
        self._set(q)
        return self._plant.CalcGravityGeneralizedForces(self._context)[self._order]

    def inverse_dynamics(self, q: np.ndarray, v: np.ndarray, a: np.ndarray) -> np.ndarray:
        """M a + bias - gravity (n,)."""
        self._set(q, v)
        self._plant.CalcForceElementsContribution(self._context, self._forces)
        drake = self._plant.CalcInverseDynamics(self._context, a[self._place], self._forces)
        return drake[self._order]

    def kinetic_energy(self, q: np.ndarray, v: np.ndarray) -> float:
        """Kinetic energy [J]."""
        self._set(q, v)
        return self._plant.CalcKineticEnergy(self._context)

    def motion(self, q: np.ndarray) -> Motion:
        """Twists of the coordinates and poses of the bodies at each instant of q (..., n)."""
        plant, context, world = self._plant, self._context, self._world
        instants = q.reshape(-1, q.shape[-1])
        jacobians, poses = [], []
        for row in instants[:, self._place]:
            plant.SetPositions(context, row)
            for foot in self._feet:
                jacobians.append(
                    plant.CalcJacobianSpatialVelocity(
                        context, JacobianWrtVariable.kV, foot, self._origin, world, world
                    )
                )
            poses += [plant.EvalBodyPoseInWorld(context, b).GetAsMatrix34() for b in self._bodies]
        count, n = instants.shape
        pose = np.array(poses).reshape(count, len(self._bodies), 3, 4)
        rotations, origins = pose[..., :3], pose[..., 3]
        both = np.array(jacobians).reshape(count, 2, 6, n).transpose(0, 1, 3, 2)
        seen = both.reshape(count, 2 * n, 6)[:, self._columns]
        axes = seen[..., :3]
        at_world_origin = seen[..., 3:] + cross(origins[:, self._seen_from], axes)
        twists = np.concatenate([axes, at_world_origin], axis=-1)
        lead = q.shape[:-1]
        return Motion(*(x.reshape(*lead, *x.shape[1:]) for x in (twists, rotations, origins)))
