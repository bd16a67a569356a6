"""The person who walks: skeleton, muscles, passive joints and feet in one object."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from drakegait.walker import coordinates
from drakegait.walker.disorders import Disorder, check_walker
from drakegait.walker.feet import FootGeometry
from drakegait.walker.metabolics import EnergySettings
from drakegait.walker.muscle_dynamics import MuscleFunctions
from drakegait.walker.muscle_settings import MuscleSettings
from drakegait.walker.muscles import MuscleSet
from drakegait.walker.passive_joints import PassiveJoints, PassiveSettings
from drakegait.walker.skeleton import Skeleton
from drakegait.walker.subject import AddedMass, Subject


@dataclass(frozen=True)
class Walker:
    """A subject with everything that moves or holds it.

    Attributes:
        subject: height and mass.
        skeleton: equations of motion and contact kinematics.
        muscles: groups and paths.
        muscle_functions: contraction, activation and energy of the groups.
        energy_settings: constants of the energy model.
        passive: elastic moments and damping of the joints.
        lowest_excitation: below which muscles cannot be switched off (num_muscles,) [-].
    """

    subject: Subject
    skeleton: Skeleton
    muscles: MuscleSet
    muscle_functions: MuscleFunctions
    energy_settings: EnergySettings
    passive: PassiveJoints
    lowest_excitation: np.ndarray

    @classmethod
    def build(
        cls,
        kind: str,
        subject: Subject | None = None,
        added_masses: tuple[AddedMass, ...] = (),
        muscle_settings: MuscleSettings | None = None,
        energy_settings: EnergySettings | None = None,
        passive_settings: PassiveSettings | None = None,
        strength: Mapping[str, float] | None = None,
        planar_set: str = "table3",
        sdf: str | None = None,
        muscle_changes: Mapping[str, Mapping[str, float]] | None = None,
        disorders: tuple[Disorder, ...] = (),
        toe_torque: bool = False,
        sequence: str = "213",
    ) -> Walker:
        """Build the walker of a `"spatial"` or `"planar"` skeleton (`sdf`: text of your own).

        `muscle_changes`: other values in the muscle table, see `MuscleSet.load`. Disorders act on
        the subject with its strength and added masses.

        Raises:
            InvalidInput, UnknownName: disorders of muscles that are not there.
        """
        subject = subject or Subject()
        energy_settings = energy_settings or EnergySettings()
        natural = MuscleSet.load(
            kind, subject, planar_set, strength=strength or {}, changes=muscle_changes
        )
        check_walker(disorders, natural, (*(strength or ()), *(muscle_changes or ())))
        muscles = natural
        for item in sorted(disorders, key=lambda item: len(item.bare_joints())):  # removal last
            muscles = item.changed_muscles(muscles)
        masses = (*added_masses, *_all(disorders, "added_masses"))
        return cls(
            subject=subject,
            skeleton=Skeleton.load(
                kind, subject, masses, sdf, _all(disorders, "segment_edits"), toe_torque, sequence
            ),
            muscles=muscles,
            muscle_functions=MuscleFunctions(
                muscles, muscle_settings or MuscleSettings(), energy_settings
            ),
            energy_settings=energy_settings,
            passive=PassiveJoints(
                kind,
                subject,
                passive_settings or PassiveSettings(),
                springs=_all(disorders, "springs"),
                bands=_pulls(disorders, natural),
                bare=_all(disorders, "bare_joints"),
            ),
            lowest_excitation=_lowest_excitation(disorders, natural, muscles),
        )

    @property
    def coordinate_names(self) -> tuple[str, ...]:
        """Names of the coordinates, in order."""
        return self.skeleton.coordinates

    @cached_property
    def is_rotation(self) -> np.ndarray:
        """Mask (num_coordinates,) of the angles among the coordinates."""
        return coordinates.rotations(self.skeleton.kind)

    @property
    def foot(self) -> FootGeometry:
        """Heel and toe along the sole."""
        return self.skeleton.foot

    @cached_property
    def coupling(self) -> np.ndarray:
        """Which coordinates enter which joint torque (num_coordinates, num_coordinates).

        In a tree, the torque at a joint of one leg depends on the motion of the trunk and
        of that leg only.
        """
        legs = np.array([name[-2:] if name[-2:] in ("_r", "_l") else "" for name in
                         self.coordinate_names])  # fmt: skip
        opposite = (legs[:, None] != "") & (legs[None, :] != "") & (legs[:, None] != legs[None, :])
        return ~opposite


def _all(disorders: tuple[Disorder, ...], what: str) -> tuple:
    """One kind of change of all disorders."""
    return tuple(part for item in disorders for part in getattr(item, what)())


def _pulls(
    disorders: tuple[Disorder, ...], muscles: MuscleSet
) -> list[tuple[np.ndarray, float, np.ndarray]]:
    """Passive tension along paths as exponentials of the coordinates, for `PassiveJoints`."""
    pulls = []
    for item in disorders:
        for band in item.bands(muscles):
            i = muscles.names.index(band.muscle)
            arms = muscles.moment_arms[i]  # l = l0 - arms q
            offset = band.offset + band.rate * muscles.l0[i]
            pulls.append((band.tension * arms, offset, -band.rate * arms))
    return pulls


def _lowest_excitation(
    disorders: tuple[Disorder, ...], natural: MuscleSet, muscles: MuscleSet
) -> np.ndarray:
    lowest = np.zeros(natural.num_muscles)
    for item in disorders:
        floor = item.lowest_excitation(natural)
        lowest = lowest if floor is None else np.maximum(lowest, floor)
    return lowest[[natural.names.index(name) for name in muscles.names]]
