"""In what the studies of a sweep differ: names, values and units for tables and pictures."""

from __future__ import annotations

import hashlib
import json
import math
from collections.abc import Mapping, Sequence
from typing import Any

from drakegait.errors import InvalidInput, UnknownName
from drakegait.settings import Settings, find
from drakegait.study import SETTINGS_GROUPS, GaitStudy
from drakegait.walker import coordinates
from drakegait.walker.subject import Subject

_UNITS = {"speed": "m/s", "height": "m", "mass": "kg", "nodes": "-", "energy_weight": "-",
          "deviation_weight": "-"}  # fmt: skip
_ABSENT = {"added_mass": 0.0, "strength": 1.0}
Places = Mapping[str, Mapping[str, Any]]
"""Name of a study -> {axis: value}."""


def differences(studies: Mapping[str, GaitStudy]) -> Places:
    """The statements in which the studies are not all equal, by the names of a sweep's file."""
    flat = {name: _flat(study) for name, study in studies.items()}
    names = list(dict.fromkeys(name for statements in flat.values() for name in statements))
    found = {
        study: {name: statements.get(name, _absent(name)) for name in names}
        for study, statements in flat.items()
    }
    varied = [name for name in names if len({repr(place[name]) for place in found.values()}) > 1]
    return {study: {name: place[name] for name in varied} for study, place in found.items()}


def checked(axes: Places, studies: Mapping[str, GaitStudy]) -> Places:
    """`axes` as given, if each study has a place and all have the same axes.

    Raises:
        InvalidInput, UnknownName: naming the study.
    """
    if not isinstance(axes, Mapping):
        raise InvalidInput("axes", axes, "a mapping, name of a study -> {axis: value}")
    for name in axes:
        if name not in studies:
            raise UnknownName("study in axes", name, studies)
    first: list[str] | None = None
    for name in studies:
        place = axes.get(name)
        if not isinstance(place, Mapping) or first not in (None, list(place)):
            allowed = "{axis: value} with the same axes, in the same order, for each study"
            raise InvalidInput(f"axes of {name!r}", place, allowed)
        first = list(place)
    return {name: {axis: label(x) for axis, x in axes[name].items()} for name in studies}


def grid(places: Places) -> dict[str, list[Any]] | None:
    """The values along each axis if every combination is there once, else None.

    Numbers ascend, words are in the order in which they come.
    """
    axes = list(next(iter(places.values())))
    values = {axis: levels(axis, places) for axis in axes}
    combinations = {tuple(place[axis] for axis in axes) for place in places.values()}
    # Counted, not built: unlike studies have as many levels as there are of them, on every axis.
    whole = math.prod(map(len, values.values())) == len(combinations) == len(places)
    return values if axes and whole else None


def levels(axis: str, places: Places) -> list[Any]:
    """The values of an axis, each once; numbers ascend."""
    found = list(dict.fromkeys(place[axis] for place in places.values()))
    return sorted(found) if numeric(found) else [str(value) for value in found]


def numeric(values: Sequence[Any]) -> bool:
    """Whether all values are numbers."""
    return all(isinstance(x, (int, float)) and not isinstance(x, bool) for x in values)


def label(value: Any) -> Any:
    """A value as a number or as words."""
    if isinstance(value, bool):
        return "on" if value else "off"
    if isinstance(value, (int, float, str)):
        return value
    if hasattr(value, "item") and getattr(value, "ndim", 1) == 0:
        return value.item()
    if isinstance(value, Mapping):
        return " ".join(f"{name}={label(x)}" for name, x in value.items())
    if isinstance(value, (list, tuple)):
        return " ".join(str(label(item)) for item in value)
    return "default" if value is None else str(value)


def unit(axis: str) -> str:
    """Unit of an axis; empty if it is none that studies have."""
    if axis in _UNITS:
        return _UNITS[axis]
    head, _, rest = axis.partition(".")
    if head in ("added_mass", "strength", "limit"):
        angle = "m" if rest in coordinates.TRANSLATIONS else "deg"
        return {"added_mass": "kg", "strength": "-", "limit": angle}[head]
    try:
        name = rest if head == "set" else axis
        return find({**SETTINGS_GROUPS, "subject": Subject}, name)[1].metadata.get("unit", "")
    except UnknownName:
        return ""


def _absent(name: str) -> Any:
    return _ABSENT.get(name.partition(".")[0], "default")


def _flat(study: GaitStudy) -> dict[str, Any]:
    flat: dict[str, Any] = {}
    for name, value in study.to_dict().items():
        if name == "added_masses":
            for item in value:
                _add_mass(flat, item)
        elif name == "limits":
            for item in value:
                flat[f"limit.{item['coordinate']}"] = _limit(item, study.skeleton_kind)
        elif name == "subject":
            flat |= {"height": value["height"], "mass": value["mass"]}
            rest = {key: x for key, x in value.items() if key not in ("height", "mass")}
            _nest(flat, "subject", rest)
        elif name == "sdf":
            flat["sdf"] = "default" if value is None else _digest(value)
        elif isinstance(getattr(study, name), Settings) or isinstance(value, Mapping):
            _nest(flat, name, value)
        elif isinstance(value, list) and any(isinstance(item, Mapping) for item in value):
            flat[name] = json.dumps(value, sort_keys=True, default=str)
        else:
            flat[name] = label(value)
    flat["reference"] = "default" if study.reference is None else study.reference.name
    return flat


def _nest(flat: dict[str, Any], above: str, values: Mapping[str, Any]) -> None:
    for name, value in values.items():
        if isinstance(value, Mapping):
            _nest(flat, f"{above}.{name}", value)
        else:
            flat[f"{above}.{name}"] = label(value)


def _add_mass(flat: dict[str, Any], item: Mapping[str, Any]) -> None:
    key = f"added_mass.{item['segment']}"
    if item["point"] is None and not isinstance(flat.get(key), str):
        flat[key] = flat.get(key, 0.0) + item["mass"]
    else:
        place = "" if item["point"] is None else "@" + ",".join(f"{x:g}" for x in item["point"])
        before = f"{flat[key]} " if key in flat else ""
        flat[key] = f"{before}{item['mass']:g}{place}"


def _limit(item: Mapping[str, Any], kind: str) -> str:
    angles = dict(zip(coordinates.names(kind), coordinates.rotations(kind), strict=True))
    factor = 180.0 / math.pi if angles.get(item["coordinate"]) else 1.0
    ends = [item["low"], item["high"]]
    return ":".join(f"{factor * end:g}" if math.isfinite(end) else "" for end in ends)


def _digest(text: str) -> str:
    return f"sdf {hashlib.sha256(text.encode()).hexdigest()[:8]}"
