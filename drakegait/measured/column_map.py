"""Which column of a table is what: the file behind `--columns`.

TOML (or JSON with the same structure):

    angle_unit = "deg"                      # or "rad"; default: by the range of the knee
    [axes]                                  # of positions and forces; default: OpenSim's
    forward = "x"                           # x, y, z, -x, -y or -z
    up = "y"
    [columns]                               # our name = theirs
    time = "Time (ms)"
    hip_flexion_r = "RHip_X"
    knee_angle_r = { column = "RKnee_X", factor = -1.0 }
    ground_force_r_vx = "Fx1"
    [markers]                               # of a C3D file: name in Plug-in Gait = theirs
    RASI = "R.ASIS"
    [sides]                                 # foot on a plate whose name does not say it
    ground_force_1_ = "r"
"""

from __future__ import annotations

import json
import tomllib
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from drakegait.errors import BadFile, InvalidInput, UnknownName
from drakegait.measured.table import read_text

_KEYS = ("angle_unit", "axes", "columns", "markers", "sides")
_AXES = ("x", "y", "z", "-x", "-y", "-z")


@dataclass(frozen=True, kw_only=True)
class ColumnMap:
    """What a user says about the columns of a file.

    Attributes:
        columns: (heading in the file, factor) by our name.
        degrees: whether angles are in degrees; None if not said.
        axes: forward and up axis of the file's positions and forces; None if not said.
        sides: foot by group of force columns.
        markers: label in a C3D file by the name of Plug-in Gait.
    """

    columns: Mapping[str, tuple[str, float]] = field(default_factory=dict)
    degrees: bool | None = None
    axes: tuple[str, str] | None = None
    sides: Mapping[str, str] = field(default_factory=dict)
    markers: Mapping[str, str] = field(default_factory=dict)


def read_map(path: str | Path) -> ColumnMap:
    """Read a map of columns.

    Raises:
        BadFile: not TOML or JSON.
        UnknownName, InvalidInput: a key or value that means nothing.
    """
    text = read_text(path)
    in_json = Path(path).suffix.lower() == ".json"
    language, parse = ("JSON", json.loads) if in_json else ("TOML", tomllib.loads)
    try:
        plain = parse(text)
    except ValueError as error:
        raise BadFile(path, f"is not {language}: {error}") from None
    if not isinstance(plain, dict):
        raise BadFile(path, "is not a table of names.")
    for key in plain:
        if key not in _KEYS:
            raise UnknownName(f"key in {path}", key, _KEYS)
    sections = {key: plain.get(key, {}) for key in ("columns", "sides", "markers")}
    for key, section in sections.items():
        if not isinstance(section, dict):
            raise InvalidInput(key, section, "a table of names")
    unit = plain.get("angle_unit")
    if unit not in (None, "deg", "rad"):
        raise UnknownName("angle_unit", unit, ("deg", "rad"))
    return ColumnMap(
        columns={name: _column(name, value) for name, value in sections["columns"].items()},
        degrees=None if unit is None else unit == "deg",
        axes=_axes(plain.get("axes")),
        sides={name: _side(name, value) for name, value in sections["sides"].items()},
        markers={name: _label(name, value) for name, value in sections["markers"].items()},
    )


def axes_matrix(axes: tuple[str, str]) -> np.ndarray:
    """Matrix (3, 3) from a file's axes, by its forward and up axis, to ours: x forward, z up."""

    def unit(name: str) -> np.ndarray:
        vector = np.zeros(3)
        vector["xyz".index(name[-1])] = -1.0 if name.startswith("-") else 1.0
        return vector

    forward, up = (unit(name) for name in axes)
    return np.stack([forward, np.cross(up, forward), up])


def _column(name: str, value: Any) -> tuple[str, float]:
    if isinstance(value, str):
        return value, 1.0
    allowed = 'a heading, or { column = "heading", factor = number }'
    if not isinstance(value, dict) or not isinstance(value.get("column"), str):
        raise InvalidInput(f"columns.{name}", value, allowed)
    factor = value.get("factor", 1.0)
    if set(value) - {"column", "factor"} or isinstance(factor, bool) or not isinstance(
        factor, (int, float)
    ) or factor == 0:  # fmt: skip
        raise InvalidInput(f"columns.{name}", value, allowed)
    return value["column"], float(factor)


def _label(name: str, value: Any) -> str:
    if not isinstance(value, str) or not value.strip():
        raise InvalidInput(f"markers.{name}", value, "the label of a marker in the file")
    return value


def _axes(plain: Any) -> tuple[str, str] | None:
    if plain is None:
        return None
    allowed = f"forward and up, each one of {', '.join(_AXES)}, at right angles"
    if not isinstance(plain, dict) or set(plain) != {"forward", "up"}:
        raise InvalidInput("axes", plain, allowed)
    forward, up = (str(plain[key]).lstrip("+").lower() for key in ("forward", "up"))
    if forward not in _AXES or up not in _AXES or forward[-1] == up[-1]:
        raise InvalidInput("axes", plain, allowed)
    return forward, up


def _side(name: str, value: Any) -> str:
    short = str(value).lower()[:1]
    if short not in ("r", "l"):
        raise UnknownName(f"sides.{name}", value, ("right", "left"))
    return short
