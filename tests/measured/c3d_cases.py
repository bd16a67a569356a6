"""C3D files of a walk whose truth is known: force plates and markers."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from measured_cases import SUBJECT, Lab

from drakegait.walker.skeleton import Skeleton


def write_c3d(path: Path, lab: Lab, markers: dict | None = None, unit: str = "mm") -> None:
    """Two plates of type 2 and markers of a laboratory that has x to the left, y backward, z up.

    Args:
        markers: (K, 3) by label, in our axes [m], at a fifth of the plates' rate.
        unit: what the file calls the unit of its markers, millimetres in truth.
    """
    ezc3d = pytest.importorskip("ezc3d")
    file = ezc3d.c3d()
    columns, rate = lab.forces(), lab.force_rate
    count = len(columns["time"])
    frames = count // 5
    file["parameters"]["POINT"]["RATE"]["value"] = [rate / 5.0]
    file["parameters"]["ANALOG"]["RATE"]["value"] = [rate]
    markers = markers or {"M1": np.zeros((frames, 3))}
    points = np.ones((4, len(markers), frames))
    for k, place in enumerate(markers.values()):
        points[:3, k] = 1000.0 * np.stack([place[:, 1], -place[:, 0], place[:, 2]])[:, :frames]
    file["data"]["points"] = points
    file["parameters"]["POINT"]["LABELS"]["value"] = list(markers)
    file["parameters"]["POINT"]["UNITS"]["value"] = [unit]
    signals, corners = [], []
    for k, head in enumerate(lab.heads):
        forward, up, right = (columns[f"{head}v{axis}"] for axis in "xyz")
        place = [columns[f"{head}p{axis}"] for axis in "xyz"]
        force = np.stack([-right, -forward, up])  # on the foot, laboratory axes
        middle = np.array([0.0, -2000.0 - 100.0 * k, 0.0])
        point = 1000.0 * np.stack([-place[2], -place[0], place[1]]) - middle[:, None]
        point[2] = 0.0
        # a plate measures the force on itself in its own axes: x along the laboratory's x, z down
        turn = np.diag([1.0, -1.0, -1.0])
        own = turn @ -force
        moment = np.cross((turn @ point).T, own.T).T
        signals += [*own, *moment]
        half = 4000.0 * np.array([[1, -1, 0], [-1, -1, 0], [-1, 1, 0], [1, 1, 0]])  # own axes
        corners.append((half + middle).T)
    analogs = np.stack(signals)[:, : frames * 5]
    file["data"]["analogs"] = analogs[None]
    labels = [f"{name}{k}" for k in (1, 2) for name in ("Fx", "Fy", "Fz", "Mx", "My", "Mz")]
    file["parameters"]["ANALOG"]["LABELS"]["value"] = labels
    file.add_parameter("ANALOG", "UNITS", 2 * (["N"] * 3 + ["Nmm"] * 3))
    for name, value in {
        "USED": np.array([2]), "TYPE": np.array([2, 2]), "ZERO": np.array([1, 0]),
        "CORNERS": np.stack(corners, axis=-1), "ORIGIN": np.zeros((3, 2)),
        "CHANNEL": np.arange(1, 13).reshape(2, 6).T,
    }.items():  # fmt: skip
        file["parameters"]["FORCE_PLATFORM"][name]["value"] = value
    file.write(str(path))


def markers_of(lab: Lab) -> dict[str, np.ndarray]:
    """Places (K, 3) [m] of Plug-in Gait's markers and medial ones, our axes.

    The pelvis is shaped so that the regression of Harrington et al. finds the model's hips.
    """
    rate = lab.force_rate / 5.0
    time = np.arange(round(lab.strides * lab.reference.stride_time * rate) + 1) / rate
    tau = lab.begin + time / lab.reference.stride_time
    q = lab.reference.coordinate_values(tau)
    q[:, 0] += lab.reference.foot_placement.stride_length * tau - lab.belt * time
    poses = Skeleton.load("spatial", SUBJECT).body_poses(q)

    def on(segment: str, *place: float, of: str | None = None) -> np.ndarray:
        """A point of a segment; `of`: from the origin of another one."""
        return poses[of or segment][1] + poses[segment][0] @ np.array(place)

    half = 0.5 * np.linalg.norm(poses["thigh_r"][1][0] - poses["thigh_l"][1][0])
    width, depth = (half - 0.0073) / 0.33, 0.14
    front = np.array([0.24 * depth + 0.0099, 0.0, 0.30 * width + 0.0109])
    found = {
        "C7": on("hat", -0.1, 0.0, 0.5), "CLAV": on("hat", 0.1, 0.0, 0.45),
        "T10": on("hat", -0.1, 0.0, 0.25), "STRN": on("hat", 0.1, 0.0, 0.2),
    }  # fmt: skip
    for side, out in (("R", -1.0), ("L", 1.0)):
        low = side.lower()
        thigh, shank, foot = f"thigh_{low}", f"shank_{low}", f"foot_{low}"
        found |= {
            f"{side}ASI": on("hat", front[0], out * 0.5 * width, front[2]),
            f"{side}PSI": on("hat", front[0] - depth, out * 0.05, front[2]),
            f"{side}KNE": on(thigh, 0.0, out * 0.05, 0.0, of=shank),
            f"{side}KNM": on(thigh, 0.0, -out * 0.05, 0.0, of=shank),
            f"{side}ANK": on(shank, 0.0, out * 0.035, 0.0, of=foot),
            f"{side}MED": on(shank, 0.0, -out * 0.035, 0.0, of=foot),
            f"{side}HEE": on(foot, -0.06, 0.0, -0.03),
            f"{side}TOE": on(foot, 0.13, 0.0, -0.03),
        }
    return found
