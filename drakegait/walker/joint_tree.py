"""Poses and joint axes of the whole tree at many instants at once, with numpy.

The same as `PlantDoor.motion`, from the frames and axes that Drake's plant was read for once:
a call of Drake for every instant and body costs many times the arithmetic.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from pydrake.multibody.plant import MultibodyPlant

from drakegait.walker.dynamics_derivatives import Motion, cross, skew


@dataclass(frozen=True, eq=False)
class _Joint:
    """One joint with one axis.

    Attributes:
        coordinate: which one.
        parent, child: bodies by Drake's index.
        turns: whether it is revolute.
        axis: (3,) in both frames of the joint.
        before, after: rotation and translation from the parent to the joint's frame there, and
            from the moving frame to the child; None where the rotation is none.
    """

    coordinate: int
    parent: int
    child: int
    turns: bool
    axis: np.ndarray
    before: tuple[np.ndarray | None, np.ndarray]
    after: tuple[np.ndarray | None, np.ndarray]


class JointTree:
    """The joints of `plant` from the ground outwards.

    Args:
        plant: finalised, with revolute and prismatic joints only.
        names: of the joints, in the order of the coordinates.
        bodies: names of the bodies whose poses are wanted.
    """

    def __init__(self, plant: MultibodyPlant, names: Sequence[str], bodies: Sequence[str]):
        joints = [_read(plant.GetJointByName(name), k) for k, name in enumerate(names)]
        self._ground = int(plant.world_body().index())
        self._joints: list[_Joint] = []
        reached = {self._ground}
        while len(self._joints) < len(joints):
            more = [j for j in joints if j.parent in reached and j.child not in reached]
            self._joints += more
            reached |= {joint.child for joint in more}
        self._bodies = [int(plant.GetBodyByName(name).index()) for name in bodies]

    def motion(self, q: np.ndarray) -> Motion:
        """Twists of the coordinates and poses of the bodies at each instant of q (..., n)."""
        lead = q.shape[:-1]
        poses = {self._ground: (np.broadcast_to(np.eye(3), (*lead, 3, 3)), np.zeros((*lead, 3)))}
        twists = np.zeros((*lead, q.shape[-1], 6))
        for joint in self._joints:
            rotation, origin = _moved(poses[joint.parent], joint.before)
            axis, by = rotation @ joint.axis, q[..., joint.coordinate]
            twist = twists[..., joint.coordinate, :]
            if joint.turns:
                twist[..., :3] = axis
                twist[..., 3:] = cross(origin, axis)
                across = skew(joint.axis)
                angle = by[..., None, None]
                turned = np.sin(angle) * across + (1.0 - np.cos(angle)) * (across @ across)
                rotation = rotation + rotation @ turned  # Rodrigues
            else:
                twist[..., 3:] = axis
                origin = origin + axis * by[..., None]
            poses[joint.child] = _moved((rotation, origin), joint.after)
        rotations = np.stack([poses[body][0] for body in self._bodies], axis=-3)
        origins = np.stack([poses[body][1] for body in self._bodies], axis=-2)
        return Motion(twists, rotations, origins)


def _moved(
    pose: tuple[np.ndarray, np.ndarray], step: tuple[np.ndarray | None, np.ndarray]
) -> tuple[np.ndarray, np.ndarray]:
    (rotation, origin), (turn, shift) = pose, step
    if shift.any():
        origin = origin + rotation @ shift
    return (rotation if turn is None else rotation @ turn), origin


def _read(joint, coordinate: int) -> _Joint:  # noqa: ANN001 - Drake's joint
    turns = joint.type_name() == "revolute"

    def fixed(pose) -> tuple[np.ndarray | None, np.ndarray]:  # noqa: ANN001 - Drake's pose
        rotation = pose.rotation()
        none = rotation.IsExactlyIdentity()
        return None if none else rotation.matrix(), pose.translation()

    return _Joint(
        coordinate,
        int(joint.parent_body().index()),
        int(joint.child_body().index()),
        turns,
        joint.revolute_axis() if turns else joint.translation_axis(),
        fixed(joint.frame_on_parent().GetFixedPoseInBodyFrame()),
        fixed(joint.frame_on_child().GetFixedPoseInBodyFrame().inverse()),
    )
