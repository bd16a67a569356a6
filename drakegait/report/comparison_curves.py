"""The curves of a comparison: what they are called, where they come from, what lies behind them."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from drakegait.report.curves import GaitCurves
from drakegait.report.joint_moments import JOINT_AXES, moment, power
from drakegait.walker import coordinates

BAND_SHARE = 0.25
"""Half width of the reference band, in sigma of eq. (10)."""
BAND_MEANING = (
    "Grey band: the reference stride ± a quarter of σ, eq. (10) of the model: the root mean square "
    "deviation of that curve from its own mean over the stride. It shows how far is far in the "
    "terms in which the walker is held to the reference. It is not the spread among healthy people."
)
LINE_MEANING = (
    "Grey line: moments and powers of the reference stride, by inverse dynamics of its motion and "
    "ground forces through the model without changes. It is computed, not measured; it steps where "
    "a contact begins or ends."
)
LEAST_LOAD = 0.01
"""Share of body weight below which a foot in the air has no band."""
_PERCENT = np.linspace(0.0, 100.0, 101)


@dataclass(frozen=True)
class Quantity:
    """One quantity over the gait cycle.

    Attributes:
        name: key in tables.
        title: what it is called.
        unit: as shown.
        up, down: what values above and below zero mean.
        values: of (curves, side) -> (num_samples,), None if the walker has no such thing.
        reference: of (curves, side, tau) -> its reference value (num,) and sigma in the same unit,
            at fractions tau of the reference stride; None without one.
        sided: whether each leg has one.
        derived: the same as `reference`, for what the reference does not hold but inverse dynamics
            of it tells: (num,), a line without a band.
    """

    name: str
    title: str
    unit: str
    up: str
    down: str
    values: Callable[[GaitCurves, str], np.ndarray | None]
    reference: Callable[[GaitCurves, str, np.ndarray], tuple[np.ndarray, float] | None] | None = (
        None
    )
    sided: bool = True
    derived: Callable[[GaitCurves, str, np.ndarray], np.ndarray | None] | None = None

    def own(self, curves: GaitCurves, side: str) -> tuple[np.ndarray, np.ndarray] | None:
        """Percent of the side's own cycle and values, ready to draw; None if there is none."""
        found = self.values(curves, side)
        return None if found is None else curves.own_cycle(side, found)

    def band(self, curves: GaitCurves, side: str) -> tuple[np.ndarray, ...] | None:
        """Percent of the side's cycle in the reference, lower and upper edge of its band (101,)."""
        found = self._read(self.reference, curves, side)
        if found is None:
            return None
        mean, sigma = found
        return _PERCENT, mean - BAND_SHARE * sigma, mean + BAND_SHARE * sigma

    def line(self, curves: GaitCurves, side: str) -> tuple[np.ndarray, np.ndarray] | None:
        """Percent of the side's cycle in the reference and what inverse dynamics makes of it."""
        found = self._read(self.derived, curves, side)
        return None if found is None else (_PERCENT, found)

    def _read(self, read: Callable | None, curves: GaitCurves, side: str):
        if read is None:
            return None
        start = reference_heel_strike(curves, side if self.sided else "right")
        return read(curves, side, 0.01 * _PERCENT + start)


def reference_heel_strike(curves: GaitCurves, side: str) -> float:
    """When a side's cycle begins in the reference, as fraction of its stride."""
    fractions = curves.gait.study.reference_walk.phase_fractions
    return 0.0 if side == "right" else float(sum(fractions[:4]))


def _reference_coordinate(name: str) -> Callable:
    def read(curves: GaitCurves, side: str, tau: np.ndarray):
        walk = curves.gait.study.reference_walk
        row = walk.coordinates.index(f"{name}_{side[0]}" if not name.startswith("hat_") else name)
        grid = np.arange(400) / 400.0
        angles = (
            np.degrees(coordinates.to_anatomical(walk.kind, walk.coordinate_values(at))[:, row])
            for at in (tau, grid)
        )
        mean, spread = angles
        return mean, float(spread.std())

    return read


def _reference_force(axis: str) -> Callable:
    def read(curves: GaitCurves, side: str, tau: np.ndarray):
        walk = curves.gait.study.reference_walk
        if walk.forces is None:
            return None
        foot, column = (0 if side == "right" else 1), {"fore-aft": 0, "medial": 1, "vertical": 2}
        sign = -1.0 if axis == "medial" and side == "left" else 1.0  # towards the other foot
        scale = sign * 100.0 / curves.body_weight
        force = (
            scale * walk.ground_reactions(at)[:, foot, column[axis]]
            for at in (tau, np.arange(400) / 400.0)
        )
        mean, spread = force
        loaded = walk.ground_reactions(tau)[:, foot, 2] > LEAST_LOAD * curves.body_weight
        return np.where(loaded, mean, np.nan), float(spread.std())

    return read


def _reference_moment(name: str) -> Callable:
    def read(curves: GaitCurves, side: str, tau: np.ndarray):
        dynamics = curves.reference_dynamics
        if dynamics is None or f"{name}_{side[0]}" not in dynamics.joints:
            return None
        column = dynamics.joints.index(f"{name}_{side[0]}")
        return dynamics.at(tau, dynamics.moments[:, column]) / curves.mass

    return read


def _reference_power(joint: str) -> Callable:
    def read(curves: GaitCurves, side: str, tau: np.ndarray):
        dynamics = curves.reference_dynamics
        if dynamics is None:
            return None
        axes = [f"{name}_{side[0]}" for name in JOINT_AXES[joint]]
        columns = [dynamics.joints.index(name) for name in axes if name in dynamics.joints]
        return dynamics.at(tau, dynamics.powers[:, columns].sum(axis=1)) / curves.mass

    return read


def _angle(name: str, title: str, up: str, down: str) -> Quantity:
    sided = not name.startswith("hat_")

    def values(curves: GaitCurves, side: str) -> np.ndarray | None:
        return curves.coordinate(f"{name}_{side[0]}" if sided else name)

    return Quantity(name, title, "°", up, down, values, _reference_coordinate(name), sided)


def _moment(name: str, title: str, up: str, down: str) -> Quantity:
    def values(curves: GaitCurves, side: str) -> np.ndarray | None:
        return moment(curves, f"{name}_{side[0]}")

    return Quantity(
        f"{name}_moment", title, "N m/kg", up, down, values, derived=_reference_moment(name)
    )


def _power(joint: str) -> Quantity:
    return Quantity(
        f"{joint.lower()}_power", f"{joint} power", "W/kg", "generated", "absorbed",
        lambda curves, side: power(curves, joint, side), derived=_reference_power(joint),
    )  # fmt: skip


def _force(axis: str, title: str, up: str, down: str) -> Quantity:
    def values(curves: GaitCurves, side: str) -> np.ndarray | None:
        spatial = curves.gait.study.skeleton_kind == "spatial"
        return curves.ground_reaction(side, axis) if spatial or axis != "medial" else None

    name = f"{axis.replace('-', '_')}_force"
    return Quantity(name, title, "% BW", up, down, values, _reference_force(axis))


SAGITTAL_ANGLES = (
    _angle("hip_flexion", "Hip flexion", "flexion", "extension"),
    _angle("knee_flexion", "Knee flexion", "flexion", "extension"),
    _angle("ankle_dorsiflexion", "Ankle dorsiflexion", "dorsi", "plantar"),
)
OTHER_ANGLES = (
    _angle("hip_adduction", "Hip adduction", "adduction", "abduction"),
    _angle("hip_rotation", "Hip rotation", "internal", "external"),
)
TRUNK_ANGLES = (
    _angle("hat_tilt", "Trunk tilt", "forward", "backward"),
    _angle("hat_list", "Trunk list", "to the right", "to the left"),
    _angle("hat_rotation", "Trunk rotation", "to the left", "to the right"),
)
MOMENTS = (
    _moment("hip_flexion", "Hip moment, sagittal", "flexor", "extensor"),
    _moment("knee_flexion", "Knee moment", "flexor", "extensor"),
    _moment("ankle_dorsiflexion", "Ankle moment", "dorsi", "plantar"),
    _moment("hip_adduction", "Hip moment, frontal", "adductor", "abductor"),
    _moment("hip_rotation", "Hip moment, rotation", "internal", "external"),
)
POWERS = tuple(_power(joint) for joint in ("Hip", "Knee", "Ankle"))
FORCES = (
    _force("vertical", "Vertical ground reaction", "", ""),
    _force("fore-aft", "Fore-aft ground reaction", "propels", "brakes"),
    _force("medial", "Side ground reaction", "medial", "lateral"),
)


def excitation(group: str) -> Quantity:
    """Excitation of a muscle group of each leg."""
    return Quantity(
        f"{group}_excitation", group.replace("_", " ").capitalize(), "", "", "",
        lambda curves, side: curves.muscle(f"{group}_{side[0]}"),
    )  # fmt: skip


def muscle_groups(all_curves: Sequence[GaitCurves]) -> tuple[str, ...]:
    """Muscle groups that any of the walkers has, without side, in order."""
    names = [name for curves in all_curves for name in curves.gait.muscle_names]
    return tuple(dict.fromkeys(name[:-2] for name in names))


def quantities(all_curves: Sequence[GaitCurves]) -> tuple[Quantity, ...]:
    """All quantities that the first walker has, for tables."""
    known = (*SAGITTAL_ANGLES, *OTHER_ANGLES, *TRUNK_ANGLES, *MOMENTS, *POWERS, *FORCES)
    shown = [item for item in known if item.values(all_curves[0], "right") is not None]
    return (*shown, *(excitation(group) for group in muscle_groups(all_curves)))


def at_percent(item: Quantity, curves: GaitCurves, side: str) -> np.ndarray:
    """The quantity at 0, 1, ..., 100 % of the side's own cycle (101,); nan if there is none."""
    found = item.own(curves, side)
    if found is None:
        return np.full(len(_PERCENT), np.nan)
    return np.interp(_PERCENT, *found)
