"""The coordinates of the two skeletons: names, order, signs, mirror images.

Inside the package every array of coordinates uses the order of `SPATIAL` or
`PLANAR` and the signs of the plant: right-handed rotations about the axes
x forward, y left, z up (Garcia-Vallejo & Schiehlen 2012, eq. 2). Files and
figures show anatomical signs, in which the name of a coordinate is its
positive sense: `hip_flexion_r` > 0 is flexion, while the plant's angle about
+y is then negative. `to_anatomical` and `to_plant` are the only place where
the two meet.

The joints are stacked in the sequence y, x, z (rotation R_y(b) R_x(a) R_z(g)),
although the paper lists the angles as a, b, g: use names, never positions.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from drakegait.errors import UnknownName

SKELETONS = ("spatial", "planar")
TRANSLATIONS = ("hat_x", "hat_y", "hat_z")
"""Names of the coordinates that are lengths [m]; all others are angles [rad]."""
TO_OPENSIM = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]])
"""Turns our vectors (x forward, y left, z up) into OpenSim's (x forward, y up, z right)."""
_OTHER_SIDE = {"_r": "_l", "_l": "_r"}


def other_side(name: str) -> str:
    """The name of the same thing on the other side; of the trunk's, the name itself."""
    end = name[-2:]
    return name[:-2] + _OTHER_SIDE[end] if end in _OTHER_SIDE else name


def without_side(name: str) -> str:
    """The name without `"_r"` or `"_l"` at its end."""
    return name[:-2] if name[-2:] in _OTHER_SIDE else name


@dataclass(frozen=True)
class Coordinate:
    """One generalised coordinate.

    Attributes:
        name: our name, also that of the joint in the SDF file (`"hip_flexion_r"`).
        paper_name: symbol in eq. (2) of the paper, a, b, g = alpha, beta, gamma (`"b_13"`).
        kind: `"rotation"` [rad] or `"translation"` [m].
        anatomical_sign: +1 if the plant's positive sense is the one that the name says, else -1.
        mirror_of: name of the coordinate that is its mirror image about the sagittal plane.
        mirror_sign: in a gait of equal sides, coordinate(t) = mirror_sign * mirror_of(t + T/2),
            in plant signs.
    """

    name: str
    paper_name: str
    kind: str
    anatomical_sign: int
    mirror_of: str
    mirror_sign: int

    @property
    def is_rotation(self) -> bool:
        """Whether it is an angle [rad] and not a length [m]."""
        return self.kind == "rotation"

    @property
    def unit(self) -> str:
        """`"rad"` or `"m"`."""
        return "rad" if self.is_rotation else "m"


def _coordinate(name: str, paper_name: str, anatomical_sign: int) -> Coordinate:
    # A reflection of y turns lateral motion and rotations about x and z over.
    lateral = paper_name[0] in "yag"
    return Coordinate(
        name=name,
        paper_name=paper_name,
        kind="translation" if paper_name[0] in "xyz" else "rotation",
        anatomical_sign=anatomical_sign,
        mirror_of=other_side(name),
        mirror_sign=-1 if lateral else 1,
    )


SPATIAL: tuple[Coordinate, ...] = (
    _coordinate("hat_x", "x_I1", 1),
    _coordinate("hat_y", "y_I1", 1),
    _coordinate("hat_z", "z_I1", 1),
    _coordinate("hat_list", "a_I1", 1),
    _coordinate("hat_tilt", "b_I1", 1),
    _coordinate("hat_rotation", "g_I1", 1),
    _coordinate("hip_adduction_r", "a_13", 1),
    _coordinate("hip_flexion_r", "b_13", -1),
    _coordinate("hip_rotation_r", "g_13", 1),
    _coordinate("knee_flexion_r", "b_34", 1),
    _coordinate("ankle_dorsiflexion_r", "b_45", -1),
    _coordinate("hip_adduction_l", "a_16", -1),
    _coordinate("hip_flexion_l", "b_16", -1),
    _coordinate("hip_rotation_l", "g_16", -1),
    _coordinate("knee_flexion_l", "b_67", 1),
    _coordinate("ankle_dorsiflexion_l", "b_78", -1),
)
"""The 16 coordinates of the spatial skeleton, in order."""

PLANAR: tuple[Coordinate, ...] = tuple(c for c in SPATIAL if c.paper_name[0] in "xzb")
"""The 9 sagittal coordinates of the planar skeleton, in order."""


def coordinates(skeleton: str) -> tuple[Coordinate, ...]:
    """The coordinates of the `"spatial"` or `"planar"` skeleton, in order.

    Raises:
        UnknownName: for any other name of a skeleton.
    """
    if skeleton not in SKELETONS:
        raise UnknownName("skeleton", skeleton, SKELETONS)
    return SPATIAL if skeleton == "spatial" else PLANAR


def names(skeleton: str) -> tuple[str, ...]:
    """Names of the coordinates, in order."""
    return tuple(c.name for c in coordinates(skeleton))


def index(skeleton: str) -> dict[str, int]:
    """Position of each coordinate by its name."""
    return {name: i for i, name in enumerate(names(skeleton))}


def position(skeleton: str, name: str) -> int:
    """Position of the coordinate called `name`, ours (`"hat_x"`) or the paper's (`"x_I1"`).

    Raises:
        UnknownName: if the skeleton has no such coordinate; lists our names.
    """
    for i, c in enumerate(coordinates(skeleton)):
        if name in (c.name, c.paper_name):
            return i
    raise UnknownName("coordinate", name, names(skeleton))


def positions(skeleton: str, wanted: Iterable[str]) -> np.ndarray:
    """Positions of several coordinates by name, as an integer array."""
    return np.array([position(skeleton, name) for name in wanted], dtype=int)


def rotations(skeleton: str) -> np.ndarray:
    """Mask (num_coordinates,): True where the coordinate is an angle."""
    return np.array([c.is_rotation for c in coordinates(skeleton)])


def joint_angles(skeleton: str) -> np.ndarray:
    """Positions (num_joint_angles,) of the angles between segments, in order (all but the HAT's).

    These are the rows on which muscles act: matrix B of the paper selects them.
    """
    table = coordinates(skeleton)
    return np.array([i for i, c in enumerate(table) if not c.name.startswith("hat_")])


def mirror_positions(skeleton: str) -> np.ndarray:
    """Position (num_coordinates,) of the mirror image of each coordinate."""
    where = index(skeleton)
    return np.array([where[c.mirror_of] for c in coordinates(skeleton)])


def mirror_signs(skeleton: str) -> np.ndarray:
    """Sign (num_coordinates,) that each coordinate takes in the mirror, in plant signs."""
    return np.array([float(c.mirror_sign) for c in coordinates(skeleton)])


def mirror(skeleton: str, values: np.ndarray) -> np.ndarray:
    """Mirror coordinates (or velocities, or accelerations) about the sagittal plane.

    Args:
        values: (..., num_coordinates), plant signs.
    """
    return mirror_signs(skeleton) * np.asarray(values)[..., mirror_positions(skeleton)]


def anatomical_signs(skeleton: str) -> np.ndarray:
    """Factor (num_coordinates,) between plant and anatomical signs."""
    return np.array([float(c.anatomical_sign) for c in coordinates(skeleton)])


def to_anatomical(skeleton: str, values: np.ndarray) -> np.ndarray:
    """Plant signs -> anatomical signs, in the same units.

    Args:
        values: (..., num_coordinates) coordinates, their derivatives or generalised forces.
    """
    return anatomical_signs(skeleton) * np.asarray(values)


def to_plant(skeleton: str, values: np.ndarray) -> np.ndarray:
    """Anatomical signs -> plant signs: the inverse of `to_anatomical`."""
    return anatomical_signs(skeleton) * np.asarray(values)
