"""What may be in conflict: the rows and bounds of a program in groups that a walker would name.

Muscles are given up by letting a moment without a source act at the joints ("reserve"), which is
more than any excitation could do; excitations themselves therefore stay within their bounds. So do
the rows that define the contact forces by least squares (eq. 17): a reserve fills what is left.
The laws of mechanics are a group that is never given up. Without them anything moves, and no
change of a study would do what giving them up does.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from drakegait.errors import InvalidInput
from drakegait.program.design import PHASE_DURATIONS, STEP_LENGTHS, STEP_WIDTHS, STRIDE_TIMES
from drakegait.program.elastic import ElasticProgram
from drakegait.program.formulation import JointLimit
from drakegait.program.gait_program import GaitProgram
from drakegait.walker.coordinates import TRANSLATIONS, without_side

MUSCLES, SPEED, FRICTION, ASYMMETRY = "muscles", "speed", "friction", "asymmetry"
MECHANICS = "mechanics"
STEPS, PHASES, RANGE = "steps", "phase durations", "range of "
SIDES = {"_r": "right", "_l": "left"}
# Price of one unit of a law that is given up. Friction costs by what slips, not by how slippery the
# ground is: the price of a squared body weight.
_CHEAP, _CHEAP_FRICTION = 2e-3, 0.02


@dataclass(frozen=True, eq=False)
class Law:
    """One group of rows and bounds.

    Attributes:
        name: `"muscles"`, `"speed"`, ..., `"range of knee_flexion"`.
        words: what it demands, to be read after "cannot all hold:".
        stated: whether the study states it; else it holds for every walk.
        rows: mask of the program's rows (num_constraints,).
        variables: mask of the unknowns whose bounds belong to it (num_variables,).
    """

    name: str
    words: str
    stated: bool
    rows: np.ndarray
    variables: np.ndarray


def laws_of(program: GaitProgram) -> list[Law]:
    """All groups of `program`, those that a study states first.

    Raises:
        InvalidInput: the equations of motion are bounded by their largest residual alone.
    """
    formulation = program.formulation
    form = formulation.variants.eom_form
    if form != "components":
        raise InvalidInput("eom_form", form, "'components' where a conflict is to be explained")
    rows: dict[str, list[int]] = {}
    for number, name in enumerate(program.row_names):
        rows.setdefault(_law_of_row(name), []).append(number)
    variables: dict[str, list[int]] = {}
    for number, name in enumerate(program.design.names):
        variables.setdefault(_law_of_variable(program, number, name), []).append(number)
    words = _words(program)
    known = [name for name in words if name in rows or name in variables]
    return [
        Law(
            name, *words[name],
            _mask(rows.get(name, ()), program.num_constraints),
            _mask(variables.get(name, ()), program.num_variables),
        )
        for name in known
    ]  # fmt: skip


def cheap_prices(elastic: ElasticProgram) -> np.ndarray:
    """Price of one unit of each soft row where its law is given up (num_soft,)."""
    size = elastic.row_scale[elastic.ends] / elastic.formulation.body_weight**2
    return np.where(elastic.slips, _CHEAP_FRICTION * size, _CHEAP)


def _mask(which: object, size: int) -> np.ndarray:
    mask = np.zeros(size, dtype=bool)
    mask[list(which)] = True  # type: ignore[call-overload]
    return mask


_ROWS = {
    "foot contact": MECHANICS,
    "clearance": MECHANICS,
    "friction": FRICTION,
    "free moment": FRICTION,
    "normal force": MECHANICS,
    "toe torque": "toe torque",
    "average speed": SPEED,
    "phase duration": PHASES,
    "asymmetry": ASYMMETRY,
    "periodic ends": "periodic ends",
}


def _law_of_row(name: str) -> str:
    """The group of a row; empty for excitations and least-squares forces, which always hold."""
    law, _, what = name.split(" | ")
    if law == "equations of motion":
        return MECHANICS if what.startswith("hat_") else MUSCLES
    if law == "joint limit":
        return RANGE + without_side(what)
    return _ROWS.get(law, "")


def _law_of_variable(program: GaitProgram, number: int, name: str) -> str:
    """The group of the bounds of an unknown; empty where they always hold."""
    if name.startswith("contact force") and np.isfinite(program.design.lower[number]):
        return "toe torque" if np.isfinite(program.design.upper[number]) else MECHANICS
    return STEPS if name.startswith("step ") or name == "stride time" else ""


def _words(program: GaitProgram) -> dict[str, tuple[str, bool]]:
    """Words of each group and whether a study states it, in order."""
    formulation = program.formulation
    limited = {without_side(limit.coordinate): limit for limit in formulation.limits}
    ranges = {RANGE + base: (words_of_limits(formulation.limits, base), True) for base in limited}
    ratios = " and ".join(item.describe() for item in formulation.asymmetries)
    shortest, longest = PHASE_DURATIONS
    return {
        MUSCLES: ("the strength of the muscles", True),
        SPEED: (f"a speed of {formulation.speed:g} m/s", True),
        FRICTION: (f"friction of {formulation.contact.friction:g}", True),
        **ranges,
        ASYMMETRY: (ratios, True),
        "toe torque": ("the torque that the toes can bear", True),
        STEPS: (
            f"steps of {STEP_LENGTHS[0]:g} to {STEP_LENGTHS[1]:g} m, no wider than "
            f"{STEP_WIDTHS[1]:g} m, in strides of {STRIDE_TIMES[0]:g} to {STRIDE_TIMES[1]:g} s",
            False,
        ),
        PHASES: (f"contact phases of {shortest:.2g} to {longest:.2g} s", False),
        "periodic ends": ("ends of the curves that agree as in eq. (14)", False),
        MECHANICS: (
            "feet that stand still on the ground, which can only push, and forces in balance", False
        ),
    }


def words_of_limits(limits: Sequence[JointLimit], base: str) -> str:
    """The ranges of a joint's coordinate; of each side where the sides differ."""
    own = [limit for limit in limits if without_side(limit.coordinate) == base]
    sided = {side for limit in own for side in SIDES if limit.coordinate.endswith(side)}
    alike = len({(limit.low, limit.high) for limit in own}) == 1 and len(sided) != 1
    words = []
    for limit in own:
        side = "" if alike else SIDES.get(limit.coordinate[-2:], "")
        words.append(f"{side} {_range_words(base, limit.low, limit.high)}".strip())
    return " and ".join(dict.fromkeys(words))


def _range_words(coordinate: str, low: float, high: float) -> str:
    base = without_side(coordinate)
    factor, unit = (1.0, " m") if base in TRANSLATIONS else (180.0 / np.pi, " degrees")
    if not np.isfinite(low):
        ends = f"of at most {factor * high:.3g}{unit}"
    elif not np.isfinite(high):
        ends = f"of at least {factor * low:.3g}{unit}"
    else:
        ends = f"between {factor * low:.3g} and {factor * high:.3g}{unit}"
    return f"{base.replace('_', ' ')} {ends}"
