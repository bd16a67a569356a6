"""Does a walk hang on where the solve started? Many starts of each model, and what they end in.

Starts: the reference, standing, silent muscles, then the reference with 10 to 30 per cent of noise
on nodal values and phase durations (`drakegait/program/starts.py`). Optima whose costs differ by
less than one per cent are put together; what sets them apart is in the phase durations and in
the co-contraction, the stride's mean of the smaller of the activations of a joint's flexors and
extensors, each weighted with its greatest moment. Results go to `benchmarks/robustness.json`,
after every start.

    python benchmarks/robustness.py                              # planar-symmetric, 40 starts
    python benchmarks/robustness.py --model spatial --starts 40
    python benchmarks/robustness.py --model spatial --starts 40 --continue  # those not in the file
    python benchmarks/robustness.py --print                      # tables from the file, no runs
"""

from __future__ import annotations

import argparse
import datetime
import json
import time
from pathlib import Path
from typing import Any

import numpy as np

from drakegait.gait import Gait
from drakegait.loads import muscle_inputs
from drakegait.program.starts import Start, starts
from drakegait.solve import solve
from drakegait.solvers.options import SOLVERS, SolverOptions
from drakegait.study import MODELS, GaitStudy
from drakegait.summary import versions

RESULTS = Path(__file__).resolve().parent / "robustness.json"
SAME = 0.01  # optima whose costs differ by less are one
INSTANTS = 400
NODES = {"spatial": 18, "planar": 18, "spatial-symmetric": 19, "planar-symmetric": 19}


def co_contraction(gait: Gait) -> dict[str, float]:
    """Mean over the stride of min(flexors' activation, extensors'), both sides together."""
    walker, motion = gait.study.walker, gait.motion(np.arange(INSTANTS) / INSTANTS)
    activation = walker.muscle_functions.states(muscle_inputs(walker, motion))["activation"]
    moments = walker.muscles.f_max[:, None] * walker.muscles.moment_arms
    found: dict[str, list[float]] = {}
    for column, name in enumerate(gait.coordinate_names):
        ways = [np.maximum(sign * moments[:, column], 0.0) for sign in (1.0, -1.0)]
        if min(way.sum() for way in ways) > 0.0:
            pulls = [activation @ way / way.sum() for way in ways]
            found.setdefault(name[:-2], []).append(float(np.minimum(*pulls).mean()))
    return {name: float(np.mean(values)) for name, values in found.items()}


def run(study: GaitStudy, start: Start, options: SolverOptions, refine: bool) -> dict[str, Any]:
    """One solve, as a record."""
    began, cpu = time.monotonic(), time.process_time()
    gait = solve(study, starts=[start], refine=refine, options=options)
    outcome = gait.outcome
    return {
        "start": start.name,
        "status": outcome.status,
        "message": outcome.message,
        "worst": list(outcome.worst),
        "cost": gait.cost["total"],
        "energy_J_per_m": gait.metabolic.cost_of_transport,
        "deviation": gait.cost.get("deviation"),
        "iterations": outcome.iterations,
        "wall_s": time.monotonic() - began,
        "cpu_s": time.process_time() - cpu,
        "check_passed": gait.report.passed,
        "stride_time_s": gait.stride_time,
        "step_length_m": gait.placement.step_length_right,
        "phase_durations_s": gait.phase_durations.tolist(),
        "co_contraction": co_contraction(gait),
    }


def kept(before: dict[str, Any], now: dict[str, Any]) -> list[dict[str, Any]]:
    """Runs of the file to go on from; refuses those of another seed, refinement or version."""
    same = ("seed", "refined", "versions")
    differ = [name for name in same if before[name] != now[name]]
    if differ:
        raise SystemExit(f"cannot continue: the file differs in {', '.join(differ)}")
    return before["runs"]


def clusters(runs: list[dict[str, Any]]) -> list[list[dict[str, Any]]]:
    """Converged runs by cost, together while within `SAME` of the least of their cluster."""
    groups: list[list[dict[str, Any]]] = []
    for record in sorted(
        (r for r in runs if r["status"] == "converged"), key=lambda r: r["cost"]
    ):
        if not groups or record["cost"] > (1.0 + SAME) * groups[-1][0]["cost"]:
            groups.append([])
        groups[-1].append(record)
    return groups


def summarise(runs: list[dict[str, Any]]) -> dict[str, Any]:
    """What the runs of a model have in common and what not."""
    good = [r for r in runs if r["status"] == "converged"]
    costs = [r["cost"] for r in good]
    return {
        "starts": len(runs),
        "converged_percent": 100.0 * len(good) / len(runs),
        "spread_percent": 100.0 * (max(costs) / min(costs) - 1.0) if good else None,
        "check_passed_percent": 100.0 * sum(r["check_passed"] for r in good) / max(len(good), 1),
        "median_cpu_s": float(np.median([r["cpu_s"] for r in runs])),
        "median_iterations": float(np.median([r["iterations"] for r in runs])),
        "clusters": [
            {
                "runs": len(group),
                "cost": [group[0]["cost"], group[-1]["cost"]],
                "energy_J_per_m": _range(group, "energy_J_per_m"),
                "phase_durations_s": _mean(group, "phase_durations_s"),
                "step_length_m": _range(group, "step_length_m"),
                "co_contraction": {
                    joint: float(np.mean([r["co_contraction"][joint] for r in group]))
                    for joint in group[0]["co_contraction"]
                },
                "starts": [r["start"] for r in group],
            }
            for group in clusters(runs)
        ],
    }


def _range(group: list[dict[str, Any]], key: str) -> list[float]:
    return [min(r[key] for r in group), max(r[key] for r in group)]


def _mean(group: list[dict[str, Any]], key: str) -> list[float]:
    return np.mean([r[key] for r in group], axis=0).tolist()


def print_model(name: str, found: dict[str, Any]) -> None:
    """A short table."""
    summary = found["summary"]
    spread = summary["spread_percent"]
    spread = "-" if spread is None else f"{spread:.2f}"
    print(
        f"\n{name}: {summary['converged_percent']:.1f} % of {summary['starts']} starts converged, "
        f"costs within {spread} %, median {summary['median_iterations']:.0f} iterations, "
        f"{summary['median_cpu_s']:.1f} s CPU"
    )
    for group in summary["clusters"]:
        durations = " ".join(f"{x:.3f}" for x in group["phase_durations_s"])
        muscles = ", ".join(f"{j} {x:.3f}" for j, x in group["co_contraction"].items())
        low, high = group["cost"]
        print(f"  {group['runs']:3d} x f {low:.4f} to {high:.4f}; phases [s] {durations}")
        print(f"        co-contraction {muscles}")
    for record in found["runs"]:
        if record["status"] != "converged":
            print(f"  {record['start']}: {record['message']}")
            print("".join(f"        {row}\n" for row in record["worst"]), end="")


def save(results: dict[str, Any]) -> None:
    """Write all results, beside the file and then renamed."""
    beside = RESULTS.with_suffix(".part")
    beside.write_text(json.dumps(results, indent=1) + "\n", encoding="utf-8")
    beside.replace(RESULTS)


def main() -> None:
    """See the top of this file."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--model", action="append", choices=MODELS)
    parser.add_argument("--starts", type=int, default=40)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--nodes", type=int, help="default 18, symmetric models 19")
    parser.add_argument("--solver", choices=SOLVERS, default=SolverOptions().solver)
    parser.add_argument("--limit", type=float, default=600.0, help="seconds for each start")
    parser.add_argument("--no-refine", action="store_true", help="no added control points")
    parser.add_argument(
        "--continue", dest="go_on", action="store_true",
        help="keep starts of the same seed and versions that the file holds, and run the rest",
    )  # fmt: skip
    parser.add_argument("--print", action="store_true", help="tables from the file, no runs")
    given = parser.parse_args()
    options = SolverOptions(solver=given.solver, time_limit=given.limit)
    results = json.loads(RESULTS.read_text("utf-8")) if RESULTS.exists() else {}
    if not given.print:
        for model in given.model or ["planar-symmetric"]:
            study = GaitStudy(model=model, nodes=given.nodes or NODES[model])
            found: dict[str, Any] = {
                "nodes": study.nodes, "solver": given.solver, "seed": given.seed,
                "refined": not given.no_refine,
                "date": datetime.date.today().isoformat(), "versions": versions(), "runs": [],
            }  # fmt: skip
            key = f"{model}, {study.nodes} nodes, {given.solver}"
            if given.go_on and key in results:
                found["runs"] = kept(results[key], found)
            for start in starts(given.starts, given.seed)[len(found["runs"]) :]:
                record = run(study, start, options, not given.no_refine)
                found["runs"].append(record)
                found["summary"] = summarise(found["runs"])
                results[key] = found
                save(results)
                print(
                    f"{model}: {record['start']}: {record['status']}, f {record['cost']:.4f}, "
                    f"{record['iterations']} iterations, {record['cpu_s']:.1f} s CPU", flush=True,
                )  # fmt: skip
    for name, found in results.items():
        print_model(name, found)


if __name__ == "__main__":
    main()
