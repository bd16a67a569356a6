"""A walker as a model for OpenSim 4.5 or later, written without OpenSim.

Bodies, joints, added masses, muscle paths and passive moments are ours exactly; what differs is the
contraction of the muscles, see `drakegait.export.muscles`. Axes are those of OpenSim (x forward, y
up, z to the right), coordinates have our names and anatomical signs, angles are in rad. The ground
is the plane y = 0. Feet have markers at heel and toe and no contact force.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from xml.etree.ElementTree import Element

import numpy as np

from drakegait.export.bodies import Freedom, Part, read_parts
from drakegait.export.muscles import add_muscles
from drakegait.export.passive import add_passive_moments
from drakegait.export.shapes import add_shapes
from drakegait.export.xml_text import add, document, written
from drakegait.program.design import coordinate_bounds
from drakegait.program.formulation import JointLimit
from drakegait.quantities import GRAVITY
from drakegait.walker import coordinates
from drakegait.walker.walker import Walker

_TRAVEL = 100.0  # range of hat_x [m]: it contains the advance


def osim_model(
    walker: Walker,
    *,
    name: str = "drakegait",
    muscles: str = "degroote_fregly",
    passive: bool = True,
    limits: Iterable[JointLimit] = (),
) -> str:
    """Text of an `.osim` file.

    Args:
        walker: the person with all that is fixed to it.
        name: of the model.
        muscles: `"degroote_fregly"`, `"actuators"` (ideal, exactly our forces) or `"none"`.
        passive: whether to write the passive joint moments.
        limits: of a study; they narrow the ranges of the coordinates.

    Raises:
        UnknownName: for another kind of muscles.
        BadFile: for joints of an SDF model of one's own that OpenSim cannot have.
    """
    parts = read_parts(walker.skeleton)
    root = document()
    model = add(root, "Model", name=name)
    add(model, "gravity", [0.0, -GRAVITY, 0.0])
    add(model, "length_units", "meters")
    add(model, "force_units", "N")
    bodies = add(add(model, "BodySet", name="bodyset"), "objects")
    joints = add(add(model, "JointSet", name="jointset"), "objects")
    markers = add(add(model, "MarkerSet", name="markerset"), "objects")
    ranges = _ranges(walker, limits)
    paths = {}
    for part in parts:
        add_shapes(_add_body(bodies, part), part, walker.skeleton.sdf)
        _add_joint(joints, part, ranges)
        for point, place in part.points.items():
            marker = add(markers, "Marker", name=point)
            add(marker, "socket_parent_frame", f"/bodyset/{part.name}")
            add(marker, "location", place)
            add(marker, "fixed", True)
        for freedom in part.freedoms:
            paths[freedom.coordinate] = f"/jointset/{part.joint}/{freedom.coordinate}"
    forces = add(add(model, "ForceSet", name="forceset"), "objects")
    add_muscles(forces, walker, muscles, paths)
    if passive:
        add_passive_moments(forces, walker, paths)
    return written(root)


def _ranges(walker: Walker, limits: Iterable[JointLimit]) -> dict[str, tuple[float, float]]:
    """Lowest and highest value of each coordinate, anatomical signs."""
    kind = walker.skeleton.kind
    signs = coordinates.anatomical_signs(kind)
    bounds = coordinate_bounds(kind, walker.subject.height) * signs[:, None]
    ranges = {
        name: (min(row), max(row)) for name, row in zip(walker.coordinate_names, bounds.tolist(),
                                                        strict=True)
    }  # fmt: skip
    ranges["hat_x"] = (-_TRAVEL, _TRAVEL)
    for limit in limits:
        low, high = ranges[limit.coordinate]
        ranges[limit.coordinate] = max(low, limit.low), min(high, limit.high)
    return ranges


def _add_body(bodies: Element, part: Part) -> Element:
    body = add(bodies, "Body", name=part.name)
    add(body, "mass", part.mass)
    add(body, "mass_center", part.com)
    inertia = part.inertia
    moments = [*np.diag(inertia), inertia[0, 1], inertia[0, 2], inertia[1, 2]]
    add(body, "inertia", moments)
    return body


def _add_joint(joints: Element, part: Part, ranges: dict[str, tuple[float, float]]) -> None:
    # Turning about z alone, with either sign, is OpenSim's PinJoint, which is quicker.
    pin = len(part.freedoms) == 1 and part.freedoms[0].rotation
    pin = pin and math.isclose(abs(part.freedoms[0].axis[2]), 1.0)
    tag = "PinJoint" if pin else "CustomJoint" if part.freedoms else "WeldJoint"
    joint = add(joints, tag, name=part.joint)
    add(joint, "socket_parent_frame", f"{part.parent}_offset")
    add(joint, "socket_child_frame", f"{part.name}_offset")
    if part.freedoms:
        _add_coordinates(add(joint, "coordinates"), part, ranges)
    frames = add(joint, "frames")
    turned = [math.pi if pin and part.freedoms[0].axis[2] < 0.0 else 0.0, 0.0, 0.0]
    for body, place in ((part.parent, part.place), (part.name, np.zeros(3))):
        frame = add(frames, "PhysicalOffsetFrame", name=f"{body}_offset")
        add(frame, "socket_parent", "/ground" if body == "ground" else f"/bodyset/{body}")
        add(frame, "translation", place)
        add(frame, "orientation", turned)
    if tag == "CustomJoint":
        _add_transform(joint, part)


def _add_coordinates(group: Element, part: Part, ranges: dict[str, tuple[float, float]]) -> None:
    for freedom in _rotations_first(part.freedoms):
        coordinate = add(group, "Coordinate", name=freedom.coordinate)
        low, high = ranges[freedom.coordinate]
        add(coordinate, "default_value", min(max(0.0, low), high))
        add(coordinate, "range", [low, high])


def _rotations_first(freedoms: tuple[Freedom, ...]) -> list[Freedom]:
    """OpenSim's order of the coordinates of a CustomJoint, which slides in its parent's axes."""
    return sorted(freedoms, key=lambda freedom: not freedom.rotation)


def _add_transform(joint: Element, part: Part) -> None:
    transform = add(joint, "SpatialTransform")
    for kind in ("rotation", "translation"):
        wanted = [f for f in part.freedoms if f.rotation == (kind == "rotation")]
        axes = [freedom.axis for freedom in wanted]
        for unit in np.eye(3):  # OpenSim wants three independent axes, also where nothing moves
            if len(axes) < 3 and np.linalg.matrix_rank(np.array([*axes, unit])) == len(axes) + 1:
                axes.append(unit)
        for i, axis in enumerate(axes):
            line = add(transform, "TransformAxis", name=f"{kind}{i + 1}")
            moves = i < len(wanted)
            add(line, "coordinates", wanted[i].coordinate if moves else "")
            add(line, "axis", axis)
            if moves:
                add(add(line, "LinearFunction", name="function"), "coefficients", [1.0, 0.0])
            else:
                add(add(line, "Constant", name="function"), "value", 0.0)
