"""What is measured on gaits: numbers that a claim of the paper is about."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from drakegait.gait import Gait
from drakegait.quantities import GRAVITY
from drakegait.report.curves import GaitCurves
from drakegait.walker.coordinates import TRANSLATIONS

ACTIVE = 0.10
"""Excitation above which a muscle counts as active, for how wide its bursts are."""
LATE = 0.25
"""Last part of a stance that counts as its end."""


def angle_names(gait: Gait) -> list[str]:
    """All coordinates that are angles."""
    return [name for name in gait.coordinate_names if name not in TRANSLATIONS]


def angles(gait: Gait, names: list[str]) -> np.ndarray:
    """Angles (201, num_names) [degree], anatomical signs, over 0..100 % of the stride."""
    return gait.sample().coordinates.sel(coordinate=names).values


def angle_changes(before: Gait, after: Gait, names: list[str]) -> np.ndarray:
    """Root mean square change of each angle over the stride [degree]."""
    return np.sqrt(np.mean((angles(after, names) - angles(before, names))[:-1] ** 2, axis=0))


def spread(changes: np.ndarray) -> float:
    """Over how many of the coordinates a change is spread: (sum d^2)^2 / sum d^4.

    1 if all of it is in one coordinate, n if n coordinates share it equally.
    """
    squares = np.asarray(changes) ** 2
    return float(squares.sum() ** 2 / (squares**2).sum())


def ranges(gait: Gait, name: str) -> tuple[float, float]:
    """Range of a coordinate over the stride and that of the reference [degree or m]."""
    data = gait.sample()
    return tuple(
        float(np.ptp(data[kind].sel(coordinate=name).values))
        for kind in ("coordinates", "reference_coordinates")
    )


def foot_lift(gait: Gait, side: str) -> float:
    """Largest height of the middle between heel and toe [mm]."""
    points = gait.sample().contact_points.sel(axis="z")
    names = [f"{point}_{side[0]}" for point in ("heel", "toe")]
    return 1e3 * float(points.sel(contact_point=names).mean("contact_point").max())


def excitation_height(gait: Gait, side: str) -> float:
    """Largest excitation of a muscle in the stride, averaged over the muscles of a side."""
    return float(_excitations(gait, side).max(axis=0).mean())


def excitation_width(gait: Gait, side: str) -> float:
    """Share of the stride in which a muscle is active, averaged over the muscles of a side [%]."""
    return 100.0 * float((_excitations(gait, side)[:-1] > ACTIVE).mean())


def excitation_change(before: Gait, after: Gait, side: str) -> float:
    """Root mean square change of the excitations of a side."""
    difference = _excitations(after, side) - _excitations(before, side)
    return float(np.sqrt(np.mean(difference[:-1] ** 2)))


def excitation_peak(gait: Gait, muscle: str, low: float, high: float) -> float:
    """Largest excitation of a muscle between two percentages of the stride."""
    data = gait.sample()
    within = (data.percent.values >= low) & (data.percent.values <= high)
    return float(data.excitation.sel(muscle=muscle).values[within].max())


def late_stance_force(gait: Gait, side: str) -> float:
    """Mean normal force on a foot in the last quarter of its stance [% of body weight]."""
    curves = GaitCurves(gait)
    percent, force = curves.own_cycle(side, curves.ground_reaction(side, "vertical"))
    end = curves.toe_off(side)
    late = (percent >= (1.0 - LATE) * end) & (percent <= end)
    return float(force[late].mean())


def excitation_at_peak(
    gait: Gait, muscle: str, others: Sequence[str], low: float, high: float
) -> float:
    """Largest excitation of `others` when `muscle` is excited most between two percentages."""
    data = gait.sample()
    within = (data.percent.values >= low) & (data.percent.values <= high)
    at = int(np.argmax(np.where(within, data.excitation.sel(muscle=muscle).values, -np.inf)))
    return float(data.excitation.sel(muscle=list(others)).values[at].max())


def shared_excitation(
    gait: Gait, muscle: str, others: Sequence[str], low: float, high: float
) -> float:
    """Largest excitation that `muscle` and one of `others` have together between two
    percentages of the stride."""
    data = gait.sample()
    within = (data.percent.values >= low) & (data.percent.values <= high)
    antagonist = data.excitation.sel(muscle=list(others)).values.max(axis=-1)
    both = np.minimum(data.excitation.sel(muscle=muscle).values, antagonist)
    return float(both[within].max())


def angle_change(before: Gait, after: Gait, name: str, low: float, high: float) -> float:
    """Root mean square change of an angle between two percentages of the stride [degree]."""
    percent = before.sample().percent.values
    within = (percent >= low) & (percent < high)
    difference = angles(after, [name]) - angles(before, [name])
    return float(np.sqrt(np.mean(difference[within] ** 2)))


def reaction_change(before: Gait, after: Gait, feet: Sequence[str] = ("right", "left")) -> float:
    """Root mean square change of vertical and fore-aft forces on the feet [% of body weight].

    Body weight is that of the subject without what it wears.
    """
    forces = [
        gait.sample().ground_reaction_force.sel(axis=["x", "z"], foot=list(feet)).values
        for gait in (before, after)
    ]
    weight = before.study.subject.mass * GRAVITY
    return 100.0 * float(np.sqrt(np.mean((forces[1] - forces[0])[:-1] ** 2))) / weight


def mean_angle(gait: Gait, name: str, phases: tuple[int, ...]) -> float:
    """Mean of an angle over some of the phases 1 to 8 [degree]."""
    data = gait.sample()
    within = np.isin(data.phase.values, phases)
    return float(data.coordinates.sel(coordinate=name).values[within].mean())


def largest_angle(
    gait: Gait, name: str, phases: tuple[int, ...] = (1, 2, 3, 4, 5, 6, 7, 8)
) -> float:
    """Largest value of an angle in some of the phases 1 to 8 [degree]."""
    within = np.isin(gait.sample().phase.values, phases)
    return float(angles(gait, [name])[within].max())


def _excitations(gait: Gait, side: str) -> np.ndarray:
    data = gait.sample()
    names = [name for name in data.muscle.values if name.endswith(f"_{side[0]}")]
    return data.excitation.sel(muscle=names).values
