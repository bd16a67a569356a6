"""What an import did to the measurement, in numbers."""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass
from typing import Any

import numpy as np

from drakegait.measured.fit import INSTANTS, FittedStride, StrideFit
from drakegait.quantities import GRAVITY
from drakegait.walker.coordinates import coordinates, to_anatomical
from drakegait.walker.feet import NUM_PHASES, PHASE_NAMES

_POINT_ROWS = {"heel_r": (0, 1, 2), "toe_r": (3, 4, 5), "heel_l": (7, 8, 9), "toe_l": (10, 11, 12)}
_WORDS = {
    "hat_x": "hips, forward", "hat_y": "hips, to the left", "hat_z": "hips, height",
    "hat_tilt": "trunk tilt", "hat_list": "trunk list", "hat_rotation": "trunk rotation",
}  # fmt: skip
_GOOD_CONTACT = 0.003  # [m] rms
_FAR_ANGLE = 6.0  # [deg] rms change by the fit


@dataclass(frozen=True, kw_only=True)
class Quality:
    """How well the stride was measured, and what was changed.

    Attributes:
        facts: what was read and found, by name, in words with units.
        strides: one entry per stride of the recording.
        contacts: rows of phase, point, and root mean square distance from its footprint before
            and after the fit [mm]; before: measured angles, laid on the ground as well as possible.
        penetration: deepest point of a free foot before and after [mm], negative is in the ground.
        forces: root mean square of m(a+g) minus the measured force before and after, fore-aft,
            lateral, vertical [body weights]; empty without complete forces.
        changes: rows of coordinate, unit, gap between start and end of the measured stride, root
            mean square change about the mean, mean change, largest change by the fit.
        warnings: in words.
    """

    facts: dict[str, str]
    strides: list[dict[str, Any]]
    contacts: list[dict[str, Any]]
    penetration: tuple[float, float]
    forces: list[dict[str, Any]]
    changes: list[dict[str, Any]]
    warnings: tuple[str, ...]

    def to_dict(self) -> dict[str, Any]:
        """Plain types that JSON can hold."""
        return dataclasses.asdict(self)

    @classmethod
    def from_dict(cls, plain: dict[str, Any]) -> Quality:
        """Inverse of `to_dict`."""
        values = dict(plain)
        values["penetration"] = tuple(values["penetration"])
        values["warnings"] = tuple(values["warnings"])
        return cls(**values)


def spoken(name: str) -> str:
    """A coordinate or point in words: `knee_flexion_r` is "right knee flexion"."""
    side = {"_r": "right ", "_l": "left "}.get(name[-2:], "")
    return _WORDS.get(name) or side + (name[:-2] if side else name).replace("_", " ")


def contact_table(fit: StrideFit, before: FittedStride, after: FittedStride) -> list[dict]:
    """Contact residuals by phase and point; only what stands in that phase."""
    errors = [1e3 * fit.contact_errors(stride) for stride in (before, after)]
    rows = []
    for phase in range(NUM_PHASES):
        during = fit.phases == phase
        for point, places in _POINT_ROWS.items():
            active = fit.active[during][:, places]
            if not active.any():
                continue
            both = [_rms(values[during][:, places]) for values in errors]
            rows.append({"phase": phase + 1, "name": PHASE_NAMES[phase], "point": point,
                         "before_mm": both[0], "after_mm": both[1]})  # fmt: skip
    return rows


def _rms(values: np.ndarray) -> float:
    """Root mean square distance: of the rows that are there, summed over directions."""
    squares = np.nansum(values**2, axis=-1)
    return float(np.sqrt(np.mean(squares)))


def penetration(fit: StrideFit, before: FittedStride, after: FittedStride) -> tuple[float, float]:
    """Lowest height of points that should be free [mm]."""
    return tuple(float(1e3 * np.nanmin(fit.free_heights(x))) for x in (before, after))


def force_table(fit: StrideFit, before: FittedStride, after: FittedStride) -> list[dict]:
    """What the motion needs against what the plates measured [body weights]."""
    if fit.target.forces is None:
        return []
    weight = fit.skeleton.total_mass * GRAVITY
    errors = [(fit.ground_force(x) - fit.target.forces) / weight for x in (before, after)]
    names = ("fore-aft", "lateral", "vertical")
    return [
        {"direction": name, "before": _spread(errors[0][:, k]), "after": _spread(errors[1][:, k])}
        for k, name in enumerate(names)
        if not (fit.planar and k == 1)
    ]


def change_table(fit: StrideFit, after: FittedStride, gaps: np.ndarray) -> list[dict]:
    """What the fit changed in each coordinate, in anatomical signs and degrees or mm.

    Args:
        gaps: (n,) end minus start of the measured stride, plant signs [rad, m].
    """
    kind = fit.skeleton.kind
    basis = fit.spline.dense_basis(np.arange(INSTANTS) / INSTANTS)
    change = basis @ after.coefficients.T - fit.target.coordinates
    change, gaps = to_anatomical(kind, change), to_anatomical(kind, gaps)
    rows = []
    for k, c in enumerate(coordinates(kind)):
        unit, factor = ("deg", 180.0 / np.pi) if c.is_rotation else ("mm", 1e3)
        values = factor * change[:, k]
        rows.append({"coordinate": c.name, "unit": unit, "gap": float(factor * gaps[k]),
                     "rms": float(values.std()), "mean": float(values.mean()),
                     "largest": float(values[np.argmax(np.abs(values))])})  # fmt: skip
    return rows


def judge(contacts: list[dict], changes: list[dict]) -> list[str]:
    """Warnings that the numbers call for."""
    found = []
    worst = max(contacts, key=lambda row: row["after_mm"])
    if worst["after_mm"] > 1e3 * _GOOD_CONTACT:
        found.append(
            f"After the fit the {spoken(worst['point'])} is still {worst['after_mm']:.1f} mm (rms) "
            f"off its footprint in phase {worst['phase']}, {worst['name']}."
        )
    angles = [row for row in changes if row["unit"] == "deg"]
    for row in angles:
        size = float(np.hypot(row["rms"], row["mean"]))
        if size > _FAR_ANGLE:
            found.append(
                f"{spoken(row['coordinate']).capitalize()} had to be changed by {size:.1f} "
                "degrees (rms) to put the feet on the ground: its offset or the phases are "
                "doubtful."
            )
    open_rows = [row for row in angles if abs(row["gap"]) > 5.0]
    if open_rows:
        text = ", ".join(f"{spoken(row['coordinate'])} {row['gap']:+.1f}" for row in open_rows)
        found.append(f"The stride does not end as it began (degrees): {text}; it was closed.")
    return found


def _spread(values: np.ndarray) -> float:
    return float(np.sqrt(np.mean(values**2)))
