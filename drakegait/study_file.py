"""A study as plain types that JSON can hold, and back."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from drakegait.errors import InvalidInput, UnknownName
from drakegait.program.formulation import JointLimit
from drakegait.settings import Settings
from drakegait.walker.disorders import from_plain, to_plain
from drakegait.walker.subject import AddedMass

if TYPE_CHECKING:
    from drakegait.study import GaitStudy


def study_to_dict(study: GaitStudy) -> dict[str, Any]:
    """Everything but the reference, which has a place of its own in `gait.nc`."""
    plain = {
        item.name: getattr(study, item.name)
        for item in dataclasses.fields(study)
        if item.name != "reference"
    }
    for name, value in plain.items():
        if isinstance(value, Settings):
            plain[name] = value.to_dict()
    plain["strength"] = dict(study.strength)
    plain["muscle_changes"] = {key: dict(new) for key, new in study.muscle_changes.items()}
    plain["added_masses"] = [dataclasses.asdict(item) for item in study.added_masses]
    plain["limits"] = [dataclasses.asdict(item) for item in study.limits]
    plain["disorders"] = [to_plain(item) for item in study.disorders]
    points = study.interior_points
    plain["interior_points"] = None if points is None else list(points)
    return plain


def study_statements(
    plain: Mapping[str, Any], known: tuple[str, ...], groups: Mapping[str, type[Settings]]
) -> dict[str, Any]:
    """The statements from which a study is made again.

    Args:
        plain: as `study_to_dict` gives them; what is missing keeps its default.
        known: names of all statements.
        groups: the groups of constants, and the subject, by name.

    Raises:
        UnknownName: for a key that no study has, or a disorder that does not exist.
    """
    values = dict(plain)
    for name in values:
        if name not in known:
            raise UnknownName("study key", name, sorted(known))
    for name in ("added_masses", "limits", "disorders", "interior_points"):
        if not isinstance(values.get(name, ()), (list, tuple, type(None))):
            raise InvalidInput(name, values[name], "a list")
    for name, group in groups.items():
        if name in values:
            values[name] = group(**values[name])
    values["added_masses"] = tuple(
        AddedMass(item["segment"], item["mass"], item.get("point"))
        for item in values.get("added_masses", ())
    )
    values["limits"] = tuple(JointLimit(**item) for item in values.get("limits", ()))
    values["disorders"] = tuple(from_plain(item) for item in values.get("disorders", ()))
    points = values.get("interior_points")
    values["interior_points"] = None if points is None else tuple(points)
    return values
