"""Disorders as they are typed: by the command line and in the file of a sweep."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Mapping, Sequence

from drakegait.errors import InvalidInput
from drakegait.walker import disorders as dis

Texts = Sequence[str] | None

_NUMBER = r"([-+]?[\d.]+(?:[eE][-+]?\d+)?)"


def read_disorders(given: Mapping[str, Texts]) -> tuple[dis.Disorder, ...]:
    """What was typed, by name of the option without dashes, as disorders.

    Raises:
        InvalidInput, UnknownName: the first that cannot be used.
    """
    found = []
    for name, texts in given.items():
        form, read = READERS[name]
        option = "--" + name.strip("_").replace("_", "-")
        for text in texts or ():
            found.append(read(option, text, f"{form[0]}, for example {form[1]}"))
    return tuple(found)


def _split(option: str, text: str, allowed: str) -> tuple[str, str, str]:
    """Name without side, side, and what stands behind the sign of equality."""
    name, equals, value = (part.strip() for part in text.partition("="))
    if not equals or not name or not value:
        raise InvalidInput(option, text, allowed)
    if name[-2:] in ("_r", "_l"):
        return name[:-2], name[-1], value
    return name, "both", value


def _numbers(option: str, text: str, value: str, pattern: str, allowed: str) -> list[float | None]:
    """The numbers where `pattern` has N; None for optional parts that are missing."""
    match = re.fullmatch(pattern.replace("N", _NUMBER), value)
    try:
        return [None if part is None else float(part) for part in match.groups()]  # type: ignore[union-attr]
    except (AttributeError, ValueError):
        raise InvalidInput(option, text, allowed) from None


def _one_number(
    make: Callable[[str, str, float], dis.Disorder],
) -> Callable[[str, str, str], dis.Disorder]:
    def read(option: str, text: str, allowed: str) -> dis.Disorder:
        name, side, value = _split(option, text, allowed)
        return make(name, side, _numbers(option, text, value, "N", allowed)[0])  # type: ignore[arg-type]

    return read


def _stiffness(option: str, text: str, allowed: str) -> dis.Disorder:
    name, side, value = _split(option, text, allowed)
    numbers = _numbers(option, text, value, "N(?:@N)?(?::N)?", allowed)
    return dis.JointStiffness(name, side, *(x or 0.0 for x in numbers))


def _range(option: str, text: str, allowed: str) -> dis.Disorder:
    name, side, value = _split(option, text, allowed)
    low, high = _numbers(option, text, value, "N?:N?", allowed)
    if low is None and high is None:
        raise InvalidInput(option, text, allowed)
    return dis.LimitedRange(
        name, side, -math.inf if low is None else low, math.inf if high is None else high
    )


def _prosthesis(option: str, text: str, allowed: str) -> dis.Disorder:
    name, side, value = _split(option, text, allowed)
    category, angle = _numbers(option, text, value.removeprefix("category"), "N(?:@N)?", allowed)
    if name != "transtibial" or category != int(category):  # type: ignore[arg-type]
        raise InvalidInput(option, text, allowed)
    return dis.Prosthesis(side, int(category), angle or 0.0)  # type: ignore[arg-type]


def _orthosis(option: str, text: str, allowed: str) -> dis.Disorder:
    name, side, value = _split(option, text, allowed)
    stiffness, angle, mass = _numbers(option, text, value, r"N(?:@N)?(?:\+N)?", allowed)
    if name != "ankle":
        raise InvalidInput(option, text, allowed)
    return dis.Orthosis(side, stiffness, angle or 0.0, mass=mass or 0.0)  # type: ignore[arg-type]


def _asymmetry(option: str, text: str, allowed: str) -> dis.Disorder:
    name, side, value = _split(option, text, allowed)
    if side != "both":
        raise InvalidInput(option, text, allowed)
    return dis.Asymmetry(name, _numbers(option, text, value, "N", allowed)[0])  # type: ignore[arg-type]


READERS: dict[str, tuple[tuple[str, str], Callable[[str, str, str], dis.Disorder]]] = {
    "weakness": (("MUSCLE=SHARE with a number", "soleus_l=0.5"), _one_number(dis.Weakness)),
    "contracture": (
        ("MUSCLE=LENGTH with a number", "gastrocnemius_r=0.9"), _one_number(dis.Contracture)
    ),
    "spasticity": (
        ("MUSCLE=EXCITATION with a number", "hamstrings_l=0.1"), _one_number(dis.Spasticity)
    ),
    "stiffness": (
        ("JOINT=K[@DEGREES][:DAMPING] with numbers [N m/rad, N m s/rad]", "ankle_r=40@-5:0.5"),
        _stiffness,
    ),
    "range_": (("JOINT=LOW:HIGH with numbers [degrees]", "knee_l=5:45"), _range),
    "leg_length": (("SEGMENT=M with a number [m]", "shank_l=-0.02"), _one_number(dis.LegLength)),
    "prosthesis": (
        ("transtibial_SIDE=CATEGORY[@DEGREES] with whole category 1 to 9", "transtibial_r=4"),
        _prosthesis,
    ),
    "orthosis": (
        ("ankle_SIDE=K[@DEGREES][+KG] with numbers [N m/rad, kg]", "ankle_l=60@5+0.4"), _orthosis
    ),
    "asymmetry": (
        ("step_length=RATIO or stance_time=RATIO, right over left", "step_length=1.1"), _asymmetry
    ),
    "pain": (("PLACE=WEIGHT with a number", "foot_r=2"), _one_number(dis.Pain)),
}  # fmt: skip
"""Form and reader of each option."""
