"""One answer under all versions? The default walks under several Pythons and releases of Drake.

    python benchmarks/versions.py .venv/bin/python .venv-other/bin/python

Each Python must be able to import drakegait and what it needs. Every walk is a process of its own,
from the reference, without added control points. Results go to `benchmarks/versions.json`; costs
agree where they differ by less than 1e-4 of themselves.
"""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[1]
RESULTS = ROOT / "benchmarks" / "versions.json"
AGREES = 1e-4
WALKS = {
    "planar-symmetric, 19 nodes": ("planar-symmetric", 19),
    "planar-symmetric, 35 nodes": ("planar-symmetric", 35),
    "planar, 18 nodes": ("planar", 18),
    "spatial-symmetric, 19 nodes": ("spatial-symmetric", 19),
    "spatial, 18 nodes": ("spatial", 18),
}


def walk(python: str, model: str, nodes: int) -> dict[str, Any]:
    """Cost, iterations and versions of one walk; SystemExit if it did not converge."""
    command = [python, "-m", "drakegait.cli", "walk", "--model", model, "--nodes", str(nodes)]
    environment = {**os.environ, "PYTHONPATH": str(ROOT), "OMP_CANCELLATION": "TRUE"}
    with tempfile.TemporaryDirectory() as folder:
        done = subprocess.run(
            [*command, "--no-pictures", "--no-refine", "--out", folder],
            env=environment, capture_output=True, text=True,
        )  # fmt: skip
        if done.returncode != 0:
            raise SystemExit(f"{python}: {' '.join(command[3:])} ended with {done.returncode}.")
        summary = json.loads((Path(folder) / "summary.json").read_text(encoding="utf-8"))
    names = ("python", "drake", "numpy", "casadi")
    return {
        "versions": {name: summary["versions"][name] for name in names},
        "cost": summary["cost"]["total"],
        "iterations": summary["solver"]["iterations"],
    }


def table(results: dict[str, list[dict[str, Any]]]) -> str:
    """The results as Markdown."""
    first = next(iter(results.values()))
    heads = ["python {python}, drake {drake}".format(**item["versions"]) for item in first]
    lines = [f"| walk | {' | '.join(f'f, {head}' for head in heads)} | largest difference |"]
    lines.append("|---|" + "---:|" * (len(heads) + 1))
    for name, found in results.items():
        costs = [item["cost"] for item in found]
        shown = [f"{item['cost']:.6f} ({item['iterations']} iterations)" for item in found]
        spread = max(costs) / min(costs) - 1.0
        verdict = f"{spread:.1e}{'' if spread < AGREES else ', does not agree'}"
        lines.append(f"| {name} | {' | '.join(shown)} | {verdict} |")
    return "\n".join(lines)


def main() -> None:
    """Run all walks under all Pythons."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("python", nargs="+", help="of an environment that holds what it needs")
    given = parser.parse_args()
    results = {}
    for name, (model, nodes) in WALKS.items():
        print(f"{name} ...", file=sys.stderr, flush=True)
        results[name] = [walk(python, model, nodes) for python in given.python]
    RESULTS.write_text(json.dumps(results, indent=1) + "\n", encoding="utf-8")
    print(table(results))


if __name__ == "__main__":
    main()
