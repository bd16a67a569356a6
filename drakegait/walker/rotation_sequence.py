"""The order of the three rotations of trunk and hips: 213 (y, x, z) or 123 (x, y, z).

    213: R = R_y(b) R_x(a) R_z(g)        123: R = R_x(a) R_y(b) R_z(g)

a, b, g are list or adduction, tilt or flexion, and rotation. A posture has other angles in the
other sequence, and moment arms, passive moments and damping, which belong to the angles of the
joints, then belong to those: the two walkers differ a little in more than their description.
"""

from __future__ import annotations

from xml.etree import ElementTree

import numpy as np

from drakegait.walker import coordinates

_TRIPLES = (
    ("hat_list", "hat_tilt", "hat_rotation"),
    *((f"hip_adduction_{side}", f"hip_flexion_{side}", f"hip_rotation_{side}") for side in "rl"),
)


def sdf_in_sequence_123(text: str) -> str:
    """SDF text of the walker whose trunk and hips turn in the sequence 123, from one in 213.

    The first and the second joint of trunk and hips change places: name and axis, and with the name
    all that refers to the frame of the joint. Links, masses and shapes stay.
    """
    root = ElementTree.fromstring(text)
    joints = {joint.get("name"): joint for joint in root.iter("joint")}
    swap = {}
    for about_x, about_y, _ in _TRIPLES:
        swap |= {about_x: about_y, about_y: about_x}
        axes = [joints[name].find("axis/xyz") for name in (about_x, about_y)]
        axes[0].text, axes[1].text = axes[1].text, axes[0].text
        for name in (about_x, about_y):
            joints[name].set("name", swap[name])
    for element in root.iter():
        for key in ("relative_to", "attached_to", "expressed_in"):
            name = element.get(key)
            if name in swap:
                element.set(key, swap[name])
    return ElementTree.tostring(root, encoding="unicode")


def convert(values: np.ndarray, given: str, wanted: str) -> np.ndarray:
    """Coordinates (..., 16) of the spatial skeleton, plant signs, in another sequence.

    Angles about the middle axis have to be within +-pi/2, as in any walk.
    """
    if given == wanted:
        return np.array(values, dtype=float)
    out = np.array(values, dtype=float)
    for triple in _TRIPLES:
        places = coordinates.positions("spatial", triple)
        rotation = _rotation(*(out[..., place] for place in places), given)
        out[..., places] = _angles(rotation, wanted)
    return out


def rotation_matrix(bag: np.ndarray) -> np.ndarray:
    """R_y(b) R_x(a) R_z(g) (..., 3, 3) of angles b, a, g (..., 3) [rad]."""
    b, a, g = np.moveaxis(bag, -1, 0)
    return _rotation(a, b, g, "213")


def rotation_angles(rotation: np.ndarray) -> np.ndarray:
    """The inverse: b, a, g (..., 3) with |a| below a right angle."""
    return _angles(rotation, "213")[..., [1, 0, 2]]


def _rotation(a: np.ndarray, b: np.ndarray, g: np.ndarray, sequence: str) -> np.ndarray:
    about_x, about_y, about_z = _turn(a, 0), _turn(b, 1), _turn(g, 2)
    if sequence == "213":
        return about_y @ about_x @ about_z
    return about_x @ about_y @ about_z


def _turn(angle: np.ndarray, axis: int) -> np.ndarray:
    """Rotations (..., 3, 3) about a coordinate axis."""
    out = np.zeros((*np.shape(angle), 3, 3))
    one, two = (axis + 1) % 3, (axis + 2) % 3
    out[..., axis, axis] = 1.0
    out[..., one, one] = out[..., two, two] = np.cos(angle)
    out[..., two, one] = np.sin(angle)
    out[..., one, two] = -np.sin(angle)
    return out


def _angles(R: np.ndarray, sequence: str) -> np.ndarray:
    """a, b, g (..., 3) of rotations (..., 3, 3)."""
    if sequence == "213":
        a = np.arcsin(np.clip(-R[..., 1, 2], -1.0, 1.0))
        b = np.arctan2(R[..., 0, 2], R[..., 2, 2])
        g = np.arctan2(R[..., 1, 0], R[..., 1, 1])
    else:
        a = np.arctan2(-R[..., 1, 2], R[..., 2, 2])
        b = np.arcsin(np.clip(R[..., 0, 2], -1.0, 1.0))
        g = np.arctan2(-R[..., 0, 1], R[..., 0, 0])
    return np.stack([a, b, g], axis=-1)
