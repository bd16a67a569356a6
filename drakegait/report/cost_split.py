"""Where the metabolic energy goes: by muscle group, leg and phase of the leg's cycle.

E^t = (1 / (L_R + L_L)) int sum_m P_m dt, eq. (8) of Garcia-Vallejo & Schiehlen (2012), with the
exact powers: the parts add up to `Gait.metabolic.cost_of_transport`.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from drakegait.gait import ENERGY_INSTANTS
from drakegait.loads import muscle_inputs
from drakegait.report.curves import SIDES

if TYPE_CHECKING:
    from drakegait.gait import Gait

OWN_PHASES = (
    "loading",
    "foot flat, other toe down",
    "single support, foot flat",
    "single support, heel up",
    "other foot loading",
    "other foot flat, toe down",
    "swing, other foot flat",
    "swing, other heel up",
)
"""The eight contact phases as a leg lives them, from its own heel strike."""

PARTS = {
    "Loading response": (0, 1),
    "Single support, foot flat": (2,),
    "Single support, heel up": (3,),
    "Pre-swing": (4, 5),
    "Swing": (6, 7),
}
"""Parts of a leg's own cycle and the contact phases that make them; double support is in the
first and the fourth."""


@dataclass(frozen=True, eq=False)
class CostSplit:
    """Cost of transport of one gait in parts.

    Attributes:
        groups: muscle groups, without side.
        values: (num_groups, 2, 8) cost of each group, leg (right, left) and phase of that leg's
            own cycle [J/m]; 0 for a muscle that only the other leg has.
        muscles: names of the muscles, with side.
        basal: what the body takes besides its muscles [J/m].
    """

    groups: tuple[str, ...]
    values: np.ndarray
    muscles: tuple[str, ...]
    basal: float

    @classmethod
    def of(cls, gait: Gait) -> CostSplit:
        """The split of a gait, on the instants of `Gait.metabolic`."""
        walker = gait.study.walker
        motion = gait.motion(np.arange(ENERGY_INSTANTS) / ENERGY_INSTANTS)
        power = walker.muscle_functions.states(muscle_inputs(walker, motion))["power"]
        by_phase = phase_shares(gait.values.events).T @ power / gait.speed
        names = gait.muscle_names
        groups = tuple(dict.fromkeys(name[:-2] for name in names))
        values = np.zeros((len(groups), 2, len(OWN_PHASES)))
        for column, name in enumerate(names):
            side = 0 if name.endswith("_r") else 1
            # The left leg's cycle begins with the fifth contact phase.
            own = np.roll(by_phase[:, column], -4 * side)
            values[groups.index(name[:-2]), side] += own
        basal = walker.energy_settings.basal_power(walker.subject.mass) / gait.speed
        return cls(groups, values, names, float(basal))

    @property
    def total(self) -> float:
        """E^t [J/m]."""
        return float(self.values.sum()) + self.basal

    @cached_property
    def by_group(self) -> np.ndarray:
        """Cost of each group of each leg (num_groups, 2) [J/m]."""
        return self.values.sum(axis=2)

    @cached_property
    def by_side(self) -> np.ndarray:
        """Cost of the right and the left leg (2,) [J/m]."""
        return self.values.sum(axis=(0, 2))

    @cached_property
    def by_part(self) -> np.ndarray:
        """Cost in each of `PARTS` of each leg (5, 2) [J/m]."""
        phases = self.values.sum(axis=0)
        return np.array([phases[:, list(which)].sum(axis=1) for which in PARTS.values()])

    def of_group(self, group: str, side: str) -> float:
        """Cost of a group of a leg [J/m]; nan if that leg has no such muscle."""
        if f"{group}_{side[0]}" not in self.muscles:
            return float("nan")
        return float(self.by_group[self.groups.index(group), SIDES.index(side)])


def phase_shares(events: np.ndarray, instants: int = ENERGY_INSTANTS) -> np.ndarray:
    """How much of each instant's share of the stride lies in each phase, (instants, 8).

    Instant k stands for [k - 1/2, k + 1/2] / instants; columns add up to the phases' durations as
    fractions of the stride, and everything to 1.
    """
    edges = np.append(np.asarray(events, dtype=float), 1.0)
    cells = (np.arange(instants + 1) - 0.5) / instants
    shares = np.zeros((instants, len(edges) - 1))
    for shift in (0.0, 1.0):  # the first cell reaches back into the last phase
        low = np.maximum(cells[:-1, None], edges[None, :-1] - shift)
        high = np.minimum(cells[1:, None], edges[None, 1:] - shift)
        shares += np.maximum(high - low, 0.0)
    return shares
