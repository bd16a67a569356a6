"""Every constant that `--set NAME=VALUE` changes: find, read, list."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterable, Iterator
from typing import Any

from drakegait.errors import InvalidInput, UnknownName
from drakegait.settings import by_name, find, parse
from drakegait.solvers.options import SolverOptions
from drakegait.study import SETTINGS_GROUPS
from drakegait.walker.subject import Subject

GROUPS = {**SETTINGS_GROUPS, "subject": Subject, "solver": SolverOptions}
_EXAMPLE = "NAME=VALUE, for example friction=0.4"
_OPTIONS = ("height", "mass", "solver", "time_limit")  # have an option of their own
_HEADINGS = {
    "tolerances": "Tolerances",
    "contact": "Feet and ground",
    "muscles": "Muscles",
    "energy": "Metabolic energy",
    "passive": "Passive joint moments",
    "deviation": "Deviation from the reference",
    "variants": "Other forms of the problem",
    "subject": "Body",
    "solver": "Solver",
}


def catalogue() -> dict[str, tuple[str, dataclasses.Field]]:
    """Name of each constant (`"group.name"` where two share one) -> its group and field."""
    return {name: place for name, place in by_name(GROUPS).items() if name not in _OPTIONS}


def read_constants(texts: Iterable[str]) -> dict[str, dict[str, Any]]:
    """Values by group and name from `["friction=0.4", ...]`.

    Raises:
        UnknownName: no such constant.
        InvalidInput: not NAME=VALUE, a value that cannot be read, or a constant stated twice.
            Ranges are checked by the groups.
    """
    values: dict[str, dict[str, Any]] = {}
    for text in texts:
        name, equals, value = (part.strip() for part in text.partition("="))
        if not equals or not name or not value:
            raise InvalidInput("--set", text, _EXAMPLE)
        if name.split(".")[-1] in _OPTIONS:
            option = name.split(".")[-1].replace("_", "-")
            raise InvalidInput("--set", text, f"a constant; {name} has an option: --{option}")
        try:
            group, item = find(GROUPS, name)
        except UnknownName:
            raise UnknownName("setting", name, sorted(catalogue())) from None
        if item.name in values.setdefault(group, {}):
            raise InvalidInput("--set", text, f"stated once for {item.name}")
        values[group][item.name] = parse(item, value)
    return values


def describe(item: dataclasses.Field) -> tuple[str, str]:
    """Default with unit, and what is allowed, as text."""
    meta = item.metadata
    if "options" in meta:
        return item.default, " | ".join(meta["options"])
    if meta.get("flag"):
        return "on" if item.default else "off", "on | off"
    unit = "" if meta["unit"] == "-" else f" {meta['unit']}"
    return f"{item.default:g}{unit}", f"{meta['low']:g} to {meta['high']:g}{unit}"


def rows() -> Iterator[tuple[str, str, str, str, str]]:
    """Heading, name, default, allowed and meaning of every constant, by groups."""
    known = catalogue()
    for group, heading in _HEADINGS.items():
        for name, (owner, item) in known.items():
            if owner == group:
                yield heading, name, *describe(item), item.metadata["meaning"]


def print_constants() -> None:
    """The list at the end of `drakegait walk --help`."""
    from rich.box import SIMPLE
    from rich.console import Console
    from rich.table import Table
    from rich.text import Text

    table = Table(box=SIMPLE, title="Constants for --set NAME=VALUE", title_justify="left",
                  pad_edge=False, expand=True)  # fmt: skip
    table.add_column("name", no_wrap=True)
    table.add_column("default", no_wrap=True)
    table.add_column("allowed", ratio=2)
    table.add_column("meaning", ratio=3)
    last = None
    for heading, *cells in rows():
        if heading != last:
            if last is not None:
                table.add_section()
            table.add_row(Text(heading, style="bold"))
            last = heading
        table.add_row(*(Text(cell) for cell in cells))
    Console().print(table)
