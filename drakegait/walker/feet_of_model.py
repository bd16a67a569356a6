"""Heel and toe points of a model's feet, read from its frames and refused if they fit no ground."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from pydrake.multibody.plant import MultibodyPlant

from drakegait.errors import BadFile
from drakegait.walker.contact_kinematics import FeetGeometry
from drakegait.walker.dynamics_derivatives import Tree
from drakegait.walker.model_file import CONTACT_FRAMES
from drakegait.walker.sdf_elements import OWN_MODEL

_SAME = 1e-6  # [m]


def read_feet(
    plant: MultibodyPlant, tree: Tree, names: Sequence[str], tilts: bool
) -> FeetGeometry:
    """The feet of a finalised plant.

    Args:
        names: of the coordinates.
        tilts: see `FeetGeometry`.

    Raises:
        BadFile: a frame that is not on its foot, feet that differ or have no level sole, a joint
            that moves neither foot.
    """
    points = []
    for name in CONTACT_FRAMES:
        frame = plant.GetFrameByName(name)
        if frame.body().name() != f"foot_{name[-1]}":
            raise BadFile(OWN_MODEL, f"frame {name!r} is not fixed to foot_{name[-1]}.")
        points.append(frame.GetFixedPoseInBodyFrame().translation())
    _check(np.array(points))
    feet = np.array([tree.names.index(name) for name in ("foot_r", "foot_l")])
    moves = tree.moves[:, feet].T
    if not np.all(moves.any(axis=0)):
        name = names[int(np.argmin(moves.any(axis=0)))]
        raise BadFile(OWN_MODEL, f"joint {name!r} moves neither foot.")
    return FeetGeometry(tree.inner, moves, feet, np.array(points).reshape(2, 2, 3), tilts)


def _check(points: np.ndarray) -> None:
    """Footprints take both feet as alike: in their sagittal plane, heel and toe level, toe ahead.

    Args:
        points: of `CONTACT_FRAMES` (4, 3) [m].
    """
    for name, point in zip(CONTACT_FRAMES, points, strict=True):
        if abs(point[1]) > _SAME:
            raise BadFile(
                OWN_MODEL,
                f"frame {name!r} is {1e3 * point[1]:.3g} mm beside its foot's sagittal plane; y "
                "must be 0.",
            )
    for one, other, axes, what in (
        (0, 2, (0, 2), "as on the other foot"), (1, 3, (0, 2), "as on the other foot"),
        (0, 1, (2,), "level with its heel"),
    ):  # fmt: skip
        if np.abs(points[one, axes] - points[other, axes]).max() > _SAME:
            x, z = 1e3 * points[other, [0, 2]]
            raise BadFile(
                OWN_MODEL, f"frame {CONTACT_FRAMES[other]!r} is at x = {x:.4g}, z = {z:.4g} mm; it "
                f"must be {what}.",
            )  # fmt: skip
    if not points[1, 0] > points[0, 0] + _SAME:
        raise BadFile(OWN_MODEL, "frame 'toe_r' must be ahead of 'heel_r' along x.")
