"""The person: body height and mass, and what they make of the seven segments.

All numbers of the default set stand in `sdf/human_spatial.sdf`, for 1.80 m and
75 kg. Another height H and mass M scale lengths with H, masses with M and
moments of inertia with M H^2 (geometric similarity).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from drakegait.errors import InvalidInput, UnknownName
from drakegait.quantities import is_number
from drakegait.settings import Settings, choice, quantity

REFERENCE_HEIGHT = 1.80
"""Body height for which the SDF files are written [m]."""

REFERENCE_MASS = 75.0
"""Body mass for which the SDF files are written [kg]."""

SEGMENTS = ("hat", "thigh_r", "shank_r", "foot_r", "thigh_l", "shank_l", "foot_l")
"""The rigid bodies; hat = head, arms and trunk."""

MAX_ADDED_MASS = 30.0
"""Largest mass that may be fixed to a segment [kg]."""


@dataclass(frozen=True, kw_only=True)
class Subject(Settings):
    """Body height, body mass and the source of the segments' proportions.

    Anthropometry sets:
        default: masses, lengths and sagittal mass centres by Winter's fractions, the ratios of
            the three radii of gyration by de Leva (1996); foot inertia by de Leva.
        winter_planar: as default, but the foot's radius of gyration is 0.475 of its full length,
            as in Winter's table (about four times the inertia).
        deleva: all by de Leva (1996), male: heavier thighs, lighter HAT.
    """

    height: float = quantity(REFERENCE_HEIGHT, "m", 1.2, 2.2, "body height")
    mass: float = quantity(REFERENCE_MASS, "kg", 30.0, 200.0, "body mass")
    anthropometry: str = choice(
        "default", ("default", "winter_planar", "deleva"), "source of segment proportions"
    )

    @property
    def length_scale(self) -> float:
        """Lengths relative to those of the SDF files, H / 1.80 m."""
        return self.height / REFERENCE_HEIGHT

    @property
    def mass_scale(self) -> float:
        """Masses relative to those of the SDF files, M / 75 kg."""
        return self.mass / REFERENCE_MASS


@dataclass(frozen=True)
class AddedMass:
    """A point mass fixed to a segment: the disorder of the paper is `("foot_r", 2.0)`.

    Attributes:
        segment: name of the segment that carries it.
        mass: mass [kg], above 0 and at most 30.
        point: where, in the segment's frame (x forward, y left, z up in the neutral posture,
            origin at its proximal joint; mid-hip for the HAT) [m]. Default: the centre of mass
            of the segment alone.

    Raises:
        UnknownName: for a segment that does not exist.
        InvalidInput: for a mass or a point that cannot be used.
    """

    segment: str
    mass: float
    point: tuple[float, float, float] | None = None

    def __post_init__(self) -> None:
        if self.segment not in SEGMENTS:
            raise UnknownName("segment", self.segment, SEGMENTS)
        if not is_number(self.mass) or not 0 < self.mass <= MAX_ADDED_MASS:
            allowed = f"a number above 0 and at most {MAX_ADDED_MASS:g} [kg]"
            raise InvalidInput("added mass", self.mass, allowed)
        if self.point is None:
            return
        try:
            values = tuple(self.point)
        except TypeError:
            values = ()
        if len(values) != 3 or not all(is_number(x) and abs(x) <= 1.0 for x in values):
            allowed = "three numbers from -1 to 1 [m] in the segment's frame"
            raise InvalidInput("point of the added mass", self.point, allowed)
        object.__setattr__(self, "point", tuple(float(x) for x in values))


@dataclass(frozen=True, eq=False)
class Segment:
    """Mass properties of one segment, in its own frame.

    Attributes:
        mass: [kg].
        length: hip to shoulder, hip to knee, knee to ankle, or heel to toe tip [m].
        com: (3,) centre of mass from the origin of the segment [m].
        inertia: (3, 3) inertia matrix about the centre of mass [kg m^2].
    """

    mass: float
    length: float
    com: np.ndarray
    inertia: np.ndarray


def segment_properties(subject: Subject) -> dict[str, Segment]:
    """Mass properties of the subject's seven segments, by name."""
    from drakegait.walker.model_file import model_sdf, read_segments  # it needs Subject

    return read_segments(model_sdf("spatial", subject))
