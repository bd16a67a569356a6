"""The moving part of a replay: one stride as frames, repeated as a Meshcat animation."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from pydrake.geometry import MeshcatAnimation
from pydrake.math import RigidTransform, RotationMatrix

from drakegait import replay_scene as scene
from drakegait.quantities import GRAVITY
from drakegait.replay_muscles import MusclePiece, activation_colours

if TYPE_CHECKING:
    from drakegait.gait import Gait

FRAME_RATE = 30.0
"""Frames per second, about; the browser interpolates between frames."""
LEAST_LOAD = 0.02
"""Share of body weight below which a foot has no arrow."""
_FOR_EVER = 1_000_000  # repetitions


@dataclass(frozen=True, eq=False)
class Film:
    """What moves in one stride, at equal distances in time; the last frame opens the next stride.

    Attributes:
        frames_per_stride: K.
        frame_rate: frames per second that make the walk last as long as it does [1/s].
        stride_length: advance of the walker in K frames [m].
        poses: rotation (K, 3, 3) and origin (K, 3) [m] of each segment, by name.
        activation: (K, num_muscles).
        muscles: their names.
        pressure: centres of pressure (K, 2, 3), right and left foot [m]; nan where unloaded.
        force: ground reactions (K, 2, 3) [body weights].
    """

    frames_per_stride: int
    frame_rate: float
    stride_length: float
    poses: dict[str, tuple[np.ndarray, np.ndarray]]
    activation: np.ndarray
    muscles: tuple[str, ...]
    pressure: np.ndarray
    force: np.ndarray

    @classmethod
    def of(cls, gait: Gait, frames: int | None = None) -> Film:
        """The film of a gait at about `FRAME_RATE`, or with `frames` in a stride."""
        stride_time = float(gait.values.stride_time)
        count = frames or max(8, round(FRAME_RATE * stride_time))
        data = gait.sample(count + 1).isel(time=slice(0, count))
        weight = gait.study.subject.mass * GRAVITY
        return cls(
            frames_per_stride=count,
            frame_rate=count / stride_time,
            stride_length=gait.stride_length,
            poses=gait.study.walker.skeleton.body_poses(gait.motion(np.arange(count) / count).q),
            activation=data.activation.values,
            muscles=tuple(str(name) for name in data.muscle.values),
            pressure=data.centre_of_pressure.values,
            force=data.ground_reaction_force.values / weight,
        )

    @cached_property
    def loaded(self) -> np.ndarray:
        """Whether each foot gets an arrow (K, 2)."""
        return (self.force[..., 2] > LEAST_LOAD) & np.isfinite(self.pressure).all(axis=-1)

    @cached_property
    def colours(self) -> np.ndarray:
        """Colour of each muscle (K, num_muscles, 3)."""
        return activation_colours(self.activation)

    def viewer(self, frame: np.ndarray | int) -> np.ndarray:
        """Forward position of a viewer who travels beside the hips at the mean speed [m]."""
        forward = self.poses["hat"][1][:, 0]
        step = self.stride_length / self.frames_per_stride
        start = np.mean(forward - step * np.arange(self.frames_per_stride))
        return start + step * np.asarray(frame)

    def colour(self, muscle: str) -> np.ndarray:
        """Colour of a muscle by its name (K, 3)."""
        return self.colours[:, self.muscles.index(muscle)]

    def piece_ends(self, piece: MusclePiece) -> np.ndarray:
        """World positions of both ends of a piece of a muscle (K, 2, 3) [m]."""
        ends = []
        for segment, point in zip(piece.segments, piece.points, strict=True):
            rotation, origin = self.poses[segment]
            ends.append(rotation @ point + origin)
        return np.stack(ends, axis=1)


def animate(film: Film, pieces: list[MusclePiece], strides: int, size: float) -> MeshcatAnimation:
    """The film played `strides` times in a row, each time a stride further on.

    Args:
        size: height of the subject over 1.80 m.
    """
    animation = endless(film.frame_rate)
    add_walker(animation, film, pieces, strides, size)
    return animation


def endless(frame_rate: float) -> MeshcatAnimation:
    """An animation without frames that starts at once and repeats."""
    animation = MeshcatAnimation(frame_rate)
    animation.set_loop_mode(MeshcatAnimation.LoopMode.kLoopRepeat)
    animation.set_repetitions(_FOR_EVER)
    animation.set_autoplay(True)
    return animation


def add_walker(
    animation: MeshcatAnimation, film: Film, pieces: list[MusclePiece], strides: int, size: float,
    root: str = scene.ROOT, aside: float = 0.0,
) -> None:  # fmt: skip
    """Add the frames of a walker, repeated `strides` times.

    The root moves back at the mean speed of the walker, so that the view travels with it.

    Args:
        root: path of the walker.
        aside: how far to the left it walks [m].
    """
    ends = {piece: film.piece_ends(piece) for piece in pieces}
    for frame in range(strides * film.frames_per_stride + 1):
        stride, row = divmod(frame, film.frames_per_stride)
        advance = np.array([stride * film.stride_length, 0.0, 0.0])
        view = RigidTransform([-float(film.viewer(frame)), aside, 0.0])
        animation.SetTransform(frame, root, view)
        for segment, (rotation, origin) in film.poses.items():
            pose = RigidTransform(RotationMatrix(rotation[row]), origin[row] + advance)
            animation.SetTransform(frame, scene.body_path(segment, root), pose)
        for piece, points in ends.items():
            _move_piece(animation, frame, piece, points[row] + advance, root)
            if piece.belly:
                colour = film.colour(piece.muscle)[row]
                path = f"{scene.piece_path(piece, root)}/shape/<object>"
                animation.SetProperty(frame, path, "material.color", list(linear_light(colour)))
        _move_arrows(animation, frame, film, row, advance, size, root)


def _move_piece(
    animation: MeshcatAnimation, frame: int, piece: MusclePiece, points: np.ndarray, root: str
) -> None:
    if piece.segments[0] == piece.segments[1]:
        return  # it is fixed to its segment
    pose, length = scene.piece_pose(points)
    path = scene.piece_path(piece, root)
    animation.SetTransform(frame, path, pose)
    animation.SetProperty(frame, f"{path}/shape", "scale", [1.0, 1.0, length])


def _move_arrows(
    animation: MeshcatAnimation, frame: int, film: Film, row: int, advance: np.ndarray,
    size: float, root: str,
) -> None:  # fmt: skip
    for foot, side in enumerate(("right", "left")):
        path, loaded = scene.arrow_path(side, root), bool(film.loaded[row, foot])
        animation.SetProperty(frame, path, "visible", loaded)
        if not loaded:
            continue
        force = film.force[row, foot]
        length = scene.ARROW_SCALE * size * float(np.linalg.norm(force))
        start = film.pressure[row, foot] + advance
        animation.SetTransform(frame, path, RigidTransform(scene.along_z(force), start))
        animation.SetProperty(frame, f"{path}/shaft", "scale", [1.0, 1.0, length])
        animation.SetTransform(frame, f"{path}/head", RigidTransform([0.0, 0.0, length]))


def linear_light(colour: np.ndarray) -> np.ndarray:
    """A colour as the browser's animations take it, from the usual sRGB (IEC 61966-2-1)."""
    return np.where(colour <= 0.04045, colour / 12.92, ((colour + 0.055) / 1.055) ** 2.4)
