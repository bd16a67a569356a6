"""Work of the joints and peaks of angles, moments and powers, leg by leg."""

from __future__ import annotations

import numpy as np

from drakegait.report.curves import SIDES, GaitCurves
from drakegait.report.joint_moments import moment, power
from drakegait.report.measures import Measure, both_sides

JOINTS = ("Hip", "Knee", "Ankle")
_ANGLES = {
    "hip_flexion": ("Hip flexion", "− is extension"),
    "knee_flexion": ("Knee flexion", "− is extension"),
    "ankle_dorsiflexion": ("Ankle dorsiflexion", "− is plantarflexion"),
    "hip_adduction": ("Hip adduction", "− is abduction"),
    "hip_rotation": ("Hip internal rotation", "− is external"),
}


def stride_integral(curves: GaitCurves, rate: np.ndarray) -> float:
    """Integral of a periodic rate (num_samples,) over the stride: the rectangle rule."""
    return float(np.mean(rate[:-1])) * curves.gait.stride_time


def positive_and_negative(curves: GaitCurves, rate: np.ndarray) -> tuple[float, float]:
    """Integrals of the positive part and of the negative part (< 0) of a rate."""
    positive = stride_integral(curves, np.maximum(rate, 0.0))
    return positive, stride_integral(curves, np.minimum(rate, 0.0))


def joint_work(curves: GaitCurves) -> tuple[Measure, ...]:
    """Work over the stride that muscles and passive structures do at each joint [J/kg].

    Amounts: generated is the integral of positive power, which gives energy to the segments,
    absorbed that of negative power. The power of the hip is the sum over its axes. A leg's work is
    the sum over its joints, so that what one absorbs while another generates is not set off.
    """
    found, legs = [], {"generated": [0.0, 0.0], "absorbed": [0.0, 0.0]}
    for joint in JOINTS:
        parts = [positive_and_negative(curves, power(curves, joint, side)) for side in SIDES]
        for which, both in zip(legs, zip(*parts, strict=True), strict=True):
            values = [abs(value) for value in both]
            name, label = f"{joint.lower()}_work_{which}", f"{joint}, work {which}"
            found += both_sides(name, label, "J/kg", *values, 3)
            legs[which] = [a + b for a, b in zip(legs[which], values, strict=True)]
    for which, values in legs.items():
        label = f"Leg, work {which} by all joints"
        found += both_sides(f"leg_work_{which}", label, "J/kg", *values, 3)
    return tuple(found)


def peaks(curves: GaitCurves) -> tuple[Measure, ...]:
    """Extremes of joint angles [deg], ranges, and peaks of moments and powers per body mass."""
    found = []
    for name, (label, negative) in _ANGLES.items():
        both = [curves.coordinate(f"{name}_{side[0]}") for side in SIDES]
        if both[0] is None:
            continue
        found += both_sides(f"{name}_max", f"{label}, maximum", "°", *(x.max() for x in both), 1)
        found += both_sides(
            f"{name}_min", f"{label}, minimum ({negative})", "°", *(x.min() for x in both), 1
        )
        found += both_sides(f"{name}_range", f"{label}, range", "°", *(np.ptp(x) for x in both), 1)
    for name, label, sign in (
        ("hip_flexion", "Hip extensor moment, peak", -1.0),
        ("hip_flexion", "Hip flexor moment, peak", 1.0),
        ("hip_adduction", "Hip abductor moment, peak", -1.0),
        ("knee_flexion", "Knee extensor moment, peak", -1.0),
        ("ankle_dorsiflexion", "Ankle plantarflexor moment, peak", -1.0),
    ):
        both = [moment(curves, f"{name}_{side[0]}") for side in SIDES]
        if both[0] is not None:
            key = f"{label.split(' moment')[0].lower().replace(' ', '_')}_moment"
            found += both_sides(key, label, "N m/kg", *((sign * x).max() for x in both))
    for joint in JOINTS:
        both = [power(curves, joint, side) for side in SIDES]
        name = f"{joint.lower()}_peak_power"
        found += both_sides(name, f"{joint} power, peak generated", "W/kg",
                            *(x.max() for x in both))  # fmt: skip
    return tuple(found)


def ground_impulses(curves: GaitCurves) -> tuple[Measure, ...]:
    """Impulses of the ground reactions over the stride [body weights x s], and peaks [% BW].

    The vertical impulses of both feet add up to the weight times the stride time. Braking is the
    backward force, propulsion the forward one. First and second peak: of the vertical force in the
    first and in the second half of stance.
    """
    vertical, braking, propulsion, first, second = [], [], [], [], []
    for side in SIDES:
        up = curves.ground_reaction(side, "vertical")
        forward = 0.01 * curves.ground_reaction(side, "fore-aft")
        gives, takes = positive_and_negative(curves, forward)
        vertical.append(0.01 * stride_integral(curves, up))
        propulsion.append(gives)
        braking.append(-takes)
        percent, own = curves.own_cycle(side, up)
        middle, end = 0.5 * curves.toe_off(side), curves.toe_off(side)
        first.append(own[(percent >= 0.0) & (percent <= middle)].max())
        second.append(own[(percent >= middle) & (percent <= end)].max())
    return (
        *both_sides("vertical_impulse", "Vertical impulse", "BW s", *vertical, 3),
        *both_sides("braking_impulse", "Braking impulse", "BW s", *braking, 4),
        *both_sides("propulsion_impulse", "Propulsive impulse", "BW s", *propulsion, 4),
        *both_sides("first_peak", "Vertical force, first peak", "% BW", *first, 1),
        *both_sides("second_peak", "Vertical force, second peak", "% BW", *second, 1),
    )
