"""Where muscles are drawn in the replay. Decoration: no force, length or moment uses it.

In the mechanics a muscle is a constant moment arm about each joint it crosses (`walker.muscles`).
The lines here run between plausible places on the segments so that one sees which muscle works.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from drakegait.walker.muscles import SPECIFIC_TENSION, MuscleSet
from drakegait.walker.subject import Subject

TENDON_RADIUS = 0.004  # [m]
_BELLY_SHARE = 0.33  # drawn radius of a belly, as share of that of its cross-section f_max / sigma
RESTING = np.array([0.13, 0.30, 0.80])
"""Colour of a muscle with activation 0."""
ACTIVE = np.array([0.88, 0.06, 0.06])
"""Colour of a muscle with activation 1."""

# Points (segment, forward, outward, up) [m] at 1.80 m in the segment's frame, from the origin of
# the muscle to its insertion; outward is to the right for a right leg and, on the HAT, from its
# midline. The number names the piece that carries the belly, the others are tendon.
_PATHS = {
    "soleus": (0, ("shank", -0.035, 0.0, -0.08), ("shank", -0.046, 0.0, -0.32),
               ("foot", -0.055, 0.0, -0.045)),
    "tibialis_anterior": (0, ("shank", 0.030, 0.022, -0.06), ("shank", 0.036, 0.0, -0.36),
                          ("foot", 0.065, -0.015, -0.035)),
    "gastrocnemius": (0, ("thigh", -0.040, 0.0, -0.395), ("shank", -0.062, 0.0, -0.235),
                      ("foot", -0.058, 0.0, -0.040)),
    "vasti": (0, ("thigh", 0.030, 0.028, -0.10), ("thigh", 0.054, 0.006, -0.40),
              ("thigh", 0.056, 0.0, -0.435), ("shank", 0.046, 0.0, -0.065)),
    "rectus_femoris": (0, ("hat", 0.060, 0.090, 0.015), ("thigh", 0.066, -0.004, -0.37),
                       ("thigh", 0.060, 0.0, -0.435), ("shank", 0.048, 0.0, -0.065)),
    "hamstrings": (0, ("hat", -0.060, 0.065, -0.055), ("thigh", -0.058, 0.012, -0.355),
                   ("shank", -0.034, 0.026, -0.065)),
    "tensor_fasciae_latae": (0, ("hat", 0.045, 0.135, 0.065), ("thigh", 0.012, 0.070, -0.17),
                             ("thigh", 0.002, 0.060, -0.40), ("shank", 0.012, 0.046, -0.03)),
    "gluteus_maximus": (0, ("hat", -0.090, 0.045, 0.045), ("thigh", -0.038, 0.050, -0.12)),
    "gluteus_maximus_lateral": (0, ("hat", -0.085, 0.070, 0.060), ("thigh", -0.034, 0.062, -0.12)),
    "gluteus_maximus_medial": (0, ("hat", -0.090, 0.030, 0.020), ("thigh", -0.044, 0.034, -0.13)),
    "gluteus_medius_anterior": (0, ("hat", 0.030, 0.125, 0.085), ("thigh", 0.008, 0.066, -0.02)),
    "gluteus_medius_posterior": (0, ("hat", -0.045, 0.105, 0.090), ("thigh", -0.014, 0.066, -0.02)),
    "adductor_magnus": (0, ("hat", -0.030, 0.030, -0.055), ("thigh", -0.006, -0.030, -0.29)),
    "adductor_longus_brevis": (0, ("hat", 0.035, 0.025, -0.030), ("thigh", 0.008, -0.026, -0.19)),
    "iliopsoas": (0, ("hat", 0.005, 0.045, 0.14), ("hat", 0.052, 0.075, 0.005),
                  ("thigh", 0.006, -0.012, -0.055)),
}  # fmt: skip


@dataclass(frozen=True, eq=False)
class MusclePiece:
    """A straight piece of a drawn muscle.

    Attributes:
        muscle: name with side.
        number: of the piece along the muscle.
        segments: bodies at its two ends, origin first.
        points: the ends in the frames of these bodies (2, 3) [m].
        belly: whether it is coloured by activation, else it is tendon.
        radius: largest radius [m].
    """

    muscle: str
    number: int
    segments: tuple[str, str]
    points: np.ndarray
    belly: bool
    radius: float


def muscle_pieces(muscles: MuscleSet, subject: Subject) -> list[MusclePiece]:
    """The drawn pieces of all muscles; a muscle without a known path is left out."""
    pieces = []
    size = subject.length_scale
    for name, strength in zip(muscles.names, muscles.f_max, strict=True):
        group, side = name[:-2], name[-1]
        if group not in _PATHS:
            continue
        belly, *path = _PATHS[group]
        radius = _BELLY_SHARE * size * np.sqrt(strength / SPECIFIC_TENSION / np.pi)
        outward = -1.0 if side == "r" else 1.0
        ends = [
            (body if body == "hat" else f"{body}_{side}", size * np.array([x, outward * y, z]))
            for body, x, y, z in path
        ]
        for number, (start, end) in enumerate(zip(ends[:-1], ends[1:], strict=True)):
            pieces.append(
                MusclePiece(
                    muscle=name,
                    number=number,
                    segments=(start[0], end[0]),
                    points=np.array([start[1], end[1]]),
                    belly=number == belly,
                    radius=float(radius) if number == belly else size * TENDON_RADIUS,
                )
            )
    return pieces


def activation_colours(activation: np.ndarray) -> np.ndarray:
    """Colours (..., 3) from blue at activation 0 to red at 1; red, green, blue in 0..1."""
    share = np.clip(np.asarray(activation, dtype=float), 0.0, 1.0)[..., None]
    return (1.0 - share) * RESTING + share * ACTIVE
