"""drakegait and OpenSim Moco on the same walker, side by side; needs the extra `peers` (opensim).

Both solve one stride of the planar walker of the default study: the same bodies, joints, passive
moments, muscle paths and strengths (exported by `drakegait.export`, equal to 1e-10), the same
reference with the same weights, the same speed, the same start (the reference with the muscle
forces that fit it best), one thread.

    python benchmarks/peers.py                       # both forms of contact, writes peers.json
    python benchmarks/peers.py --contact prescribed --intervals 25 --time-limit 1500

What differs, because Moco has no twin for it:

- **Contact.** Our rigid footprints in eight phases, whose instants and places are unknowns, do
  not exist in Moco. `prescribed` applies OUR ground reactions to the feet as external loads: Moco
  is given what we have to find, the feet need not stand still, and its problem is the easier one.
  `smooth` puts compliant spheres at heel and toe (Hunt-Crossley with smooth friction) and tracks
  the reference's forces with our weights: contact is found, feet sink in by millimetres and slide.
- **Duration and steps.** Ours are unknowns; Moco gets the duration that we found.
- **Muscles.** De Groote-Fregly curves in place of ours (`drakegait/export/muscles.py`).
- **Cost.** Tracking terms are equal, weight by weight. Energy is not: Umberger's rate is not smooth
  in OpenSim. Moco minimises the sum of squared excitations, weighted so that it is worth for OUR
  answer what energy is worth in it. Both answers are then judged by our code: deviation of the
  motion, and energy by the exact law from tendon forces and path lengths.
- **Equations of motion.** We leave 5 N and 2 N m per coordinate unexplained (the paper has 2 N m);
  Moco gets residual actuators of the same size on all coordinates, nearly free.
- **Derivatives.** Ours are exact, first and second; Moco's are finite differences of OpenSim's
  functions and a quasi-Newton Hessian. This is how Moco is meant to be used; its tolerance on
  optimality is 1e-2, as in its examples of walking, ours 1e-3.

Times are of whole processes, imports and files included, as wall time and as CPU time; the ratio is
of CPU time, which other programs on the machine disturb less.
"""

from __future__ import annotations

import argparse
import dataclasses
import json
import os
import platform
import re
import resource
import shutil
import statistics
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

import numpy as np
from evaluation import evaluate, milliseconds  # this file's folder is where Python looks first
from scipy.interpolate import CubicSpline

from drakegait.export.bodies import read_parts
from drakegait.export.opensim import GROUND, LOADS, export_opensim
from drakegait.export.storage import write_storage
from drakegait.gait import Gait
from drakegait.loads import loads_along
from drakegait.program.design import coordinate_bounds
from drakegait.program.gait_program import GaitProgram
from drakegait.program.guess import guess_from_reference
from drakegait.quantities import GRAVITY
from drakegait.walker import coordinates
from drakegait.walker.coordinates import TO_OPENSIM

ROOT = Path(__file__).resolve().parents[1]
RESULTS = ROOT / "benchmarks" / "peers.json"
FOLDER = ROOT / "out" / "peers"
KIND = "planar"
# Moco's examples of walking end at 1e-2; finite differences hardly allow less. Ours: 1e-3.
CONVERGENCE, CONSTRAINT = 1e-2, 1e-3
INSTANTS = 401  # of the reference
# Smooth contact of OpenSim's own two-dimensional walking example (example2DWalking).
SPHERE = {
    "radius": 0.03, "stiffness": 1e6, "dissipation": 2.0, "static_friction": 0.8,
    "dynamic_friction": 0.8, "viscous_friction": 0.5, "transition_velocity": 0.2,
}  # fmt: skip
NEAR = 0.01  # of the last objective
HIGHEST_SPEED = 20.0  # of joints [rad/s]
RESIDUAL_WEIGHT = 1e-3  # of a residual at its tolerance, against a muscle at full excitation
Record = dict[str, Any]


def timed(command: list[str], log: Path, limit: float | None = None) -> Record:
    """Run a program on one thread; wall and CPU time [s] and its exit code."""
    environment = {**os.environ, "OMP_NUM_THREADS": "1", "PYTHONPATH": str(ROOT)}
    before, started = resource.getrusage(resource.RUSAGE_CHILDREN), time.perf_counter()
    with log.open("w", encoding="utf-8") as file:
        try:
            code = subprocess.run(
                command, stdout=file, stderr=subprocess.STDOUT, env=environment, cwd=ROOT,
                timeout=limit,
            ).returncode  # fmt: skip
        except subprocess.TimeoutExpired:
            code = None
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    cpu = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    return {"wall_s": time.perf_counter() - started, "cpu_s": cpu, "exit_code": code}


# drakegait -------------------------------------------------------------------------------


def solve_ours(nodes: int, folder: Path) -> tuple[Gait, Record]:
    """`drakegait walk` as a user types it."""
    words = ["walk", "--model", KIND, "--nodes", str(nodes), "--no-pictures", "--out", str(folder)]
    folder.mkdir(parents=True, exist_ok=True)
    record = timed([sys.executable, "-m", "drakegait.cli", *words], folder / "log.txt")
    gait = Gait.load(folder / "gait.nc")
    program = GaitProgram(gait.study.formulation())
    x = guess_from_reference(program)
    evaluate(program, x)  # builds what is built once
    times = [milliseconds(lambda k=k: evaluate(program, x + 1e-6 * k)) for k in range(1, 11)]
    outcome = gait.outcome
    record |= {
        "status": outcome.status,
        "iterations": outcome.iterations,
        "num_variables": outcome.num_variables,
        "num_constraints": outcome.num_constraints,
        "jacobian_nonzeros": outcome.jacobian_nonzeros,
        "derivatives_ms": statistics.median(times),
        **judged(gait, *own_curves(gait)),
    }
    return gait, record


def own_curves(gait: Gait) -> tuple[np.ndarray, ...]:
    """Instants, coordinates, muscle forces and ground reactions of our answer, plant signs."""
    motion = gait.motion(np.linspace(0.0, 1.0, INSTANTS))
    loads = loads_along(gait.study.walker, motion, gait.phase_of(motion.tau))
    return motion.tau, motion.q, motion.forces, loads.ground_reactions


def judged(
    gait: Gait, tau: np.ndarray, q: np.ndarray, forces: np.ndarray, ground: np.ndarray
) -> Record:
    """Both answers by one yardstick: how far from the reference, and what it costs.

    Args:
        gait: ours; the duration, the reference and the walker are those of both.
        tau, q, forces: fractions of the stride (K,), coordinates (K, n) and tendon forces
            (K, num_muscles), both ends of the stride included.
        ground: force on each foot (K, 2, 3), x forward, y left, z up.
    """
    walker, period, length = gait.study.walker, gait.stride_time, gait.stride_length
    fine = np.linspace(0.0, 1.0, INSTANTS)
    shift = np.zeros(q.shape[1])
    shift[0] = length
    periodic = q - tau[:, None] * shift
    motion, force = _periodic(tau, periodic), _periodic(tau, forces)
    order = [motion(fine, k) / period**k for k in range(3)]
    order[0] = order[0] + fine[:, None] * shift
    order[1] = order[1] + shift / period
    muscles = walker.muscles
    inputs = np.stack(
        [*(force(fine, k) / period**k for k in range(3)), muscles.lengths(order[0]),
         muscles.length_rates(order[1]), muscles.length_rates(order[2])], axis=-1,
    )  # fmt: skip
    power = walker.muscle_functions.states(inputs)["power"][:-1].mean(axis=0).sum()
    reference = gait.study.reference_walk
    error = (order[0] - fine[:, None] * shift - reference.coordinate_values(fine))[:-1]
    rate = (error / reference.coordinate_sigma) ** 2 @ reference.coordinate_weight
    off = np.array([np.interp(fine, tau, each) for each in ground.reshape(len(tau), 6).T]).T
    off = (off.reshape(-1, 2, 3) - reference.ground_reactions(fine))[:-1]
    force_rate = np.sum(reference.force_weight * (off / reference.force_sigma) ** 2, axis=(1, 2))
    rotation = walker.is_rotation
    energy = float(power * period / length)
    deviation = float(period * (rate.mean() + force_rate.mean()))
    return {
        "rms_angles_deg": float(np.degrees(np.sqrt(np.mean(error[:, rotation] ** 2)))),
        "rms_translations_mm": float(1e3 * np.sqrt(np.mean(error[:, ~rotation] ** 2))),
        "rms_vertical_force_N": float(np.sqrt(np.mean(off[..., 2] ** 2))),
        "deviation_of_motion_s": float(period * rate.mean()),
        "deviation_s": deviation,
        "energy_J_per_m": energy,
        "cost": energy / 100.0 + deviation,
    }


def _periodic(tau: np.ndarray, values: np.ndarray) -> CubicSpline:
    closed = values.copy()
    closed[-1] = closed[0]
    return CubicSpline(tau, closed, bc_type="periodic")


# Moco ------------------------------------------------------------------------------------


def write_problem(gait: Gait, folder: Path, contact: str, options: argparse.Namespace) -> None:
    """Everything that `peers_moco.py` needs, in one folder."""
    study, walker = gait.study, gait.study.walker
    program = GaitProgram(study.formulation())
    guess = dataclasses.replace(gait, values=program.values(guess_from_reference(program)))
    shutil.rmtree(folder, ignore_errors=True)
    export_opensim(gait, folder)
    export_opensim(guess, folder / "guess")
    reference = study.reference_walk
    tau = np.linspace(0.0, 1.0, INSTANTS)
    q = reference.coordinate_values(tau).copy()
    q[:, 0] += gait.stride_length * tau
    q = coordinates.to_anatomical(KIND, q)
    names = walker.coordinate_names
    paths = {
        freedom.coordinate: f"/jointset/{part.joint}/{freedom.coordinate}"
        for part in read_parts(walker.skeleton)
        for freedom in part.freedoms
    }
    values = {f"{paths[name]}/value": q[:, i] for i, name in enumerate(names)}
    write_storage(folder / "reference.sto", "reference", tau * gait.stride_time, values, False)
    _write_reference_forces(gait, folder, tau)

    excitations = np.loadtxt(folder / "excitations.sto", skiprows=7)[:-1, 1:]
    effort = gait.stride_time * float(np.mean(np.sum(np.clip(excitations, 0, 1) ** 2, axis=1)))
    signs = coordinates.anatomical_signs(KIND)
    ranges = coordinate_bounds(KIND, walker.subject.height) * signs[:, None]
    bounds = {f"{paths[name]}/value": sorted(ranges[i].tolist()) for i, name in enumerate(names)}
    bounds |= {f"{paths[name]}/speed": [-HIGHEST_SPEED, HIGHEST_SPEED] for name in names}
    travel = f"{paths['hat_x']}/value"
    bounds[travel] = [-0.5, gait.stride_length + 0.5]
    weight = reference.coordinate_weight / reference.coordinate_sigma**2
    # MocoContactTrackingGoal divides by body weight, which is in no documentation.
    body_weight = walker.skeleton.total_mass * GRAVITY
    force_weight = body_weight * reference.force_weight / reference.force_sigma**2
    tolerances, rotation = study.tolerances, walker.is_rotation
    start = float(guess.motion(np.array([0.0])).q[0, 0])
    problem = {
        "model": "model.osim",
        "contact": contact,
        "external_loads": LOADS,
        "reference": "reference.sto",
        "reference_loads": "reference_loads.xml",
        "guess_states": "guess/states.sto",
        "guess_controls": "guess/controls.sto",
        "final_time": gait.stride_time,
        "speed": study.speed,
        "travel": travel,
        "start_of_travel": [start - 0.1, start + 0.1],
        "bounds": bounds,
        "tracking_weights": {
            f"{paths[name]}/value": float(weight[i]) for i, name in enumerate(names)
        },
        "force_weights": {
            foot: {"x": float(force_weight[i, 0]), "y": float(force_weight[i, 2])}
            for i, foot in enumerate(("foot_r", "foot_l"))
        },
        "effort_weight": gait.metabolic.cost_of_transport / 100.0 / effort,
        "residuals": {
            name: tolerances.moment_tolerance if rotation[i] else tolerances.force_tolerance
            for i, name in enumerate(names)
        },
        "residual_weight": RESIDUAL_WEIGHT,
        "sphere": SPHERE,
        "time_limit": options.time_limit,
        "solver": {
            "intervals": options.intervals,
            "scheme": "hermite-simpson",
            "dynamics": options.dynamics,
            "convergence": CONVERGENCE,
            "constraint": CONSTRAINT,
            "differences": options.differences,
            "hessian": "limited-memory",
            "sparsity": options.sparsity,
            "max_iterations": 5000,
            "scale": False,
        },
    }
    (folder / "problem.json").write_text(json.dumps(problem, indent=1), encoding="utf-8")


def _write_reference_forces(gait: Gait, folder: Path, tau: np.ndarray) -> None:
    forces = gait.study.reference_walk.ground_reactions(tau)
    columns = {}
    for i, side in enumerate("rl"):
        turned = forces[:, i] @ TO_OPENSIM.T
        for k, axis in enumerate("xyz"):
            columns[f"ground_force_{side}_v{axis}"] = turned[:, k]
        for prefix in (f"ground_force_{side}_p", f"ground_torque_{side}_"):
            columns |= {f"{prefix}{axis}": np.zeros(len(tau)) for axis in "xyz"}
    file = "reference_ground_reactions.mot"
    write_storage(folder / file, "reference", tau * gait.stride_time, columns, False)
    text = (folder / LOADS).read_text(encoding="utf-8").replace(GROUND, file)
    (folder / "reference_loads.xml").write_text(text, encoding="utf-8")


def run_moco(gait: Gait, contact: str, options: argparse.Namespace) -> Record:
    """Moco's answer, its sizes and times from IPOPT's own words."""
    folder = FOLDER / contact
    write_problem(gait, folder, contact, options)
    log = folder / "log.txt"
    command = [sys.executable, str(ROOT / "benchmarks" / "peers_moco.py"), str(folder)]
    record = timed(command, log, limit=4.0 * options.time_limit + 300.0)
    text = log.read_text(encoding="utf-8", errors="replace")
    record |= {"contact": contact, "intervals": options.intervals}
    record |= {"differences": options.differences, "time_limit_s": options.time_limit}
    record |= ipopt_figures(text)
    result = folder / "result.json"
    if not result.is_file():
        return record | {"status": "no answer, see " + str(log)}
    record |= json.loads(result.read_text(encoding="utf-8"))
    return record | judged(gait, *moco_curves(gait, folder))


def ipopt_figures(text: str) -> Record:
    """Sizes, and CPU times of evaluations, from the log."""
    figures = {}
    for name, pattern in (
        ("num_variables", r"Total number of variables\.*: +(\d+)"),
        ("num_constraints", r"Total number of equality constraints\.*: +(\d+)"),
        ("jacobian_nonzeros", r"nonzeros in equality constraint Jacobian\.*: +(\d+)"),
        ("constraint_violation", r"Constraint violation\.*: +\S+ +(\S+)"),
        ("dual_infeasibility", r"Dual infeasibility\.*: +\S+ +(\S+)"),
    ):
        found = re.findall(pattern, text)
        if found:
            figures[name] = float(found[-1]) if "." in found[-1] else int(found[-1])
    # For example "nlp_jac_g |  125.19 s (  1.09 s) ...": CPU time of all calls and of one.
    units = {"us": 1e-3, "ms": 1.0, "s": 1e3}
    total: float | None = 0.0
    for name in ("nlp_f", "nlp_g", "nlp_grad_f", "nlp_jac_g"):
        found = re.search(rf"{name} +\| +\S+ *\w+ +\( *([\d.]+) ?(us|ms|s)\)", text)
        known = found and total is not None
        total = total + float(found[1]) * units[found[2]] if known else None
    return figures | {"derivatives_ms": total, "iterations_to_1_percent": _nearly_done(text)}


def _nearly_done(text: str) -> int | None:
    """Iterations until the objective stayed within 1 % of its last value, in IPOPT's log."""
    lines = re.findall(r"^ *\d+r? +(-?\d\.\d+e[+-]\d+) ", text, re.MULTILINE)
    if not lines:
        return None
    objective = np.array(lines, dtype=float)
    far = np.flatnonzero(np.abs(objective - objective[-1]) > NEAR * abs(objective[-1]))
    return int(far[-1]) + 1 if len(far) else 0


def moco_curves(gait: Gait, folder: Path) -> tuple[np.ndarray, ...]:
    """Instants, coordinates, tendon forces and ground reactions of Moco's answer, as ours."""
    heads, table = _read_storage(folder / "solution.sto")
    columns = {"/".join(head.split("/")[-2:]): table[:, i] for i, head in enumerate(heads)}
    q = np.stack([columns[f"{name}/value"] for name in gait.coordinate_names], axis=1)
    share = [columns[f"{name}/normalized_tendon_force"] for name in gait.muscle_names]
    forces = np.stack(share, axis=1) * gait.study.walker.muscles.f_max
    tau = table[:, 0] / table[-1, 0]
    # Forces of compliant contact, or ours that were prescribed.
    smooth = folder / "contact_forces.sto"
    heads, ground = _read_storage(smooth if smooth.is_file() else folder / GROUND)
    turned = np.stack([
        np.stack([np.interp(tau, ground[:, 0] / ground[-1, 0],
                            ground[:, heads.index(f"ground_force_{side}_v{axis}")])
                  for axis in "xyz"], axis=1) @ TO_OPENSIM
        for side in "rl"
    ], axis=1)  # fmt: skip
    return tau, coordinates.to_plant(KIND, q), forces, turned


def _read_storage(path: Path) -> tuple[list[str], np.ndarray]:
    lines = path.read_text(encoding="utf-8").splitlines()
    start = lines.index("endheader") + 1
    rows = [line.split("\t") for line in lines[start + 1 :]]
    return lines[start].split("\t"), np.array(rows, dtype=float)


# Table -----------------------------------------------------------------------------------

ROWS = (
    ("spline nodes, mesh intervals", "grid", "{}"),
    ("ended", "status", "{}"),
    ("wall time [s]", "wall_s", "{:.1f}"),
    ("CPU time [s]", "cpu_s", "{:.1f}"),
    ("iterations", "iterations", "{}"),
    ("iterations to within 1 % of the last cost", "iterations_to_1_percent", "{}"),
    ("CPU time per iteration [s]", "iteration_s", "{:.3f}"),
    ("all derivatives once [ms]", "derivatives_ms", "{:.1f}"),
    ("variables", "num_variables", "{}"),
    ("rows", "num_constraints", "{}"),
    ("entries of the Jacobian", "jacobian_nonzeros", "{}"),
    ("RMS off the reference, angles [deg]", "rms_angles_deg", "{:.2f}"),
    ("RMS off the reference, HAT [mm]", "rms_translations_mm", "{:.1f}"),
    ("RMS off the reference, vertical force [N]", "rms_vertical_force_N", "{:.0f}"),
    ("deviation of the motion [s]", "deviation_of_motion_s", "{:.3f}"),
    ("deviation J_dev [s]", "deviation_s", "{:.3f}"),
    ("energy by our law [J/m]", "energy_J_per_m", "{:.0f}"),
    ("cost f by our law", "cost", "{:.2f}"),
)


def table(ours: Record, peers: list[Record]) -> str:
    """Both side by side in Markdown, with Moco as a multiple of ours."""
    ours = ours | {"grid": ours.get("nodes")}
    peers = [peer | {"grid": peer.get("intervals")} for peer in peers]
    heads = [f"Moco, {peer['contact']} contact | ratio" for peer in peers]
    lines = [
        "| | drakegait | " + " | ".join(heads) + " |",
        "|---|---:|" + "---:|---:|" * len(peers),
    ]
    for title, key, form in ROWS:
        cells = [_cell(ours.get(key), form)]
        for peer in peers:
            mine, theirs = ours.get(key), peer.get(key)
            numbers = isinstance(mine, (int, float)) and isinstance(theirs, (int, float))
            cells += [_cell(theirs, form), f"{theirs / mine:.3g}" if numbers and mine else ""]
        lines.append(f"| {title} | " + " | ".join(cells) + " |")
    return "\n".join(lines)


def _cell(value: Any, form: str) -> str:
    return "" if value is None else form.format(value)


def main() -> None:
    """Solve with both, print the table, write `peers.json`."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--nodes", type=int, default=18, help="of our splines")
    parser.add_argument("--intervals", type=int, default=25, help="of Moco's mesh")
    parser.add_argument("--contact", choices=("prescribed", "smooth", "both"), default="both")
    parser.add_argument("--dynamics", choices=("explicit", "implicit"), default="explicit")
    parser.add_argument("--differences", choices=("central", "forward"), default="central")
    parser.add_argument("--sparsity", choices=("none", "random", "initial-guess"), default="none")
    parser.add_argument("--time-limit", type=float, default=1500.0, help="CPU time of Moco [s]")
    options = parser.parse_args()
    FOLDER.mkdir(parents=True, exist_ok=True)
    gait, ours = solve_ours(options.nodes, FOLDER / "drakegait")
    kinds = ("prescribed", "smooth") if options.contact == "both" else (options.contact,)
    peers = [run_moco(gait, contact, options) for contact in kinds]
    for record in (ours, *peers):
        if record.get("iterations"):
            record["iteration_s"] = record["cpu_s"] / record["iterations"]
    machine = f"{os.cpu_count()} cores, {platform.system()} {platform.machine()}"
    # Rows of a form of contact that did not run now stay as they were.
    kept = json.loads(RESULTS.read_text(encoding="utf-8"))["moco"] if RESULTS.is_file() else []
    kept = [peer for peer in kept if peer["contact"] not in kinds]
    peers = sorted([*kept, *peers], key=lambda peer: peer["contact"])
    found = {
        "machine": machine,
        "drakegait": ours | {"nodes": options.nodes},
        "moco": peers,
        "date": time.strftime("%Y-%m-%d"),
    }
    RESULTS.write_text(json.dumps(found, indent=1) + "\n", encoding="utf-8")
    print(table(found["drakegait"], peers))


if __name__ == "__main__":
    main()
