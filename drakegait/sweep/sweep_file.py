"""The file that `drakegait sweep` takes: a grid, a list of studies, or a program with studies."""

from __future__ import annotations

import itertools
import re
import runpy
import sys
import tomllib
import traceback
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from drakegait.errors import BadFile, DrakegaitError, InvalidInput, UnknownName
from drakegait.solvers.options import SolverOptions
from drakegait.study import GaitStudy
from drakegait.sweep.axes import label
from drakegait.sweep.statements import Statements, flatten

SECTIONS = ("sweep", "base", "grid", "study")
KEYS = ("warm", "refine")
MOST_STUDIES = 100_000


@dataclass(frozen=True)
class SweepFile:
    """What a file asks for; the fields are arguments of `sweep`."""

    studies: Mapping[str, GaitStudy]
    warm: Mapping[str, str]
    options: SolverOptions | Mapping[str, SolverOptions]
    refine: bool
    axes: Mapping[str, Mapping[str, Any]] | None


def read(path: str | Path) -> SweepFile:
    """Read a sweep.

    Raises:
        BadFile: in one sentence, what is wrong with which key.
    """
    path = Path(path).expanduser()
    readers = {".toml": _read_toml, ".py": _read_python}
    if path.suffix not in readers:
        raise BadFile(path, "is neither a .toml nor a .py file.")
    if not path.is_file():
        raise BadFile(path, "is a folder." if path.is_dir() else "does not exist.")
    try:
        return readers[path.suffix](path)
    except BadFile as error:
        raise error if str(error.path) == str(path) else BadFile(path, str(error)) from None
    except DrakegaitError as error:
        raise BadFile(path, str(error)) from None


# Python ------------------------------------------------------------------------------------


def _read_python(path: Path) -> SweepFile:
    sys.path.insert(0, str(path.parent.resolve()))  # as `python FILE.py` does
    try:
        found = runpy.run_path(str(path), run_name="drakegait_sweep")
    except DrakegaitError as error:
        raise BadFile(path, f"line {_line(error, path)}: {error}") from None
    except Exception as error:  # noqa: BLE001 - whatever a user's program raises
        where, what = _line(error, path), f"{type(error).__name__}: {error}"
        raise BadFile(path, f"line {where}: {what}") from None
    finally:
        sys.path.pop(0)
    if "studies" not in found:
        raise BadFile(path, "does not define studies, a mapping of names to GaitStudy.")
    return SweepFile(
        studies=found["studies"],
        warm=found.get("warm") or {},
        options=found.get("options") or SolverOptions(),
        refine=found.get("refine", True),
        axes=found.get("axes"),
    )


def _line(error: Exception, path: Path) -> int:
    if isinstance(error, SyntaxError):
        return error.lineno or 0
    steps = traceback.extract_tb(error.__traceback__)
    lines = [step.lineno for step in steps if step.filename == str(path)]
    return (lines[-1] if lines else 0) or 0


# TOML --------------------------------------------------------------------------------------


def _read_toml(path: Path) -> SweepFile:
    try:
        content = tomllib.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError) as error:  # TOMLDecodeError is a ValueError
        raise BadFile(path, f"cannot be read: {error}.") from None
    for section, kind in content.items():
        if section not in SECTIONS:
            raise UnknownName("section", section, SECTIONS)
        if not isinstance(kind, list if section == "study" else dict):
            brackets = "[[study]]" if section == "study" else f"[{section}]"
            raise InvalidInput(section, kind, f"a section {brackets}")
    general = content.get("sweep", {})
    for key in general:
        if key not in KEYS:
            raise UnknownName("key of [sweep]", key, KEYS)
    refine = general.get("refine", True)
    if not isinstance(refine, bool):
        raise InvalidInput("refine in [sweep]", refine, "true or false")
    base = _section("[base]", content.get("base", {}))
    if ("grid" in content) == ("study" in content):
        raise BadFile(path, "must have either a [grid] or [[study]] entries, and not both.")
    builder = Statements(path.parent)
    if "grid" in content:
        return _grid(builder, base, content["grid"], general.get("warm", []), refine)
    if "warm" in general:
        allowed = "left out with [[study]]; an entry says warm = the name of another"
        raise InvalidInput("warm in [sweep]", general["warm"], allowed)
    return _listed(builder, base, content["study"], refine)


def _section(where: str, table: Mapping[str, Any]) -> dict[str, Any]:
    try:
        return flatten(table)
    except InvalidInput as error:
        raise BadFile(where, str(error)) from None


def _grid(
    builder: Statements, base: Mapping[str, Any], table: Mapping[str, Any], warm: Any, refine: bool
) -> SweepFile:
    axes = _section("[grid]", table)
    for axis, values in axes.items():
        if not isinstance(values, list) or not values:
            raise InvalidInput(f"{axis} in [grid]", values, "a list with at least one value")
        labels = [label(value) for value in values]
        if len(set(map(str, labels))) < len(labels):
            raise InvalidInput(f"{axis} in [grid]", values, "a list without repeated values")
    if not axes:
        raise InvalidInput("[grid]", table, "at least one axis, for example speed = [1.0, 1.2]")
    along = [warm] if isinstance(warm, str) else warm
    if not isinstance(along, list):
        raise InvalidInput("warm in [sweep]", warm, "an axis of [grid], or a list of axes")
    for axis in along:
        if axis not in axes:
            raise UnknownName("warm in [sweep]", axis, axes)
    count = 1
    for values in axes.values():
        count *= len(values)
    if count > MOST_STUDIES:
        raise InvalidInput("number of studies in [grid]", count, f"at most {MOST_STUDIES}")
    named: dict[tuple[int, ...], str] = {}
    studies, options, places, warmed = {}, {}, {}, {}
    for index in itertools.product(*(range(len(values)) for values in axes.values())):
        chosen = {axis: axes[axis][k] for axis, k in zip(axes, index, strict=True)}
        place = {axis: label(value) for axis, value in chosen.items()}
        name = _folder_name(place)
        if name in studies:
            raise InvalidInput("[grid]", name, "values that make different names of folders")
        studies[name], options[name] = _built(builder, f"[grid] {name}", {**base, **chosen})
        named[index], places[name] = name, place
        before = _before(index, [list(axes).index(axis) for axis in along])
        if before is not None:
            warmed[name] = named[before]
    return SweepFile(studies, warmed, options, refine, places)


def _before(index: tuple[int, ...], along: list[int]) -> tuple[int, ...] | None:
    """The neighbour that comes before on the first axis in `along` that has one."""
    for axis in along:
        if index[axis] > 0:
            return (*index[:axis], index[axis] - 1, *index[axis + 1 :])
    return None


def _folder_name(place: Mapping[str, Any]) -> str:
    words = [
        f"{axis}={x:.12g}" if isinstance(x, float) else f"{axis}={x}" for axis, x in place.items()
    ]
    return re.sub(r"[^\w.=+,()~-]+", "_", ",".join(words), flags=re.ASCII)


def _listed(
    builder: Statements, base: Mapping[str, Any], entries: list[Any], refine: bool
) -> SweepFile:
    studies, options, warm = {}, {}, {}
    for number, entry in enumerate(entries, 1):
        where = f"[[study]] {number}"
        if not isinstance(entry, Mapping) or not isinstance(entry.get("name"), str):
            given = entry.get("name") if isinstance(entry, Mapping) else entry
            raise InvalidInput(f"{where}: name", given, "a name, text in quotes")
        name = entry["name"]
        if name in studies:
            raise InvalidInput(f"{where}: name", name, "another name than those before")
        statements = {key: x for key, x in entry.items() if key not in ("name", "warm")}
        statements = {**base, **_section(f"{where}, {name}", statements)}
        studies[name], options[name] = _built(builder, f"{where}, {name}", statements)
        if "warm" in entry:
            warm[name] = entry["warm"]
    return SweepFile(studies, warm, options, refine, None)


def _built(
    builder: Statements, where: str, statements: Mapping[str, Any]
) -> tuple[GaitStudy, SolverOptions]:
    try:
        return builder.study(statements)
    except DrakegaitError as error:
        raise BadFile(where, str(error)) from None
