"""Events that reach the end of their window: the same program about where they are now.

Events are bounded about centres so that every control point keeps its window of spline
coefficients (`control_points`). Those bounds are no law of walking; they move along with the
events. Nothing else changes: the unknowns, rows and their values stay what they were.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from drakegait.program.gait_program import GaitProgram

MOST_RECENTRINGS = 3  # of a round that has ended
AT_BOUND = 0.98  # of the reach of an event

def far_from_centres(program: GaitProgram, events: np.ndarray, share: float) -> bool:
    """Whether an event is further from its centre than `share` of its reach.

    Args:
        events: fractions of the cycle (8,).
    """
    formulation = program.formulation
    moved = np.abs(events - np.array(formulation.event_centres))
    return bool(np.any(moved > share * formulation.event_reach))


def recentred(program: GaitProgram, x: np.ndarray, share: float) -> GaitProgram | None:
    """`program` with its events bounded about those of `x`.

    Args:
        x: design vector.
        share: of the reach of an event; None is returned where all are nearer to their centres.
    """
    events = program.values(x).events
    if not far_from_centres(program, events, share):
        return None
    centres = tuple(float(event) for event in events)
    other = type(program)(replace(program.formulation, event_centres=centres))
    other.smoothing = program.smoothing
    return other
