"""What an earlier gait is worth as a start: changed walks from it, and from the reference.

    python benchmarks/warm_starts.py                 # all changes, about ten minutes
    python benchmarks/warm_starts.py --model planar  # those of one model
    python benchmarks/warm_starts.py --print         # tables from the file, no runs

The walk without change is solved first; then each changed one twice, from the reference (cold) and
from that walk with its multipliers (warm), in this process, without added control points, by the
default solver. A cold and a warm solve may end in different optima: both costs are kept. Results
go to `benchmarks/warm_starts.json`, after every change.
"""

from __future__ import annotations

import argparse
import json
import os
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # as on the command line

from drakegait.gait import Gait  # noqa: E402
from drakegait.solve import solve  # noqa: E402
from drakegait.study import MODELS, GaitStudy  # noqa: E402

RESULTS = Path(__file__).resolve().parent / "warm_starts.json"
BASES = (
    ("spatial", 18), ("spatial", 27), ("spatial", 35), ("spatial-symmetric", 19),
    ("planar", 18), ("planar", 24), ("planar", 35),
    ("planar-symmetric", 19), ("planar-symmetric", 25), ("planar-symmetric", 35),
)  # fmt: skip
# Of the spatial walk with 18 nodes, whose changes are the users', more than of the others.
MANY = ("spatial", 18)
SEGMENTS, MASSES = ("foot_r", "foot_l", "thigh_r", "shank_l"), (0.3, 0.7, 1.5, 2.0, 3.0)  # kg
SPEEDS = (1.1, 1.15, 1.25, 1.3)  # m/s
FEW_MASSES, FEW_SPEEDS = (0.5, 2.0), (1.25,)


def changes(model: str, nodes: int) -> Iterator[tuple[str, GaitStudy]]:
    """Names and studies of what is changed."""
    study = GaitStudy(model=model, nodes=nodes)
    many = (model, nodes) == MANY
    for segment in SEGMENTS if many else ("foot_r",):
        for mass in MASSES if many else FEW_MASSES:
            changed = study.with_added_mass(segment, mass)
            name = f"{mass:g} kg on {segment}"
            if "symmetric" in model:  # both feet
                changed, name = changed.with_added_mass("foot_l", mass), f"{name} and foot_l"
            yield name, changed
    for speed in SPEEDS if many else FEW_SPEEDS:
        yield f"{speed:g} m/s", GaitStudy(model=model, nodes=nodes, speed=speed)


def run(study: GaitStudy, guess: Gait | None) -> dict[str, Any]:
    """One solve, as a record."""
    began = time.monotonic()
    gait = solve(study, guess=guess, refine=False)
    return {
        "status": gait.outcome.status,
        "iterations": gait.outcome.iterations,
        "wall_s": time.monotonic() - began,
        "cost": gait.cost["total"],
    }


def _means(pairs: list[tuple[dict[str, Any], dict[str, Any]]], key: str) -> np.ndarray:
    """Geometric means (2,) of the cold and of the warm solves."""
    return np.exp(np.mean(np.log([[one[key] for one in pair] for pair in pairs]), axis=0))


def table(results: dict[str, dict[str, Any]]) -> str:
    """The results as Markdown: a line per walk; means are geometric."""
    lines = [
        "| walk | changes | iterations, cold | warm | solve, cold [s] | warm [s] | ratio of times: "
        "mean | least | most | f, warm by cold |",
        "|---|" + "---:|" * 9,
    ]
    for name, found in results.items():
        pairs = [(item["cold"], item["warm"]) for item in found["changes"].values()]
        pairs = [pair for pair in pairs if all(one["status"] == "converged" for one in pair)]
        if not pairs:
            continue

        ratios = [warm["wall_s"] / cold["wall_s"] for cold, warm in pairs]
        iterations, times, costs = (_means(pairs, key) for key in ("iterations", "wall_s", "cost"))
        lines.append(
            f"| {name} | {len(pairs)} | {iterations[0]:.0f} | {iterations[1]:.0f} | "
            f"{times[0]:.1f} | {times[1]:.1f} | {times[1] / times[0]:.2f} | {min(ratios):.2f} | "
            f"{max(ratios):.2f} | {costs[1] / costs[0]:.4f} |"
        )
    return "\n".join(lines)


def main() -> None:
    """Solve all changes of the models asked for."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--model", choices=sorted(MODELS), action="append")
    parser.add_argument("--print", action="store_true", help="tables from the file, no runs")
    given = parser.parse_args()
    results = json.loads(RESULTS.read_text(encoding="utf-8")) if RESULTS.exists() else {}
    for model, nodes in () if given.print else BASES:
        if given.model and model not in given.model:
            continue
        name = f"{model}, {nodes} nodes"
        base = solve(GaitStudy(model=model, nodes=nodes))
        results[name] = {"iterations": base.outcome.iterations, "changes": {}}
        for change, study in changes(model, nodes):
            found = {"cold": run(study, None), "warm": run(study, base)}
            results[name]["changes"][change] = found
            counts = [f"{way} {one['iterations']} ({one['status']})" for way, one in found.items()]
            print(f"{name}, {change}: {', '.join(counts)}", flush=True)
            RESULTS.write_text(json.dumps(results, indent=1) + "\n", encoding="utf-8")
    print(table(results))


if __name__ == "__main__":
    main()
