"""The statements of a sweep's file, put into a study: by the names of the command line.

    model, nodes, speed, multipliers, planar_muscles, interior_points, ...   as GaitStudy has them
    energy_weight, deviation_weight; or weights = [1.0, 0.5]
    height, mass                     the person [m, kg]
    added_mass.foot_r = 2.0          [kg], or { mass = 2.0, point = [0.1, 0.0, 0.0] } [m]; 0: none
    strength.soleus_l = 0.5          factor
    muscle.SOL.l_slack = 0.245       another value in the muscle table
    limit.knee_flexion_r = [0, 60]   degrees or m
    set.friction = 0.4               every constant and solver option that --set knows
    solver = "snopt", time_limit = 600.0
    reference, sdf                   a file beside the sweep's file; reference also by its name
    weakness.soleus_l = 0.5          a disorder, as its option takes it: range.knee_l = [5, 45], ...
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import fields
from pathlib import Path
from typing import Any

from drakegait.errors import InvalidInput, UnknownName
from drakegait.reference.named import measured_person, named_reference
from drakegait.reference.reference import Reference
from drakegait.settings import find
from drakegait.solvers.options import SolverOptions
from drakegait.study import MODELS, SETTINGS_GROUPS, GaitStudy
from drakegait.walker import coordinates
from drakegait.walker.disorders.reading import READERS
from drakegait.walker.subject import Subject
from drakegait.whole_file import read_text

_GROUPS = {**SETTINGS_GROUPS, "subject": Subject}
_ALIASES = ("height", "mass", "weights", "added_mass", "muscle", "limit", "set", "solver",
            "time_limit")  # fmt: skip
_UNWRITTEN = ("subject", "limits", "muscle_changes")  # fields that have an alias
_DISORDERS = {name.strip("_"): name for name in READERS}
_TABLES = ("added_mass", "strength", "muscle", "limit", "set", *_GROUPS, *_DISORDERS)


def known() -> list[str]:
    """The names that a statement can begin with."""
    names = [item.name for item in fields(GaitStudy) if item.name not in _UNWRITTEN]
    return sorted({*names, *_ALIASES, *_DISORDERS})


def flatten(table: Mapping[str, Any]) -> dict[str, Any]:
    """Statements by dotted names: `{"set": {"friction": 0.4}}` -> `{"set.friction": 0.4}`.

    Raises:
        UnknownName: a name that no statement begins with.
        InvalidInput: a table where a value belongs, or the other way round.
    """
    return dict(_leaves(table))


def _leaves(table: Mapping[str, Any]) -> Iterator[tuple[str, Any]]:
    for name, value in table.items():
        head, _, rest = name.partition(".")
        if head not in known():
            raise UnknownName("statement", name, known())
        inside = head in _TABLES
        if inside and not rest and not isinstance(value, Mapping):
            raise InvalidInput(name, value, f"a table, for example {_example(head)}")
        if isinstance(value, Mapping) and (inside or rest):
            yield from _inner(name, value)
        else:
            yield name, value


def _inner(name: str, table: Mapping[str, Any]) -> Iterator[tuple[str, Any]]:
    point = name.startswith("added_mass.") and "mass" in table
    if point:
        yield name, table
        return
    for key, value in table.items():
        below = f"{name}.{key}"
        if isinstance(value, Mapping):
            yield from _inner(below, value)
        else:
            yield below, value


def _example(head: str) -> str:
    if head in _DISORDERS:
        form, value = READERS[_DISORDERS[head]][0][1].split("=")
        return f"{head}.{form} = {value if value.replace('.', '').isdigit() else repr(value)}"
    return {
        "added_mass": "added_mass.foot_r = 2.0",
        "strength": "strength.soleus_l = 0.5",
        "muscle": "muscle.SOL.l_slack = 0.245",
        "limit": "limit.knee_flexion_r = [0, 60]",
    }.get(head, "set.friction = 0.4")


class Statements:
    """Builds a study and its solver options from statements.

    Args:
        folder: against which the names of files are resolved.
    """

    def __init__(self, folder: Path):
        self._folder = folder
        self._references: dict[Any, Reference] = {}

    def study(self, statements: Mapping[str, Any]) -> tuple[GaitStudy, SolverOptions]:
        """The study that the statements describe, all others as by default.

        Args:
            statements: by dotted name, as `flatten` gives them; later ones count.

        Raises:
            InvalidInput, UnknownName, BadFile: the first that cannot be used.
        """
        model = statements.get("model", "spatial")
        if model not in MODELS:
            raise UnknownName("model", model, MODELS)
        start = getattr(GaitStudy, model.replace("-", "_"))()  # with the nodes of its model
        reference = statements.get("reference")
        plain, options = self._as_measured(start, reference).to_dict(), {}
        for name, value in statements.items():
            self._put(plain, options, name, value)
        try:
            study = GaitStudy.from_dict(plain)
        except (TypeError, ValueError, AttributeError, KeyError) as error:
            raise InvalidInput("a statement", error, "of the kind that GaitStudy takes") from None
        disorders = _disorders(statements)
        if disorders:
            study = study.replace(disorders=(*study.disorders, *disorders))
        if reference is not None:
            study = study.replace(reference=self._reference(reference, study))
        return study, SolverOptions(**options)

    def _put(
        self, plain: dict[str, Any], options: dict[str, Any], name: str, value: Any
    ) -> None:
        head, _, rest = name.partition(".")
        special: dict[str, Callable[[], None]] = {
            "height": lambda: plain["subject"].update(height=value),
            "mass": lambda: plain["subject"].update(mass=value),
            "weights": lambda: plain.update(_weights(value)),
            "added_mass": lambda: _add_mass(plain, rest, value),
            "muscle": lambda: _change_muscle(plain, name, rest, value),
            "limit": lambda: _limit(plain, rest, value),
            "set": lambda: _set(plain, options, rest, value),
            "solver": lambda: options.update(solver=value),
            "time_limit": lambda: options.update(time_limit=value),
            "sdf": lambda: plain.update(sdf=read_text(self._folder / str(value))),
            "strength": lambda: plain["strength"].update({rest: value}),
        }
        if head in special:
            special[head]()
        elif head in _GROUPS:
            _set(plain, options, name, value)
        elif head != "reference" and head not in _DISORDERS:
            plain[name] = value

    def _as_measured(self, start: GaitStudy, reference: object) -> GaitStudy:
        """The person and speed of an imported reference, where no statement says otherwise."""
        if not isinstance(reference, str):
            return start
        found = measured_person(self._folder / reference, start.skeleton_kind)
        if found is None:
            return start
        return start.replace(subject=found[0] or start.subject, speed=found[1])

    def _reference(self, given: object, study: GaitStudy) -> Reference:
        """A reference, made once for all studies that agree on it."""
        key = (str(given), study.skeleton_kind, study.subject)
        if key not in self._references:
            self._references[key] = named_reference(*key, folder=self._folder)
        return self._references[key]


def _disorders(statements: Mapping[str, Any]) -> tuple[Any, ...]:
    """Disorders as the command line reads them, in the order of the statements."""
    found = []
    for name, value in statements.items():
        head, _, rest = name.partition(".")
        if head in _DISORDERS:
            form, read = READERS[_DISORDERS[head]]
            text = ":".join(map(str, value)) if isinstance(value, list) else str(value)
            found.append(read(head, f"{rest}={text}", f"{form[0]}, for example {form[1]}"))
    return tuple(found)


def _weights(value: Any) -> dict[str, Any]:
    if not isinstance(value, list) or len(value) != 2:
        raise InvalidInput("weights", value, "two numbers, [energy, deviation]")
    return {"energy_weight": value[0], "deviation_weight": value[1]}


def _add_mass(plain: dict[str, Any], segment: str, value: Any) -> None:
    item = dict(value) if isinstance(value, Mapping) else {"mass": value}
    if not set(item) <= {"mass", "point"}:
        raise InvalidInput(f"added_mass.{segment}", value, "a mass, or { mass = .., point = [..] }")
    others = [worn for worn in plain["added_masses"] if worn["segment"] != segment]
    none = isinstance(item["mass"], (int, float)) and item["mass"] == 0
    plain["added_masses"] = others if none else [*others, {"segment": segment, **item}]


def _change_muscle(plain: dict[str, Any], name: str, place: str, value: Any) -> None:
    muscle, dot, entry = place.partition(".")
    if not dot or not entry:
        raise InvalidInput(name, value, "muscle.NAME.ENTRY, for example muscle.SOL.l_slack = 0.245")
    plain["muscle_changes"].setdefault(muscle, {})[entry] = value


def _limit(plain: dict[str, Any], name: str, value: Any) -> None:
    kind = str(plain["model"]).removesuffix("-symmetric")
    angles = dict(zip(coordinates.names(kind), coordinates.rotations(kind), strict=True))
    if name not in angles or name == "hat_x":
        raise UnknownName("coordinate of a limit", name, [x for x in angles if x != "hat_x"])
    pair = isinstance(value, list) and len(value) == 2
    numbers = pair and all(
        isinstance(x, (int, float)) and not isinstance(x, bool) for x in value
    )
    if not numbers or not value[0] < value[1]:
        allowed = "[low, high], numbers in degrees or m, low below high (inf is a number)"
        raise InvalidInput(f"limit.{name}", value, allowed)
    unit = math.pi / 180.0 if angles[name] else 1.0
    others = [limit for limit in plain["limits"] if limit["coordinate"] != name]
    new = {"coordinate": name, "low": unit * value[0], "high": unit * value[1]}
    plain["limits"] = [*others, new]


def _set(plain: dict[str, Any], options: dict[str, Any], name: str, value: Any) -> None:
    group, item = find({**_GROUPS, "solver": SolverOptions}, name)
    target = options if group == "solver" else plain[group]
    target[item.name] = value
