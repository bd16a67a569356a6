"""Frozen groups of constants that know their unit, range and meaning.

A group is a dataclass derived from `Settings` whose fields are declared with
`quantity`, `choice` or `flag`. A value out of range is refused when the group
is made, with a sentence that names it. The same declarations feed the command
line's ``--set NAME=VALUE`` and its help.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping, Sequence
from typing import Any

from drakegait.errors import InvalidInput, UnknownName
from drakegait.quantities import check_number, plain


def quantity(
    default: float, unit: str, low: float, high: float, meaning: str, whole: bool = False
) -> Any:
    """Declare a number with its unit and closed allowed range; `whole` numbers have no fraction."""
    declared = {"unit": unit, "low": low, "high": high, "meaning": meaning, "whole": whole}
    return dataclasses.field(default=default, metadata=declared)


def choice(default: str, options: Sequence[str], meaning: str) -> Any:
    """Declare a name to be picked from `options`."""
    return dataclasses.field(
        default=default, metadata={"options": tuple(options), "meaning": meaning}
    )


def flag(default: bool, meaning: str) -> Any:
    """Declare a switch, on or off."""
    return dataclasses.field(default=default, metadata={"flag": True, "meaning": meaning})


@dataclasses.dataclass(frozen=True, kw_only=True)
class Settings:
    """Base of all groups of constants: validated when made, never changed after."""

    def __post_init__(self) -> None:
        for field in dataclasses.fields(self):
            value = getattr(self, field.name)
            _validate(field, value)
            object.__setattr__(self, field.name, plain(value))

    def replace(self, **changes: Any) -> Any:
        """A copy with some values changed, validated again."""
        known = [field.name for field in dataclasses.fields(self)]
        for name in changes:
            if name not in known:
                raise UnknownName("setting", name, known)
        return dataclasses.replace(self, **changes)

    def to_dict(self) -> dict[str, Any]:
        """The values by name, as plain types that JSON can hold."""
        return dataclasses.asdict(self)


def parse(field: dataclasses.Field, text: str) -> Any:
    """Read the text of ``--set NAME=VALUE`` as the type that `field` holds."""
    meta = field.metadata
    if "options" in meta:
        return text
    if meta.get("flag"):
        words = {"true": True, "yes": True, "on": True, "1": True,
                 "false": False, "no": False, "off": False, "0": False}  # fmt: skip
        if text.lower() not in words:
            raise InvalidInput(field.name, text, "on or off")
        return words[text.lower()]
    try:
        return float(text)
    except ValueError:
        raise InvalidInput(field.name, text, _allowed(meta)) from None


def by_name(groups: Mapping[str, type[Settings]]) -> dict[str, tuple[str, dataclasses.Field]]:
    """All fields of `groups`: name (`"group.name"` where two share one) -> group, field."""
    owners: dict[str, list[tuple[str, dataclasses.Field]]] = {}
    for group, settings in groups.items():
        for field in dataclasses.fields(settings):
            owners.setdefault(field.name, []).append((group, field))
    return {
        name if len(places) == 1 else f"{group}.{name}": (group, field)
        for name, places in owners.items()
        for group, field in places
    }


def find(groups: Mapping[str, type[Settings]], name: str) -> tuple[str, dataclasses.Field]:
    """Group and field called `name`; `"group.name"` always works.

    Raises:
        UnknownName: there is none, or several share the name.
    """
    known = by_name(groups)
    if name in known:
        return known[name]
    group, _, rest = name.partition(".")
    for field in dataclasses.fields(groups[group]) if group in groups else ():
        if field.name == rest:
            return group, field
    raise UnknownName("setting", name, sorted(known))


def _allowed(meta: Any) -> str:
    return f"a number from {meta['low']:g} to {meta['high']:g} [{meta['unit']}]"


def _validate(field: dataclasses.Field, value: Any) -> None:
    meta = field.metadata
    if "options" in meta:
        if value not in meta["options"]:
            raise UnknownName(field.name, value, meta["options"])
    elif meta.get("flag"):
        if not isinstance(value, bool):
            raise InvalidInput(field.name, value, "True or False")
    elif "unit" in meta:
        check_number(field.name, value, meta["low"], meta["high"], meta["unit"])
        if meta["whole"] and value != int(value):
            raise InvalidInput(field.name, value, "a whole number")
