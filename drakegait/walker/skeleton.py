"""The skeleton: equations of motion and contact kinematics of one walker, by Drake.

    M(q) q'' + bias(q, q') = gravity(q) + passive + B tau + C(q)^T lambda      (1), (16), (25)

Arrays of floats go through Drake's double plant, arrays of `AutoDiffXd` through its copy; the
postures and inverse dynamics of many instants go through numpy with what was read of the plant
(tests hold both equal). Methods that return derivatives take floats only. Coordinates have the
order and signs of `drakegait.walker.coordinates`; the contact rows are, for the right and then
the left foot, heel x, y, z, toe x, y, z and the rotation about the vertical (yaw).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
import pydrake.math as scalar_math
from pydrake.autodiffutils import AutoDiffXd
from pydrake.multibody.parsing import Parser
from pydrake.multibody.plant import MultibodyPlant, MultibodyPlant_

from drakegait.errors import BadFile, InvalidInput
from drakegait.quantities import GRAVITY
from drakegait.walker import coordinates
from drakegait.walker.dynamics_derivatives import (
    Motion,
    inverse_dynamics,
    inverse_dynamics_derivatives,
)
from drakegait.walker.feet import FootGeometry
from drakegait.walker.feet_of_model import read_feet
from drakegait.walker.joint_tree import JointTree
from drakegait.walker.model_file import model_sdf
from drakegait.walker.plant_door import PlantDoor
from drakegait.walker.plant_tree import check_joints, read_tree
from drakegait.walker.rotation_sequence import sdf_in_sequence_123
from drakegait.walker.sdf_elements import OWN_MODEL
from drakegait.walker.segment_edits import SegmentEdit
from drakegait.walker.subject import AddedMass, Subject

"""Acceleration of gravity [m/s^2]."""

# From here on numpy costs less than Drake's calls for each instant (a third for 76).
_MANY_INSTANTS = 16


class Skeleton:
    """Rigid bodies and joints of one walker.

    Args:
        sdf_text: an SDF model as `model_sdf` makes it.
        kind: `"spatial"` (16 coordinates) or `"planar"` (9).
        toe_torque: whether there are four more contact rows, see `drakegait.walker.feet`.

    Attributes:
        kind, toe_torque: as given.
        coordinates: names of the coordinates, in order.
        num_coordinates: how many.
        sdf: the text it was made from.
        plant: Drake's plant in double precision. Its own order of the coordinates may differ.
        tree, feet_geometry: what does not change with the posture.
        total_mass: of the body with all that is fixed to it [kg].

    Raises:
        BadFile: if the text is not a model of this skeleton; says what is wrong.

    An instance keeps Drake contexts and must not be shared between threads.
    """

    def __init__(self, sdf_text: str, kind: str, toe_torque: bool = False):
        self.kind = kind
        self.toe_torque = toe_torque
        self.sdf = sdf_text
        self.coordinates = coordinates.names(kind)
        self.num_coordinates = len(self.coordinates)
        self.plant = MultibodyPlant(time_step=0.0)
        try:
            Parser(self.plant).AddModelsFromString(sdf_text, "sdf")
            self.plant.mutable_gravity_field().set_gravity_vector([0.0, 0.0, -GRAVITY])
            self.plant.Finalize()
        except RuntimeError as error:
            raise BadFile(OWN_MODEL, f"Drake cannot read the model: {error}") from None
        self._order = check_joints(self.plant, self.coordinates)
        self.tree = read_tree(self.plant, self.coordinates, GRAVITY)
        self.feet_geometry = read_feet(self.plant, self.tree, self.coordinates, toe_torque)
        self.total_mass = float(self.tree.masses.sum())
        self._double = self._open(self.plant, float)
        self._joints = JointTree(self.plant, self.coordinates, self.tree.names)
        self._autodiff: PlantDoor | None = None
        self._last: tuple[np.ndarray, Motion] | None = None

    @classmethod
    def load(
        cls,
        kind: str,
        subject: Subject | None = None,
        added_masses: Sequence[AddedMass] = (),
        text: str | None = None,
        edits: Sequence[SegmentEdit] = (),
        toe_torque: bool = False,
        sequence: str = "213",
    ) -> Skeleton:
        """The skeleton of a subject (default 1.80 m, 75 kg), with masses fixed to it.

        Args:
            text: SDF text of your own in place of the shipped file, see `model_sdf`.
            edits: changes of single segments.
            toe_torque: see the class.
            sequence: of the rotations of trunk and hips, `"213"` or `"123"`.
        """
        sdf = model_sdf(kind, subject or Subject(), added_masses, text, edits)
        if sequence != "213":
            if kind == "planar":
                raise InvalidInput("sequence", sequence, "213 for a planar walker")
            sdf = sdf_in_sequence_123(sdf)
        return cls(sdf, kind, toe_torque)

    @property
    def foot(self) -> FootGeometry:
        """Heel and toe along the sole, the same on both feet."""
        heel, toe = self.feet_geometry.points[0, :, 0]
        return FootGeometry(heel=float(heel), toe=float(toe))

    def with_sdf(self, text: str) -> Skeleton:
        """The same with other numbers in the text that it was made from."""
        return type(self)(text, self.kind, self.toe_torque)

    # Equations of motion. Leading axes (...) are instants.

    def mass_matrix(self, q: np.ndarray) -> np.ndarray:
        """M(q) (..., n, n) [kg, kg m, kg m^2]."""
        return self._each(lambda door, q: door.mass_matrix(q), q)

    def bias(self, q: np.ndarray, v: np.ndarray) -> np.ndarray:
        """Centrifugal, Coriolis and gyroscopic forces (..., n), on the left-hand side [N, N m]."""
        return self._each(lambda door, q, v: door.bias(q, v), q, v)

    def gravity_forces(self, q: np.ndarray) -> np.ndarray:
        """Generalised forces of gravity (..., n), on the right-hand side [N, N m]."""
        return self._each(lambda door, q: door.gravity_forces(q), q)

    def inverse_dynamics(self, q: np.ndarray, v: np.ndarray, a: np.ndarray) -> np.ndarray:
        """M(q) a + bias(q, v) - gravity_forces(q) (..., n): forces that make the motion."""
        if _many(q) and _many(v) and _many(a):
            return inverse_dynamics(self.tree, self.motion(q), v, a)
        return self._each(lambda door, q, v, a: door.inverse_dynamics(q, v, a), q, v, a)

    def kinetic_energy(self, q: np.ndarray, v: np.ndarray) -> np.ndarray:
        """Kinetic energy (...) [J]."""
        return self._each(lambda door, q, v: door.kinetic_energy(q, v), q, v)

    def potential_energy(self, q: np.ndarray) -> np.ndarray:
        """Energy (...) of gravity, zero with the centre of mass on the ground [J]."""
        return self.total_mass * GRAVITY * self.center_of_mass(q)[..., 2]

    def residual_derivatives(
        self, q: np.ndarray, v: np.ndarray, a: np.ndarray, multipliers: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        """Forces that the joints must supply, and their derivatives; floats only.

            r = inverse_dynamics(q, v, a) - C(q)^T multipliers            (16), (25)

        Args:
            q, v, a: (..., n).
            multipliers: (..., 14) contact forces [N] and yaw moments [N m] on the feet.

        Returns:
            r (..., n), dr/dq (..., n, n), dr/dv (..., n, n) and M = dr/da (..., n, n).
            dr/dmultipliers is -contact_jacobian(q)^T.

        One call for all instants of a gait is many times cheaper than one call each.
        """
        motion = self.motion(q)
        r, dr_dq, dr_dv, mass = inverse_dynamics_derivatives(self.tree, motion, v, a)
        jacobian = self.feet_geometry.jacobian(motion)
        r = r - (np.asarray(multipliers)[..., None, :] @ jacobian)[..., 0, :]
        return r, dr_dq - self.feet_geometry.force_derivative(motion, multipliers), dr_dv, mass

    # Kinematics.

    def contact_points(self, q: np.ndarray) -> np.ndarray:
        """World positions (..., 4, 3) of heel_r, toe_r, heel_l, toe_l [m]."""
        points = self.feet_geometry.contact_points(self.motion(q))
        return points.reshape(*points.shape[:-3], 4, 3)

    def contact_jacobian(self, q: np.ndarray) -> np.ndarray:
        """C(q) (..., 14, n): velocities of the contact rows per unit speed of each coordinate.

        The yaw row is e_z . angular velocity: its multiplier is a purely vertical moment.
        """
        return self.feet_geometry.jacobian(self.motion(q))

    def contact_velocity_derivative(self, q: np.ndarray, w: np.ndarray) -> np.ndarray:
        """Derivative (..., 14, n) of C(q) w with respect to q, w (..., n) held constant."""
        return self.feet_geometry.velocity_derivative(self.motion(q), np.asarray(w))

    def foot_yaw(self, q: np.ndarray) -> np.ndarray:
        """Heading (..., 2) of both feet: atan2(d_y, d_x), d from heel to toe [rad].

        Not differentiable where a foot is vertical.
        """
        points = self.contact_points(q)
        along = points[..., 1::2, :] - points[..., 0::2, :]
        return _arctan2(along[..., 1], along[..., 0])

    def foot_yaw_gradient(self, q: np.ndarray) -> np.ndarray:
        """Derivative (..., 2, n) of `foot_yaw`; not the yaw rows of C where a foot is tilted."""
        motion = self.motion(q)
        points = self.feet_geometry.contact_points(motion)
        along = points[..., 1, :] - points[..., 0, :]
        x, y = along[..., 0, None], along[..., 1, None]
        rows = self.feet_geometry.jacobian(motion)
        rows = rows[..., :14, :].reshape(*rows.shape[:-2], 2, 7, rows.shape[-1])[..., :6, :]
        change = rows[..., 3:, :] - rows[..., :3, :]
        return (x * change[..., 1, :] - y * change[..., 0, :]) / (x * x + y * y)

    def body_poses(self, q: np.ndarray) -> dict[str, tuple[np.ndarray, np.ndarray]]:
        """Rotation (..., 3, 3) to world axes and origin (..., 3) [m] of each segment, by name."""
        motion = self.motion(q)
        return {
            name: (motion.rotations[..., i, :, :], motion.origins[..., i, :])
            for i, name in enumerate(self.tree.names)
        }

    def center_of_mass(self, q: np.ndarray) -> np.ndarray:
        """Centre of mass (..., 3) of the whole walker in the world [m]."""
        motion = self.motion(q)
        places = motion.origins + (motion.rotations @ self.tree.coms[..., None])[..., 0]
        return (self.tree.masses / self.total_mass) @ places

    def center_of_mass_jacobian(self, q: np.ndarray) -> np.ndarray:
        """Velocity (..., 3, n) of the centre of mass per unit speed of each coordinate."""
        motion, tree = self.motion(q), self.tree
        places = motion.origins + (motion.rotations @ tree.coms[..., None])[..., 0]
        shares = tree.moves * (tree.masses / self.total_mass)  # (n, bodies)
        axes, at_origin = motion.twists[..., :3], motion.twists[..., 3:]
        moved = np.cross(axes, shares @ places) + shares.sum(axis=-1)[:, None] * at_origin
        return np.swapaxes(moved, -1, -2)

    # The door to Drake.

    def _open(self, plant: MultibodyPlant_, scalar: type) -> PlantDoor:
        bodies, moves_right = self.tree.names, self.feet_geometry.moves[0] > 0
        return PlantDoor(plant, scalar, self._order, bodies, moves_right)

    def _door(self, q: np.ndarray) -> PlantDoor:
        if q.dtype != object:
            return self._double
        if self._autodiff is None:
            self._autodiff = self._open(self.plant.ToAutoDiffXd(), AutoDiffXd)
        return self._autodiff

    def _each(self, function: Callable, *arrays: np.ndarray) -> np.ndarray:
        """Call `function(door, *vectors)` for each instant, AutoDiff if one array is."""
        arrays = tuple(np.asarray(x) for x in arrays)
        if any(x.dtype == object for x in arrays):
            arrays = tuple(_as_autodiff(x) for x in arrays)
        door = self._door(arrays[0])
        if arrays[0].ndim == 1:
            return function(door, *arrays)
        lead = arrays[0].shape[:-1]
        flat = [x.reshape(-1, self.num_coordinates) for x in arrays]
        results = np.array([function(door, *row) for row in zip(*flat, strict=True)])
        return results.reshape(*lead, *results.shape[1:])

    def motion(self, q: np.ndarray) -> Motion:
        """Poses of the bodies and twists of the coordinates."""
        q = np.asarray(q)
        if q.dtype == object:
            return self._door(q).motion(q)
        # The residual, its derivatives and the contact rows are asked for at the same q.
        if self._last is None or not np.array_equal(self._last[0], q):
            source = self._joints if _many(q) else self._double
            self._last = q.copy(), source.motion(q)
        return self._last[1]


def _many(values: np.ndarray) -> bool:
    """Whether numpy over all instants is cheaper than a call of Drake for each."""
    values = np.asarray(values)
    return values.dtype != object and values.ndim > 1 and values[..., 0].size >= _MANY_INSTANTS


def _as_autodiff(values: np.ndarray) -> np.ndarray:
    return values if values.dtype == object else np.vectorize(AutoDiffXd, otypes=[object])(values)


def _arctan2(y: np.ndarray, x: np.ndarray) -> np.ndarray:
    if y.dtype != object:
        return np.arctan2(y, x)
    return np.vectorize(scalar_math.arctan2, otypes=[object])(y, x)
