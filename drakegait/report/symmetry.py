"""How equal the two legs walk: symmetry indices.

    SI = 100 % * (x_right - x_left) / ((x_right + x_left) / 2)

of R. O. Robinson, W. Herzog and B. M. Nigg, "Use of force platform variables to quantify the
effects of chiropractic manipulation on gait symmetry", J. Manipulative Physiol. Ther. 10 (1987)
172-176: 0 for equal legs, above 0 where the right leg has more, at most +-200 %.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from drakegait.report.cost_split import CostSplit
from drakegait.report.curves import SIDES, GaitCurves
from drakegait.report.measures import Measure, find
from drakegait.report.powers import ground_impulses, joint_work
from drakegait.report.spatiotemporal import spatiotemporal
from drakegait.walker import coordinates

INDEXED = (
    "step_length",
    "step_time",
    "stance_time",
    "single_support",
    "vertical_impulse",
    "braking_impulse",
    "propulsion_impulse",
    "leg_work_generated",
    "leg_work_absorbed",
    "leg_cost",
)
"""Measures of both legs of which an index is given."""
UNIT = "SI %"
"""Unit of the indices in tables."""
_CURVES = {
    "hip_flexion": "Hip flexion",
    "knee_flexion": "Knee flexion",
    "ankle_dorsiflexion": "Ankle dorsiflexion",
}
_INSTANTS = 200


def symmetry_index(right: float, left: float) -> float:
    """SI of Robinson et al. (1987) [%]; nan where both are zero.

    Both values must have the same sign: give amounts.
    """
    mean = 0.5 * (right + left)
    return 100.0 * (right - left) / mean if mean else math.nan


def symmetry(
    curves: GaitCurves, measures: Sequence[Measure] = (), split: CostSplit | None = None
) -> tuple[Measure, ...]:
    """Symmetry indices [%], and the mean distance of right and left angle curves [deg].

    The indices are of step length and time (of the step that ends with that side's heel strike),
    stance, single support, ground impulses, work of the leg's joints and metabolic cost of the
    leg's muscles. The distance is the root mean square of right minus left over the cycle, each
    leg on its own.

    Args:
        curves: of one gait.
        measures: its spatio-temporal measures, impulses and work, if they are known already.
        split: its cost by leg, if known already.
    """
    known = list(measures) or [
        *spatiotemporal(curves), *ground_impulses(curves), *joint_work(curves)
    ]  # fmt: skip
    legs = (split or CostSplit.of(curves.gait)).by_side
    known += [
        Measure("leg_cost", "Cost of transport of the leg's muscles", "J/m", float(cost), side)
        for side, cost in zip(SIDES, legs, strict=True)
    ]
    labels = {measure.name: measure.label for measure in known}
    found = []
    for name in INDEXED:
        right, left = (find(known, name, side) for side in SIDES)
        found.append(
            Measure(f"{name}_si", labels[name], UNIT, symmetry_index(right, left), digits=1)
        )
    for name, label in _CURVES.items():
        distance = curve_distance(curves, name)
        text = f"{label}, distance of right and left curve"
        found.append(Measure(f"{name}_distance", text, "°", distance, digits=1))
    return tuple(found)


def curve_distance(curves: GaitCurves, name: str) -> float:
    """Root mean square of right minus left angle over the legs' own cycles [deg]."""
    gait, tau = curves.gait, np.arange(_INSTANTS) / _INSTANTS
    kind = gait.study.skeleton_kind
    both = []
    for side in SIDES:
        row = gait.coordinate_names.index(f"{name}_{side[0]}")
        own = gait.motion(tau + 0.01 * curves.heel_strike(side)).q
        both.append(coordinates.to_anatomical(kind, own)[:, row])
    return float(np.degrees(np.sqrt(np.mean((both[0] - both[1]) ** 2))))
