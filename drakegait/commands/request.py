"""The options of `drakegait walk`, and what they ask for."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Sequence

from drakegait.commands.constants import read_constants
from drakegait.commands.gait_files import load_gait
from drakegait.commands.unchanged import unchanged
from drakegait.errors import InvalidInput, UnknownName
from drakegait.gait import Gait
from drakegait.program.formulation import JointLimit
from drakegait.program.starts import starts as several_starts
from drakegait.reference.named import measured_person, named_reference
from drakegait.solve import check_guess
from drakegait.solvers.options import SolverOptions
from drakegait.study import MODELS, SETTINGS_GROUPS, GaitStudy
from drakegait.walker import coordinates
from drakegait.walker.disorders.reading import READERS, Texts, read_disorders
from drakegait.walker.subject import AddedMass, Subject
from drakegait.whole_file import read_text

_ADDED = "SEGMENT=KG or SEGMENT=KG@X,Y,Z with numbers [kg, m], for example foot_r=2.0"
_CHANGE = "MUSCLE.ENTRY=VALUE with a number, for example SOL.l_slack=0.245"
_STRENGTH = "MUSCLE=FACTOR with a number, for example soleus_l=0.5"
_DEFAULT_SPEED = 1.2  # [m/s]
_LIMIT = "COORDINATE=LOW:HIGH with numbers [degrees or m], for example knee_flexion_r=0:60"


@dataclasses.dataclass(frozen=True, kw_only=True)
class WalkRequest:
    """What was typed; the fields are the options of `walk`."""

    model: str
    nodes: int | None
    speed: float | None
    weights: tuple[float, float]
    reference: str | None
    limit: Sequence[str] | None
    height: float | None
    mass: float | None
    added_mass: Sequence[str] | None
    strength: Sequence[str] | None
    muscle: Sequence[str] | None
    planar_muscles: str
    sdf: str | None
    set_: Sequence[str] | None
    solver: str | None
    multipliers: str
    guess: str | None
    time_limit: float
    refine: bool
    out: str
    no_pictures: bool
    starts: int = 1
    seed: int = 0
    compare: bool = False
    explain: bool = True
    weakness: Texts = None
    contracture: Texts = None
    spasticity: Texts = None
    stiffness: Texts = None
    range_: Texts = None
    leg_length: Texts = None
    prosthesis: Texts = None
    orthosis: Texts = None
    asymmetry: Texts = None
    pain: Texts = None

    def prepare(self) -> tuple[GaitStudy, SolverOptions, Gait | None]:
        """Study, way to solve it and guess, all validated and the walker built.

        Raises:
            InvalidInput, UnknownName, BadFile: the first thing that cannot be used.
        """
        if self.model not in MODELS:
            raise UnknownName("model", self.model, MODELS)
        constants = read_constants(self.set_ or ())
        options = SolverOptions(time_limit=self.time_limit, **constants.pop("solver", {}))
        if self.solver is not None:
            options = options.replace(solver=self.solver)
        person, measured_speed = self._measured_person()
        subject = Subject(
            height=person.height if self.height is None else self.height,
            mass=person.mass if self.mass is None else self.mass,
            **constants.pop("subject", {}),
        )
        energy_weight, deviation_weight = self.weights
        study = GaitStudy(
            model=self.model,
            nodes=_default_nodes(self.model) if self.nodes is None else self.nodes,
            speed=measured_speed if self.speed is None else self.speed,
            subject=subject,
            added_masses=tuple(_added_mass(text) for text in self.added_mass or ()),
            energy_weight=energy_weight,
            deviation_weight=deviation_weight,
            strength=_strengths(self.strength or ()),
            planar_muscles=self.planar_muscles,
            muscle_changes=_muscle_changes(self.muscle or ()),
            sdf=None if self.sdf is None else read_text(self.sdf),
            multipliers=self.multipliers,
            limits=tuple(_limit(text, self.model) for text in self.limit or ()),
            disorders=read_disorders({name: getattr(self, name) for name in READERS}),
            **{group: SETTINGS_GROUPS[group](**values) for group, values in constants.items()},
        )
        if self.reference is not None:
            kind, subject = study.skeleton_kind, study.subject
            walk = named_reference(self.reference, kind, subject, option="--reference")
            study = study.replace(reference=walk)
        guess = None if self.guess is None else load_gait(self.guess)
        if guess is not None:
            check_guess(study, guess)
        several_starts(self.starts, self.seed)
        if self.compare:
            unchanged(study).formulation()
        study.formulation()  # builds the walker: strengths and weights are judged there
        return study, options, guess

    def _measured_person(self) -> tuple[Subject, float]:
        """Height, mass and speed of an imported reference, or the usual ones."""
        kind = self.model.removesuffix("-symmetric")
        found = None if self.reference is None else measured_person(self.reference, kind)
        subject, speed = found or (None, _DEFAULT_SPEED)
        return subject or Subject(), speed


def _default_nodes(model: str) -> int:
    return getattr(GaitStudy, model.replace("-", "_"))().nodes


def _pair(option: str, text: str, allowed: str) -> tuple[str, str]:
    name, equals, value = (part.strip() for part in text.partition("="))
    if not equals or not name or not value:
        raise InvalidInput(option, text, allowed)
    return name, value


def _number(option: str, whole: str, text: str, allowed: str) -> float:
    try:
        return float(text)
    except ValueError:
        raise InvalidInput(option, whole, allowed) from None


def _added_mass(text: str) -> AddedMass:
    option = "--added-mass"
    segment, value = _pair(option, text, _ADDED)
    mass, at, place = value.partition("@")
    point = tuple(_number(option, text, word, _ADDED) for word in place.split(",")) if at else None
    return AddedMass(segment, _number(option, text, mass, _ADDED), point)


def _strengths(texts: Sequence[str]) -> dict[str, float]:
    option, factors = "--strength", {}
    for text in texts:
        name, value = _pair(option, text, _STRENGTH)
        if name in factors:
            raise InvalidInput(option, text, f"stated once for {name}")
        factors[name] = _number(option, text, value, _STRENGTH)
    return factors


def _muscle_changes(texts: Sequence[str]) -> dict[str, dict[str, float]]:
    option, changes = "--muscle", {}
    for text in texts:
        place, value = _pair(option, text, _CHANGE)
        name, dot, entry = place.partition(".")
        if not dot or not name or not entry:
            raise InvalidInput(option, text, _CHANGE)
        if entry in changes.setdefault(name, {}):
            raise InvalidInput(option, text, f"stated once for {place}")
        changes[name][entry] = _number(option, text, value, _CHANGE)
    return changes


def _limit(text: str, model: str) -> JointLimit:
    option, kind = "--limit", model.removesuffix("-symmetric")
    name, value = _pair(option, text, _LIMIT)
    angles = dict(zip(coordinates.names(kind), coordinates.rotations(kind), strict=True))
    if name not in angles or name == "hat_x":
        known = [known for known in angles if known != "hat_x"]
        raise UnknownName("coordinate of a limit", name, known)
    low, colon, high = value.partition(":")
    if not colon or not (low.strip() or high.strip()):
        raise InvalidInput(option, text, _LIMIT)
    unit = math.pi / 180.0 if angles[name] else 1.0
    ends = [
        unit * _number(option, text, end, _LIMIT) if end.strip() else missing
        for end, missing in ((low, -math.inf), (high, math.inf))
    ]
    if not ends[0] < ends[1]:
        raise InvalidInput(option, text, "a range whose low end is below its high end")
    return JointLimit(name, *ends)
