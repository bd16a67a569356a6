"""Where a law has to break: the instant, the joint or foot, and the muscles that can do no more."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from drakegait.infeasibility.conflict import Relaxation, Relaxed
from drakegait.infeasibility.laws import MUSCLES, without_side
from drakegait.program.gait_program import GaitProgram
from drakegait.walker import coordinates, feet

_SATURATED = 0.9  # of full excitation or activation
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
_SIDES = {"_r": "right", "_l": "left"}


@dataclass(frozen=True)
class Place:
    """Where a walk that gives up one law breaks it most.

    Attributes:
        law: the law that was given up.
        what: joint and direction, foot, or the stride as a whole.
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
        text = f"{self.what} lacks {self.missing:.2g} {self.unit}{at}".replace("  ", " ")
        if self.law != MUSCLES:
            text = f"{self.what} is off by {self.missing:.2g} {self.unit}{at}"
        elif self.muscles:
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
    kind, _, name = elastic.row_names[row].split(" | ")
    point = _point_of(relaxation.program, row)
    x = elastic.unknowns(relaxed.point)
    if point is None:
        what = {"average speed": "the length of a stride", "bound": f"bound of {name}"}
        words = what.get(kind, f"{kind} of {name}")
        return Place(law, words, "", np.nan, abs(amount), elastic.row_units[row])
    percent = 100.0 * float(relaxation.program.state(x).tau[point])
    when = _when(relaxation.program, point, name)
    if law == MUSCLES:
        return _of_muscles(relaxation.program, x, point, name, -amount, percent, when)
    what = f"{kind} of {name.replace('_r', ' right').replace('_l', ' left').replace('_', ' ')}"
    return Place(law, what, when, percent, abs(amount), elastic.row_units[row])


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
    side = next((end for end in ("_r", "_l") if end in name), "")
    if not side:
        return words
    leg = (phase + (4 if side == "_l" else 0)) % feet.NUM_PHASES
    return f"{words}; the {_SIDES[side]} leg {_LEG_DOES[leg]}"


def _of_muscles(
    program: GaitProgram, x: np.ndarray, point: int, coordinate: str, lack: float, percent: float,
    when: str,
) -> Place:  # fmt: skip
    """`lack`: the generalised moment without a source, plant signs [N m]."""
    walker = program.formulation.walker
    position = walker.coordinate_names.index(coordinate)
    sense = lack * coordinates.anatomical_signs(walker.skeleton.kind)[position]
    turn = _TURNS[without_side(coordinate)][0 if sense > 0.0 else 1]
    inputs = program.state(x).muscle_inputs[point]
    states = walker.muscle_functions.states(inputs)
    effort = np.maximum(states["excitation"], states["activation"])
    arms = walker.muscles.moment_arms[:, position]
    pulls = arms * lack > 0.0
    full = np.flatnonzero(pulls & (effort >= _SATURATED))
    order = full[np.argsort(-np.abs(arms * inputs[:, 0])[full])]
    return Place(
        MUSCLES,
        f"{_SIDES[coordinate[-2:]]} {turn}",
        when,
        percent,
        abs(lack),
        "N m",
        tuple(walker.muscles.abbreviations[i] for i in order),
        tuple(walker.muscles.names[i] for i in np.flatnonzero(pulls)),
        float(np.abs(arms[pulls]) @ inputs[pulls, 0]),
    )
