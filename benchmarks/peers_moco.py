"""OpenSim Moco on the problem that `peers.py` has written; run by it in a process of its own.

OpenSim and drakegait each bring a library of the same name (CasADi), so one process cannot hold
both: this file imports nothing of drakegait.

    python benchmarks/peers_moco.py FOLDER

FOLDER/problem.json says what to solve; solution.sto and result.json are written beside it, IPOPT's
own words go to stdout.
"""

from __future__ import annotations

import json
import os
import sys
import time
from pathlib import Path

import numpy as np
import opensim as osim

LEAST_ACTIVATION = 0.001
PREFIX = "residual_"


def model_with_loads(folder: Path, problem: dict) -> osim.Model:
    """The walker with residual forces, and with smooth contacts or our ground reactions."""
    model = osim.Model(str(folder / problem["model"]))
    for name, tolerance in problem["residuals"].items():
        actuator = osim.CoordinateActuator(name)
        actuator.setName(PREFIX + name)
        actuator.setOptimalForce(tolerance)
        actuator.setMinControl(-1.0)
        actuator.setMaxControl(1.0)
        model.addForce(actuator)
    if problem["contact"] == "prescribed":
        model.finalizeConnections()
        processor = osim.ModelProcessor(model)
        processor.append(osim.ModOpAddExternalLoads(str(folder / problem["external_loads"])))
        return processor.process()
    _add_spheres(model, problem["sphere"])
    model.finalizeConnections()
    return model


def _add_spheres(model: osim.Model, sphere: dict) -> None:
    """Heels and toes as spheres that touch the ground y = 0 where the points of our feet do."""
    down = osim.Vec3(0.0, 0.0, -0.5 * np.pi)
    floor = osim.ContactHalfSpace(osim.Vec3(0.0), down, model.getGround(), "floor")
    model.addContactGeometry(floor)
    markers = {m.getName(): m for m in (model.getMarkerSet().get(i) for i in
                                        range(model.getMarkerSet().getSize()))}  # fmt: skip
    for name, marker in markers.items():
        place = marker.get_location()
        body = model.getBodySet().get(f"foot_{name[-1]}")
        centre = osim.Vec3(place[0], place[1] + sphere["radius"], place[2])
        ball = osim.ContactSphere(sphere["radius"], centre, body, f"ball_{name}")
        model.addContactGeometry(ball)
        force = osim.SmoothSphereHalfSpaceForce(f"contact_{name}", ball, floor)
        for key in ("stiffness", "dissipation", "static_friction", "dynamic_friction",
                    "viscous_friction", "transition_velocity"):  # fmt: skip
            getattr(force, f"set_{key}")(sphere[key])
        model.addForce(force)


def study_of(folder: Path, problem: dict, model: osim.Model) -> osim.MocoStudy:
    """Goals, bounds and solver."""
    study = osim.MocoStudy()
    study.setName("peer")
    moco = study.updProblem()
    moco.setModel(model)
    moco.setTimeBounds(0.0, problem["final_time"])
    for path, (low, high) in problem["bounds"].items():
        moco.setStateInfo(path, [low, high])
    travel = problem["travel"]
    moco.setStateInfo(travel, problem["bounds"][travel], problem["start_of_travel"])
    moco.setStateInfoPattern("/forceset/.*/activation", [LEAST_ACTIVATION, 1.0])
    moco.setStateInfoPattern("/forceset/.*/normalized_tendon_force", [0.0, 1.5])
    moco.setControlInfoPattern("/forceset/[^r].*", [LEAST_ACTIVATION, 1.0])
    moco.setControlInfoPattern("/forceset/rectus.*", [LEAST_ACTIVATION, 1.0])
    _add_goals(moco, folder, problem, model)

    solver = study.initCasADiSolver()
    options = problem["solver"]
    solver.set_num_mesh_intervals(options["intervals"])
    solver.set_transcription_scheme(options["scheme"])
    solver.set_multibody_dynamics_mode(options["dynamics"])
    solver.set_optim_convergence_tolerance(options["convergence"])
    solver.set_optim_constraint_tolerance(options["constraint"])
    solver.set_optim_finite_difference_scheme(options["differences"])
    solver.set_optim_hessian_approximation(options["hessian"])
    solver.set_optim_max_iterations(options["max_iterations"])
    solver.set_optim_sparsity_detection(options["sparsity"])
    solver.set_scale_variables_using_bounds(options["scale"])
    solver.set_parallel(0)
    _set_guess(solver, folder, problem, model)
    return study


def _add_goals(moco: osim.MocoProblem, folder: Path, problem: dict, model: osim.Model) -> None:
    tracking = osim.MocoStateTrackingGoal("tracking", 1.0)
    tracking.setReference(osim.TableProcessor(str(folder / problem["reference"])))
    tracking.setAllowUnusedReferences(True)
    for path, weight in problem["tracking_weights"].items():
        tracking.setWeightForState(path, weight)
    moco.addGoal(tracking)
    if problem["contact"] == "smooth":
        for foot in ("foot_r", "foot_l"):
            for axis, weight in problem["force_weights"][foot].items():
                goal = osim.MocoContactTrackingGoal(f"force_{foot}_{axis}", weight)
                goal.setExternalLoadsFile(str(folder / problem["reference_loads"]))
                names = osim.StdVectorString()
                for point in ("heel", "toe"):
                    names.append(f"/forceset/contact_{point}_{foot[-1]}")
                goal.addContactGroup(names, f"ground_on_{foot}")
                goal.setProjection("vector")
                goal.setProjectionVector(osim.Vec3(*[float(axis == each) for each in "xyz"]))
                moco.addGoal(goal)
    effort = osim.MocoControlGoal("effort", problem["effort_weight"])
    for name in problem["residuals"]:
        effort.setWeightForControl(f"/forceset/{PREFIX}{name}", problem["residual_weight"])
    moco.addGoal(effort)

    model.initSystem()
    periodic = osim.MocoPeriodicityGoal("periodic")
    for path in osim.createStateVariableNamesInSystemOrder(model):
        if path != problem["travel"]:
            periodic.addStatePair(osim.MocoPeriodicityGoalPair(path))
    for path in osim.createControlNamesFromModel(model):
        periodic.addControlPair(osim.MocoPeriodicityGoalPair(path))
    moco.addGoal(periodic)
    speed = osim.MocoAverageSpeedGoal("speed")
    speed.set_desired_average_speed(problem["speed"])
    moco.addGoal(speed)


def _set_guess(
    solver: osim.MocoCasADiSolver, folder: Path, problem: dict, model: osim.Model
) -> None:
    """Our own starting point: the reference with the muscle forces that fit it best."""
    guess = solver.createGuess("bounds")
    states = osim.TimeSeriesTable(str(folder / problem["guess_states"]))
    controls = osim.TimeSeriesTable(str(folder / problem["guess_controls"]))
    fine = np.array(states.getIndependentColumn())
    fine *= problem["final_time"] / fine[-1]
    times = guess.getTimeMat()
    for path in guess.getStateNames():
        column = states.getDependentColumn(path).to_numpy()
        guess.setState(path, np.interp(times, fine, column))
    for path in guess.getControlNames():
        if PREFIX in path:
            guess.setControl(path, np.zeros(len(times)))
            continue
        column = np.clip(controls.getDependentColumn(path).to_numpy(), LEAST_ACTIVATION, 1.0)
        guess.setControl(path, np.interp(times, fine, column))
    for path in guess.getDerivativeNames():
        guess.setDerivative(path, np.zeros(len(times)))
    solver.setGuess(guess)


def main() -> None:
    folder = Path(sys.argv[1]).resolve()
    problem = json.loads((folder / "problem.json").read_text(encoding="utf-8"))
    os.chdir(folder)
    start = time.time()
    # CasADi's IPOPT reads this file; Moco has no limit of time of its own.
    limit = f"max_cpu_time {problem['time_limit']}\nprint_timing_statistics yes\n"
    Path("ipopt.opt").write_text(limit, encoding="utf-8")
    model = model_with_loads(folder, problem)
    study = study_of(folder, problem, model)
    ready = time.time()
    solution = study.solve()
    done = time.time()
    status = solution.getStatus()
    if solution.isSealed():
        solution.unseal()
    solution.write("solution.sto")
    if problem["contact"] == "smooth":
        sides = []
        for side in "rl":
            sides.append(osim.StdVectorString())
            for point in ("heel", "toe"):
                sides[-1].append(f"/forceset/contact_{point}_{side}")
        forces = osim.createExternalLoadsTableForGait(model, solution, *sides)
        osim.STOFileAdapter.write(forces, "contact_forces.sto")
    terms = {name: solution.getObjectiveTerm(name) for name in solution.getObjectiveTermNames()}
    result = {
        "opensim": osim.GetVersion(),
        "status": status,
        "success": bool(solution.success()),
        "iterations": solution.getNumIterations(),
        "objective": solution.getObjective(),
        "terms": terms,
        "setup_s": ready - start,
        "solve_s": done - ready,
        "solver_duration_s": solution.getSolverDuration(),
    }
    Path("result.json").write_text(json.dumps(result, indent=1), encoding="utf-8")


if __name__ == "__main__":
    main()
