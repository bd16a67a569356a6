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
import statistics
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from walks import machine  # this file's folder is where Python looks first

from drakegait import GaitStudy, solve
from drakegait.program.differences import DifferencedProgram
from drakegait.program.gait_program import GaitProgram
from drakegait.program.guess import guess_from_reference
from drakegait.transcription.splines import PeriodicQuintic

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


def milliseconds(call: Callable[[], object], repeats: int = REPEATS) -> float:
    """Median wall time."""
    times = []
    for _ in range(repeats):
        started = time.perf_counter()
        call()
        times.append(1e3 * (time.perf_counter() - started))
    return statistics.median(times)


def derivatives(study: GaitStudy) -> dict[str, float]:
    """One set of first derivatives, cost and rows: exact, by colours, and one by one."""
    formulation = study.formulation()
    exact = GaitProgram(formulation)
    x = guess_from_reference(exact)
    coloured = DifferencedProgram(formulation)
    moves = iter(1e-6 * np.arange(1, 10_000))

    def at(program: GaitProgram) -> None:
        y = x + next(moves)
        program.gradient(y)
        program.jacobian(y)

    at(exact)
    by_colours = milliseconds(lambda: at(coloured), 3)
    one_value = milliseconds(lambda: exact.rows(x + next(moves)))
    return {
        "variables": exact.num_variables,
        "colours": coloured.num_colours,
        "exact_ms": milliseconds(lambda: at(exact)),
        "coloured_ms": by_colours,
        "one_by_one_ms_estimated": by_colours * exact.num_variables / coloured.num_colours,
        "values_alone_ms": one_value,
    }


def splines(study: GaitStudy) -> dict[str, float]:
    """From nodal values to coefficients, for all curves of the study: each time, or prepared.

    The paper's polynomials have 5 (N - 1) unknowns; the B-splines here have N - 1.
    """
    nodes = study.nodes
    walker = study.walker
    curves = walker.skeleton.num_coordinates + walker.muscles.num_muscles
    spline = PeriodicQuintic(nodes)
    nodal = np.random.default_rng(0).normal(size=(curves, nodes - 1))
    system, right = polynomial_system(nodes - 1)
    inverse = np.linalg.inv(system) @ right
    wanted = polynomials(np.linalg.solve(system, right @ nodal.T), nodal)
    ours = spline.evaluate(spline.coefficients(nodal), (np.arange(nodes - 1) + 0.3) / (nodes - 1))
    np.testing.assert_allclose(wanted, ours.T, atol=1e-9)
    circulant = spline.nodal_values(np.eye(nodes - 1)).T
    instants = study.schedule.num_points
    tau = np.linspace(0.0, 1.0, instants, endpoint=False)
    coefficients = spline.coefficients(nodal)
    return {
        "curves": curves,
        "unknowns_per_curve": 5 * (nodes - 1),
        "polynomials_assembled_and_solved_ms": milliseconds(
            lambda: np.linalg.solve(*(lambda a, b: (a, b @ nodal.T))(*polynomial_system(nodes - 1)))
        ),
        "polynomials_solved_ms": milliseconds(lambda: np.linalg.solve(system, right @ nodal.T)),
        "polynomials_prepared_ms": milliseconds(lambda: inverse @ nodal.T),
        "b_splines_solved_ms": milliseconds(lambda: np.linalg.solve(circulant, nodal.T)),
        "b_splines_prepared_ms": milliseconds(lambda: spline.coefficients(nodal)),
        "evaluation_at_control_points_ms": milliseconds(
            lambda: [spline.evaluate(coefficients, tau, order) for order in range(3)]
        ),
    }


def polynomial_system(intervals: int) -> tuple[np.ndarray, np.ndarray]:
    """Matrix (5 M, 5 M) of c_1 .. c_5 of each interval and (5 M, M) of the nodal values.

    p_i(t) = f_i + c_1 t + .. + c_5 t^5 on 0 <= t <= 1: it ends at f_(i+1), and its derivatives 1 to
    4 go on in the next interval; the last one is followed by the first.
    """
    size = 5 * intervals
    matrix, right = np.zeros((size, size)), np.zeros((size, intervals))
    for i in range(intervals):
        after = (i + 1) % intervals
        matrix[5 * i, 5 * i : 5 * i + 5] = 1.0
        right[5 * i, after], right[5 * i, i] = 1.0, -1.0
        for order in range(1, 5):
            row = 5 * i + order
            for power in range(order, 6):
                falling = np.prod(np.arange(power - order + 1, power + 1))
                matrix[row, 5 * i + power - 1] = falling
            matrix[row, 5 * after + order - 1] = -np.prod(np.arange(1, order + 1))
    return matrix, right


def polynomials(unknowns: np.ndarray, nodal: np.ndarray, t: float = 0.3) -> np.ndarray:
    """Values (M, num_curves) at the share t of each interval."""
    by_interval = unknowns.reshape(len(nodal[0]), 5, -1)
    return nodal.T + np.einsum("p,ipc->ic", t ** np.arange(1, 6), by_interval)


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
