"""What one evaluation of the spatial program costs: costs, gradient, all rows, the Jacobian.

Once as arrays, the way of IPOPT with MUMPS, with the share of each part; once through the bindings
of Drake's `MathematicalProgram`, the way of Drake's solvers. Vectors with derivatives are seeded
before the clock starts, as a solver does that in C++; handing them over is in the time. Medians of
`REPEATS` evaluations at points that differ, so that nothing is remembered.

    python benchmarks/evaluation.py
"""

from __future__ import annotations

import statistics
import time
from collections.abc import Callable

import numpy as np
from pydrake.autodiffutils import InitializeAutoDiff
from walks import store, stored  # this file's folder is where Python looks first

from drakegait import GaitStudy
from drakegait.program.gait_program import GaitProgram
from drakegait.program.guess import guess_from_reference
from drakegait.program.local_state import LocalState
from drakegait.program.mathematical_program import mathematical_program

REPEATS = 20
STEP = 1e-6  # between the points, in the scaled design vector
# What the laws share, in the order in which it is computed.
SHARED = {
    "splines": ("basis", "motion", "forces", "q", "v"),
    "equations of motion": ("dynamics", "residual"),
    "contact kinematics": ("contact_jacobian", "contact_positions", "footprints"),
    "muscles": ("muscle_inputs", "muscles", "muscle_inputs_by_tau"),
}


def milliseconds(call: Callable[[], object]) -> float:
    """Wall time of one call."""
    started = time.perf_counter()
    call()
    return 1e3 * (time.perf_counter() - started)


def evaluate(program: GaitProgram, x: np.ndarray) -> None:
    """Everything that a step of IPOPT asks for."""
    program.cost(x)
    program.gradient(x)
    program.rows(x)
    program.jacobian(x)


def parts(program: GaitProgram, x: np.ndarray) -> dict[str, float]:
    """Time of each part of one evaluation [ms]: what is shared, then laws and costs."""
    state = LocalState(
        program.formulation, program.points, program.selection.values(x), program.smoothing
    )
    times = {
        f"shared: {name}": milliseconds(lambda names=names: [getattr(state, n) for n in names])
        for name, names in SHARED.items()
    }
    for law in program.constraints:
        times[f"rows: {law.kind}"] = milliseconds(
            lambda law=law: (law.values(state), law.jacobian(state))
        )
    for cost in program.costs:
        times[f"cost: {cost.kind}"] = milliseconds(
            lambda cost=cost: (cost.values(state), cost.gradient(state))
        )
    return times


def through_bindings(program: GaitProgram, points: list[np.ndarray]) -> list[float]:
    """Time of an evaluation of all bindings with AutoDiffXd, for each of `points` [ms]."""
    drake = mathematical_program(program)
    bindings = [
        (binding.evaluator(), drake.program.FindDecisionVariableIndices(binding.variables()))
        for binding in (*drake.costs, *drake.constraints)
    ]
    times = []
    for x in points:
        seeded = [InitializeAutoDiff(x[index])[:, 0] for _, index in bindings]
        calls = list(zip(bindings, seeded, strict=True))
        times.append(milliseconds(lambda calls=calls: [b[0].Eval(s) for b, s in calls]))
    return times


def main() -> None:
    """Measure, print, and add to the stored results."""
    program = GaitProgram(GaitStudy.spatial(nodes=18).formulation())
    start = guess_from_reference(program)
    evaluate(program, start)  # builds what is built once
    points = [start + STEP * (number + 1) for number in range(REPEATS)]
    arrays = statistics.median(milliseconds(lambda x=x: evaluate(program, x)) for x in points)
    profiles = [parts(program, x) for x in points]
    profile = {name: statistics.median(p[name] for p in profiles) for name in profiles[0]}
    # A fresh program: nothing is known of these points.
    fresh = GaitProgram(program.formulation)
    bindings = statistics.median(through_bindings(fresh, points))
    found = {
        "as arrays": arrays,
        **profile,
        "assembly and bookkeeping": arrays - sum(profile.values()),
        "through Drake's bindings": bindings,
    }
    print(
        f"spatial, 18 nodes: {program.num_variables} variables, {program.num_constraints} rows, "
        f"{program.num_entries} entries; medians of {REPEATS}"
    )
    for name, value in found.items():
        print(f"  {name:45}{value:8.2f} ms")
    results = stored()
    results["evaluation"] = found
    store(results)


if __name__ == "__main__":
    main()
