"""Exact second derivatives: the Hessian of the Lagrangian against differences of its gradient."""

from __future__ import annotations

import functools

import numpy as np
import pytest
import scipy.sparse
from program_cases import MODELS, directional_difference, jiggled, program

from drakegait.errors import InvalidInput
from drakegait.program.gait_program import GaitProgram
from drakegait.program.lagrangian_hessian import LagrangianHessian
from drakegait.study import GaitStudy

# Entries of the lower triangle for the default studies. More means a slower solve: raise a number
# only for a law that needs it.
MOST_ENTRIES = {
    "spatial": 146_921,
    "planar": 44_937,
    "spatial-symmetric": 71_319,
    "planar-symmetric": 21_608,
}
OBJECTIVE = 0.7


def points(model: str) -> tuple[int, ...]:
    """Besides those on events, a control point with a flat foot on each side."""
    return (0, 1, 0, 0) if model.endswith("symmetric") else (0, 1, 0, 0, 0, 1, 0, 0)


def small(model: str, **statements) -> GaitProgram:
    """Few enough variables that all columns of the Hessian can be had by differences."""
    return program(model, interior_points=points(model), **statements)


@functools.cache
def hessian(model: str, **statements) -> LagrangianHessian:
    return LagrangianHessian(small(model, **statements))


def walk(model: str, **statements) -> np.ndarray:
    return jiggled(model, interior_points=points(model), **statements)


def with_events(model: str, share: float) -> np.ndarray:
    """A walk whose events lie at this share of the way between their bounds."""
    design, x = small(model).design, walk(model)
    events = [i for i, name in enumerate(design.names) if name.startswith("event")]
    assert events
    x[events] = (1.0 - share) * design.lower[events] + share * design.upper[events]
    return x


def weights(problem: GaitProgram) -> np.ndarray:
    return np.random.default_rng(7).normal(size=problem.num_constraints)


def gradient(problem: GaitProgram, x: np.ndarray, multipliers: np.ndarray, objective: float):
    """First derivatives of the Lagrangian."""
    slopes = problem.jacobian(x) * multipliers[problem.jacobian_rows]
    return objective * problem.gradient(x) + np.bincount(
        problem.jacobian_columns, slopes, problem.num_variables
    )


def full(exact: LagrangianHessian, entries: np.ndarray, size: int) -> np.ndarray:
    """Both triangles."""
    lower = scipy.sparse.coo_array((entries, (exact.rows, exact.columns)), shape=(size, size))
    return lower.toarray() + np.tril(lower.toarray(), -1).T


def assert_every_column(model: str, x: np.ndarray) -> None:
    problem, exact = small(model), hessian(model)
    multipliers, step, n = weights(problem), 2e-6, x.size
    found = full(exact, exact.values(x, multipliers, OBJECTIVE), n)
    declared = full(exact, np.ones(exact.num_entries), n) > 0.0
    names = problem.design.names
    for i, way in enumerate(step * np.eye(n)):
        rise = gradient(problem, x + way, multipliers, OBJECTIVE)
        rise -= gradient(problem, x - way, multipliers, OBJECTIVE)
        by_differences = rise / (2.0 * step)
        size = 0.1 + np.abs(by_differences).max()
        wrong = np.abs(found[:, i] - by_differences) / size
        k = int(np.argmax(wrong))
        assert wrong[k] < 1e-5, f"{names[k]} by {names[i]}: {found[k, i]}, {by_differences[k]}"
        outside = np.where(declared[:, i], 0.0, np.abs(by_differences) / size)
        k = int(np.argmax(outside))
        assert outside[k] < 1e-6, f"not declared: {names[k]} by {names[i]}"


def assert_along_directions(
    problem: GaitProgram,
    exact: LagrangianHessian,
    x: np.ndarray,
    multipliers: np.ndarray,
    objective: float,
) -> None:
    """One random direction in each block of variables."""
    entries = exact.values(x, multipliers, objective)
    found, random = full(exact, entries, x.size), np.random.default_rng(3)
    starts = sorted({*problem.design.offsets.values(), x.size})
    for start, stop in zip(starts[:-1], starts[1:], strict=True):
        way = np.zeros(x.size)
        way[start:stop] = random.uniform(-1.0, 1.0, stop - start)
        by_differences = directional_difference(
            lambda y: gradient(problem, y, multipliers, objective), x, way, 2e-6
        )
        size = 1e-2 + np.abs(by_differences).max()
        np.testing.assert_allclose(found @ way, by_differences, atol=2e-5 * size)


# Every entry -----------------------------------------------------------------------------------


@pytest.mark.parametrize("model", MODELS)
def test_every_column(model):
    """Rows that hold nowhere, mirrored variables, limits, flat feet: all in one weighted sum."""
    assert_every_column(model, walk(model))


@pytest.mark.parametrize("share", [0.001, 0.999])
def test_no_entry_appears_when_events_reach_other_knots(share):
    assert_every_column("planar-symmetric", with_events("planar-symmetric", share))


@pytest.mark.parametrize("share", [0.001, 0.999])
@pytest.mark.parametrize("model", MODELS)
def test_directions_with_events_at_their_bounds(model, share):
    problem, x = small(model), with_events(model, share)
    assert_along_directions(problem, hessian(model), x, weights(problem), OBJECTIVE)


@pytest.mark.parametrize("model", MODELS)
def test_lower_triangle_each_entry_once(model):
    exact, n = hessian(model), small(model).num_variables
    assert (exact.rows >= exact.columns).all()
    assert exact.columns.min() >= 0
    assert exact.rows.max() < n
    assert len(np.unique(exact.rows * n + exact.columns)) == exact.num_entries


@pytest.mark.parametrize("model", MODELS)
def test_the_pattern_does_not_grow(model):
    study = GaitStudy(model=model, nodes=19 if model.endswith("symmetric") else 18)
    assert LagrangianHessian(GaitProgram(study.formulation())).num_entries <= MOST_ENTRIES[model]


# Weights ---------------------------------------------------------------------------------------


@pytest.mark.parametrize("model", ["planar", "spatial-symmetric"])
def test_the_objective_alone(model):
    problem, exact, x = small(model), hessian(model), walk(model)
    none = np.zeros(problem.num_constraints)
    assert not exact.values(x, none, 0.0).any()
    assert_along_directions(problem, exact, x, none, 1.0)


@pytest.mark.parametrize("model", ["planar", "spatial-symmetric"])
def test_every_law_alone(model):
    """Errors of two laws cannot hide each other."""
    problem, exact, x = small(model), hessian(model), walk(model)
    some = weights(problem)
    laws = [numbers[numbers >= 0] for numbers in problem.row_numbers]
    laws.append(np.arange(problem.first_timing_row, problem.num_constraints))
    for law in laws:
        alone = np.zeros(problem.num_constraints)
        alone[law] = some[law]
        assert_along_directions(problem, exact, x, alone, 0.0)


@pytest.mark.parametrize("model", MODELS)
def test_timing_rows_bend_by_their_own_account(model):
    """T (theta_end - theta_start): bilinear, so that differences are exact for any step."""
    timing, x, n = small(model).timing, walk(model), small(model).num_variables
    some = np.random.default_rng(2).normal(size=len(timing.scale))

    def slopes(y: np.ndarray) -> np.ndarray:
        return np.bincount(timing.columns, timing.jacobian(y) * some[timing.rows], n)

    lower = np.zeros((n, n))
    np.add.at(lower, (timing.curved_rows, timing.curved_columns), timing.curvature(some))
    assert (timing.curved_rows > timing.curved_columns).all()
    variables = np.unique(timing.columns)
    assert len(variables) >= (5 if model.endswith("symmetric") else 10)
    ways = np.eye(n)[variables]
    expected = np.stack([(slopes(x + way) - slopes(x - way)) / 2.0 for way in ways], axis=-1)
    np.testing.assert_allclose((lower + lower.T)[:, variables], expected, atol=1e-10)


def test_it_is_linear_in_its_weights():
    problem, exact, x = small("planar"), hessian("planar"), walk("planar")
    some, none = weights(problem), np.zeros(problem.num_constraints)
    parts = exact.values(x, some, 0.0) + 3.0 * exact.values(x, none, 1.0)
    np.testing.assert_allclose(exact.values(x, some, 3.0), parts, atol=1e-9)


@pytest.mark.parametrize("kept", ["energy_weight", "deviation_weight"])
@pytest.mark.parametrize("model", ["planar", "spatial-symmetric"])
def test_one_cost_only(model, kept):
    dropped = ({"energy_weight", "deviation_weight"} - {kept}).pop()
    stated = {kept: 1.5, dropped: 0.0}
    problem, exact = small(model, **stated), hessian(model, **stated)
    x = walk(model)
    assert len(problem.costs) == 1
    assert exact.num_entries <= hessian(model).num_entries
    assert_along_directions(problem, exact, x, weights(problem), OBJECTIVE)


def test_without_joint_limits():
    problem = small("planar", limits=())
    exact, x = LagrangianHessian(problem), walk("planar")
    assert problem.num_constraints < small("planar").num_constraints
    assert_along_directions(problem, exact, x, weights(problem), OBJECTIVE)


def test_smoothing_is_that_of_the_program():
    problem, exact, x = small("planar"), hessian("planar"), walk("planar")
    some = weights(problem)
    sharp = exact.values(x, some, OBJECTIVE)
    try:
        problem.smoothing = 30.0
        assert np.abs(exact.values(x, some, OBJECTIVE) - sharp).max() > 1e-3
        assert_along_directions(problem, exact, x, some, OBJECTIVE)
    finally:
        problem.smoothing = 1.0


@pytest.mark.parametrize("model", ["planar", "spatial-symmetric"])
def test_projected_multipliers_are_refused_in_a_sentence(model):
    with pytest.raises(InvalidInput, match="lifted for exact second derivatives"):
        LagrangianHessian(program(model, "projected"))
