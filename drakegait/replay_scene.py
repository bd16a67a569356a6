"""What stands in the replay: body, bones, weights, muscles, arrows, footprints and ground.

Every function puts shapes at fixed paths of a Meshcat; `replay` moves and colours them. All of one
walker is below a root, `ROOT` if it is alone, in the world of the mechanics (x forward, y left, z
up, ground at z = 0).
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from pydrake.geometry import (
    Box,
    Capsule,
    Cylinder,
    Ellipsoid,
    Meshcat,
    MeshcatCone,
    Rgba,
    SceneGraph,
    Sphere,
)
from pydrake.math import RigidTransform, RotationMatrix
from pydrake.multibody.parsing import Parser
from pydrake.multibody.plant import MultibodyPlant

from drakegait.replay_muscles import RESTING, MusclePiece, muscle_pieces
from drakegait.report.footprints import placed_outline, prints
from drakegait.walker.subject import SEGMENTS, segment_properties

if TYPE_CHECKING:
    from drakegait.gait import Gait

ROOT = "gait"
ARROW_SCALE = 0.8  # length of the arrow of one body weight [m at 1.80 m of height]
_SIDES = {"right": (0.11, 0.38, 0.65), "left": (0.75, 0.19, 0.12)}
_FLESH = (0.86, 0.76, 0.68)
_BONE = Rgba(0.93, 0.90, 0.82, 1.0)
_TENDON = Rgba(0.88, 0.86, 0.80, 1.0)
_ARROW = Rgba(0.10, 0.62, 0.25, 1.0)
_WEIGHT = Rgba(0.15, 0.15, 0.17, 1.0)
_SHIRT = ("trunk", "upper_arm")  # shapes of the HAT that take another colour
_STEEL = 7850.0  # [kg/m^3], makes the drawn size of an added mass
_OPACITY = {"hat": 0.45, "thigh": 0.25, "shank": 0.25, "foot": 0.75}
WIDTH = 2.4
"""Of the walkway of a single walker [m]."""
_MARGIN = 4.0  # ground before the first and after the last print [m]


def body_path(segment: str, root: str = ROOT) -> str:
    """Path whose pose is that of a segment's frame."""
    return f"{root}/walker/{segment}"


def piece_path(piece: MusclePiece, root: str = ROOT) -> str:
    """Path of a piece of a muscle; on a segment's path if both ends are fixed to that segment."""
    start, end = piece.segments
    parent = body_path(start, root) if start == end else f"{root}/walker/muscles"
    return f"{parent}/{piece.muscle}/{piece.number}"


def arrow_path(side: str, root: str = ROOT) -> str:
    """Path of the arrow of the force on a foot, its z axis along the force."""
    return f"{root}/forces/{side}"


def build(
    meshcat: Meshcat, gait: Gait, strides: int, root: str = ROOT, width: float = WIDTH,
    shirt: tuple[float, float, float] | None = None,
) -> list[MusclePiece]:  # fmt: skip
    """Put a walker and its walkway; returns the pieces of the muscles.

    Args:
        root: path below which everything is put.
        width: of the walkway [m].
        shirt: colour of the trunk, default that of the model; red, green, blue in 0..1.
    """
    study = gait.study
    set_ground(meshcat, gait, strides, root, width)
    set_body(meshcat, gait, root, shirt)
    pieces = muscle_pieces(study.walker.muscles, study.subject)
    for piece in pieces:
        set_muscle(meshcat, piece, root)
    for side in _SIDES:
        set_arrow(meshcat, side, study.subject.length_scale, root)
    return pieces


def set_body(
    meshcat: Meshcat, gait: Gait, root: str = ROOT, shirt: tuple[float, float, float] | None = None
) -> None:
    """The shapes of the SDF model, see-through over bones, and the weights that are worn."""
    study = gait.study
    plant, scene = MultibodyPlant(time_step=0.0), SceneGraph()
    plant.RegisterAsSourceForSceneGraph(scene)
    Parser(plant).AddModelsFromString(study.walker.skeleton.sdf, "sdf")
    plant.Finalize()
    inspector = scene.model_inspector()
    for segment in SEGMENTS:
        shapes = plant.GetVisualGeometriesForBody(plant.GetBodyByName(segment))
        for number, shape in enumerate(shapes):
            path = f"{body_path(segment, root)}/shape_{number}"
            skin = _skin(inspector, shape, segment, shirt)
            meshcat.SetObject(path, inspector.GetShape(shape), skin)
            meshcat.SetTransform(path, inspector.GetPoseInFrame(shape))
    _set_bones(meshcat, gait, root)
    properties = segment_properties(study.subject)
    for number, worn in enumerate(study.added_masses):
        path = f"{body_path(worn.segment, root)}/weight_{number}"
        point = properties[worn.segment].com if worn.point is None else np.array(worn.point)
        meshcat.SetObject(path, Sphere((0.75 * worn.mass / np.pi / _STEEL) ** (1 / 3)), _WEIGHT)
        meshcat.SetTransform(path, RigidTransform(np.asarray(point, dtype=float)))


def _skin(inspector, shape, segment: str, shirt: tuple[float, float, float] | None) -> Rgba:
    opacity = _OPACITY[segment.split("_")[0]]
    if segment.startswith("foot"):
        return Rgba(*_SIDES["right" if segment.endswith("_r") else "left"], opacity)
    if segment == "hat":
        if shirt is not None and any(word in inspector.GetName(shape) for word in _SHIRT):
            return Rgba(*shirt, 0.7)
        colour = inspector.GetIllustrationProperties(shape).GetProperty("phong", "diffuse")
        return Rgba(colour.r(), colour.g(), colour.b(), opacity)
    return Rgba(*_FLESH, opacity)


def _set_bones(meshcat: Meshcat, gait: Gait, root: str) -> None:
    """Rods between the joints, read from the skeleton in its neutral posture."""
    skeleton, size = gait.study.walker.skeleton, gait.study.subject.length_scale
    poses = skeleton.body_poses(np.zeros(skeleton.num_coordinates))
    where = {name: pose[1] for name, pose in poses.items()}
    rods = [("hat", where["thigh_l"], where["thigh_r"])]
    for side in "rl":
        rods.append((f"thigh_{side}", where[f"thigh_{side}"], where[f"shank_{side}"]))
        rods.append((f"shank_{side}", where[f"shank_{side}"], where[f"foot_{side}"]))
    for segment, start, end in rods:
        path = f"{body_path(segment, root)}/bone"
        along = start - end
        length = float(np.linalg.norm(along))
        if length < 1e-6:
            continue
        meshcat.SetObject(path, Capsule(0.013 * size, length), _BONE)
        middle = 0.5 * (start + end) - where[segment]
        meshcat.SetTransform(path, RigidTransform(along_z(along), middle))


def set_muscle(meshcat: Meshcat, piece: MusclePiece, root: str = ROOT) -> None:
    """A piece of unit length along z, centred: a spindle for a belly, a thin rod for tendon."""
    path = piece_path(piece, root)
    if piece.belly:
        shape = Ellipsoid(piece.radius, piece.radius, 0.5)
        meshcat.SetObject(f"{path}/shape", shape, Rgba(*RESTING, 1.0))
    else:
        meshcat.SetObject(f"{path}/shape", Cylinder(piece.radius, 1.0), _TENDON)
    if piece.segments[0] == piece.segments[1]:
        pose, length = piece_pose(piece.points)
        meshcat.SetTransform(path, pose)
        meshcat.SetProperty(f"{path}/shape", "scale", [1.0, 1.0, length])


def set_arrow(meshcat: Meshcat, side: str, size: float, root: str = ROOT) -> None:
    """The arrow of a foot's ground reaction: a shaft of unit length and a head."""
    path = arrow_path(side, root)
    meshcat.SetObject(f"{path}/shaft/shape", Cylinder(0.010 * size, 1.0), _ARROW)
    meshcat.SetTransform(f"{path}/shaft/shape", RigidTransform([0.0, 0.0, 0.5]))
    head = 0.07 * size
    meshcat.SetObject(f"{path}/head/shape", MeshcatCone(head, 0.026 * size, 0.026 * size), _ARROW)
    tip_up = RigidTransform(RotationMatrix.MakeXRotation(np.pi), [0.0, 0.0, head])
    meshcat.SetTransform(f"{path}/head/shape", tip_up)


def set_ground(
    meshcat: Meshcat, gait: Gait, strides: int, root: str = ROOT, width: float = WIDTH
) -> None:
    """A walkway with a line every half metre, and the prints that the feet should land on."""
    length = gait.stride_length
    low, high = -0.5 * length - _MARGIN, (strides + 0.5) * length + _MARGIN
    floor = Rgba(0.86, 0.87, 0.88, 1.0)
    meshcat.SetObject(f"{root}/ground/floor", Box(high - low, width, 0.02), floor)
    centre = RigidTransform([0.5 * (low + high), 0.0, -0.01])
    meshcat.SetTransform(f"{root}/ground/floor", centre)
    for number in range(int(np.ceil(2 * low)), int(np.floor(2 * high)) + 1):
        path = f"{root}/ground/line_{number}"
        wide = 0.025 if number % 2 == 0 else 0.012
        meshcat.SetObject(path, Box(wide, width, 0.002), Rgba(0.70, 0.72, 0.75, 1.0))
        meshcat.SetTransform(path, RigidTransform([0.5 * number, 0.0, 0.0]))
    for side, places in prints(gait, strides).items():
        for number, where in enumerate(places):
            _set_print(meshcat, f"{root}/ground/print_{side}_{number}", gait, side, where)


def _set_print(meshcat: Meshcat, path: str, gait: Gait, side: str, where: np.ndarray) -> None:
    outline = placed_outline(gait, side, where)
    middle = outline.mean(axis=0)
    vertices = np.column_stack([np.vstack([middle, outline]), np.full(len(outline) + 1, 0.004)])
    rim = 1 + np.arange(len(outline))
    faces = np.stack([np.zeros_like(rim), rim, np.roll(rim, -1)])
    meshcat.SetTriangleMesh(
        path, np.asfortranarray(vertices.T), np.asfortranarray(faces.astype(np.int32)),
        Rgba(*_SIDES[side], 0.55), False, 1.0, Meshcat.SideOfFaceToRender.kDoubleSide,
    )  # fmt: skip


def set_view(meshcat: Meshcat, size: float, middle: float = 0.0, distance: float = 1.0) -> None:
    """Seen from the front right, at hip height; no axes, no grid.

    Args:
        size: of the subject, height over 1.80 m.
        middle: how far to the left of the first walker the middle of the picture is [m].
        distance: of the camera, relative to that for one walker.
    """
    for path in ("/Grid", "/Axes"):
        meshcat.SetProperty(path, "visible", False)
    meshcat.SetProperty("/Background/<object>", "top_color", [0.80, 0.86, 0.92])
    meshcat.SetProperty("/Background/<object>", "bottom_color", [0.97, 0.98, 0.99])
    meshcat.SetCamera(Meshcat.PerspectiveCamera(fov=38.0))
    meshcat.SetProperty("/Lights/AmbientLight/<object>", "intensity", 0.9)
    # A little behind the walker: the legend is on the left.
    target = np.array([-0.3 * size, middle, 0.86 * size])
    meshcat.SetCameraPose(target + distance * size * np.array([1.35, -3.4, 0.45]), target)


def piece_pose(points: np.ndarray) -> tuple[RigidTransform, float]:
    """Pose and length [m] of a piece of a muscle between two points (2, 3), origin first."""
    along = points[0] - points[1]
    middle = 0.5 * (points[0] + points[1])
    return RigidTransform(along_z(along), middle), float(np.linalg.norm(along))


def along_z(direction: np.ndarray) -> RotationMatrix:
    """The smallest rotation of z onto a direction; not defined for one straight down."""
    x, y, z = direction / np.linalg.norm(direction)
    share = 1.0 / (1.0 + z)
    return RotationMatrix(
        np.array([
            [1.0 - share * x * x, -share * x * y, x],
            [-share * x * y, 1.0 - share * y * y, y],
            [-x, -y, z],
        ])
    )  # fmt: skip
