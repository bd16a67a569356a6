"""A walk whose truth is known, written as a laboratory would write it.

The embedded stride is repeated; the pelvis takes the place of the HAT (no lumbar angles), and the
ground forces act on a line from heel to toe.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from drakegait.reference.reference import Reference
from drakegait.walker.coordinates import index
from drakegait.walker.skeleton import Skeleton
from drakegait.walker.subject import Subject

SUBJECT = Subject(height=1.75, mass=68.0)
HIPS = {-1: (-0.0707, -0.0661), 1: (-0.0563, -0.0785)}  # by the sign of knee flexion, 1.80 m
SIDES = ("r", "l")


@dataclass
class Lab:
    """How the laboratory writes its files.

    Attributes:
        begin: first instant, in strides after a right heel strike.
        strides: length of the recording in strides.
        belt: speed of the treadmill [m/s].
        knee: +1 or -1, the sign of flexion.
        unit: `"deg"` or `"rad"`.
        header: `"new"` (`inDegrees=`) or `"old"` (`datarows`), or `"none"` (no unit).
        metre: length of a metre in the file's unit.
        heads: groups of force columns of the right and the left foot.
    """

    begin: float = -0.3
    strides: float = 3.6
    belt: float = 0.0
    knee: int = 1
    unit: str = "deg"
    header: str = "new"
    metre: float = 1.0
    rate: float = 100.0
    force_rate: float = 500.0
    heads: tuple[str, str] = ("ground_force_r_", "ground_force_l_")
    noise: float = 0.0
    reference: Reference = field(
        default_factory=lambda: Reference.embedded("spatial", SUBJECT, "asymmetric")
    )

    def motion(self) -> dict[str, np.ndarray]:
        """Columns of the motion file."""
        time, tau = self._time(self.rate)
        q = self.reference.coordinate_values(tau)
        at = index("spatial")
        q[:, 0] += self.reference.foot_placement.stride_length * tau - self.belt * time
        if self.noise:
            q = q + self.noise * np.random.default_rng(1).standard_normal(q.shape)
        size = np.degrees(1.0) if self.unit == "deg" else 1.0
        b, a, g = (q[:, at[f"hat_{x}"]] for x in ("tilt", "list", "rotation"))
        arm = SUBJECT.height / 1.80 * np.array(HIPS[self.knee])
        offset = np.stack([  # R_y(b) R_x(a) R_z(g) (x, 0, z)
            (np.cos(b) * np.cos(g) + np.sin(b) * np.sin(a) * np.sin(g)) * arm[0]
            + np.sin(b) * np.cos(a) * arm[1],
            np.cos(a) * np.sin(g) * arm[0] - np.sin(a) * arm[1],
            (np.cos(b) * np.sin(a) * np.sin(g) - np.sin(b) * np.cos(g)) * arm[0]
            + np.cos(b) * np.cos(a) * arm[1],
        ])  # fmt: skip
        pelvis = self.metre * (q[:, :3].T - offset)
        columns = {
            "time": time, "pelvis_tilt": -size * b, "pelvis_list": size * a,
            "pelvis_rotation": size * g, "pelvis_tx": pelvis[0], "pelvis_ty": pelvis[2],
            "pelvis_tz": -pelvis[1],
        }  # fmt: skip
        for side, out in (("r", 1.0), ("l", -1.0)):
            columns |= {
                f"hip_flexion_{side}": -size * q[:, at[f"hip_flexion_{side}"]],
                f"hip_adduction_{side}": out * size * q[:, at[f"hip_adduction_{side}"]],
                f"hip_rotation_{side}": out * size * q[:, at[f"hip_rotation_{side}"]],
                f"knee_angle_{side}": self.knee * size * q[:, at[f"knee_flexion_{side}"]],
                f"ankle_angle_{side}": -size * q[:, at[f"ankle_dorsiflexion_{side}"]],
            }
        return columns

    def forces(self) -> dict[str, np.ndarray]:
        """Columns of the force file."""
        time, tau = self._time(self.force_rate)
        forces = self.reference.ground_reactions(tau)
        q = self.reference.coordinate_values(tau)
        q[:, 0] += self.reference.foot_placement.stride_length * tau - self.belt * time
        points = Skeleton.load("spatial", SUBJECT).contact_points(q)
        fractions = np.cumsum(self.reference.phase_fractions)
        strikes, ends = (0.0, fractions[3]), (fractions[5], 1.0 + fractions[1])
        columns = {"time": time}
        for foot, head in enumerate(self.heads):
            share = (tau - strikes[foot]) % 1.0 / (ends[foot] - strikes[foot])
            place = points[:, 2 * foot] + np.clip(share, 0.0, 1.0)[:, None] * (
                points[:, 2 * foot + 1] - points[:, 2 * foot]
            )
            place = self.metre * np.where(share[:, None] <= 1.0, place, 0.0)
            force = np.where(share[:, None] <= 1.0, forces[:, foot], 0.0)
            for k, (axis, sign) in enumerate((("x", 1.0), ("z", -1.0), ("y", 1.0))):
                columns[f"{head}v{axis}"] = sign * force[:, k]
                columns[f"{head}p{axis}"] = sign * place[:, k]
        return columns

    def write(self, folder: Path) -> tuple[Path, Path]:
        """Both files."""
        motion, forces = folder / "ik.mot", folder / "grf.mot"
        write_mot(motion, self.motion(), self.header, self.unit)
        write_mot(forces, self.forces(), self.header, self.unit)
        return motion, forces

    def _time(self, rate: float) -> tuple[np.ndarray, np.ndarray]:
        period = self.reference.stride_time
        time = np.arange(round(self.strides * period * rate) + 1) / rate
        return time, self.begin + time / period


def write_mot(path: Path, columns: dict, header: str = "new", unit: str = "deg") -> None:
    """An OpenSim table."""
    count = len(columns["time"])
    lines = {
        "new": [path.name, "version=1", f"nRows={count}", f"nColumns={len(columns)}",
                f"inDegrees={'yes' if unit == 'deg' else 'no'}", "endheader"],
        "old": [f"name {path.name}\t\t", f"datacolumns {len(columns)}", f"datarows {count}",
                "Angles are in " + ("degrees." if unit == "deg" else "radians."), "endheader"],
        "none": ["Coordinates", "endheader"],
    }[header]  # fmt: skip
    rows = np.stack(list(columns.values()), axis=-1)
    text = "\n".join([*lines, "\t".join(columns)]) + "\n"
    path.write_text(text + "\n".join("\t".join(f"{x:.8g}" for x in row) for row in rows) + "\n")


def write_csv(path: Path, columns: dict, separator: str = ",") -> None:
    """A table of another program."""
    rows = np.stack(list(columns.values()), axis=-1)
    lines = [separator.join(columns), *(separator.join(f"{x:.8g}" for x in row) for row in rows)]
    path.write_text("\n".join(lines) + "\n")
