"""The numbers of a study that one can ask about: name, unit, value, and the study with another.

    for parameter in parameters(study):
        heavier = parameter.study(parameter.value + 1e-3)

Everything that makes a walk is here: speed and weights, body, segments, muscles, disorders,
tolerances and constants. In a symmetric study both sides change together.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import partial
from xml.etree import ElementTree

import numpy as np

from drakegait.settings import by_name
from drakegait.study import SETTINGS_GROUPS, GaitStudy
from drakegait.walker.muscle_dynamics import MuscleFunctions
from drakegait.walker.muscles import MuscleSet
from drakegait.walker.sdf_elements import named_element, parse_sdf, read_inertial, write_inertial
from drakegait.walker.subject import SEGMENTS
from drakegait.walker.walker import Walker

# Statements of a study that its walker is built from.
_MAKES_WALKER = (
    "model", "subject", "added_masses", "muscles", "energy", "passive", "strength",
    "planar_muscles", "muscle_changes", "sdf", "disorders", "variants",
)  # fmt: skip
_SHARE = 0.1  # of a value: the usual step
_LENGTH_SHARE = 0.02  # the same of the lengths of a muscle, which are known better
_ADDED_MASS, _CENTRE = 0.5, 0.01  # steps [kg], [m]
# Away from the proximal joint, in the segment's frame.
_DISTAL = {"hat": (0.0, 0.0, 1.0), "foot": (1.0, 0.0, 0.0)}
_LEG_DISTAL = (0.0, 0.0, -1.0)


@dataclass(frozen=True)
class Parameter:
    """One number of a study.

    Attributes:
        name: in words, with the segment, muscle or constant that it belongs to.
        group: what kind of number: "walk", "body", "added mass", "segment", "muscle", "disorder",
            "limit", or a group of constants ("tolerances", "passive", ...).
        unit: of `value`.
        value: present value.
        step: a change worth thinking about, in the same unit: a tenth of most values.
        study: the study with another value. It raises InvalidInput where that is out of range.
    """

    name: str
    group: str
    unit: str
    value: float
    step: float
    study: Callable[[float], GaitStudy]


def parameters(study: GaitStudy) -> list[Parameter]:
    """All numbers of `study` that can change by a little without changing the kind of question."""
    return [
        *_walk(study), *_body(study), *_added_masses(study), *_segments(study), *_muscles(study),
        *_disorders(study), *_limits(study), *_constants(study),
    ]  # fmt: skip


def _changed(study: GaitStudy, **statements: object) -> GaitStudy:
    """A copy with other statements, which shares what they do not touch."""
    copy = study.replace(**statements)
    if not set(statements).intersection(_MAKES_WALKER):
        copy.__dict__["walker"] = study.walker
    if not set(statements).intersection(("model", "subject", "reference", "deviation")):
        copy.__dict__["reference_walk"] = study.reference_walk
    return copy


def _with_walker(study: GaitStudy, **parts: object) -> GaitStudy:
    """A copy whose walker has other parts than its statements say."""
    copy = _changed(study)
    copy.__dict__["walker"] = dataclasses.replace(study.walker, **parts)
    return copy


def _sides(study: GaitStudy, name: str) -> tuple[tuple[str, tuple[str, ...]], ...]:
    """What is named and all that change with it: a left thing follows the right in a mirror."""
    if not study.symmetric or name[-2:] not in ("_r", "_l"):
        return ((name, (name,)),)
    return () if name.endswith("_l") else ((name[:-2], (name, f"{name[:-2]}_l")),)


# Walk and body ----------------------------------------------------------------------------------


def _walk(study: GaitStudy) -> Iterator[Parameter]:
    for name, unit, step in (
        ("speed", "m/s", 0.05), ("energy_weight", "-", 0.1), ("deviation_weight", "-", 0.1),
    ):  # fmt: skip
        value = float(getattr(study, name))
        if value > 0.0:  # a term of weight zero is no part of the program
            change = partial(lambda name, value: _changed(study, **{name: value}), name)
            yield Parameter(name, "walk", unit, value, step, change)


def _body(study: GaitStudy) -> Iterator[Parameter]:
    for name, unit in (("height", "m"), ("mass", "kg")):
        value = float(getattr(study.subject, name))

        def change(value: float, name: str = name) -> GaitStudy:
            return _changed(study, subject=study.subject.replace(**{name: value}))

        step = (0.2 if name == "height" else 1.0) * _SHARE * value
        yield Parameter(f"body {name}", "body", unit, value, step, change)


def _added_masses(study: GaitStudy) -> Iterator[Parameter]:
    """Masses that are worn, at their points."""
    seen = set()
    for number, item in enumerate(study.added_masses):
        label, segments = next(iter(_sides(study, item.segment)), ("", ()))
        if not label or (label, item.mass) in seen:
            continue
        seen.add((label, item.mass))
        which = [
            k for k, other in enumerate(study.added_masses)
            if k == number or (other.segment in segments[1:] and other.mass == item.mass)
        ]  # fmt: skip

        def change(value: float, which: list[int] = which) -> GaitStudy:
            worn = list(study.added_masses)
            for k in which:
                worn[k] = dataclasses.replace(worn[k], mass=value)
            return _changed(study, added_masses=tuple(worn))

        name = f"mass worn on {label}"
        yield Parameter(name, "added mass", "kg", item.mass, _ADDED_MASS, change)


# Segments ---------------------------------------------------------------------------------------


def _segments(study: GaitStudy) -> Iterator[Parameter]:
    """Mass added at the mass centre, mass, mass centre and inertia of each segment as it is."""
    walker = study.walker
    root = parse_sdf(walker.skeleton.sdf, "the walker")
    worn = dict.fromkeys(SEGMENTS, 0.0)
    for item in study.added_masses:
        worn[item.segment] += item.mass
    for segment in SEGMENTS:
        for label, both in _sides(study, segment):
            mass, com, inertia = read_inertial(named_element(root, "link", segment))
            direction = np.array(_DISTAL.get(segment.partition("_")[0], _LEG_DISTAL))
            centre, turning = float(com @ direction), float(inertia[1, 1])
            change = partial(_with_segments, study, both)
            for what, group, unit, value, step, edit in (
                ("added mass", "added mass", "kg", worn[segment], _ADDED_MASS,
                 lambda new, old=worn[segment]: (new - old, 0.0, 1.0)),
                ("mass", "segment", "kg", mass, _SHARE * mass,
                 lambda new, old=mass: (new - old, 0.0, new / old)),
                ("mass centre", "segment", "m", centre, _CENTRE,
                 lambda new, old=centre, way=direction: (0.0, (new - old) * way, 1.0)),
                ("inertia", "segment", "kg m^2", turning, _SHARE * turning,
                 lambda new, old=turning: (0.0, 0.0, new / old)),
            ):  # fmt: skip
                yield Parameter(
                    f"{what} {label}", group, unit, value, step,
                    lambda new, change=change, edit=edit: change(*edit(new)),
                )  # fmt: skip


def _with_segments(
    study: GaitStudy, names: tuple[str, ...], mass: float, shift: np.ndarray | float, factor: float
) -> GaitStudy:
    """Segments of other mass [kg more], mass centre [m further] and inertia (times a factor)."""
    skeleton = study.walker.skeleton
    root = parse_sdf(skeleton.sdf, "the walker")
    for name in names:
        link = named_element(root, "link", name)
        old_mass, com, inertia = read_inertial(link)
        write_inertial(link, old_mass + mass, com + shift, factor * inertia)
    text = ElementTree.tostring(root, encoding="unicode")
    return _with_walker(study, skeleton=skeleton.with_sdf(text))


# Muscles ----------------------------------------------------------------------------------------


def _muscles(study: GaitStudy) -> Iterator[Parameter]:
    muscles = study.walker.muscles
    for i, name in enumerate(muscles.names):
        for label, both in _sides(study, name):
            which = [muscles.names.index(each) for each in both if each in muscles.names]
            for what, field, unit, value, step in (
                ("strength", "f_max", "-", 1.0, _SHARE),
                ("fibre length", "l_opt", "m", muscles.l_opt[i], _LENGTH_SHARE),
                ("tendon slack", "l_slack", "m", muscles.l_slack[i], _LENGTH_SHARE),
            ):
                change = partial(_with_muscles, study, which, field, float(value))
                step *= float(value)
                yield Parameter(f"{what} {label}", "muscle", unit, float(value), step, change)


def _with_muscles(
    study: GaitStudy, which: list[int], field: str, old: float, value: float
) -> GaitStudy:
    walker: Walker = study.walker
    changed = getattr(walker.muscles, field).copy()
    changed[which] *= value / old
    muscles: MuscleSet = dataclasses.replace(walker.muscles, **{field: changed})
    functions = walker.muscle_functions
    return _with_walker(
        study, muscles=muscles,
        muscle_functions=MuscleFunctions(muscles, functions.settings, functions.energy),
    )  # fmt: skip


# Disorders, limits, constants -------------------------------------------------------------------


def _disorders(study: GaitStudy) -> Iterator[Parameter]:
    for number, item in enumerate(study.disorders):
        words = [
            str(getattr(item, field.name))
            for field in dataclasses.fields(item)  # type: ignore[arg-type]
            if isinstance(getattr(item, field.name), str)
        ]
        for field in dataclasses.fields(item):  # type: ignore[arg-type]
            value = getattr(item, field.name)
            if not isinstance(value, float):
                continue

            def change(value: float, number: int = number, name: str = field.name) -> GaitStudy:
                disorders = list(study.disorders)
                disorders[number] = dataclasses.replace(disorders[number], **{name: value})
                return _changed(study, disorders=tuple(disorders))

            name = " ".join([item.kind, *words, field.name])
            yield Parameter(name, "disorder", "", value, _SHARE * (abs(value) or 1.0), change)


def _limits(study: GaitStudy) -> Iterator[Parameter]:
    for number, item in enumerate(study.limits):
        for end in ("low", "high"):
            value = float(getattr(item, end))
            if not np.isfinite(value):
                continue

            def change(value: float, number: int = number, end: str = end) -> GaitStudy:
                limits = list(study.limits)
                limits[number] = dataclasses.replace(limits[number], **{end: value})
                return _changed(study, limits=tuple(limits))

            unit = "m" if item.coordinate in ("hat_y", "hat_z") else "rad"
            yield Parameter(f"{end} limit {item.coordinate}", "limit", unit, value, 0.05, change)


def _constants(study: GaitStudy) -> Iterator[Parameter]:
    for group, field in by_name(SETTINGS_GROUPS).values():
        if "unit" not in field.metadata:
            continue
        settings = getattr(study, group)
        value = float(getattr(settings, field.name))

        def change(value: float, group: str = group, name: str = field.name) -> GaitStudy:
            changed = getattr(study, group).replace(**{name: value})
            return _changed(study, **{group: changed})

        meta = field.metadata
        step = _SHARE * (abs(value) or 0.1 * (meta["high"] - meta["low"]))
        yield Parameter(f"{group}.{field.name}", group, meta["unit"], value, step, change)
