"""Times of single steps that the paper gives reasons for: derivatives and splines."""

from __future__ import annotations

import statistics
import time
from collections.abc import Callable

import numpy as np

from drakegait.program.differences import DifferencedProgram
from drakegait.program.gait_program import GaitProgram
from drakegait.program.guess import guess_from_reference
from drakegait.study import GaitStudy
from drakegait.transcription.splines import PeriodicQuintic

REPEATS = 50


def milliseconds(call: Callable[[], object], repeats: int = REPEATS) -> float:
    """Median wall time."""
    times = []
    for _ in range(repeats):
        started = time.perf_counter()
        call()
        times.append(1e3 * (time.perf_counter() - started))
    return statistics.median(times)


def derivatives(study: GaitStudy, repeats: int = REPEATS) -> dict[str, float]:
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
    one_value = milliseconds(lambda: exact.rows(x + next(moves)), repeats)
    return {
        "variables": exact.num_variables,
        "colours": coloured.num_colours,
        "exact_ms": milliseconds(lambda: at(exact), repeats),
        "coloured_ms": by_colours,
        "one_by_one_ms_estimated": by_colours * exact.num_variables / coloured.num_colours,
        "values_alone_ms": one_value,
    }


def splines(study: GaitStudy, repeats: int = REPEATS) -> dict[str, float]:
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
    circulant = spline.nodal_values(np.eye(nodes - 1)).T
    tau = np.linspace(0.0, 1.0, study.schedule.num_points, endpoint=False)
    coefficients = spline.coefficients(nodal)

    def assembled() -> np.ndarray:
        matrix, other = polynomial_system(nodes - 1)
        return np.linalg.solve(matrix, other @ nodal.T)

    calls = {
        "polynomials_assembled_and_solved_ms": assembled,
        "polynomials_solved_ms": lambda: np.linalg.solve(system, right @ nodal.T),
        "polynomials_prepared_ms": lambda: inverse @ nodal.T,
        "b_splines_solved_ms": lambda: np.linalg.solve(circulant, nodal.T),
        "b_splines_prepared_ms": lambda: spline.coefficients(nodal),
        "evaluation_at_control_points_ms": lambda: [
            spline.evaluate(coefficients, tau, order) for order in range(3)
        ],
    }
    times = {name: milliseconds(call, repeats) for name, call in calls.items()}
    return {"curves": curves, "unknowns_per_curve": 5 * (nodes - 1), **times}


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
