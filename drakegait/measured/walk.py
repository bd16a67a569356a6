"""A person's measured walk, from files to a reference of the model."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from drakegait.errors import BadFile, InvalidInput
from drakegait.measured.advance import SPEEDS, belt_speed
from drakegait.measured.body_angles import read_body_angles
from drakegait.measured.contacts import find_contacts
from drakegait.measured.files import read_force_file, read_motion_file
from drakegait.measured.fit import INSTANTS, StrideFit, StrideTarget
from drakegait.measured.force_records import turned
from drakegait.measured.imported import FORCE_ROWS, ImportedWalk, reference_of_fit
from drakegait.measured.notes import Notes
from drakegait.measured.periodic_stride import first_placement, periodic_stride
from drakegait.measured.phases import phase_events
from drakegait.measured.posture import Posture, foot_pitch, level_feet, model_posture
from drakegait.measured.quality import (
    Quality,
    change_table,
    contact_table,
    force_table,
    judge,
    penetration,
)
from drakegait.measured.stance_forces import stance_forces
from drakegait.measured.strides import Stride, choose_stride
from drakegait.quantities import GRAVITY
from drakegait.reference.curves import SampledCurves
from drakegait.reference.reference import Reference
from drakegait.transcription.foot_placement import FootPlacement
from drakegait.walker.coordinates import index
from drakegait.walker.skeleton import Skeleton
from drakegait.walker.subject import Subject

_WRONG_MASS = 0.05


def import_walk(
    motion: str | Path,
    forces: str | Path,
    *,
    height: float,
    mass: float,
    treadmill_speed: float | None = None,
    stride: int | None = None,
    columns: str | Path | None = None,
    knee: str = "auto",
    sides: dict[str, str] | None = None,
    motion_cutoff: float = 6.0,
    force_cutoff: float = 20.0,
) -> ImportedWalk:
    """Read a person's walk and lay one stride of it on the model.

    docs/your_own_data.md says what is done to the data.

    Args:
        motion: joint angles, OpenSim `.mot` or `.sto`, or CSV; or markers, C3D.
        forces: ground forces, OpenSim `.mot` or `.sto`, CSV, or C3D.
        height, mass: of the person [m, kg].
        treadmill_speed: of the belt [m/s]; default: found from the standing feet.
        stride: number of the stride to take, from 1; default the best.
        columns: TOML or JSON file that says which column or marker is what, for CSV and C3D.
        knee: `"auto"`, `"flexion-positive"` or `"flexion-negative"`.
        sides: `"r"` or `"l"` by name of a force plate, where names do not say the foot.
        motion_cutoff, force_cutoff: of the low-pass filters [Hz].

    Raises:
        BadFile, InvalidInput, UnknownName: in one sentence, what cannot be used.
    """
    notes, subject = Notes(), Subject(height=float(height), mass=float(mass))
    if treadmill_speed is not None and not SPEEDS[0] <= treadmill_speed <= SPEEDS[1]:
        allowed = f"{SPEEDS[0]:g} to {SPEEDS[1]:g} [m/s]"
        raise InvalidInput("treadmill speed", treadmill_speed, allowed)
    skeleton = Skeleton.load("spatial", subject)
    table = read_motion_file(motion, columns, subject.height, notes)
    body = read_body_angles(
        table, height=subject.height, knee=knee, cutoff=motion_cutoff, notes=notes
    )
    posture = model_posture(body, skeleton, notes)
    records = read_force_file(forces, columns, sides or {}, force_cutoff, notes)
    records = turned(records, posture.heading)
    name = Path(forces).name
    if not any(_overlaps(record.series.time, posture.time) for record in records):
        raise BadFile(forces, "shares no time with the motion: "
                      f"{records[0].series.time[0]:.2f} to {records[0].series.time[-1]:.2f} s and "
                      f"{posture.time[0]:.2f} to {posture.time[-1]:.2f} s.")  # fmt: skip
    contacts = find_contacts(posture, records, notes, name)
    belt = belt_speed(posture, contacts, treadmill_speed, notes)
    chosen, strides = choose_stride(posture, contacts, stride, notes)
    posture, pitch = _flat_feet(posture, chosen, skeleton, notes)
    tau = np.arange(INSTANTS) / INSTANTS
    values, gaps, length = periodic_stride(posture, chosen, belt, tau)
    values = _embedded_where_missing(values, body.missing, subject, tau)
    _check_length(length, chosen, subject)
    q = values.copy()
    q[:, 0] += length * tau
    points = skeleton.contact_points(q)
    events = phase_events(chosen, tau, foot_pitch(points), notes)
    forces_tau = np.linspace(0.0, 1.0, FORCE_ROWS)
    measured_forces = stance_forces(chosen, contacts, forces_tau, notes)
    measured_forces[-1] = measured_forces[0]
    _check_mass(measured_forces, subject, notes)
    placement, origin = first_placement(points, _flat_masks(events, tau), length)
    values[:, :3] -= origin
    total = SampledCurves(forces_tau, measured_forces).values(tau)
    target = StrideTarget(
        coordinates=values, forces=total[:, :3] + total[:, 3:], events=events,
        placement=FootPlacement(
            step_length_right=placement[0], step_length_left=placement[1],
            toe_angle_right=placement[2], toe_angle_left=placement[3], step_width=placement[4],
        ), stride_time=chosen.duration, translations=posture.place,
    )  # fmt: skip
    fit = StrideFit(skeleton, target)
    before, after = fit.solve()
    title = f"{Path(motion).name}, stride from {chosen.right_strike:.2f} s"
    reference = reference_of_fit(title, fit, after, measured_forces)
    contacts_table = contact_table(fit, before, after)
    changes = change_table(fit, after, gaps)
    for warning in judge(contacts_table, changes):
        notes.say(warning)
    quality = Quality(
        facts=_facts(motion, forces, body, posture, chosen, belt, length, pitch, reference),
        strides=[_stride_row(k, s, s is chosen) for k, s in enumerate(strides, 1)],
        contacts=contacts_table, penetration=penetration(fit, before, after),
        forces=force_table(fit, before, after), changes=changes, warnings=notes.sentences,
    )  # fmt: skip
    return ImportedWalk(
        reference=reference, subject=subject, quality=quality, target=target,
        needed_force=fit.ground_force(after),
    )  # fmt: skip


def _overlaps(a: np.ndarray, b: np.ndarray) -> bool:
    return a[0] < b[-1] and b[0] < a[-1]


def _flat_feet(posture: Posture, stride: Stride, skeleton: Skeleton, notes: Notes):
    """The posture with flat feet level, and the pitch that was taken out, by side [rad]."""
    pitch = {}
    all_pitch = foot_pitch(posture.points)
    for foot, side in enumerate("rl"):
        strike, off = stride.strikes_and_offs[side]
        share = (posture.time - stride.right_strike) / stride.duration - strike
        inside = (share % 1.0 > 0.2 * (off - strike)) & (share % 1.0 < 0.45 * (off - strike))
        inside &= (posture.time >= stride.start) & (posture.time <= stride.end)
        pitch[side] = float(np.median(all_pitch[inside, foot]))
        if abs(pitch[side]) > np.radians(3.0):
            notes.say(
                f"The {'right' if side == 'r' else 'left'} foot stood flat with a pitch of "
                f"{np.degrees(pitch[side]):+.1f} degrees (toe down positive), an offset of the "
                "model or the markers; the ankle was corrected by it."
            )
    return level_feet(posture, skeleton, pitch), pitch


def _flat_masks(events: np.ndarray, tau: np.ndarray) -> dict[str, np.ndarray]:
    """Instants at which each foot is flat, without those at which the print changes."""
    right = (tau > events[1]) & (tau < events[3])
    left = (tau > events[5]) & (tau < events[7])
    return {"r": right, "l": left}


def _embedded_where_missing(values, missing, subject: Subject, tau: np.ndarray) -> np.ndarray:
    """Lateral coordinates that were not measured, from the embedded stride."""
    columns = {"hat_list": "pelvis_a", "hat_rotation": "pelvis_g"}
    for side in "rl":
        columns |= {f"hip_adduction_{side}": f"hip_a_{side}",
                    f"hip_rotation_{side}": f"hip_g_{side}"}  # fmt: skip
    wanted = [name for name, quantity in columns.items() if quantity in missing]
    if wanted:
        embedded = Reference.embedded("spatial", subject).coordinate_values(tau)
        at = index("spatial")
        for name in (*wanted, "hat_y"):
            values[:, at[name]] = embedded[:, at[name]]
    return values


def _check_length(length: float, stride: Stride, subject: Subject) -> None:
    low, high = 0.2 * subject.height, 1.3 * subject.height
    if not low <= length <= high:
        raise InvalidInput(
            "stride length in m", round(length, 3),
            f"{low:.2f} to {high:.2f} for this height; a walk on a treadmill needs its speed "
            f"(this stride takes {stride.duration:.2f} s)",
        )  # fmt: skip


def _check_mass(forces: np.ndarray, subject: Subject, notes: Notes) -> None:
    """The mean vertical force of a stride is the weight."""
    carried = float((forces[:-1, 2] + forces[:-1, 5]).mean() / GRAVITY)
    if abs(carried - subject.mass) > _WRONG_MASS * subject.mass:
        notes.say(
            f"The mean vertical force of the stride carries {carried:.1f} kg, but the mass is "
            f"given as {subject.mass:g} kg: check the mass, and the zero and gain of the plates."
        )


def _facts(motion, forces, body, posture, stride, belt, length, pitch, reference) -> dict[str, str]:
    placement = reference.foot_placement
    return {
        "motion": f"{Path(motion).name}, {body.rate:.4g} samples/s, {posture.time[0]:.2f} to "
        f"{posture.time[-1]:.2f} s",
        "forces": Path(forces).name,
        "stride": f"{stride.start:.3f} to {stride.end:.3f} s, {stride.duration:.3f} s",
        "speed": f"{length / stride.duration:.3f} m/s"
        + (f", belt {belt:.3f} m/s" if belt else ", over ground"),
        "stride length": f"{length:.3f} m, right step {placement.step_length_right:.3f} m, left "
        f"step {placement.step_length_left:.3f} m",
        "step width": f"{placement.step_width:.3f} m",
        "trunk": f"static forward lean of {np.degrees(posture.lean):+.1f} degrees taken out",
        "flat feet": ", ".join(
            f"{'right' if side == 'r' else 'left'} ankle corrected by {np.degrees(x):+.1f} degrees"
            for side, x in pitch.items()
        ),
    }


def _stride_row(number: int, stride: Stride, chosen: bool) -> dict:
    return {
        "number": number, "leading_foot": "right" if stride.lead == "r" else "left",
        "start_s": stride.start, "end_s": stride.end, "gap_deg": float(np.degrees(stride.gap)),
        "stances_with_force": stride.loaded, "chosen": chosen,
    }  # fmt: skip
