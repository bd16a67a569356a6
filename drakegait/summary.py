"""`summary.json`: the main numbers of a gait under keys that stay."""

from __future__ import annotations

import functools
import platform
from importlib import metadata
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from drakegait.gait import Gait
    from drakegait.solvers.outcome import StartRecord

CHECKED = (
    "equations_of_motion_max_N",
    "equations_of_motion_max_Nm",
    "foot_contact_max_mm",
    "penetration_max_mm",
    "excitation_min",
    "excitation_max",
    "friction_ratio_max",
    "normal_force_min_N",
    "energy_balance_relative_error",
    "passed",
)
"""Entries of the check that the summary holds."""

PACKAGES = ("drakegait", "drake", "numpy", "casadi")


def summarise(gait: Gait) -> dict[str, Any]:
    """The summary of `gait` as plain types that JSON can hold; None where not known.

    `cost.total` is what the solver minimised, with rounded corners of the energy law; the cost of
    transport is by the exact law. Check and deviation are known once `check` has been made.
    """
    study, outcome, placement, report = gait.study, gait.outcome, gait.placement, gait.report
    return {
        "model": study.model,
        "nodes": int(study.nodes),
        "control_points": len(gait.values.multipliers),
        "subject": {"height_m": study.subject.height, "mass_kg": study.subject.mass},
        "solver": {
            "name": outcome.solver,
            "status": outcome.status,
            "iterations": outcome.iterations,
            "wall_time_s": outcome.wall_time,
            "setup_time_s": outcome.setup_time,
            "starts": [_start(record) for record in outcome.starts],
        },
        "problem": {
            "num_variables": outcome.num_variables,
            "num_constraints": outcome.num_constraints,
            "jacobian_nonzeros": outcome.jacobian_nonzeros,
        },
        "cost": {
            "total": gait.cost.get("total"),
            "metabolic_cost_of_transport_J_per_m": gait.metabolic.cost_of_transport,
            "deviation": None if report is None else report.deviation,
        },
        "gait": {
            "speed_m_per_s": gait.speed,
            "stride_time_s": gait.stride_time,
            "step_length_right_m": placement.step_length_right,
            "step_length_left_m": placement.step_length_left,
            "step_width_m": placement.step_width,
            "phase_durations_s": [float(duration) for duration in gait.phase_durations],
        },
        "check": {name: None if report is None else getattr(report, name) for name in CHECKED},
        "versions": versions(),
    }


def _start(record: StartRecord) -> dict[str, Any]:
    return {
        "start": record.start,
        "status": record.status,
        "cost": record.cost,
        "metabolic_cost_of_transport_J_per_m": record.energy,
        "iterations": record.iterations,
        "wall_time_s": record.wall_time,
        "phase_durations_s": list(record.phase_durations),
    }


@functools.cache
def _version(package: str) -> str:
    try:
        return metadata.version(package)
    except metadata.PackageNotFoundError:
        return "not installed"


def versions() -> dict[str, str]:
    """Versions of drakegait, of what its numbers hang on, and of Python."""
    return {"python": platform.python_version()} | {name: _version(name) for name in PACKAGES}
