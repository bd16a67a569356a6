"""What the paper claims about its formulation, each claim measured on one problem in one run.

Garcia-Vallejo & Schiehlen (2012), sections 2 to 5: bounds on each residual (28) against one bound
on the largest (29); exact derivatives against finite differences; splines prepared before the
solve against splines solved at each evaluation; contact forces by pseudo-inverse against contact
forces as variables; ends forced by eq. (14) against periodic splines; external torques at the
metatarsophalangeal joint or none; sequence 213 against 123.

All solves are by ipopt-mumps, from the reference, without refinement. Second derivatives are exact
unless the name says limited memory (`lm`), as the paper's were; pairs that belong together have the
same.

    python benchmarks/formulation.py
    python benchmarks/formulation.py --model planar --nodes 18 --time-limit 600
    python benchmarks/formulation.py --rows reference eq14
"""

from __future__ import annotations

import argparse
import json
from pathlib import Path
from typing import Any

from walks import machine  # this file's folder is where Python looks first

from drakegait import GaitStudy, solve
from drakegait.paper.timings import derivatives, splines

RESULTS = Path(__file__).with_name("formulation.json")
LM = {"second_derivatives": "limited-memory"}
PROJECTED = {"multipliers": "projected"}
# Name of each solve -> statements of the study, settings, solver options.
SOLVES: dict[str, tuple[dict[str, Any], dict[str, Any], dict[str, Any]]] = {
    "reference": ({}, {}, {}),
    "reference, lm": ({}, {}, LM),
    "eq29": ({}, {"eom_form": "maximum"}, {}),
    "eq29, lm": ({}, {"eom_form": "maximum"}, LM),
    "projected, lm": (PROJECTED, {}, LM),
    "projected eq29, lm": (PROJECTED, {"eom_form": "maximum"}, LM),
    "finite differences, lm": ({}, {}, LM | {"derivatives": "finite-differences"}),
    "eq14": ({}, {"periodicity": "eq14"}, {}),
    "toe torque": ({}, {"toe_torque": True}, {}),
    "toe torque without limit": ({}, {"toe_torque": True, "toe_torque_limit": 1000.0}, {}),
    "spatial 213": ({"model": "spatial-symmetric", "nodes": 19}, {}, {}),
    "spatial 123": ({"model": "spatial-symmetric", "nodes": 19}, {"sequence": "123"}, {}),
}
# Claim of the paper -> the solves that test it.
CLAIMS = {
    "(28) takes fewer iterations than (29)": (
        "reference", "eq29", "reference, lm", "eq29, lm", "projected, lm", "projected eq29, lm"),
    "analytic derivatives take less time than finite differences": (
        "reference, lm", "finite differences, lm"),
    "lambda by the pseudo-inverse (17); drakegait: lambda as variables": (
        "reference, lm", "projected, lm"),
    "(14) forced upon the curves; drakegait: periodic splines": ("reference", "eq14"),
    "no external torque at the toe leads to a very similar solution": (
        "reference", "toe torque", "toe torque without limit"),
    "rotations are the same in the sequences 213 and 123": ("spatial 213", "spatial 123"),
}  # fmt: skip
REPEATS = 50
SOLVER = "ipopt-mumps"  # takes every form itself, unlike the default


def solved(study: GaitStudy, options: dict[str, Any], time_limit: float) -> dict[str, Any]:
    """One solve and what it found."""
    gait = solve(study, solver=SOLVER, refine=False, time_limit=time_limit, **options)
    outcome, report = gait.outcome, gait.report
    return {
        "status": outcome.status,
        "passed": report.passed,
        "iterations": outcome.iterations,
        "wall_s": outcome.wall_time,
        "f": gait.cost["total"],
        "energy_J_per_m": gait.metabolic.cost_of_transport,
        "deviation_s": report.deviation,
        "residual_N": report.equations_of_motion_max_N,
        "residual_Nm": report.equations_of_motion_max_Nm,
        "variables": outcome.num_variables,
        "rows": outcome.num_constraints,
    }


def table(results: dict[str, Any]) -> str:
    """Claims with their solves, then derivatives and splines, as Markdown."""
    lines = [
        "| claim | solve | ended | check | iterations | time [s] | f | energy [J/m] | J_dev [s] |",
        "|---|---|---|---|---:|---:|---:|---:|---:|",
    ]
    rows = results["solves"]
    for claim, names in CLAIMS.items():
        for name in (name for name in names if name in rows):
            row = rows[name]
            lines.append(
                f"| {claim} | {name} | {row['status']} | {'passed' if row['passed'] else 'failed'} "
                f"| {row['iterations']} | {row['wall_s']:.1f} | {row['f']:.3f} "
                f"| {row['energy_J_per_m']:.1f} | {row['deviation_s']:.2f} |"
            )
            claim = ""
    for what in ("derivatives", "splines"):
        lines += ["", f"| {what} | |", "|---|---:|"]
        lines += [f"| {name} | {value:.4g} |" for name, value in results[what].items()]
    return "\n".join(lines)


def main() -> None:
    """Measure, print, and write `formulation.json`."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--model", default="planar-symmetric")
    parser.add_argument("--nodes", type=int, default=19)
    parser.add_argument("--time-limit", type=float, default=300.0, help="for each solve [s]")
    parser.add_argument("--rows", nargs="*", choices=list(SOLVES), default=list(SOLVES))
    parser.add_argument("--out", type=Path, default=RESULTS)
    asked, _ = parser.parse_known_args()
    base = GaitStudy(model=asked.model, nodes=asked.nodes)
    results: dict[str, Any] = {
        "machine": machine(), "model": asked.model, "nodes": asked.nodes,
        "time_limit_s": asked.time_limit, "solves": {},
        "derivatives": derivatives(base), "splines": splines(base),
    }  # fmt: skip
    for name in asked.rows:
        statements, settings, options = SOLVES[name]
        study = base.replace(**statements).with_settings(**settings)
        results["solves"][name] = row = solved(study, options, asked.time_limit)
        print(f"{name:28}{row['status']:17}{row['iterations']:5} {row['wall_s']:8.1f} s "
              f"f = {row['f']:.3f}", flush=True)  # fmt: skip
        asked.out.write_text(json.dumps(results, indent=2) + "\n", encoding="utf-8")
    print(table(results))


if __name__ == "__main__":
    main()
