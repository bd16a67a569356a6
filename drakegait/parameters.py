"""The numbers of a study that one can ask about: name, unit, value, and the study with another.

    for parameter in parameters(study):
        heavier = parameter.study(parameter.value + 1e-3)

Everything that makes a walk is here: speed and weights, body, segments, muscles, disorders,
tolerances and constants. In a symmetric study both sides change together.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from typing import TypeVar
from xml.etree import ElementTree

import numpy as np

from drakegait.settings import by_name
from drakegait.study import SETTINGS_GROUPS, GaitStudy
from drakegait.study_rules import mirrored_limit, mirrored_mass
from drakegait.walker.coordinates import TRANSLATIONS, other_side, without_side
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
_Item = TypeVar("_Item")


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
        *_walk(study), *_body(study), *_numbered(_added_masses(study)), *_segments(study),
        *_muscles(study), *_disorders(study), *_numbered(_limits(study)), *_constants(study),
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
    return () if name.endswith("_l") else ((without_side(name), (name, other_side(name))),)


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


def _together(
    study: GaitStudy, items: Sequence[_Item], image: Callable[[_Item], _Item]
) -> Iterator[tuple[int, ...]]:
    """Positions of what changes together: in a mirror each item and its image."""
    left = list(range(len(items)))
    while left:
        number = left.pop(0)
        twins = [k for k in left if study.symmetric and items[k] == image(items[number])]
        if not twins or image(items[number]) == items[number]:
            yield (number,)
        else:
            left.remove(twins[0])
            yield number, twins[0]


def _with_items(
    study: GaitStudy, statement: str, which: tuple[int, ...], name: str, value: float
) -> GaitStudy:
    """Another value `name` of the items of `statement` at the positions `which`."""
    items = list(getattr(study, statement))
    for k in which:
        items[k] = dataclasses.replace(items[k], **{name: value})
    return _changed(study, **{statement: tuple(items)})


def _numbered(found: Iterable[Parameter]) -> Iterator[Parameter]:
    """The same, with a number behind names that have been there before."""
    seen: dict[str, int] = {}
    for parameter in found:
        count = seen[parameter.name] = seen.get(parameter.name, 0) + 1
        name = parameter.name if count == 1 else f"{parameter.name} ({count})"
        yield dataclasses.replace(parameter, name=name)


def _added_masses(study: GaitStudy) -> Iterator[Parameter]:
    """Masses that are worn, at their points."""
    worn = study.added_masses
    for which in _together(study, worn, mirrored_mass):
        item = worn[which[0]]
        label = item.segment if len(which) == 1 else without_side(item.segment)
        change = partial(_with_items, study, "added_masses", which, "mass")
        place = "" if item.point is None else " at {:g}, {:g}, {:g} m".format(*item.point)
        name = f"mass worn on {label}{place}"
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
    stated = study.disorders
    for which in _together(study, stated, lambda item: item.mirrored()):
        item = stated[which[0]]
        words = [item.kind, *item.target]
        if hasattr(item, "side") and len(which) == 1:
            words.append(item.side)
        for field, value in item.numbers.items():
            change = partial(_with_items, study, "disorders", which, field)
            name, step = " ".join([*words, field]), _SHARE * (abs(value) or 1.0)
            yield Parameter(name, "disorder", item.units[field], value, step, change)


def _limits(study: GaitStudy) -> Iterator[Parameter]:
    limits = study.limits
    for which in _together(study, limits, mirrored_limit):
        item = limits[which[0]]
        label = item.coordinate if len(which) == 1 else without_side(item.coordinate)
        for end in ("low", "high"):
            value = float(getattr(item, end))
            if not np.isfinite(value):
                continue
            change = partial(_with_items, study, "limits", which, end)
            unit = "m" if item.coordinate in TRANSLATIONS else "rad"
            yield Parameter(f"{end} limit {label}", "limit", unit, value, 0.05, change)


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
