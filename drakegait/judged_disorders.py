"""What `check` measures of the disorders of a walker and of its limits.

The changed muscles, segments and springs are part of the walker that all other items judge. What
is left are statements about the walk: excitations that cannot be low, joints that stay in a
range, steps in a ratio. A study without them has none of these items.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from drakegait.check import CheckItem
from drakegait.walker import coordinates
from drakegait.walker.disorders import Asymmetry

if TYPE_CHECKING:
    from drakegait.judgement import Judged

EXCITATION_SLACK = 0.05
LIMIT_SLACK = (1.0, 5.0)  # beyond a joint limit, between control points [degrees], [mm]
RATIO_TOLERANCE = 0.005


def disorders(judged: Judged) -> list[CheckItem]:
    """All items that the study gives reason for."""
    return [*_spasticity(judged), *_limits(judged), *_asymmetries(judged)]


def _spasticity(judged: Judged) -> list[CheckItem]:
    """Excitations above the smallest that a muscle can have."""
    lowest = judged.walker.lowest_excitation
    muscles = np.flatnonzero(lowest)
    if not len(muscles):
        return []
    spare = judged.states["excitation"][:, muscles] - lowest[muscles]
    names = tuple(judged.walker.muscles.names[i] for i in muscles)
    return [
        judged.worst(
            "spastic_excitation_margin", "excitation above that of a spastic muscle at rest", spare,
            "", -EXCITATION_SLACK, names, largest=False,
        )
    ]  # fmt: skip


def _limits(judged: Judged) -> list[CheckItem]:
    """How far joints leave their limits."""
    study = judged.gait.study
    items = []
    for turns, unit, factor, slack in (
        (True, "degrees", 180.0 / np.pi, LIMIT_SLACK[0]),
        (False, "mm", 1e3, LIMIT_SLACK[1]),
    ):
        names = judged.walker.coordinate_names
        rotation = dict(zip(names, judged.walker.is_rotation, strict=True))
        limits = [limit for limit in study.all_limits if rotation[limit.coordinate] == turns]
        if not limits:
            continue
        which = [names.index(limit.coordinate) for limit in limits]
        values = coordinates.to_anatomical(study.skeleton_kind, judged.motion.q)[:, which]
        low = np.array([limit.low for limit in limits])
        high = np.array([limit.high for limit in limits])
        beyond = factor * np.maximum(low - values, values - high)
        items.append(
            judged.worst(
                f"limit_excess_{unit}", "joint beyond its limit", beyond, unit, slack,
                tuple(limit.coordinate for limit in limits),
            )
        )  # fmt: skip
    return items


def _asymmetries(judged: Judged) -> list[CheckItem]:
    """Ratios of steps and stances against those of the study."""
    values, items = judged.gait.values, []
    events = np.asarray(values.events)
    found = {
        "step_length": float(values.placement[0] / values.placement[1]),
        "stance_time": float((events[6] - events[0]) / (1.0 + events[2] - events[4])),
    }
    for item in judged.gait.study.disorders:
        if isinstance(item, Asymmetry):
            words = f"{item.quantity.replace('_', ' ')} right over left"
            ratio = found[item.quantity]
            items.append(
                CheckItem(f"{item.quantity}_ratio_error", f"{words} off by",
                          abs(ratio - item.ratio), "", high=RATIO_TOLERANCE,
                          where=f"{ratio:.3f}, wanted {item.ratio:g}")
            )  # fmt: skip
    return items
