"""A gait as files of OpenSim: model, motion, muscles, joint moments and ground reactions.

| file | content |
|---|---|
| `model.osim` | the walker of the gait, see `osim_model` |
| `coordinates.mot`, `speeds.sto` | in degrees and m, and per s |
| `muscle_forces.sto` | tendon forces [N] |
| `activations.sto`, `excitations.sto` | of *our* contraction and activation dynamics |
| `joint_moments.sto` | internal moments of muscles and passive structures [N m] |
| `states.sto`, `controls.sto` | states of the model by their full paths [rad, m], for Moco |
| `ground_reactions.mot`, `external_loads.xml` | forces on the feet, for every tool of OpenSim |
| `inverse_dynamics.xml` | set-up of OpenSim's inverse dynamics with these files |

Signs are anatomical, axes those of OpenSim. Played back through OpenSim's muscles, our excitations
give other forces, because its curves differ from ours (`drakegait.export.muscles`).
"""

from __future__ import annotations

from pathlib import Path

import numpy as np

from drakegait.export.bodies import read_parts
from drakegait.export.osim_model import osim_model
from drakegait.export.storage import shown, write_storage
from drakegait.export.xml_text import add, document, written
from drakegait.gait import Gait
from drakegait.loads import Loads, loads_along, muscle_inputs
from drakegait.motion import MOST_INSTANTS, Motion
from drakegait.quantities import GRAVITY, check_count
from drakegait.sampling import LOADED, centre_of_pressure
from drakegait.walker import coordinates
from drakegait.walker.coordinates import TO_OPENSIM
from drakegait.whole_file import new_folder, write_text

MODEL, GROUND, LOADS = "model.osim", "ground_reactions.mot", "external_loads.xml"
COORDINATES, MOMENTS = "coordinates.mot", "inverse_dynamics.sto"
FEET = ("foot_r", "foot_l")
MOST_STRIDES = 20


def export_opensim(
    gait: Gait,
    folder: str | Path,
    *,
    num: int = 201,
    strides: int = 1,
    muscles: str = "degroote_fregly",
) -> list[Path]:
    """Write a gait for OpenSim 4.5 or later.

    Args:
        gait: converged or not.
        folder: made if need be; files in it are replaced.
        num: instants per stride, both ends counted.
        strides: how many strides one after the other, 1 to 20.
        muscles: how the model gets its muscles, see `osim_model`.

    Returns:
        The files.

    Raises:
        InvalidInput, UnknownName: for such arguments.
        BadFile: a file cannot be written.
    """
    check_count("instants", num, 2, MOST_INSTANTS)
    check_count("strides", strides, 1, MOST_STRIDES)
    walker, kind = gait.study.walker, gait.study.skeleton_kind
    model = osim_model(
        walker, name=f"drakegait_{kind}", muscles=muscles, limits=gait.study.all_limits
    )
    tau = np.linspace(0.0, strides, strides * (num - 1) + 1)
    motion = gait.motion(tau)
    loads = loads_along(walker, motion, gait.phase_of(tau))
    states = walker.muscle_functions.states(muscle_inputs(walker, motion))

    folder = new_folder(folder)
    write_text(folder / MODEL, model)
    _write_motion(gait, folder, motion)
    names = gait.muscle_names
    for file, title, values in (
        ("muscle_forces.sto", "Tendon forces [N]", motion.forces),
        ("activations.sto", "Activations", states["activation"]),
        ("excitations.sto", "Excitations", states["excitation"]),
    ):
        columns = dict(zip(names, values.T, strict=True))
        write_storage(folder / file, title, motion.time, columns, degrees=False)
    _write_moments(gait, folder, motion, loads)
    if muscles != "none":
        _write_states(gait, folder, motion, states, muscles)
    write_storage(folder / GROUND, "Ground reactions [N, m, N m]", motion.time,
                  ground_columns(gait, motion, loads), degrees=False)  # fmt: skip
    write_text(folder / LOADS, _external_loads())
    write_text(folder / "inverse_dynamics.xml", _inverse_dynamics(motion))
    return sorted(path for path in folder.iterdir() if path.name in _FILES)


_FILES = {
    MODEL, COORDINATES, GROUND, LOADS, "speeds.sto", "muscle_forces.sto", "activations.sto",
    "excitations.sto", "joint_moments.sto", "states.sto", "controls.sto", "inverse_dynamics.xml",
}  # fmt: skip


def _write_motion(gait: Gait, folder: Path, motion: Motion) -> None:
    kind, rotation = gait.study.skeleton_kind, gait.study.walker.is_rotation
    for file, title, values in (
        (COORDINATES, "Coordinates", motion.q),
        ("speeds.sto", "Speeds", motion.v),
    ):
        values = coordinates.to_anatomical(kind, values)
        values = np.where(rotation, np.degrees(values), values)
        columns = dict(zip(gait.coordinate_names, values.T, strict=True))
        write_storage(folder / file, title, motion.time, columns, degrees=True)


def _write_moments(gait: Gait, folder: Path, motion: Motion, loads: Loads) -> None:
    rows = coordinates.joint_angles(gait.study.skeleton_kind)
    moments = coordinates.to_anatomical(gait.study.skeleton_kind, loads.muscles + loads.passive)
    columns = {f"{gait.coordinate_names[row]}_moment": moments[:, row] for row in rows}
    title = "Internal joint moments of muscles and passive structures [N m]"
    write_storage(folder / "joint_moments.sto", title, motion.time, columns, degrees=False)


def _write_states(gait: Gait, folder: Path, motion: Motion, states: dict, muscles: str) -> None:
    """States as OpenSim names them; controls are excitations or shares of the largest force."""
    kind, walker = gait.study.skeleton_kind, gait.study.walker
    paths = {
        freedom.coordinate: f"/jointset/{part.joint}/{freedom.coordinate}"
        for part in read_parts(walker.skeleton)
        for freedom in part.freedoms
    }
    columns = {}
    for name, values in (("value", motion.q), ("speed", motion.v)):
        values = coordinates.to_anatomical(kind, values)
        for i, coordinate in enumerate(gait.coordinate_names):
            columns[f"{paths[coordinate]}/{name}"] = values[:, i]
    share = motion.forces / walker.muscles.f_max
    controls = share
    if muscles == "degroote_fregly":
        controls = states["excitation"]
        for i, muscle in enumerate(gait.muscle_names):
            columns[f"/forceset/{muscle}/activation"] = states["activation"][:, i]
            columns[f"/forceset/{muscle}/normalized_tendon_force"] = share[:, i]
    write_storage(folder / "states.sto", "States", motion.time, columns, degrees=False)
    columns = {f"/forceset/{m}": controls[:, i] for i, m in enumerate(gait.muscle_names)}
    write_storage(folder / "controls.sto", "Controls", motion.time, columns, degrees=False)


def ground_columns(gait: Gait, motion: Motion, loads: Loads) -> dict[str, np.ndarray]:
    """Force, point and moment of each foot by OpenSim's headings, in its axes.

    The point is the centre of pressure where the foot is loaded, else below the middle of heel and
    toe. The moment is all that the force at that point leaves: the free moment and, as heel and toe
    stand within the tolerance of the ground only, a little about the horizontal.
    """
    skeleton = gait.study.walker.skeleton
    points = skeleton.contact_points(motion.q).reshape(-1, 2, 2, 3)
    centre, _ = centre_of_pressure(points, loads, LOADED * skeleton.total_mass * GRAVITY)
    below = points.mean(axis=2) * [1.0, 1.0, 0.0]
    centre = np.where(np.isfinite(centre), centre, below)
    moment = np.cross(points - centre[:, :, None], loads.point_forces).sum(axis=2)
    moment[..., :2] += loads.toe_torques
    moment[..., 2] += loads.pivot_moments
    columns = {}
    for i, foot in enumerate(FEET):
        for prefix, values in (
            ("ground_force_{}_v", loads.ground_reactions),
            ("ground_force_{}_p", centre),
            ("ground_torque_{}_", moment),
        ):
            turned = values[:, i] @ TO_OPENSIM.T
            for axis, column in zip("xyz", turned.T, strict=True):
                columns[prefix.format(foot[-1]) + axis] = column
    return columns


def _external_loads() -> str:
    root = document()
    loads = add(root, "ExternalLoads", name="ground_reactions")
    objects = add(loads, "objects")
    for foot in FEET:
        force = add(objects, "ExternalForce", name=f"ground_on_{foot}")
        for tag, value in (
            ("applied_to_body", foot),
            ("force_expressed_in_body", "ground"),
            ("point_expressed_in_body", "ground"),
            ("force_identifier", f"ground_force_{foot[-1]}_v"),
            ("point_identifier", f"ground_force_{foot[-1]}_p"),
            ("torque_identifier", f"ground_torque_{foot[-1]}_"),
        ):
            add(force, tag, value)
    add(loads, "datafile", GROUND)
    return written(root)


def _inverse_dynamics(motion: Motion) -> str:
    root = document()
    tool = add(root, "InverseDynamicsTool", name="inverse_dynamics")
    for tag, value in (
        ("results_directory", "."),
        ("model_file", MODEL),
        ("time_range", " ".join(shown(x) for x in motion.time[[0, -1]])),
        ("forces_to_exclude", "ALL"),
        ("external_loads_file", LOADS),
        ("coordinates_file", COORDINATES),
        ("lowpass_cutoff_frequency_for_coordinates", -1),
        ("output_gen_force_file", MOMENTS),
    ):
        add(tool, tag, value)
    return written(root)
