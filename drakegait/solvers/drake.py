"""Drake's own IPOPT and SNOPT on the `MathematicalProgram`."""

from __future__ import annotations

import os
import re
import tempfile
from pathlib import Path
from typing import Any

# Drake's IPOPT factorises with SPRAL, which needs these before the library is loaded.
os.environ.setdefault("OMP_CANCELLATION", "TRUE")
os.environ.setdefault("OMP_PROC_BIND", "TRUE")

import numpy as np  # noqa: E402
from pydrake.solvers import (  # noqa: E402
    IpoptSolver,
    MathematicalProgramResult,
    SnoptSolver,
    SolutionResult,
    SolverInterface,
)
from pydrake.solvers import SolverOptions as DrakeOptions  # noqa: E402

from drakegait.program.gait_program import GaitProgram  # noqa: E402
from drakegait.program.mathematical_program import (  # noqa: E402
    DrakeProgram,
    mathematical_program,
)
from drakegait.solvers.ipopt_options import ipopt_options  # noqa: E402
from drakegait.solvers.monitor import Monitor, StopSolve  # noqa: E402
from drakegait.solvers.options import SolverOptions  # noqa: E402
from drakegait.solvers.solution import Solution, status_of_ipopt  # noqa: E402

_SNOPT_STATUS = {
    1: "converged", 2: "converged", 3: "acceptable", 11: "infeasible", 12: "infeasible",
    13: "infeasible", 14: "infeasible", 31: "iteration_limit", 32: "iteration_limit",
    34: "time_limit", 41: "acceptable",
}  # fmt: skip


def solve_with_drake(
    program: GaitProgram,
    x: np.ndarray,
    options: SolverOptions,
    monitor: Monitor,
    warm: bool = False,
) -> Solution:
    """Minimise with Drake's `IpoptSolver` or `SnoptSolver` from `x`; see `Solution`."""

    def guard() -> None:
        if monitor.stop_reason is not None:
            raise StopSolve(monitor.stop_reason)

    def watch(at: np.ndarray) -> None:
        monitor.step(at)
        guard()

    drake = mathematical_program(program, guard)

    drake.program.AddVisualizationCallback(watch, drake.variables)
    with tempfile.TemporaryDirectory() as folder:
        log = Path(folder) / "solver.log"
        if options.solver == "ipopt":
            solver: SolverInterface = IpoptSolver()
            chosen = _ipopt(options, warm, log)
        else:
            solver = SnoptSolver()
            chosen = _snopt(options, monitor, log)
        drake_options = DrakeOptions()
        for name, value in chosen.items():
            drake_options.SetOption(solver.solver_id(), name, value)
        try:
            result = solver.Solve(drake.program, x, drake_options)
        except (StopSolve, RuntimeError) as error:
            # Drake hands on the text of an exception with its traceback: the last line says it.
            return _stopped(x, monitor, str(error).strip().splitlines()[-1])
        text = log.read_text(errors="replace") if log.exists() else ""
    if options.solver == "ipopt":
        return _read_ipopt(drake, result, monitor, text, x)
    return _read_snopt(drake, result, monitor, text)


def _ipopt(options: SolverOptions, warm: bool, log: Path) -> dict[str, Any]:
    return ipopt_options(options, warm) | {
        "linear_solver": "spral",
        "spral_order": "metis",  # the default ordering is 45 times slower here
        "spral_scaling": "none",
        "spral_nemin": 4,  # small supernodes: a third less time per factorisation than with 32
        "output_file": str(log),
        "file_print_level": 3,
    }


def _snopt(options: SolverOptions, monitor: Monitor, log: Path) -> dict[str, Any]:
    return {
        "Major optimality tolerance": options.optimality,
        "Major feasibility tolerance": min(options.feasibility, 1e-4),
        "Major iterations limit": int(options.max_iterations),
        "Iterations limit": int(1000 * options.max_iterations),
        "Time limit": float(max(monitor.remaining, 0.1) + 5.0),
        "Print file": str(log),
    }


def _stopped(x: np.ndarray, monitor: Monitor, detail: str) -> Solution:
    best = monitor.best if monitor.best is not None else x
    return Solution(best, monitor.stop_reason or "failed", monitor.iteration, detail)


def _read_ipopt(
    drake: DrakeProgram,
    result: MathematicalProgramResult,
    monitor: Monitor,
    log: str,
    start: np.ndarray,
) -> Solution:
    details = result.get_solver_details()
    code = getattr(details, "status", -199)
    status = status_of_ipopt(code, monitor.stop_reason)
    found = re.search(r"Number of Iterations\.*:\s*(\d+)", log)
    iterations = int(found.group(1)) if found else monitor.iteration
    if status not in ("converged", "acceptable"):
        stopped = _stopped(start, monitor, f"IPOPT return code {code}")
        return Solution(stopped.x, status, iterations, stopped.detail)
    rows = np.zeros(len(drake.rows))
    # Copies: what Drake hands out is memory of `result`.
    multipliers = np.array(details.lambda_val)
    if multipliers.size == rows.size:
        rows[drake.rows] = multipliers
    return Solution(
        result.GetSolution(drake.variables),
        status,
        iterations,
        f"IPOPT return code {code}",
        rows if multipliers.size == rows.size else None,
        np.array(details.z_L),
        np.array(details.z_U),
    )


def _read_snopt(
    drake: DrakeProgram,
    result: MathematicalProgramResult,
    monitor: Monitor,
    log: str,
) -> Solution:
    code = result.get_solver_details().info
    status = _SNOPT_STATUS.get(code, "failed")
    if status != "converged" and monitor.stop_reason is not None:
        status = monitor.stop_reason
    found = re.search(r"No\. of major iterations\s+(\d+)", log)
    iterations = int(found.group(1)) if found else monitor.iteration
    x = result.GetSolution(drake.variables)
    detail = f"SNOPT info {code}"
    if result.get_solution_result() != SolutionResult.kSolutionFound:
        best = x if monitor.best is None else monitor.best
        return Solution(best, status, iterations, detail)
    # SNOPT's signs are those of grad f = J^T multipliers + reduced costs; the first row is f.
    details = result.get_solver_details()
    reduced, rows = np.array(details.xmul), np.zeros(len(drake.rows))
    rows[drake.rows] = -np.array(details.Fmul)[1 : 1 + len(rows)]
    return Solution(
        x, status, iterations, detail, rows, np.maximum(reduced, 0.0), np.maximum(-reduced, 0.0)
    )
