"""A gait as the curves that a gait analyst reads, each leg on its own cycle.

The cycle of a leg runs from its heel strike to its next one, so that equal sides give equal
curves. Nothing is interpolated: a left curve holds the samples of the gait, with the percentage
counted from left heel strike.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from drakegait.quantities import GRAVITY
from drakegait.report.study_words import brief, peculiar

if TYPE_CHECKING:
    import xarray as xr

    from drakegait.gait import Gait
    from drakegait.report.reference_dynamics import ReferenceDynamics

SIDES = ("right", "left")
_HEEL_STRIKE = {"right": 0, "left": 4}  # positions in feet.EVENT_NAMES
_TOE_OFF = {"right": 6, "left": 2}


@dataclass(frozen=True, eq=False)
class GaitCurves:
    """Curves of one gait.

    Attributes:
        gait: where they come from.
        label: its name in legends.
        samples: instants from 0 to 100 % of the cycle, both ends counted.
    """

    gait: Gait
    label: str = "gait"
    samples: int = 201

    @cached_property
    def data(self) -> xr.Dataset:
        """The sampled gait: anatomical signs, degrees and SI units."""
        return self.gait.sample(self.samples)

    @cached_property
    def reference_dynamics(self) -> ReferenceDynamics | None:
        """Joint moments and powers of the reference stride; None if it has no ground forces."""
        from drakegait.report.reference_dynamics import reference_dynamics

        return reference_dynamics(self.gait.study)

    @cached_property
    def percent(self) -> np.ndarray:
        """Percentage of the cycle from right heel strike (num_samples,)."""
        return np.linspace(0.0, 100.0, self.samples)

    @property
    def mass(self) -> float:
        """Body mass of the subject, without what it wears [kg]."""
        return float(self.gait.study.subject.mass)

    @property
    def body_weight(self) -> float:
        """Weight of the subject [N]."""
        return self.mass * GRAVITY

    def heel_strike(self, side: str) -> float:
        """When a side's own cycle begins [% of the cycle from right heel strike]."""
        return 100.0 * float(self.gait.values.events[_HEEL_STRIKE[side]])

    def toe_off(self, side: str) -> float:
        """When stance ends [% of the side's own cycle]."""
        event = 100.0 * float(self.gait.values.events[_TOE_OFF[side]])
        return (event - self.heel_strike(side)) % 100.0

    def phase_edges(self, side: str = "right") -> np.ndarray:
        """Where the eight phases begin and the last one ends, (9,) [% of the side's own cycle].

        The first is the loading of that side.
        """
        events = np.roll(np.asarray(self.gait.values.events), -_HEEL_STRIKE[side])
        return np.append((100.0 * events - self.heel_strike(side)) % 100.0, 100.0)

    def own_cycle(self, side: str, values: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """A periodic quantity over a side's own cycle, as (percent, values) ready to draw.

        Args:
            values: (num_samples,) over `percent`.

        Returns:
            The same samples in the order of the side's cycle. The samples next to both ends
            are repeated just outside 0..100 %, so that the curve fills the cycle.
        """
        shifted = (self.percent[:-1] - self.heel_strike(side)) % 100.0
        order = np.argsort(shifted)
        percent, ordered = shifted[order], np.asarray(values)[:-1][order]
        percent = np.concatenate([[percent[-1] - 100.0], percent, [percent[0] + 100.0]])
        return percent, np.concatenate([ordered[-1:], ordered, ordered[:1]])

    # What the panels show. None where a walker has no such thing, as a planar one no adduction.

    def coordinate(self, name: str, variable: str = "coordinates") -> np.ndarray | None:
        """A coordinate-like variable by name (num_samples,); angles in degrees."""
        if variable not in self.data or name not in self.data.coordinate.values:
            return None
        return self.data[variable].sel(coordinate=name).values

    def joint(self, name: str, variable: str) -> np.ndarray | None:
        """A variable of a joint's coordinate by name (num_samples,)."""
        if name not in self.data.joint.values:
            return None
        return self.data[variable].sel(joint=name).values

    def muscle(self, name: str, variable: str = "excitation") -> np.ndarray | None:
        """A muscle's variable by its name with side (num_samples,)."""
        if name not in self.data.muscle.values:
            return None
        return self.data[variable].sel(muscle=name).values

    def ground_reaction(self, side: str, axis: str, reference: bool = False) -> np.ndarray | None:
        """Force of the ground on a foot (num_samples,) [% of body weight].

        Args:
            axis: `"vertical"` (up), `"fore-aft"` (forward) or `"medial"` (towards the other foot).
            reference: that of the reference walk instead; None if it was not measured.
        """
        variable = "reference_ground_reaction_force" if reference else "ground_reaction_force"
        if variable not in self.data:
            return None
        name = {"fore-aft": "x", "medial": "y", "vertical": "z"}[axis]
        force = self.data[variable].sel(foot=side, axis=name).values
        return self._inward(side, axis) * 100.0 * force / self.body_weight

    def free_moment(self, side: str) -> np.ndarray:
        """Moment of the ground on a foot about the vertical (num_samples,) [N m]; toe-in > 0."""
        return self._inward(side, "medial") * self.data.free_moment.sel(foot=side).values

    @staticmethod
    def _inward(side: str, axis: str) -> float:
        # To the left is towards the other foot for the right foot, and away from it for the left.
        return -1.0 if axis == "medial" and side == "left" else 1.0


def curves_of(gait: Gait, others: tuple[Gait, ...]) -> list[GaitCurves]:
    """The gait and those it is compared with, named by what makes them differ."""
    gaits = (gait, *others)
    statements = [_statements(item) for item in gaits]
    found = []
    for number, mine in enumerate(statements):
        differ = [text for key, text in mine.items() if len({s.get(key) for s in statements}) > 1]
        name = ", ".join(differ) or ("this gait" if number == 0 else f"gait {number + 1}")
        found.append(GaitCurves(gaits[number], name))
    names = [item.label for item in found]
    return [
        GaitCurves(item.gait, f"{item.label} ({number + 1})" if names.count(item.label) > 1
                   else item.label)
        for number, item in enumerate(found)
    ]  # fmt: skip


def _statements(gait: Gait) -> dict[str, str]:
    """What a reader would call a study by, in words."""
    study = gait.study
    subject, reference = study.subject, study.reference_walk.name
    return {
        "model": study.model,
        "nodes": f"{study.nodes} nodes",
        "speed": f"{gait.speed:.2f} m/s",
        "subject": f"{subject.height:.2f} m, {subject.mass:g} kg",
        "peculiar": brief(", ".join(peculiar(study))) or "unchanged walker",
        "reference": f'reference "{reference}"',
        "weights": f"weights {study.energy_weight:g}/{study.deviation_weight:g}",
    }
