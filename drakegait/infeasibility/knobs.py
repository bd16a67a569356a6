"""Changes of a study that could make it possible, in the user's terms, mildest first.

How much is needed is read from the walk that gives up the law in question; then come larger
steps, because that walk only estimates it. Values are rounded to the safe side.
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from drakegait.errors import InvalidInput
from drakegait.infeasibility.conflict import Relaxation, Relaxed
from drakegait.infeasibility.laws import (
    ASYMMETRY,
    FRICTION,
    MUSCLES,
    RANGE,
    SIDES,
    SPEED,
    words_of_limits,
)
from drakegait.infeasibility.place import Place
from drakegait.study import GaitStudy
from drakegait.walker import coordinates
from drakegait.walker.coordinates import without_side
from drakegait.walker.disorders import Asymmetry, LimitedRange, Weakness
from drakegait.walker.feet import ContactSettings

_SPEED_STEP, _FRICTION_STEP, _RATIO_STEP = 0.05, 0.05, 0.05  # [m/s], [-], [-]
_LEAST_LOAD = 0.05  # of the body weight: below, the ratio of forces means nothing
_STRENGTHS = (5, 10, 15, 20, 30, 40, 60, 80, 120, 160, 240, 320, 480, 640, 900)  # [% more]
_USUAL_SPEED = 1.1  # relative to the reference: faster is unusual
_NEARLY = 0.1  # of a change: finer is of no use to anyone
_MANY = 0.6  # of the muscles: whoever names more of them means all
_MOST_TOLERANCE = 5.0  # times the study's; with more it is no longer walking


@dataclass(frozen=True, eq=False)
class Knob:
    """One kind of change.

    Attributes:
        law: the law that it eases.
        now: the value of the study itself, in the same terms.
        values: what to try, mildest first.
        study: the changed study; raises InvalidInput where the value is out of range.
        words: the change, to be read after "feasible".
        middle: a value between two others, rounded; None if there is none worth trying.
        unusual: whether the study states something out of the ordinary here.
    """

    law: str
    now: float
    values: Sequence[float]
    study: Callable[[float], GaitStudy]
    words: Callable[[float], str]
    middle: Callable[[float, float], float | None]
    unusual: bool


def knobs_for(
    relaxation: Relaxation,
    alone: dict[str, Relaxed],
    place: Place | None,
    short: Sequence[str] = (),
) -> list[Knob]:
    """Knobs of the laws in `alone`, what is out of the ordinary first.

    Args:
        relaxation: of the study.
        alone: walks that give up one law and keep the others.
        place: where the muscles are too weak, if they are among the laws.
        short: names of the muscles that are too weak there and elsewhere.
    """
    found: list[Knob] = []
    for law, relaxed in alone.items():
        if law.startswith(RANGE):
            found += _range(relaxation, relaxed, law)
    for law, make in ((ASYMMETRY, _asymmetry), (FRICTION, _friction), (SPEED, _speed)):
        if law in alone:
            found += make(relaxation, alone[law])
    if MUSCLES in alone and place is not None:
        found += _strengths(relaxation.study, place, short)
        found += _tolerance(relaxation.study, place)
    return sorted(found, key=lambda knob: not knob.unusual)


def _middle(step: float, now: float = 0.0) -> Callable[[float, float], float | None]:
    """Half way between two values in steps; None if they are neighbours or nearly the same."""

    def middle(failed: float, good: float) -> float | None:
        if abs(good - failed) < _NEARLY * abs(good - now):
            return None
        half = round(0.5 * (failed + good) / step) * step
        apart = min(abs(half - failed), abs(half - good))
        return round(half, 6) if apart > 0.5 * step else None

    return middle


def _speed(relaxation: Relaxation, relaxed: Relaxed) -> list[Knob]:
    study, values = relaxation.study, relaxation.values(relaxed)
    reached = float(values.placement[:2].sum()) / values.stride_time
    way = -1.0 if reached < study.speed else 1.0
    step = way * _SPEED_STEP
    first = math.floor(way * reached / _SPEED_STEP + 1e-6) if way > 0 else math.floor(
        reached / _SPEED_STEP + 1e-6
    )  # fmt: skip
    first = first * _SPEED_STEP + (_SPEED_STEP if way > 0 else 0.0)
    if abs(first - study.speed) < 0.5 * _SPEED_STEP:
        first += step
    tries = [round(first + k * step, 3) for k in (0, 2, 5)]
    return [
        Knob(
            SPEED, study.speed, tries, lambda value: study.replace(speed=value),
            lambda value: f"at {value:g} m/s", _middle(_SPEED_STEP, study.speed),
            study.speed > _USUAL_SPEED * study.reference_walk.speed,
        )
    ]  # fmt: skip


def _friction(relaxation: Relaxation, relaxed: Relaxed) -> list[Knob]:
    study, program = relaxation.study, relaxation.program
    force = program.state(relaxation.elastic.unknowns(relaxed.point)).ground_reactions
    loaded = force[..., 2] > _LEAST_LOAD * program.formulation.body_weight
    ratio = np.hypot(force[..., 0], force[..., 1])[loaded] / force[..., 2][loaded]
    now = study.contact.friction
    needed = max(float(ratio.max(initial=0.0)), now + 0.2 * _FRICTION_STEP)
    first = math.ceil(needed / _FRICTION_STEP - 1e-6) * _FRICTION_STEP
    tries = [round(first + k * _FRICTION_STEP, 3) for k in (0, 2, 5)]
    return [
        Knob(
            FRICTION, now, tries, lambda value: study.with_settings(friction=value),
            lambda value: f"with friction of {value:g}", _middle(_FRICTION_STEP, now),
            now < ContactSettings().friction,
        )
    ]  # fmt: skip


def _asymmetry(relaxation: Relaxation, relaxed: Relaxed) -> list[Knob]:
    study, values = relaxation.study, relaxation.values(relaxed)
    events = values.events
    reached = {
        "step_length": values.placement[0] / values.placement[1],
        "stance_time": (events[6] - events[0]) / (1.0 + events[2] - events[4]),
    }
    found = []
    for number, item in enumerate(study.disorders):
        if not isinstance(item, Asymmetry):
            continue

        def change(value: float, number: int = number, item: Asymmetry = item) -> GaitStudy:
            others = list(study.disorders)
            others[number] = dataclasses.replace(item, ratio=value)
            return study.replace(disorders=tuple(others))

        def words(value: float, item: Asymmetry = item) -> str:
            return f"with {dataclasses.replace(item, ratio=value).describe()}"

        near = float(reached[item.quantity])
        towards = math.floor if item.ratio > 1.0 else math.ceil
        rounded = [towards(x / _RATIO_STEP) * _RATIO_STEP for x in (near, 0.5 * (1.0 + near))]
        tries = list(dict.fromkeys(round(x, 3) for x in (*rounded, 1.0) if x != item.ratio))
        middle = _middle(_RATIO_STEP, item.ratio)
        found.append(Knob(ASYMMETRY, item.ratio, tries, change, words, middle, True))
    return found


def _range(relaxation: Relaxation, relaxed: Relaxed, law: str) -> list[Knob]:
    """A wider range, by whole degrees (or centimetres) at the ends that are in the way."""
    study, base = relaxation.study, law.removeprefix(RANGE)
    program = relaxation.program
    state = program.state(relaxation.elastic.unknowns(relaxed.point))
    kind = study.skeleton_kind
    motion = coordinates.anatomical_signs(kind) * state.motion.value
    low = high = 0.0
    for limit in study.all_limits:
        if without_side(limit.coordinate) == base:
            angle = motion[:, coordinates.names(kind).index(limit.coordinate)]
            low = max(low, limit.low - float(angle.min()))
            high = max(high, float(angle.max()) - limit.high)
    factor = 0.01 if base in coordinates.TRANSLATIONS else math.pi / 180.0
    needed = max(low, high)
    if needed <= 0.0:
        return []
    first = max(1, math.ceil(needed / factor - 1e-6))
    tries = [first, *(math.ceil(first * factor) for factor in (1.25, 1.6, 2.2))]
    shares = low / needed, high / needed

    def change(value: float) -> GaitStudy:
        return _widened(study, base, *(factor * math.ceil(share * value) for share in shares))

    return [
        Knob(
            law, 0.0, list(dict.fromkeys(tries)), change,
            lambda value: f"with {words_of_limits(change(value).all_limits, base)}",
            _middle(1.0), True,
        )
    ]  # fmt: skip


def _widened(study: GaitStudy, base: str, low: float, high: float) -> GaitStudy:
    limits = tuple(
        dataclasses.replace(item, low=item.low - low, high=item.high + high)
        if without_side(item.coordinate) == base else item
        for item in study.limits
    )  # fmt: skip
    disorders = tuple(
        dataclasses.replace(
            item, low=item.low - math.degrees(low), high=item.high + math.degrees(high)
        )
        if isinstance(item, LimitedRange) and item.joint == base else item
        for item in study.disorders
    )  # fmt: skip
    return study.replace(limits=limits, disorders=disorders)


def _strengths(study: GaitStudy, place: Place, short: Sequence[str]) -> list[Knob]:
    """More strength of the muscles that are saturated where it lacks, or of all."""
    percent = 100.0 * place.missing / max(place.moment, 1e-3)
    rung = next((k for k, x in enumerate(_STRENGTHS) if x >= 0.5 * percent), len(_STRENGTHS) - 1)
    tries = [*_STRENGTHS[rung::2][:3]]
    weak = bool(study.strength) or any(isinstance(x, Weakness) for x in study.disorders)
    known = dict(zip(study.walker.muscles.names, study.walker.muscles.abbreviations, strict=True))
    chosen = list(short or place.helpers)
    if study.symmetric:
        chosen = list(dict.fromkeys(without_side(name) for name in chosen))
    who = _words_of_muscles(study, chosen)
    everyone = list(dict.fromkeys(without_side(name) for name in known))
    groups = [(everyone, "all muscles")]
    if len({without_side(name) for name in chosen}) <= _MANY * len(everyone):
        groups.insert(0, (chosen, who))
    return [
        Knob(
            MUSCLES, 0.0, tries, lambda value, names=names: _stronger(study, names, value),
            lambda value, words=words: f"with {value:g} % more strength of {words}",
            _middle(5.0), weak,
        )
        for names, words in groups
    ]  # fmt: skip


def _words_of_muscles(study: GaitStudy, chosen: Sequence[str]) -> str:
    """Abbreviations, by side where the sides differ."""
    muscles, by_side = study.walker.muscles, {"": [], " right": [], " left": []}
    for name, short in zip(muscles.names, muscles.abbreviations, strict=True):
        base = without_side(name)
        both = base in chosen or {f"{base}{side}" for side in SIDES} <= set(chosen)
        if both and short not in by_side[""]:
            by_side[""].append(short)
        elif name in chosen and not both:
            by_side[" right" if name.endswith("_r") else " left"].append(short)
    parts = [", ".join(names) + side for side, names in by_side.items() if names]
    return " and ".join(parts)


def _stronger(study: GaitStudy, names: Sequence[str], percent: float) -> GaitStudy:
    factor = 1.0 + 0.01 * percent
    more = {name: study.strength.get(name, 1.0) * factor for name in names}
    changed = study.replace(strength={**study.strength, **more})
    _ = changed.walker  # refuses a factor out of range
    return changed


def _tolerance(study: GaitStudy, place: Place) -> list[Knob]:
    now = study.tolerances.moment_tolerance
    first = math.ceil(now + place.missing)
    tries = [x for x in (first, first + 1) if x <= _MOST_TOLERANCE * now]
    if not tries:
        return []
    return [
        Knob(
            MUSCLES, now, tries, lambda value: study.with_settings(moment_tolerance=value),
            lambda value: f"if moments may be off by {value:g} N m", _middle(1.0, now), False,
        )
    ]  # fmt: skip


def changed_study(knob: Knob, value: float) -> GaitStudy | None:
    """The study with the knob at `value`; None where that is out of range."""
    try:
        study = knob.study(value)
        study.formulation()
    except InvalidInput:
        return None
    return study
