"""How time and memory grow with spline nodes and with control points.

Every case is a process of its own, from the start of Python to the answer, without added control
points; with many nodes the walk with half as many, at which it begins, is in it. Two series for
each model: nodes from 18 to 70, whose control points grow along as they do by default, and control
points at fixed nodes. A power law is fitted to each: the exponent is the slope over the logarithms,
2 where twice as many nodes take four times as long.

    python benchmarks/scaling.py                                   # both models, seven minutes
    python benchmarks/scaling.py --models planar --nodes 18 24     # some cases
    python benchmarks/scaling.py --repeats 3                       # medians
    python benchmarks/scaling.py --readme                          # table and figure, no runs

Results go to `benchmarks/scaling.json` after every case, the figure to `benchmarks/scaling.svg`,
the table into `benchmarks/README.md`. Measure on a machine that does nothing else.
"""

from __future__ import annotations

import argparse
import datetime
import json
import math
import os
import subprocess
import sys
import time
from collections.abc import Sequence
from typing import Any

import numpy as np
from walks import ROOT, machine, median_of, write_readme  # this file's folder comes first

RESULTS = ROOT / "benchmarks" / "scaling.json"
FIGURE = RESULTS.with_suffix(".svg")
BEGIN, END = "<!-- scaling:begin -->", "<!-- scaling:end -->"
MODELS = ("spatial", "planar")
NODES = (18, 24, 35, 50, 70)
FIXED_NODES = 18
DENSER = (1, 2, 3, 4)  # times the control points at FIXED_NODES
LIMIT = 1800.0  # of a solve [s]
SERIES = {"nodes": "nodes", "points": "control_points"}
"""Series -> the number over which it is drawn and fitted."""
QUANTITIES = {
    "iteration_s": "time per iteration [s]",
    "iterations": "iterations",
    "wall_s": "wall [s]",
    "peak_memory_MiB": "memory [MiB]",
}
"""What is fitted. Wall and iterations count answers only, the others every case."""
_OF_ANSWERS = ("wall_s", "iterations")


# Measuring ---------------------------------------------------------------------------------------


def solve_one(model: str, nodes: int, denser: int) -> None:
    """The child: solve and print a record as the last line."""
    from drakegait.solve import solve
    from drakegait.study import GaitStudy

    study = GaitStudy(model=model, nodes=nodes)
    if denser > 1:
        inside = study.schedule.interior_points
        study = study.replace(interior_points=tuple(denser * (n + 1) - 1 for n in inside))
    outcome = solve(study, refine=False, time_limit=LIMIT).outcome
    record = {
        "control_points": study.schedule.num_points,
        "variables": outcome.num_variables,
        "rows": outcome.num_constraints,
        "jacobian_nonzeros": outcome.jacobian_nonzeros,
        "status": outcome.status,
        "iterations": outcome.iterations,
        "solver_s": outcome.wall_time,
        "iteration_s": outcome.wall_time / max(outcome.iterations, 1),
    }
    print(json.dumps(record), flush=True)


def run(model: str, nodes: int, denser: int) -> dict[str, Any]:
    """One case in a process of its own, with its wall time and largest resident memory."""
    words = [sys.executable, __file__, "--one", model, str(nodes), str(denser)]
    # As the command line has it: one BLAS thread.
    environment = {"OMP_CANCELLATION": "TRUE", "OPENBLAS_NUM_THREADS": "1", **os.environ}
    started = time.perf_counter()
    child = subprocess.Popen(words, cwd=ROOT, env=environment, stdout=subprocess.PIPE, text=True)
    assert child.stdout is not None
    lines = child.stdout.read().splitlines()
    _, status, used = os.wait4(child.pid, 0)
    child.returncode = code = os.waitstatus_to_exitcode(status)
    if code or not lines:
        raise SystemExit(f"{model} with {nodes} nodes ended with {code}.")
    unit = 2**20 if sys.platform == "darwin" else 2**10  # of ru_maxrss, per MiB
    return json.loads(lines[-1]) | {
        "wall_s": time.perf_counter() - started,
        "peak_memory_MiB": used.ru_maxrss / unit,
    }


def measure(series: str, model: str, nodes: int, denser: int, repeats: int) -> dict[str, Any]:
    """Medians of several runs of a case."""
    record = median_of([run(model, nodes, denser) for _ in range(repeats)])
    case = {"series": series, "model": model, "nodes": nodes, "denser": denser, "runs": repeats}
    return case | record | {"measured": datetime.date.today().isoformat()}


def cases(models: Sequence[str], nodes: Sequence[int], denser: Sequence[int]) -> list[tuple]:
    """Series, model, nodes, denser of every case; the small ones of both models first."""
    found = [("nodes", model, n, 1) for n in nodes for model in models]
    return found + [("points", model, FIXED_NODES, d) for d in denser for model in models]


# Fits and tables ---------------------------------------------------------------------------------


def chosen(records: Sequence[dict[str, Any]], series: str, model: str, quantity: str):
    """(x, y) of a series, ascending; of answers only where a quantity is one of an answer."""
    points = sorted(
        (record[SERIES[series]], record[quantity])
        for record in records
        if record["series"] == series and record["model"] == model
        and (quantity not in _OF_ANSWERS or record["status"] == "converged")
    )  # fmt: skip
    return np.array(points, dtype=float).reshape(-1, 2).T


def exponent(x: np.ndarray, y: np.ndarray) -> float:
    """Slope of log y over log x by least squares; nan for fewer than two places."""
    if len(np.unique(x)) < 2:
        return math.nan
    return float(np.polyfit(np.log(x), np.log(y), 1)[0])


def steepest(x: np.ndarray, y: np.ndarray) -> float:
    """The largest exponent between neighbours, which a fit over all would hide."""
    if len(np.unique(x)) < 2:
        return math.nan
    return float(np.max(np.diff(np.log(y)) / np.diff(np.log(x))))


def table(results: dict[str, Any]) -> str:
    """Exponents and cases as Markdown."""
    records = results["cases"]
    models = [model for model in MODELS if any(r["model"] == model for r in records)]
    lines = ["| grows with | model | " + " | ".join(QUANTITIES.values()) + " |",
             "|---|---|" + "---:|" * len(QUANTITIES)]  # fmt: skip
    for series, over in SERIES.items():
        for model in models:
            cells = []
            for quantity in QUANTITIES:
                x, y = chosen(records, series, model, quantity)
                pair = (exponent(x, y), steepest(x, y))
                cells.append("-" if math.isnan(pair[0]) else f"{pair[0]:.2f} ({pair[1]:.2f})")
            lines.append(f"| {over.replace('_', ' ')} | {model} | " + " | ".join(cells) + " |")
    heads = ("model", "nodes", "control points", "variables", "time per iteration [ms]",
             "iterations", "wall [s]", "memory [MiB]", "ended")  # fmt: skip
    lines += ["", "Exponents of the fit, in brackets the largest between neighbours.", ""]
    lines += ["| " + " | ".join(heads) + " |", "|---|" + "---:|" * (len(heads) - 2) + "---|"]
    for r in records:
        lines.append(
            f"| {r['model']} | {r['nodes']} | {r['control_points']} | {r['variables']} | "
            f"{1e3 * r['iteration_s']:.0f} | {r['iterations']:.0f} | {r['wall_s']:.1f} | "
            f"{r['peak_memory_MiB']:.0f} | {r['status'].replace('_', ' ')} |"
        )
    on, runs = results["machine"], sorted({r["runs"] for r in records})
    how = "one run each" if runs == [1] else f"medians of {' or '.join(map(str, runs))} runs"
    days = sorted({r["measured"] for r in records})
    text = f"{how.capitalize()}, {' to '.join(dict.fromkeys([days[0], days[-1]]))}, on "
    text += f"{on['cores']} cores of {on['processor']} ({on['system']})."
    return "\n".join([*lines, "", f"![time and memory]({FIGURE.name})", "", text])


def draw(results: dict[str, Any]) -> None:
    """Time per iteration, wall and memory over nodes and over control points, logarithmic."""
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt
    from matplotlib.ticker import LogLocator

    shown = [name for name in QUANTITIES if name != "iterations"]
    style = {"svg.hashsalt": "drakegait", "font.size": 8, "svg.fonttype": "none"}
    with matplotlib.rc_context(style):
        figure, grid = plt.subplots(2, len(shown), figsize=(7.4, 4.4), layout="constrained")
        for row, (series, over) in zip(grid, SERIES.items(), strict=True):
            for axes, quantity in zip(row, shown, strict=True):
                for model, mark in zip(MODELS, ("o-", "s--"), strict=True):
                    x, y = chosen(results["cases"], series, model, quantity)
                    if len(x):
                        slope = exponent(x, y)
                        label = model if math.isnan(slope) else f"{model}, exponent {slope:.2f}"
                        axes.loglog(x, y, mark, ms=3.5, lw=1.0, label=label)
                        axes.set_xticks(x, [f"{v:.0f}" for v in x], minor=False)
                        axes.legend(frameon=False, fontsize=6.5)
                axes.minorticks_off()
                axes.yaxis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
                axes.yaxis.set_major_formatter("{x:g}")
                axes.set_title(QUANTITIES[quantity], fontsize=8)
                axes.set_xlabel(over.replace("_", " "))
        figure.savefig(FIGURE, metadata={"Date": None})
        plt.close(figure)


def stored() -> dict[str, Any]:
    """Earlier results of this machine and these versions; empty if it was another."""
    here = machine()
    if RESULTS.exists():
        results = json.loads(RESULTS.read_text(encoding="utf-8"))
        if results["machine"] == here:
            return results
    return {"machine": here, "cases": []}


def store(results: dict[str, Any], record: dict[str, Any]) -> None:
    """Put a record in the place of an earlier one of the same case, and write the file."""
    key = ("series", "model", "nodes", "denser")
    kept = [r for r in results["cases"] if [r[k] for k in key] != [record[k] for k in key]]
    results["cases"] = sorted([*kept, record], key=lambda r: [r[k] for k in key])
    RESULTS.write_text(json.dumps(results, indent=1) + "\n", encoding="utf-8")


def main() -> None:
    """Measure the cases asked for, or make table and figure of what was measured."""
    parser = argparse.ArgumentParser(description="How time and memory grow with the problem.")
    parser.add_argument("--models", nargs="+", choices=MODELS, default=MODELS)
    parser.add_argument("--nodes", nargs="*", type=int, default=NODES, metavar="N")
    parser.add_argument("--denser", nargs="*", type=int, default=DENSER, metavar="K",
                        help=f"times the control points of {FIXED_NODES} nodes")  # fmt: skip
    parser.add_argument("--repeats", type=int, default=1, metavar="N", help="medians of N")
    parser.add_argument("--readme", action="store_true", help="only write table and figure")
    parser.add_argument("--one", nargs=3, help=argparse.SUPPRESS)
    asked = parser.parse_args()
    if asked.one:
        solve_one(asked.one[0], int(asked.one[1]), int(asked.one[2]))
        return
    if min([asked.repeats, *asked.nodes, *asked.denser]) < 1:
        parser.error("--repeats, --nodes and --denser must be at least 1")
    if asked.readme:
        if not RESULTS.exists():
            parser.error(f"{RESULTS.name} is not there: measure first")
        results = json.loads(RESULTS.read_text(encoding="utf-8"))
    else:
        results = stored()
        for case in cases(asked.models, asked.nodes, asked.denser):
            record = measure(*case, asked.repeats)
            store(results, record)
            print(
                f"{record['model']}, {record['nodes']} nodes, {record['control_points']} points: "
                f"{1e3 * record['iteration_s']:.0f} ms x {record['iterations']:.0f}, "
                f"{record['wall_s']:.1f} s, {record['peak_memory_MiB']:.0f} MiB, "
                f"{record['status']}", flush=True,
            )  # fmt: skip
    draw(results)
    text = table(results)
    print(f"\n{text}")
    if asked.readme:
        write_readme(RESULTS.with_name("README.md"), text, BEGIN, END)


if __name__ == "__main__":
    main()
