"""Walkers that cannot do what is asked, and what relaxes them."""

from __future__ import annotations

import functools
import math

from drakegait.infeasibility.conflict import Relaxation
from drakegait.program.gait_program import GaitProgram
from drakegait.program.guess import guess_from_reference
from drakegait.solvers.monitor import Monitor
from drakegait.study import GaitStudy

# A walk as small as a walk can be.
TINY = GaitStudy.planar_symmetric(11, interior_points=(3, 2, 6, 5))


def limited(study: GaitStudy, joint: str, low: float, high: float) -> GaitStudy:
    """Both sides within [low, high] [degrees]."""
    low, high = math.radians(low), math.radians(high)
    for side in ("r", "l"):
        study = study.with_limit(f"{joint}_{side}", low, high)
    return study


def weak(study: GaitStudy, factor: float) -> GaitStudy:
    """All muscles of so much strength."""
    return study.replace(strength=dict.fromkeys(study.walker.muscles.abbreviations, factor))


@functools.cache
def relaxation_of(name: str) -> Relaxation:
    """The elastic program of one of `STUDIES`, unsolved."""
    study = STUDIES[name]
    program = GaitProgram(study.formulation())
    values = program.values(guess_from_reference(program))
    return Relaxation(study, values, Monitor(600.0))


STUDIES = {
    "plain": TINY,
    "limited": limited(TINY, "knee_flexion", 0.0, 30.0),
    "weak": weak(TINY, 0.15),
}
