"""The gaits that come with the package; their origin and licence are in NOTICE."""

from __future__ import annotations

import csv
import json
import math
from collections.abc import Sequence
from importlib import resources
from typing import Any

import numpy as np

from drakegait.errors import UnknownName
from drakegait.quantities import GRAVITY
from drakegait.reference.curves import HarmonicCurves, SampledCurves
from drakegait.transcription.foot_placement import FootPlacement
from drakegait.walker.coordinates import coordinates
from drakegait.walker.subject import Subject

GAITS = ("normal", "asymmetric", "measured", "planar")
"""Names of the embedded gaits."""


def embedded_stride(kind: str, subject: Subject, name: str | None) -> dict[str, Any]:
    """All that `Reference` holds of an embedded gait, scaled to the subject.

    Raises:
        UnknownName: no such kind or gait; the planar gait has no lateral coordinates.
    """
    paper_names = [c.paper_name for c in coordinates(kind)]
    name = name or ("normal" if kind == "spatial" else "planar")
    known = GAITS if kind == "planar" else GAITS[:-1]
    if name not in known:
        raise UnknownName(f"{kind} reference gait", name, known)
    catalogue = json.loads(_data("gaits.json"))
    facts = catalogue["gaits"][name]
    scale = subject.height / catalogue["height"]
    lateral = 1.0 if kind == "spatial" else 0.0
    placement = FootPlacement(
        step_length_right=facts["step_length_right"],
        step_length_left=facts["step_length_left"],
        toe_angle_right=lateral * facts["toe_angle_right"],
        toe_angle_left=lateral * facts["toe_angle_left"],
        step_width=lateral * facts["step_width"],
    )
    fractions = np.array(facts["phase_fractions"])
    shift = {axis: scale * facts.get("shift", {}).get(axis, 0.0) for axis in paper_names}
    return {
        "name": name,
        "stride_time": catalogue["stride_time"] * math.sqrt(scale),
        "phase_fractions": tuple((fractions / fractions.sum()).tolist()),
        "foot_placement": placement.scaled(scale),
        "motion": _motion(facts["motion"], shift, subject.height),
        "forces": _forces(catalogue["forces"], kind, subject.mass * GRAVITY),
    }


def _data(file: str) -> str:
    return (resources.files("drakegait.reference") / "data" / file).read_text(encoding="utf-8")


def _motion(file: str, shift: dict[str, float], height: float) -> HarmonicCurves:
    """Fourier coefficients of the rows named in `shift`, whose values are added to the means."""
    rows = {row["quantity"]: row for row in csv.DictReader(_data(file).splitlines())}

    def block(columns: Sequence[str]) -> np.ndarray:
        unit = {"H": height, "rad": 1.0}
        return np.array(
            [[unit[rows[x]["unit"]] * float(rows[x][c]) for c in columns] for x in shift]
        )

    orders = range(1, 1 + sum(c.startswith("cos") for c in next(iter(rows.values()))))
    mean = block(["mean"])[:, 0] + np.array(list(shift.values()))
    return HarmonicCurves(
        mean, block([f"cos{k}" for k in orders]), block([f"sin{k}" for k in orders])
    )


def _forces(file: str, kind: str, body_weight: float) -> SampledCurves:
    rows = np.loadtxt(_data(file).splitlines(), delimiter=",", skiprows=1)
    forces = body_weight * rows[:, 1:]
    if kind == "planar":
        forces[:, [1, 4]] = 0.0
    return SampledCurves(rows[:, 0] / 100.0, forces)
