"""Steps and times of a gait, as gait laboratories list them."""

from __future__ import annotations

import numpy as np

from drakegait.report.curves import SIDES, GaitCurves
from drakegait.report.measures import Measure, both_sides

SWING_MIDDLE = (0.25, 0.75)
"""Part of swing in which the clearance of the toe is sought, as shares of its duration."""


def spatiotemporal(curves: GaitCurves) -> tuple[Measure, ...]:
    """Speed, steps, times, widths and clearance.

    A side's step ends with the heel strike of that side: the right step length is how far the
    right ankle lands ahead of the left one, the right step time lasts from left to right heel
    strike. Stance, swing and single support are shares of the side's own cycle; double support
    is the sum of both periods.

    Args:
        curves: of one gait; many samples (1001) for the clearance.
    """
    gait, period = curves.gait, curves.gait.stride_time
    placement = gait.placement
    spatial = gait.study.skeleton_kind == "spatial"
    steps = {"right": placement.step_length_right, "left": placement.step_length_left}
    left_strike = curves.heel_strike("left") / 100.0
    times = {"right": (1.0 - left_strike) * period, "left": left_strike * period}
    stance = {side: curves.toe_off(side) for side in SIDES}
    single = {side: 100.0 - stance[other] for side, other in zip(SIDES, SIDES[::-1], strict=True)}
    clearance = {side: 100.0 * toe_clearance(curves, side) for side in SIDES}
    found = [
        Measure("speed", "Walking speed", "m/s", gait.speed),
        Measure("cadence", "Cadence", "steps/min", 120.0 / period, digits=1),
        Measure("stride_time", "Stride time", "s", period, digits=3),
        Measure("stride_length", "Stride length", "m", gait.stride_length, digits=3),
        *both_sides("step_length", "Step length", "m", steps["right"], steps["left"], 3),
        *both_sides("step_time", "Step time", "s", times["right"], times["left"], 3),
        *both_sides("stance_time", "Stance time", "s", *(
            0.01 * stance[side] * period for side in SIDES), 3),
        *both_sides("stance", "Stance", "% of cycle", stance["right"], stance["left"], 1),
        *both_sides("swing", "Swing", "% of cycle", *(100.0 - stance[s] for s in SIDES), 1),
        *both_sides(
            "single_support", "Single support", "% of cycle", single["right"], single["left"], 1
        ),
        Measure(
            "double_support", "Double support, both periods", "% of cycle",
            stance["right"] + stance["left"] - 100.0, digits=1,
        ),
    ]  # fmt: skip
    if spatial:
        out = np.degrees([-placement.toe_angle_right, placement.toe_angle_left])
        width = 100.0 * placement.step_width
        found.append(Measure("step_width", "Step width, of the ankles", "cm", width, digits=1))
        found += both_sides("toe_out", "Foot progression angle, toe-out +", "°", *out, 1)
    found += both_sides(
        "toe_clearance", "Toe clearance, lowest in mid-swing", "cm", *clearance.values(), 1
    )
    rise = 100.0 * float(np.ptp(curves.data.centre_of_mass.sel(axis="z").values))
    found.append(
        Measure("centre_of_mass_rise", "Rise and fall of the centre of mass", "cm", rise, digits=1)
    )
    return tuple(found)


def toe_clearance(curves: GaitCurves, side: str) -> float:
    """Lowest height of the toe point (metatarsal line) in the middle half of swing [m]."""
    toe = curves.data.contact_points.sel(contact_point=f"toe_{side[0]}", axis="z").values
    percent, height = curves.own_cycle(side, toe)
    start = curves.toe_off(side)
    low, high = (start + share * (100.0 - start) for share in SWING_MIDDLE)
    return float(height[(percent >= low) & (percent <= high)].min())
