"""The skeleton as a tree of bodies in the axes of OpenSim: x forward, y up, z to the right.

Everything is read from Drake's plant in the neutral upright posture (all coordinates zero), so a
model of the user's own and added masses come out as they were solved.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from pydrake.multibody.plant import MultibodyPlant
from pydrake.multibody.tree import RigidBody

from drakegait.errors import BadFile
from drakegait.walker import coordinates
from drakegait.walker.coordinates import TO_OPENSIM
from drakegait.walker.model_file import CONTACT_FRAMES
from drakegait.walker.sdf_elements import OWN_MODEL
from drakegait.walker.skeleton import Skeleton

_SAME_PLACE = 1e-9  # [m]


@dataclass(frozen=True, eq=False)
class Freedom:
    """One coordinate of a joint.

    Attributes:
        coordinate: our name.
        rotation: whether it is an angle.
        axis: (3,) in OpenSim's axes; positive motion along it is positive in anatomical signs.
    """

    coordinate: str
    rotation: bool
    axis: np.ndarray


@dataclass(frozen=True, eq=False)
class Part:
    """One rigid body with the joint that carries it.

    Its frame has the axes of the world in the neutral posture; the origin is the joint.

    Attributes:
        name: of the body.
        parent: name of the body that carries it, `"ground"` for the first.
        joint: name of the joint.
        freedoms: coordinates in the order in which they move the body, none if it is fixed.
        place: (3,) of the joint in the frame of the parent [m].
        mass: [kg].
        com: (3,) centre of mass [m].
        inertia: (3, 3) about the centre of mass [kg m^2].
        points: contact points on it (3,) by name [m].
        link_rotation, link_place: (3, 3) and (3,) from the axes and origin of its link in the SDF
            text, in which a vector of the link is link_place + link_rotation @ vector.
    """

    name: str
    parent: str
    joint: str
    freedoms: tuple[Freedom, ...]
    place: np.ndarray
    mass: float
    com: np.ndarray
    inertia: np.ndarray
    points: dict[str, np.ndarray]
    link_rotation: np.ndarray
    link_place: np.ndarray


def read_parts(skeleton: Skeleton) -> tuple[Part, ...]:
    """The bodies of `skeleton`, parents before children.

    Raises:
        BadFile: for joints of one body that do not meet in a point, or turn before they slide;
            only a model of the user's own can have them.
    """
    plant = skeleton.plant
    context = plant.CreateDefaultContext()
    plant.SetPositions(context, np.zeros(plant.num_positions()))
    joints = {
        int(joint.child_body().index()): joint
        for joint in (plant.get_joint(index) for index in plant.GetJointIndices())
    }
    signs = dict(zip(skeleton.coordinates, coordinates.anatomical_signs(skeleton.kind),
                     strict=True))  # fmt: skip
    segments = {name: plant.GetBodyByName(name) for name in skeleton.body_poses(
        np.zeros(skeleton.num_coordinates))}  # fmt: skip
    origins: dict[str, np.ndarray] = {"ground": np.zeros(3)}
    parts: list[Part] = []
    waiting = dict(segments)
    while waiting:
        for name, body in list(waiting.items()):
            chain, parent = _chain(plant, joints, body, segments)
            if parent not in origins:
                continue
            freedoms, origin = _freedoms(chain, context, signs, name)
            if origin is None:
                origin = plant.EvalBodyPoseInWorld(context, body).translation()
            origins[name] = origin
            place = TO_OPENSIM @ (origin - origins[parent])
            parts.append(_part(plant, context, body, parent, freedoms, place, origin))
            del waiting[name]
    return tuple(parts)


def _chain(plant: MultibodyPlant, joints: dict, body: RigidBody, segments: dict) -> tuple:
    """Joints between `body` and the next body with mass above it, outermost last; its name."""
    chain = []
    while True:
        joint = joints.get(int(body.index()))
        if joint is None:
            return chain[::-1], "ground"
        chain.append(joint)
        body = joint.parent_body()
        if body.name() in segments:
            return chain[::-1], body.name()
        if body.index() == plant.world_body().index():
            return chain[::-1], "ground"


def _freedoms(chain: list, context, signs: dict, name: str) -> tuple:
    """Coordinates of a chain of joints and the point where they meet, in our axes."""
    freedoms, centre = [], None
    for joint in chain:
        if joint.name() not in signs:
            continue  # fixed
        pose = joint.frame_on_child().CalcPoseInWorld(context)
        rotation = joint.type_name() == "revolute"
        if not rotation and any(item.rotation for item in freedoms):
            raise BadFile(OWN_MODEL, f"{name!r} turns before it slides; OpenSim has no such joint.")
        if rotation:
            if centre is not None and not np.allclose(centre, pose.translation(), atol=_SAME_PLACE):
                raise BadFile(OWN_MODEL, f"the joints of {name!r} do not meet in one point.")
            centre = pose.translation()
        axis = joint.revolute_axis() if rotation else joint.translation_axis()
        axis = signs[joint.name()] * TO_OPENSIM @ pose.rotation().matrix() @ axis
        freedoms.append(Freedom(joint.name(), rotation, axis))
    return tuple(freedoms), centre


def _part(
    plant: MultibodyPlant, context, body: RigidBody, parent: str, freedoms: tuple,
    place: np.ndarray, origin: np.ndarray,
) -> Part:  # fmt: skip
    pose = plant.EvalBodyPoseInWorld(context, body)
    turn = TO_OPENSIM @ pose.rotation().matrix()
    inertia = body.default_spatial_inertia().Shift(body.default_com())  # to the mass centre
    com = TO_OPENSIM @ (pose.multiply(body.default_com()) - origin)
    points = {}
    for name in CONTACT_FRAMES:
        frame = plant.GetFrameByName(name)
        if frame.body().name() == body.name():
            points[name] = TO_OPENSIM @ (frame.CalcPoseInWorld(context).translation() - origin)
    moments = turn @ inertia.CalcRotationalInertia().CopyToFullMatrix3() @ turn.T
    return Part(
        name=body.name(),
        parent=parent,
        joint=_joint_name(body.name()),
        freedoms=freedoms,
        place=place,
        mass=float(body.default_mass()),
        com=com,
        inertia=0.5 * (moments + moments.T),
        points=points,
        link_rotation=turn,
        link_place=TO_OPENSIM @ (pose.translation() - origin),
    )


def _joint_name(body: str) -> str:
    kind, _, side = body.partition("_")
    known = {"hat": "ground_hat", "thigh": "hip", "shank": "knee", "foot": "ankle"}
    if kind not in known:
        return f"{body}_joint"
    return f"{known[kind]}_{side}" if side else known[kind]
