"""A gait as labelled arrays with units, for figures, files and further study.

Angles in degrees and anatomical signs: the name of a coordinate is its positive sense, and a
joint moment is positive when it acts in that sense. World axes: x forward, y to the left, z up.
Contact forces follow from eq. (17), muscle states from the exact laws.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from drakegait.labelled_arrays import LabelledArrays
from drakegait.loads import Loads, loads_along, muscle_inputs
from drakegait.motion import MOST_INSTANTS
from drakegait.quantities import GRAVITY, check_count
from drakegait.walker import coordinates, feet

if TYPE_CHECKING:
    from drakegait.gait import Gait
    from drakegait.motion import Motion

FEET = ("right", "left")
AXES = ("x", "y", "z")
LOADED = 0.02
"""Share of body weight below which a foot has no centre of pressure."""

Variable = tuple[tuple[str, ...], np.ndarray, str, str]


def sample(gait: Gait, num: int = 201) -> LabelledArrays:
    """Everything about `gait` at `num` instants from 0 to 100 % of the stride.

    Returns:
        Arrays that carry `units` and `long_name`; dimensions time, coordinate, joint (coordinates
        between segments), muscle, foot, axis, contact_point, segment.

    Raises:
        InvalidInput: fewer than 2 or more than `MOST_INSTANTS`.
    """
    check_count("instants", num, 2, MOST_INSTANTS)
    tau = np.linspace(0.0, 1.0, num)
    motion, phases = gait.motion(tau), gait.phase_of(tau)
    loads = loads_along(gait.study.walker, motion, phases)
    variables = {
        **_motion(gait, motion),
        **_reference(gait, tau),
        **_joints(gait, motion, loads),
        **_muscles(gait, motion),
        **_ground(gait, motion, loads),
        **_bodies(gait, motion),
        "phase": (("time",), phases + 1, "1", "contact phase, 1 to 8, from right heel strike"),
    }
    skeleton = gait.study.walker.skeleton
    rotation = gait.study.walker.is_rotation
    names = gait.coordinate_names
    joints = [names[i] for i in coordinates.joint_angles(skeleton.kind)]
    time = {"units": "s", "long_name": "time from right heel strike"}
    labels = {
        "time": (("time",), motion.time, time),
        "percent": (("time",), 100.0 * tau, {"units": "%", "long_name": "share of the stride"}),
        "coordinate": (("coordinate",), list(names), {}),
        "coordinate_unit": (("coordinate",), ["degree" if r else "m" for r in rotation], {}),
        "joint": (("joint",), joints, {}),
        "muscle": (("muscle",), list(gait.muscle_names), {}),
        "foot": (("foot",), list(FEET), {}),
        "axis": (("axis",), list(AXES), {}),
        "contact_point": (("contact_point",), list(feet.POINT_NAMES), {}),
        "segment": (("segment",), list(skeleton.body_poses(motion.q[0])), {}),
        "event": (("event",), list(feet.EVENT_NAMES), {}),
    }
    arrays = {
        name: (dims, values, {"units": unit, "long_name": text})
        for name, (dims, values, unit, text) in variables.items()
    }
    return LabelledArrays(arrays, labels)


def _shown(gait: Gait, values: np.ndarray) -> np.ndarray:
    """Coordinates or their rates in anatomical signs, degrees and metres."""
    walker = gait.study.walker
    anatomical = coordinates.to_anatomical(walker.skeleton.kind, values)
    return np.where(walker.is_rotation, np.degrees(anatomical), anatomical)


def _motion(gait: Gait, motion: Motion) -> dict[str, Variable]:
    dims = ("time", "coordinate")
    return {
        "coordinates": (dims, _shown(gait, motion.q), "degree or m", "generalised coordinates"),
        "velocities": (dims, _shown(gait, motion.v), "degree/s or m/s", "velocities"),
        "event_percent": (("event",), 100.0 * gait.values.events, "%", "start of each phase"),
    }


def _reference(gait: Gait, tau: np.ndarray) -> dict[str, Variable]:
    reference = gait.study.reference_walk
    q = reference.coordinate_values(tau).copy()
    # Compared without the advance: shown with that of the gait, so that the curves can overlap.
    q[:, 0] += gait.stride_length * tau
    found = {
        "reference_coordinates": (
            ("time", "coordinate"), _shown(gait, q), "degree or m", "coordinates of the reference",
        ),
    }  # fmt: skip
    if reference.forces is not None:
        found["reference_ground_reaction_force"] = (
            ("time", "foot", "axis"), reference.ground_reactions(tau), "N",
            "force of the ground on each foot, reference",
        )  # fmt: skip
    return found


def _joints(gait: Gait, motion: Motion, loads: Loads) -> dict[str, Variable]:
    kind = gait.study.skeleton_kind
    rows = coordinates.joint_angles(kind)
    signs = coordinates.anatomical_signs(kind)[rows]
    muscle, passive = loads.muscles[:, rows], loads.passive[:, rows]
    dims = ("time", "joint")
    return {
        "joint_moment": (dims, signs * (muscle + passive), "N m", "internal joint moment"),
        "joint_moment_muscle": (dims, signs * muscle, "N m", "joint moment of the muscles"),
        "joint_moment_passive": (dims, signs * passive, "N m", "passive joint moment"),
        "joint_power": (dims, (muscle + passive) * motion.v[:, rows], "W", "joint power"),
    }


def _muscles(gait: Gait, motion: Motion) -> dict[str, Variable]:
    walker = gait.study.walker
    inputs = muscle_inputs(walker, motion)
    states = walker.muscle_functions.states(inputs)
    l_opt = walker.muscles.l_opt
    work = -inputs[..., 0] * inputs[..., 4]
    shown = {
        "muscle_force": (motion.forces, "N", "tendon force"),
        "activation": (states["activation"], "1", "activation"),
        "excitation": (states["excitation"], "1", "neural excitation"),
        "fiber_length": (states["normalized_fiber_length"], "1", "fibre length / optimal length"),
        "fiber_velocity": (
            states["fiber_velocity"] / l_opt, "1/s", "fibre velocity / optimal length, < 0 shortens"
        ),
        "muscle_power": (states["power"], "W", "metabolic power"),
        "muscle_work_rate": (work, "W", "mechanical power of muscle and tendon"),
    }  # fmt: skip
    return {name: (("time", "muscle"), *rest) for name, rest in shown.items()}


def _ground(gait: Gait, motion: Motion, loads: Loads) -> dict[str, Variable]:
    skeleton = gait.study.walker.skeleton
    points = skeleton.contact_points(motion.q)
    least = LOADED * skeleton.total_mass * GRAVITY
    pressure, moment = centre_of_pressure(points.reshape(-1, 2, 2, 3), loads, least)
    dims = ("time", "foot", "axis")
    return {
        "ground_reaction_force": (
            dims, loads.ground_reactions, "N", "force of the ground on each foot"
        ),
        "centre_of_pressure": (dims, pressure, "m", "centre of pressure; none where unloaded"),
        "free_moment": (
            ("time", "foot"), moment, "N m", "vertical moment about the centre of pressure"
        ),
        "contact_points": (
            ("time", "contact_point", "axis"), points, "m", "positions of heel and toe"
        ),
        "contact_forces": (
            ("time", "contact_point", "axis"), loads.point_forces.reshape(-1, 4, 3), "N",
            "force of the ground on heel and toe; a flat foot's horizontal force is at the heel",
        ),
        "equation_residual": (
            ("time", "coordinate"),
            coordinates.to_anatomical(gait.study.skeleton_kind, loads.residual),
            "N or N m", "error of the equations of motion, eq. (18)",
        ),
    }  # fmt: skip


def centre_of_pressure(
    points: np.ndarray, loads: Loads, least_load: float
) -> tuple[np.ndarray, np.ndarray]:
    """Where each foot's force acts on the ground, and the free moment there.

    Args:
        points: heel and toe of both feet (K, 2, 2, 3) [m].
        least_load: vertical force below which there is no centre [N].

    Returns:
        Centres (K, 2, 3) [m], nan where unloaded, and moments about the vertical (K, 2) [N m],
        0 where unloaded.
    """
    forces = loads.point_forces
    vertical = forces[..., 2]
    total = vertical.sum(axis=2)
    loaded = total > least_load
    safe = np.where(loaded, total, 1.0)
    moments = np.einsum("kfp,kfpa->kfa", vertical, points)
    tilting = loads.toe_torques
    moments[..., 0] -= tilting[..., 1]
    moments[..., 1] += tilting[..., 0]
    centre = moments / safe[..., None]
    arm = points - centre[:, :, None]
    moment = (arm[..., 0] * forces[..., 1] - arm[..., 1] * forces[..., 0]).sum(axis=2)
    moment = np.where(loaded, moment + loads.pivot_moments, 0.0)
    centre[..., 2] = 0.0
    return np.where(loaded[..., None], centre, np.nan), moment


def _bodies(gait: Gait, motion: Motion) -> dict[str, Variable]:
    skeleton = gait.study.walker.skeleton
    poses = skeleton.body_poses(motion.q)
    origins = np.stack([origin for _, origin in poses.values()], axis=1)
    return {
        "segment_origin": (
            ("time", "segment", "axis"), origins, "m", "proximal joint of each segment"
        ),
        "centre_of_mass": (
            ("time", "axis"), skeleton.center_of_mass(motion.q), "m", "centre of mass of the body"
        ),
    }  # fmt: skip
