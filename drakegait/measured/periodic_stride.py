"""One stride cut out of a recording and closed, on the model's cycle from right heel strike."""

from __future__ import annotations

import numpy as np

from drakegait.measured.posture import Posture
from drakegait.measured.strides import Stride
from drakegait.reference.periodicity import fit_periodic
from drakegait.transcription.splines import PeriodicQuintic
from drakegait.walker.coordinates import names

_NODES = 41  # for the measured curves: twice the harmonics that a 6 Hz filter leaves
_ROWS = 201
_DRIFT = 0.1  # of a curve's range: a larger difference of the ends is a drift, taken out first


def periodic_stride(
    posture: Posture, stride: Stride, belt: float, tau: np.ndarray
) -> tuple[np.ndarray, np.ndarray, float]:
    """The measured coordinates of one stride, made periodic.

    The belt's way is added to hat_x, the steady advance is taken out. Ends that differ by up to a
    tenth of a curve's range are closed by eq. (14) of Garcia-Vallejo & Schiehlen (2012), which
    changes the two samples at either end; a larger difference, which this would make a
    kink, is first taken out as a linear drift.

    Args:
        tau: (K,) fractions of the cycle since right heel strike.

    Returns:
        Coordinates (K, 16) in plant signs, gaps of the ends (16,), and the stride length [m].
    """
    share = np.linspace(0.0, 1.0, _ROWS)
    values = posture.series.at(stride.start + share * stride.duration)
    values[:, 0] += belt * stride.duration * share
    if not posture.place[0]:
        values[:, 0] = belt * stride.duration * share
    length = float(values[-1, 0] - values[0, 0])
    values[:, 0] -= length * share
    gaps = values[-1] - values[0]
    drifts = np.abs(gaps) > _DRIFT * np.ptp(values, axis=0)
    values -= np.where(drifts, gaps, 0.0) * (share[:, None] - 0.5)
    spline = PeriodicQuintic(_NODES)
    closed = fit_periodic(spline, share, values.T, names("spatial"))
    offset = (stride.right_strike - stride.start) / stride.duration
    return spline.evaluate(closed, tau + offset).T, gaps, length


def first_placement(points: np.ndarray, flat: dict[str, np.ndarray], length: float):
    """Footprints that the measured feet suggest, and where the first right one lies.

    Args:
        points: (K, 4, 3) of the stride in the world, hat_x with the advance [m].
        flat: masks (K,) of the instants at which the right, the left foot is flat.
        length: of the stride [m].

    Returns:
        Step length right, left, toe angles right, left, step width, and x, y, z of the origin.
    """
    heading, ankle = {}, {}
    for foot, side in enumerate("rl"):
        heel, toe = points[flat[side], 2 * foot], points[flat[side], 2 * foot + 1]
        along = np.mean(toe - heel, axis=0)
        heading[side] = float(np.arctan2(along[1], along[0]))
        # the ankle stands 0.06 m before the heel of a sole of 0.202 m
        ankle[side] = np.mean(heel + 0.06 / 0.202 * (toe - heel), axis=0)
    step_left = float((ankle["l"] - ankle["r"])[0])
    width = float((ankle["l"] - ankle["r"])[1])
    origin = np.array([ankle["r"][0], 0.5 * (ankle["r"][1] + ankle["l"][1]),
                       0.5 * (ankle["r"][2] + ankle["l"][2])])  # fmt: skip
    return (length - step_left, step_left, heading["r"], heading["l"], width), origin
