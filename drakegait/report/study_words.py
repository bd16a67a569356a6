"""Studies in words: names without underscores, and what makes one walker differ from another."""

from __future__ import annotations

import dataclasses
import math
import re
from collections import Counter
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from drakegait.settings import Settings
from drakegait.walker.coordinates import TRANSLATIONS
from drakegait.walker.muscles import ENTRY_UNITS

if TYPE_CHECKING:
    from drakegait.study import GaitStudy

SIDES = {"_r": "right", "_l": "left"}
_SEGMENTS = {"hat": "trunk"}
# Statements that have a sentence of their own below.
_TOLD = {"subject", "added_masses", "strength", "disorders", "limits", "reference", "sdf", "nodes",
         "speed", "model", "energy_weight", "deviation_weight", "planar_muscles",
         "muscle_changes", "interior_points"}  # fmt: skip


def spoken(name: str) -> str:
    """A name in words: `soleus_l` is "left soleus", `foot_r` "right foot", `hat` "trunk"."""
    side = SIDES.get(name[-2:])
    stem = (name[:-2] if side else name).replace("_", " ")
    stem = _SEGMENTS.get(stem, stem)
    return f"{side} {stem}" if side else stem


def brief(phrase: str) -> str:
    """Without what stands in brackets, for a name."""
    return re.sub(r" \([^()]*\)", "", phrase)


def worn(study: GaitStudy) -> list[str]:
    """What the walker wears, one phrase for each mass."""
    return [
        f"{item.mass:g} kg on the {spoken(item.segment)}"
        + ("" if item.point is None else f" at ({', '.join(f'{x:g}' for x in item.point)}) m")
        for item in study.added_masses
    ]


def strengths(study: GaitStudy) -> list[str]:
    """Muscles that are not as strong as the table says."""
    muscles = study.walker.muscles
    groups = {
        short: name[:-2] for short, name in zip(muscles.abbreviations, muscles.names, strict=True)
    }
    found = []
    for name, factor in study.strength.items():
        side = SIDES.get(name[-2:])
        muscle = spoken(name) if side else f"{spoken(groups.get(name, name))} of both legs"
        found += [f"{muscle} at {100.0 * factor:g} % of its force"] if factor != 1.0 else []
    return found


def entries(study: GaitStudy) -> list[str]:
    """Entries of the muscle table that are other ones."""
    return [
        f"{entry} of {muscle} {value:g} {ENTRY_UNITS[entry]}".rstrip(" -")
        for muscle, changed in study.muscle_changes.items()
        for entry, value in changed.items()
    ]


def disorders(study: GaitStudy) -> list[str]:
    """Disorders in their own words."""
    return [item.describe() for item in getattr(study, "disorders", ())]


def limits(study: GaitStudy) -> list[str]:
    """Joints that are kept within a range."""
    found = []
    for limit in study.limits:
        turn = limit.coordinate not in TRANSLATIONS
        low, high = (math.degrees(x) if turn else x for x in (limit.low, limit.high))
        found.append(
            f"{spoken(limit.coordinate)} kept from {low:.3g} to {high:.3g} {'°' if turn else 'm'}"
        )
    return found


_STATEMENTS = (worn, strengths, entries, disorders, limits)


def who(study: GaitStudy, longest: int | None = None) -> str:
    """The walker in a phrase; of what does not fit into `longest` characters it says "and more"."""
    subject = study.subject
    phrases = [f"{study.model} walker, {subject.height:.2f} m, {subject.mass:g} kg"]
    for phrase in peculiar(study):
        if longest is not None and len(", ".join([*phrases, phrase])) > longest:
            return ", ".join([*phrases, "and more"])
        phrases.append(phrase)
    return ", ".join(phrases)


def peculiar(study: GaitStudy) -> list[str]:
    """What this walker wears, has and lacks, a phrase each."""
    return [phrase for phrases in _STATEMENTS for phrase in phrases(study)]


def differences(base: GaitStudy, other: GaitStudy) -> list[str]:
    """What distinguishes `other` from `base`, statement by statement; empty if nothing does.

    Control points are no statement about a walker and left out. What `other` has comes first, what
    only `base` has begins with "without", and everything that is a number says both values.
    """
    found: list[str] = []
    for phrases in _STATEMENTS:
        mine, theirs = Counter(phrases(other)), Counter(phrases(base))
        found += (mine - theirs).elements()
        found += [f"without {text}" for text in (theirs - mine).elements()]
    found += _subject(base, other)
    for name, unit, text in (
        ("speed", " m/s", "walking at {mine} instead of {theirs}"),
        ("model", "", "a {mine} instead of a {theirs} walker"),
        ("nodes", "", "{mine} nodes instead of {theirs}"),
        ("planar_muscles", "", "muscle table {mine} instead of {theirs}"),
        ("energy_weight", "", "weight of energy {mine} instead of {theirs}"),
        ("deviation_weight", "", "weight of the deviation {mine} instead of {theirs}"),
    ):
        mine, theirs = getattr(other, name), getattr(base, name)
        if mine != theirs:
            found.append(
                text.format(mine=f"{_plain(mine)}{unit}", theirs=f"{_plain(theirs)}{unit}")
            )
    if base.sdf != other.sdf:
        found.append("another SDF model")
    mine, theirs = (study.reference_walk.name for study in (other, base))
    if mine != theirs or (base.reference is None) != (other.reference is None):
        found.append(f'reference walk "{mine}" instead of "{theirs}"')
    elif base.reference is not None and base.reference is not other.reference and not _same_walk(
        base, other
    ):  # fmt: skip
        found.append("another reference walk of the same name")
    for item in dataclasses.fields(base):
        if item.name not in _TOLD:
            found += _statement(item.name, getattr(base, item.name), getattr(other, item.name))
    return found


def _same_walk(base: GaitStudy, other: GaitStudy) -> bool:
    import numpy as np

    tau = np.linspace(0.0, 1.0, 50, endpoint=False)
    first, second = (study.reference_walk.coordinate_values(tau) for study in (base, other))
    return bool(np.allclose(first, second, atol=1e-5))


def _subject(base: GaitStudy, other: GaitStudy) -> list[str]:
    found = []
    for name, unit in (("height", " m"), ("mass", " kg"), ("anthropometry", "")):
        mine, theirs = getattr(other.subject, name), getattr(base.subject, name)
        if mine != theirs:
            title = {"height": "body height", "mass": "body mass"}.get(name, name)
            found.append(f"{title} {_plain(mine)}{unit} instead of {_plain(theirs)}{unit}")
    return found


def _statement(name: str, theirs: Any, mine: Any) -> list[str]:
    """A statement without words of its own: its name and both values."""
    if mine == theirs:
        return []
    if isinstance(mine, Settings):
        return [
            text
            for item in dataclasses.fields(mine)
            for text in _constant(item, getattr(theirs, item.name), getattr(mine, item.name))
        ]
    return [f"{name.replace('_', ' ')} {_plain(mine)} instead of {_plain(theirs)}"]


def _constant(item: dataclasses.Field, theirs: Any, mine: Any) -> list[str]:
    if mine == theirs:
        return []
    unit = item.metadata.get("unit", "")
    unit = "" if unit in ("", "-") else f" {unit}"
    meaning = item.metadata.get("meaning", item.name.replace("_", " "))
    return [f"{item.name} {_plain(mine)}{unit} instead of {_plain(theirs)}{unit} ({meaning})"]


def _plain(value: Any) -> str:
    if isinstance(value, bool) or value is None:
        return {True: "on", False: "off", None: "default"}[value]
    if isinstance(value, float):
        return f"{value:g}"
    if isinstance(value, Mapping):
        return ", ".join(f"{key} {_plain(item)}" for key, item in value.items()) or "none"
    if isinstance(value, (tuple, list)):
        return "(" + ", ".join(_plain(item) for item in value) + ")"
    return str(value)
