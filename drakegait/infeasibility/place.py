"""Where a law has to break: the instant, the joint or foot, and the muscles that can do no more."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from drakegait.infeasibility.conflict import Relaxation, Relaxed
from drakegait.infeasibility.laws import MUSCLES, SIDES
from drakegait.program.gait_program import GaitProgram
from drakegait.walker import coordinates, feet
from drakegait.walker.coordinates import without_side

_SATURATED = 0.9  # of full excitation or activation
# An excitation that follows from a spline swings about its limit: it counts where it comes to it
# within this part of the stride.
_NEARBY = 0.02
_LITTLE = 0.5  # of the tolerance: a lack that does not count
_TURNS = {  # towards + and - in anatomical sense
    "hip_flexion": ("hip flexion", "hip extension"),
    "hip_adduction": ("hip adduction", "hip abduction"),
    "hip_rotation": ("internal hip rotation", "external hip rotation"),
    "knee_flexion": ("knee flexion", "knee extension"),
    "ankle_dorsiflexion": ("ankle dorsiflexion", "ankle plantarflexion"),
}
_LEG_DOES = (  # the right leg in each phase; the left four phases later
    "takes the load", "comes to stand flat", "stands alone", "rises on its toes",
    "pushes off", "pushes off", "swings", "swings",
)  # fmt: skip


@dataclass(frozen=True)
class Place:
    """Where a walk that gives up one law breaks it most.

    Attributes:
        law: the law that was given up.
        what: for muscles the joint and the direction that lacks; for other laws what is wrong, as
            a clause.
        when: phase or event, and what the leg does there; empty for the whole stride.
        percent: of the stride; nan for the whole stride.
        missing: how much is missing, above zero.
        unit: of `missing`.
        muscles: abbreviations of the muscles that pull this way and are at full excitation.
        helpers: names of all muscles that pull this way there.
        moment: what those pull [N m].
    """

    law: str
    what: str
    when: str
    percent: float
    missing: float
    unit: str
    muscles: tuple[str, ...] = ()
    helpers: tuple[str, ...] = ()
    moment: float = 0.0

    @property
    def sentence(self) -> str:
        """In words, without a full stop."""
        at = f" at {self.percent:.0f} % of the stride ({self.when})" if self.when else ""
        lacks = f" lacks {_two_digits(self.missing)} {self.unit}" if self.law == MUSCLES else ""
        text = f"{self.what}{lacks}{at}"
        if self.muscles:
            text += f": {', '.join(self.muscles)} saturated"
        return text[0].upper() + text[1:]


def place_of(relaxation: Relaxation, relaxed: Relaxed, law: str) -> Place | None:
    """Where `relaxed`, which gave up `law`, breaks it most; None if it keeps it."""
    elastic, number = relaxation.elastic, relaxation.names.index(law)
    own = np.flatnonzero(relaxation.law_of_row == number)
    rows = elastic.ends[own]
    missing = relaxed.missing[own] * elastic.row_scale[rows]
    worst = int(np.argmax(np.abs(missing)))
    if abs(missing[worst]) == 0.0:
        return None
    row, amount = int(rows[worst]), float(missing[worst])
    kind, _, name = elastic.row_names[row].split(" | ", 2)
    point = _point_of(relaxation.program, row)
    x = elastic.unknowns(relaxed.point)
    unit = elastic.row_units[row]
    if point is None:
        clause = _of_stride(relaxation, relaxed, kind, name, amount, unit)
        return Place(law, clause, "", np.nan, abs(amount), unit)
    percent = 100.0 * float(relaxation.program.state(x).tau[point])
    when = _when(relaxation.program, point, name)
    if law == MUSCLES:
        return _of_muscles(relaxation.program, x, point, name, -amount, percent, when)
    clause = _at_point(relaxation.program, x, point, kind, name, amount, unit)
    return Place(law, clause, when, percent, abs(amount), unit)


def short_muscles(relaxation: Relaxation, relaxed: Relaxed) -> tuple[str, ...]:
    """Names of the muscles that are saturated wherever a joint lacks a moment.

    Each joint counts in each direction at the instant of its largest lack; where no muscle that
    pulls this way is saturated, all of them.
    """
    elastic, number = relaxation.elastic, relaxation.names.index(MUSCLES)
    own = np.flatnonzero(relaxation.law_of_row == number)
    worst: dict[tuple[str, bool], tuple[float, int]] = {}
    for position in own:
        row, amount = int(elastic.ends[position]), float(relaxed.missing[position])
        joint = elastic.row_names[row].rpartition(" | ")[2]
        if abs(amount) > max(worst.get((joint, amount > 0.0), (_LITTLE, 0))[0], _LITTLE):
            worst[joint, amount > 0.0] = abs(amount), position
    x = elastic.unknowns(relaxed.point)
    found: set[str] = set()
    for (joint, low), (amount, position) in worst.items():
        row = int(elastic.ends[position])
        point = _point_of(relaxation.program, row)
        assert point is not None  # equations of motion belong to control points
        lack = -amount if low else amount
        place = _of_muscles(
            relaxation.program, x, point, joint, lack * float(elastic.row_scale[row]), 0.0, ""
        )
        known = relaxation.program.formulation.walker.muscles
        short = dict(zip(known.names, known.abbreviations, strict=True))
        full = [name for name in place.helpers if short[name] in place.muscles]
        found |= set(full or place.helpers)
    return tuple(sorted(found))


def _two_digits(number: float) -> str:
    """Two digits that count, without an exponent."""
    return f"{float(f'{number:.2g}'):g}"


def _sided(name: str) -> str:
    """`toe_r z` -> right toe."""
    part = name.split()[0]
    side = SIDES.get(part[-2:], "")
    return f"{side} {without_side(part).replace('_', ' ')}".strip()


def _of_stride(
    relaxation: Relaxation, relaxed: Relaxed, kind: str, name: str, amount: float, unit: str
) -> str:
    """What is wrong with the stride as a whole."""
    values = relaxation.values(relaxed)
    if kind == "average speed":
        return f"the walk reaches {float(values.placement[:2].sum()) / values.stride_time:.2f} m/s"
    what = f"the bound of {name}" if kind == "bound" else f"the {kind} ({name})"
    return f"{what} is off by {_two_digits(abs(amount))} {unit}".strip()


def _at_point(
    program: GaitProgram, x: np.ndarray, point: int, kind: str, name: str, amount: float, unit: str
) -> str:  # fmt: skip
    """What is wrong at a control point, as a clause."""
    size, who = abs(amount), _sided(name)
    if kind == "friction":
        force = program.state(x).ground_reactions[point, 0 if name.endswith("_r") else 1]
        if force[2] > 0.0:
            ratio = float(np.hypot(force[0], force[1]) / force[2])
            return f"the {who} would need friction of {_two_digits(ratio)}"
    if kind == "clearance":
        return f"the {who} is {_two_digits(1e3 * size)} mm in the ground"
    if kind == "foot contact":
        if unit == "m":
            return f"the {who} is {_two_digits(1e3 * size)} mm too far off its print"
        return f"the {who} is turned {_two_digits(np.degrees(size))} degrees too far on its print"
    if kind == "joint limit" and unit == "rad":
        return f"{who} leaves its range by {_two_digits(np.degrees(size))} degrees"
    return f"{kind} of the {who} is off by {_two_digits(size)} {unit}"


def _point_of(program: GaitProgram, row: int) -> int | None:
    """The control point of a row; None if it belongs to the whole stride."""
    for numbers in program.row_numbers:
        found = np.argwhere(numbers == row)
        if len(found):
            return int(found[0, 0])
    return None


def _when(program: GaitProgram, point: int, name: str) -> str:
    """Phase or event, and what the leg of `name` does."""
    phase, share = int(program.points.phases[point]), float(program.points.shares[point])
    words = feet.EVENT_NAMES[phase] if share == 0.0 else feet.PHASE_NAMES[phase]
    side = name.split()[0][-2:]
    if side not in SIDES:
        return words
    leg = (phase + (4 if side == "_l" else 0)) % feet.NUM_PHASES
    return f"{words}; the {SIDES[side]} leg {_LEG_DOES[leg]}"


def _of_muscles(
    program: GaitProgram, x: np.ndarray, point: int, coordinate: str, lack: float, percent: float,
    when: str,
) -> Place:  # fmt: skip
    """`lack`: the generalised moment without a source, plant signs [N m]."""
    walker = program.formulation.walker
    position = walker.coordinate_names.index(coordinate)
    sense = lack * coordinates.anatomical_signs(walker.skeleton.kind)[position]
    turn = _TURNS[without_side(coordinate)][0 if sense > 0.0 else 1]
    state = program.state(x)
    inputs = state.muscle_inputs[point]
    apart = np.abs((state.tau - state.tau[point] + 0.5) % 1.0 - 0.5)
    states = walker.muscle_functions.states(state.muscle_inputs[apart <= _NEARBY])
    effort = np.maximum(states["excitation"], states["activation"]).max(axis=0)
    arms = walker.muscles.moment_arms[:, position]
    pulls = arms * lack > 0.0
    full = np.flatnonzero(pulls & (effort >= _SATURATED))
    order = full[np.argsort(-np.abs(arms * inputs[:, 0])[full])]
    return Place(
        MUSCLES,
        f"{SIDES[coordinate[-2:]]} {turn}",
        when,
        percent,
        abs(lack),
        "N m",
        tuple(walker.muscles.abbreviations[i] for i in order),
        tuple(walker.muscles.names[i] for i in np.flatnonzero(pulls)),
        float(np.abs(arms[pulls]) @ inputs[pulls, 0]),
    )
