"""Everything that one walking problem states, as plain data for the program.

A `Formulation` is what `GaitStudy` hands to the program: the walker, the walk
that it is compared with, the speed, the weights of eq. (13), the tolerances
and the discretisation. It knows nothing of solvers.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from drakegait.errors import InvalidInput
from drakegait.program.variants import Variants
from drakegait.quantities import GRAVITY
from drakegait.reference.reference import Reference
from drakegait.settings import Settings, quantity
from drakegait.transcription.schedule import Schedule
from drakegait.transcription.splines import PeriodicQuintic
from drakegait.walker.disorders import Asymmetry, Pain
from drakegait.walker.feet import ContactSettings
from drakegait.walker.walker import Walker


@dataclass(frozen=True, kw_only=True)
class Tolerances(Settings):
    """How exactly the laws must hold at the control points (eqs 26, 28; paper section 4.1)."""

    force_tolerance: float = quantity(
        5.0, "N", 0.01, 100.0, "equations of motion, rows of translations"
    )
    moment_tolerance: float = quantity(
        2.0, "N m", 0.01, 50.0, "equations of motion, rows of rotations"
    )
    contact_tolerance: float = quantity(
        0.002, "m", 1e-5, 0.02, "position of heel and toe on their footprint"
    )
    yaw_tolerance: float = quantity(0.01, "rad", 1e-4, 0.1, "heading of a foot on the ground")


@dataclass(frozen=True)
class JointLimit:
    """An optional bound on one coordinate at all instants (item 7 of the paper's section 3.3).

    Attributes:
        coordinate: name; the bounds are in anatomical sense.
        low, high: [rad] or [m].
    """

    coordinate: str
    low: float
    high: float

    def __post_init__(self) -> None:
        if not self.low < self.high:
            raise InvalidInput(
                f"limit of {self.coordinate}", (self.low, self.high), "a range with low < high"
            )


@dataclass(frozen=True, kw_only=True)
class Formulation:
    """One walking problem.

    Attributes:
        walker: the person.
        reference: the walk to stay close to.
        speed: average forward velocity [m/s].
        symmetric: left-right symmetric by construction.
        energy_weight, deviation_weight: w_E, w_J of eq. (13) [-].
        splines: function space of coordinates and muscle forces.
        schedule: control points.
        tolerances, contact: see there.
        limits: optional joint limits.
        lifted: contact multipliers as variables (True) or by eq. (17) (False).
        variants: forms of the statements.
        asymmetries: ratios of steps or stances that the walk must have.
        pains: loads that it spares.
        event_centres: fractions of the cycle (8,) about which the events may move.
        event_reach: largest move of an event [fraction of the cycle].
    """

    walker: Walker
    reference: Reference
    speed: float
    symmetric: bool
    energy_weight: float
    deviation_weight: float
    splines: PeriodicQuintic
    schedule: Schedule
    tolerances: Tolerances
    contact: ContactSettings
    limits: tuple[JointLimit, ...] = ()
    lifted: bool = True
    variants: Variants = Variants()
    asymmetries: tuple[Asymmetry, ...] = ()
    pains: tuple[Pain, ...] = ()
    event_centres: tuple[float, ...] = ()
    event_reach: float = 0.045

    @property
    def planar(self) -> bool:
        """Whether the walker moves in the sagittal plane only."""
        return self.walker.skeleton.kind == "planar"

    @cached_property
    def body_weight(self) -> float:
        """Weight of the unchanged subject [N]; the scale of all forces."""
        return self.walker.subject.mass * GRAVITY

    @cached_property
    def repeats(self) -> float:
        """How often the enforced part makes up the stride: 1, or 2 for a symmetric walker."""
        return 2.0 if self.symmetric else 1.0

    @cached_property
    def row_tolerances(self) -> np.ndarray:
        """Tolerance of each equation of motion (num_coordinates,) [N, N m]."""
        return np.where(
            self.walker.is_rotation,
            self.tolerances.moment_tolerance,
            self.tolerances.force_tolerance,
        )
