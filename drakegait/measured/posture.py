"""From a measured body to the 16 coordinates of the model.

The model has one rigid HAT (head, arms, trunk) in the place of pelvis and trunk. So that its mass
centre goes where the person's goes, the HAT's angles are a mixture of the trunk's and the pelvis'
(shares `TRUNK_SHARE`, which reproduce the lateral ground force of the embedded stride), without
their static pitch. The hip angles are computed anew from rotation matrices, R_HAT^T R_thigh, and
the thighs, shanks and feet keep the orientation that was measured.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from drakegait.measured.body_angles import ANGLES, BodyAngles
from drakegait.measured.notes import Notes
from drakegait.measured.time_axis import Series
from drakegait.walker.coordinates import TRANSLATIONS, index, names
from drakegait.walker.rotation_sequence import rotation_angles, rotation_matrix
from drakegait.walker.skeleton import Skeleton

TRUNK_SHARE = np.array([0.5, 0.65, 0.8])
"""Share of the trunk in the HAT's tilt, list and rotation; the pelvis has the rest."""

_STRAIGHT = np.radians(5.0)


@dataclass(frozen=True, eq=False, kw_only=True)
class Posture:
    """The walk in the model's coordinates.

    Attributes:
        series: (K, 16) plant signs, walking along +x; hat_x, hat_y, hat_z as measured.
        points: (K, 4, 3) heel_r, toe_r, heel_l, toe_l, relative to the middle of the hips [m].
        hips: (K, 3) middle of the hips [m].
        place: whether x, y, z of the hips were measured.
        lean: static pitch taken out of the HAT [rad].
        heading: angle by which everything was turned about the vertical [rad].
    """

    series: Series
    points: np.ndarray
    hips: np.ndarray
    place: tuple[bool, bool, bool]
    lean: float
    heading: float

    @property
    def time(self) -> np.ndarray:
        """Instants (K,) [s]."""
        return self.series.time


def model_posture(body: BodyAngles, skeleton: Skeleton, notes: Notes) -> Posture:
    """Coordinates of the spatial skeleton for every instant of a measurement."""
    where = {name: k for k, name in enumerate(ANGLES)}
    values = body.series.values

    def angles(*quantities: str) -> np.ndarray:
        return values[:, [where[q] for q in quantities]]

    hips = values[:, len(ANGLES) :]
    pelvis_angles = angles("pelvis_b", "pelvis_a", "pelvis_g")
    heading = _heading(pelvis_angles[:, 2], hips, body, notes)
    pelvis = _turn(-heading) @ rotation_matrix(pelvis_angles)
    hips = hips @ _turn(-heading).T
    trunk = pelvis @ rotation_matrix(angles("trunk_b", "trunk_a", "trunk_g"))
    mixture = TRUNK_SHARE * rotation_angles(trunk) + (1 - TRUNK_SHARE) * rotation_angles(pelvis)
    lean = float(mixture[body.series.usable, 0].mean())
    mixture[:, 0] -= lean
    hat = rotation_matrix(mixture)
    q = np.zeros((len(values), 16))
    at = index("spatial")
    q[:, [at["hat_tilt"], at["hat_list"], at["hat_rotation"]]] = mixture
    for side in "rl":
        thigh = pelvis @ rotation_matrix(angles(*(f"hip_{x}_{side}" for x in "bag")))
        hip = rotation_angles(np.swapaxes(hat, -1, -2) @ thigh)
        joints = ("hip_flexion", "hip_adduction", "hip_rotation")
        q[:, [at[f"{joint}_{side}"] for joint in joints]] = hip
        q[:, at[f"knee_flexion_{side}"]] = values[:, where[f"knee_{side}"]]
        q[:, at[f"ankle_dorsiflexion_{side}"]] = values[:, where[f"ankle_{side}"]]
    points = skeleton.contact_points(q)
    q[:, [at[name] for name in TRANSLATIONS]] = hips
    series = Series(time=body.series.time, values=q, usable=body.series.usable)
    return Posture(
        series=series, points=points, hips=hips, place=body.place, lean=lean, heading=heading
    )


def level_feet(posture: Posture, skeleton: Skeleton, pitch: dict[str, float]) -> Posture:
    """The posture with ankles turned so that a flat foot is flat.

    Args:
        pitch: of each foot while it stands flat, toe down positive, by side [rad].
    """
    q = posture.series.values.copy()
    at = index("spatial")
    for side, angle in pitch.items():
        q[:, at[f"ankle_dorsiflexion_{side}"]] -= angle
    still = q.copy()
    still[:, [at[name] for name in TRANSLATIONS]] = 0.0
    series = Series(time=posture.time, values=q, usable=posture.series.usable)
    return Posture(
        series=series, points=skeleton.contact_points(still), hips=posture.hips,
        place=posture.place, lean=posture.lean, heading=posture.heading,
    )  # fmt: skip


def foot_pitch(points: np.ndarray) -> np.ndarray:
    """Pitch (..., 2) of right and left foot, toe down positive, of points (..., 4, 3) [rad]."""
    along = points[..., 1::2, :] - points[..., 0::2, :]
    return np.arcsin(np.clip(-along[..., 2] / np.linalg.norm(along, axis=-1), -1.0, 1.0))


def sagittal(values: np.ndarray) -> np.ndarray:
    """The planar walker's coordinates (..., 9) of spatial ones (..., 16)."""
    at = index("spatial")
    return values[..., [at[name] for name in names("planar")]]


def _turn(angle: float) -> np.ndarray:
    cos, sin = np.cos(angle), np.sin(angle)
    return np.array([[cos, -sin, 0.0], [sin, cos, 0.0], [0.0, 0.0, 1.0]])


def _heading(rotation: np.ndarray, hips: np.ndarray, body: BodyAngles, notes: Notes) -> float:
    """Direction of walking about the vertical: of the hips' path, or of the pelvis [rad]."""
    faces = float(np.angle(np.exp(1j * rotation[body.series.usable]).mean()))
    way = hips[-1] - hips[0]
    heading = 0.5 * np.pi * round(faces / (0.5 * np.pi))
    if body.place[0] and body.place[1] and np.hypot(way[0], way[1]) > 1.5:
        heading = float(np.arctan2(way[1], way[0]))
    if abs(heading) < _STRAIGHT:  # the sway of the body, at the ends of the path, is not a turn
        return 0.0
    notes.say(f"The walk goes {np.degrees(heading):.0f} degrees to the left of the file's forward "
              "axis; everything was turned into it.")  # fmt: skip
    return heading
