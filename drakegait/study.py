"""One experiment: who walks how, as frozen and validated data.

A `GaitStudy` is a list of physical statements; `with_...` methods return a
changed copy. `solve` turns it into a `Gait`.

    study = GaitStudy.spatial(nodes=18)
    heavy = study.with_added_mass("foot_r", 2.0)  # [kg]
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np

from drakegait.errors import InvalidInput, UnknownName
from drakegait.program.formulation import Formulation, JointLimit, Tolerances
from drakegait.program.variants import Variants
from drakegait.quantities import check_count, check_number, is_whole
from drakegait.reference.deviation import DeviationSettings
from drakegait.reference.reference import Reference
from drakegait.reference.sequence import in_sequence
from drakegait.settings import find, parse
from drakegait.study_file import study_statements, study_to_dict
from drakegait.study_rules import check_both_sides, check_limits
from drakegait.transcription.schedule import Schedule
from drakegait.transcription.splines import PeriodicQuintic
from drakegait.walker import coordinates
from drakegait.walker.disorders import Asymmetry, Disorder, Pain, check_disorders
from drakegait.walker.feet import ContactSettings
from drakegait.walker.metabolics import EnergySettings
from drakegait.walker.muscle_settings import MuscleSettings
from drakegait.walker.passive_joints import PassiveSettings
from drakegait.walker.subject import AddedMass, Subject
from drakegait.walker.walker import Walker

MODELS = ("spatial", "planar", "spatial-symmetric", "planar-symmetric")
SETTINGS_GROUPS = {
    "tolerances": Tolerances,
    "contact": ContactSettings,
    "muscles": MuscleSettings,
    "energy": EnergySettings,
    "passive": PassiveSettings,
    "deviation": DeviationSettings,
    "variants": Variants,
}
FEWEST_NODES, MOST_NODES = 10, 141
SPEEDS = (0.3, 2.5)  # [m/s]
# Control points inside phases 1-4 that keep 18 nodes honest between the points (measured: the
# densest instants then stay within twice the tolerance); in proportion for more nodes.
_POINTS, _POINTS_NODES = (5, 4, 14, 11), 18


@dataclass(frozen=True, kw_only=True)
class GaitStudy:
    """A walking experiment.

    Args:
        model: `"spatial"`, `"planar"`, `"spatial-symmetric"` or `"planar-symmetric"`.
        nodes: spline nodes per stride, both ends counted; odd for symmetric models.
        speed: average forward velocity [m/s].
        subject: height and mass.
        added_masses: weights worn on segments.
        energy_weight, deviation_weight: w_E and w_J of eq. (13).
        strength: factor on the largest force of muscles, by name (`"soleus_l"`) or group.
        planar_muscles: muscle set of the planar models, `"table3"` or `"gait2d"`.
        muscle_changes: other values in the muscle table, `{"SOL": {"l_slack": 0.245}}` [m];
            see `MuscleSet.load`.
        sdf: text of an SDF model of your own (for 1.80 m, 75 kg); default the shipped one.
        reference: the walk to stay close to; default the embedded stride of the model.
        multipliers: `"lifted"` (contact forces as variables) or `"projected"` (eq. 17).
        interior_points: control points inside each of the 8 (symmetric: 4) phases; default
            by the number of nodes.
        limits: optional joint limits.
        disorders: what makes this walker differ, see `drakegait.walker.disorders`.
        tolerances, contact, muscles, energy, passive, deviation: constants.
        variants: other forms of the same problem, for comparison.

    Raises:
        InvalidInput, UnknownName: naming the value and what is allowed.
    """

    model: str = "spatial"
    nodes: int = 18
    speed: float = 1.2
    subject: Subject = field(default_factory=Subject)
    added_masses: tuple[AddedMass, ...] = ()
    energy_weight: float = 1.0
    deviation_weight: float = 1.0
    strength: Mapping[str, float] = field(default_factory=dict)
    planar_muscles: str = "table3"
    muscle_changes: Mapping[str, Mapping[str, float]] = field(default_factory=dict)
    sdf: str | None = None
    reference: Reference | None = field(default=None, compare=False)
    multipliers: str = "lifted"
    interior_points: tuple[int, ...] | None = None
    limits: tuple[JointLimit, ...] = ()
    disorders: tuple[Disorder, ...] = ()
    tolerances: Tolerances = field(default_factory=Tolerances)
    contact: ContactSettings = field(default_factory=ContactSettings)
    muscles: MuscleSettings = field(default_factory=MuscleSettings)
    energy: EnergySettings = field(default_factory=EnergySettings)
    passive: PassiveSettings = field(default_factory=PassiveSettings)
    deviation: DeviationSettings = field(default_factory=DeviationSettings)
    variants: Variants = field(default_factory=Variants)

    def __post_init__(self) -> None:
        if self.model not in MODELS:
            raise UnknownName("model", self.model, MODELS)
        if self.multipliers not in ("lifted", "projected"):
            raise UnknownName("multipliers", self.multipliers, ("lifted", "projected"))
        self._check_nodes()
        check_number("speed", self.speed, *SPEEDS, "m/s")
        check_number("energy weight", self.energy_weight, 0.0, 1e3, "-")
        check_number("deviation weight", self.deviation_weight, 0.0, 1e3, "-")
        if self.energy_weight == 0.0 and self.deviation_weight == 0.0:
            raise InvalidInput("weights", (0.0, 0.0), "positive in at least one place")
        if self.reference is not None and self.reference.kind != self.skeleton_kind:
            raise InvalidInput("kind of the reference", self.reference.kind, self.skeleton_kind)
        phases, points = 4 if self.symmetric else 8, self.interior_points
        if points is not None and not (len(points) == phases and all(map(is_whole, points))):
            raise InvalidInput("interior_points", points, f"{phases} whole numbers")
        names = [name for name in coordinates.names(self.skeleton_kind) if name != "hat_x"]
        for limit in self.limits:
            if limit.coordinate not in names:
                raise UnknownName("coordinate of a limit", limit.coordinate, names)
        check_disorders(self.disorders, self.skeleton_kind, self.symmetric)
        check_limits(self.all_limits)

    def _check_nodes(self) -> None:
        check_count("nodes", self.nodes, FEWEST_NODES, MOST_NODES)
        if self.symmetric and self.nodes % 2 == 0:
            allowed = "odd for a symmetric model (a node must lie at half the cycle)"
            raise InvalidInput("nodes", self.nodes, allowed)

    # Making ------------------------------------------------------------------------------

    @classmethod
    def spatial(cls, nodes: int = 18, **statements: Any) -> GaitStudy:
        """A three-dimensional walker whose legs move independently (3DNS)."""
        return cls(model="spatial", nodes=nodes, **statements)

    @classmethod
    def planar(cls, nodes: int = 18, **statements: Any) -> GaitStudy:
        """A walker in the sagittal plane whose legs move independently (2DNS)."""
        return cls(model="planar", nodes=nodes, **statements)

    @classmethod
    def spatial_symmetric(cls, nodes: int = 19, **statements: Any) -> GaitStudy:
        """A three-dimensional walker with mirrored legs."""
        return cls(model="spatial-symmetric", nodes=nodes, **statements)

    @classmethod
    def planar_symmetric(cls, nodes: int = 35, **statements: Any) -> GaitStudy:
        """A walker in the sagittal plane with mirrored legs (2DS)."""
        return cls(model="planar-symmetric", nodes=nodes, **statements)

    def replace(self, **statements: Any) -> GaitStudy:
        """A copy with other statements."""
        return dataclasses.replace(self, **statements)

    def with_added_mass(
        self, segment: str, mass: float, point: tuple[float, float, float] | None = None
    ) -> GaitStudy:
        """A copy that wears `mass` [kg] on `segment`, at `point` of its frame [m]."""
        return self.replace(added_masses=(*self.added_masses, AddedMass(segment, mass, point)))

    def with_disorder(self, *disorders: Disorder | AddedMass) -> GaitStudy:
        """A copy with further disorders, see `drakegait.walker.disorders`."""
        worn = tuple(x for x in disorders if isinstance(x, AddedMass))
        others = tuple(x for x in disorders if not isinstance(x, AddedMass))
        masses = (*self.added_masses, *worn)
        return self.replace(added_masses=masses, disorders=(*self.disorders, *others))

    def with_limit(
        self, coordinate: str, low: float = -math.inf, high: float = math.inf
    ) -> GaitStudy:
        """A copy where `coordinate` stays within [low, high] (anatomical) [rad] or [m]."""
        return self.replace(limits=(*self.limits, JointLimit(coordinate, low, high)))

    def with_settings(self, **values: Any) -> GaitStudy:
        """A copy with some constants changed, by their names (`"group.name"` if ambiguous).

        Text is read as the constant's type.
        """
        changes: dict[str, Any] = {}
        for name, value in values.items():
            group, item = find(SETTINGS_GROUPS, name)
            if isinstance(value, str):
                value = parse(item, value)
            changes.setdefault(group, {})[item.name] = value
        return self.replace(
            **{group: getattr(self, group).replace(**new) for group, new in changes.items()}
        )

    # Reading -----------------------------------------------------------------------------

    @property
    def symmetric(self) -> bool:
        """Whether the left half of the walk mirrors the right half."""
        return self.model.endswith("-symmetric")

    @property
    def skeleton_kind(self) -> str:
        """`"spatial"` or `"planar"`."""
        return self.model.removesuffix("-symmetric")

    @cached_property
    def walker(self) -> Walker:
        """The person of this study."""
        return Walker.build(
            self.skeleton_kind,
            self.subject,
            self.added_masses,
            self.muscles,
            self.energy,
            self.passive,
            self.strength,
            self.planar_muscles,
            self.sdf,
            muscle_changes=self.muscle_changes,
            toe_torque=self.contact.toe_torque,
            sequence=self.variants.sequence,
            disorders=self.disorders,
        )

    @cached_property
    def reference_walk(self) -> Reference:
        """The walk that this one is compared with."""
        walk = self.reference or Reference.embedded(self.skeleton_kind, self.subject)
        if walk.deviation != self.deviation:
            walk = dataclasses.replace(walk, deviation=self.deviation)
        return in_sequence(walk, self.variants.sequence)

    @property
    def all_limits(self) -> tuple[JointLimit, ...]:
        """Joint limits, those of disorders included."""
        ranges = (JointLimit(*limit) for item in self.disorders for limit in item.limits())
        return (*self.limits, *ranges)

    @property
    def schedule(self) -> Schedule:
        """Control points."""
        points = self.interior_points
        if points is None:
            factor = max(1.0, (self.nodes - 1) / (_POINTS_NODES - 1))
            points = tuple(round(factor * (n + 1)) - 1 for n in _POINTS)
            points = points if self.symmetric else 2 * points
        return Schedule(tuple(points))

    def formulation(self, event_centres: np.ndarray | None = None) -> Formulation:
        """The statements as the program takes them.

        Args:
            event_centres: fractions of the cycle (8,) around which the events may move;
                default those of the reference.

        Raises:
            InvalidInput: a symmetric walker with weights, strengths or limits on one side only.
        """
        check_both_sides(self)  # not at birth, so that one side can be stated after the other
        if event_centres is None:
            event_centres = np.append(0.0, np.cumsum(self.reference_walk.phase_fractions)[:-1])
        return Formulation(
            walker=self.walker,
            reference=self.reference_walk,
            speed=float(self.speed),
            symmetric=self.symmetric,
            energy_weight=float(self.energy_weight),
            deviation_weight=float(self.deviation_weight),
            splines=PeriodicQuintic(self.nodes),
            schedule=self.schedule,
            tolerances=self.tolerances,
            contact=self.contact,
            limits=self.all_limits,
            lifted=self.multipliers == "lifted",
            variants=self.variants,
            asymmetries=tuple(x for x in self.disorders if isinstance(x, Asymmetry)),
            pains=tuple(x for x in self.disorders if isinstance(x, Pain)),
            event_centres=tuple(float(centre) for centre in event_centres),
        )

    def to_dict(self) -> dict[str, Any]:
        """Everything but the reference, as plain types that JSON can hold."""
        return study_to_dict(self)

    @classmethod
    def from_dict(cls, plain: Mapping[str, Any], reference: Reference | None = None) -> GaitStudy:
        """Inverse of `to_dict`; raises UnknownName for a key that no study has."""
        known = tuple(item.name for item in dataclasses.fields(cls))
        groups = {"subject": Subject, **SETTINGS_GROUPS}
        return cls(**study_statements(plain, known, groups), reference=reference)
