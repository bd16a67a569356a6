"""A gait that has been found, as the reference of another: section 4.2 of the paper."""

from __future__ import annotations

import numpy as np

from drakegait.gait import Gait
from drakegait.reference.curves import SampledCurves, SplineCurves
from drakegait.reference.reference import Reference

_INSTANTS = 401  # of the ground reactions


def reference_of(gait: Gait, name: str) -> Reference:
    """The motion and the ground reactions of a gait, to stay close to.

    Args:
        name: what reports call it.
    """
    data = gait.sample(_INSTANTS)
    forces = data.ground_reaction_force.values.reshape(_INSTANTS, 6).copy()
    forces[[0, -1]] = 0.5 * (forces[0] + forces[-1])  # both are the heel strike
    return Reference(
        kind=gait.study.skeleton_kind,
        name=name,
        stride_time=gait.stride_time,
        phase_fractions=tuple(float(d) for d in gait.phase_durations / gait.stride_time),
        foot_placement=gait.placement,
        motion=SplineCurves(gait.splines, gait.values.coordinate_coefficients),
        forces=SampledCurves(np.linspace(0.0, 1.0, _INSTANTS), forces),
        deviation=gait.study.deviation,
    )
