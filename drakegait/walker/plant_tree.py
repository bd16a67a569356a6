"""What Drake's plant says about the tree of joints and bodies, read once and checked."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from pydrake.multibody.plant import MultibodyPlant
from pydrake.multibody.tree import BodyIndex

from drakegait.errors import BadFile
from drakegait.walker.coordinates import without_side
from drakegait.walker.dynamics_derivatives import Tree, skew
from drakegait.walker.sdf_elements import OWN_MODEL

_AXES = {
    "hat_x": ("prismatic", (1.0, 0.0, 0.0)),
    "hat_y": ("prismatic", (0.0, 1.0, 0.0)),
    "hat_z": ("prismatic", (0.0, 0.0, 1.0)),
    "hat_list": ("revolute", (1.0, 0.0, 0.0)),
    "hat_tilt": ("revolute", (0.0, 1.0, 0.0)),
    "hat_rotation": ("revolute", (0.0, 0.0, 1.0)),
    "hip_adduction": ("revolute", (1.0, 0.0, 0.0)),
    "hip_flexion": ("revolute", (0.0, 1.0, 0.0)),
    "hip_rotation": ("revolute", (0.0, 0.0, 1.0)),
    "knee_flexion": ("revolute", (0.0, 1.0, 0.0)),
    "ankle_dorsiflexion": ("revolute", (0.0, 1.0, 0.0)),
}
"""Type and axis of each joint; left and right are alike."""


def check_joints(plant: MultibodyPlant, names: Sequence[str]) -> np.ndarray:
    """Places (n,) of the named coordinates in Drake's vectors of positions and of velocities.

    Raises:
        BadFile: if the plant has other degrees of freedom, or a joint of another type or axis,
            or springs or damping (passive moments are a setting of drakegait).
    """
    order = []
    for name in names:
        joint = plant.GetJointByName(name)
        kind, axis = _AXES[without_side(name)]
        if joint.type_name() != kind:
            raise BadFile(OWN_MODEL, f"joint {name!r} is {joint.type_name()}, not {kind}.")
        given = joint.revolute_axis() if kind == "revolute" else joint.translation_axis()
        if not np.allclose(given, axis, atol=1e-9):
            text = " ".join(f"{x:g}" for x in given)
            wanted = " ".join(f"{x:g}" for x in axis)
            raise BadFile(OWN_MODEL, f"joint {name!r} has the axis {text}, not {wanted}.")
        if np.any(joint.default_damping_vector()):
            raise BadFile(OWN_MODEL, f"joint {name!r} has damping; use PassiveSettings instead.")
        order.append(joint.position_start())
    if plant.num_positions() != len(names) or plant.num_velocities() != len(names):
        raise BadFile(
            OWN_MODEL,
            f"the model has {plant.num_velocities()} degrees of freedom, not {len(names)}.",
        )
    if plant.num_force_elements() > 1:
        raise BadFile(OWN_MODEL, "the model has springs; use PassiveSettings instead.")
    return np.array(order)


def read_tree(plant: MultibodyPlant, names: Sequence[str], gravity: float) -> Tree:
    """The tree of the named coordinates; bodies are those with mass, in Drake's order."""
    joints = [plant.GetJointByName(name) for name in names]
    moved = [
        {int(index) for index in plant.GetBodiesKinematicallyAffectedBy([joint.index()])}
        for joint in joints
    ]
    bodies = [plant.get_body(BodyIndex(i)) for i in range(1, plant.num_bodies())]
    bodies = [body for body in bodies if body.default_mass() > 0]
    children = [int(joint.child_body().index()) for joint in joints]
    coms = np.array([body.default_com() for body in bodies])
    masses = np.array([body.default_mass() for body in bodies])
    about_origin = np.array(
        [body.default_spatial_inertia().CopyToFullMatrix6()[:3, :3] for body in bodies]
    )
    return Tree(
        names=tuple(body.name() for body in bodies),
        inner=np.array([[float(child in below) for child in children] for below in moved]),
        moves=np.array([[float(int(b.index()) in below) for b in bodies] for below in moved]),
        masses=masses,
        coms=coms,
        inertias=about_origin + masses[:, None, None] * skew(coms) @ skew(coms),
        gravity=gravity,
    )
