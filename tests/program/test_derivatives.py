"""Every derivative of every law and cost against differences of its values."""

from __future__ import annotations

import numpy as np
import pytest
from program_cases import (
    CASES,
    MODELS,
    declared,
    dense_jacobian,
    differences,
    directional_difference,
    guess,
    jiggled,
    program,
)

from drakegait.program.gait_program import GaitProgram
from drakegait.program.guess import guess_from_reference
from drakegait.study import GaitStudy

# Entries of the Jacobian of the default studies. More means a slower solve: raise a number only
# for a law that needs it.
MOST_ENTRIES = {
    ("spatial", "lifted"): 402_125,
    ("spatial", "projected"): 771_433,
    ("planar", "lifted"): 137_314,
    ("planar", "projected"): 258_090,
    ("spatial-symmetric", "lifted"): 209_499,
    ("planar-symmetric", "lifted"): 71_306,
}


@pytest.mark.parametrize(("model", "form"), CASES)
def test_every_entry_of_the_jacobian(model, form):
    problem, x = program(model, form), jiggled(model, form)
    by_differences = differences(problem.rows, x)
    # Rows differ in size by orders of magnitude; an entry counts against the largest of its row.
    size = 1e-3 + np.abs(by_differences).max(axis=1, keepdims=True)
    wrong = np.abs(dense_jacobian(problem, x) - by_differences) / size
    row, column = np.unravel_index(np.argmax(wrong), wrong.shape)
    worst = f"{problem.row_names[row]} by {problem.design.names[column]}"
    assert wrong[row, column] < 1e-6, worst
    outside = np.where(declared(problem), 0.0, np.abs(by_differences) / size)
    row, column = np.unravel_index(np.argmax(outside), outside.shape)
    worst = f"{problem.row_names[row]} by {problem.design.names[column]}"
    assert outside[row, column] < 1e-9, f"not declared: {worst}"


@pytest.mark.parametrize(("model", "form"), CASES)
def test_every_entry_of_the_gradient(model, form):
    problem, x = program(model, form), jiggled(model, form)
    by_differences = differences(lambda y: np.array([*problem.cost_parts(y).values()]), x)
    assert [cost.kind for cost in problem.costs] == list(problem.cost_parts(x))
    for cost, expected in zip(problem.costs, by_differences, strict=True):
        exact = problem.cost_gradient(cost, x)
        assert np.abs(exact).max() > 0.01  # the cost sees something
        np.testing.assert_allclose(exact, expected, atol=1e-7, err_msg=cost.kind)
    total = sum(problem.cost_gradient(cost, x) for cost in problem.costs)
    np.testing.assert_allclose(problem.gradient(x), total, atol=1e-14)


@pytest.mark.parametrize(("model", "form"), CASES)
def test_full_size_along_random_directions(model, form):
    nodes = 19 if model.endswith("symmetric") else 18
    problem = GaitProgram(GaitStudy(model=model, nodes=nodes, multipliers=form).formulation())
    design, random = problem.design, np.random.default_rng(5)
    x = guess_from_reference(problem)
    x = np.clip(x + random.uniform(-0.05, 0.05, x.size), design.lower, design.upper)
    for block, start in design.offsets.items():
        later = [at for at in design.offsets.values() if at > start]
        stop = min(later, default=design.num_variables)
        if stop == start:
            continue
        way = np.zeros(x.size)
        way[start:stop] = random.normal(size=stop - start)
        exact = np.bincount(
            problem.jacobian_rows,
            problem.jacobian(x) * way[problem.jacobian_columns],
            problem.num_constraints,
        )
        by_differences = directional_difference(problem.rows, x, way, 1e-6)
        scale = 1.0 + np.abs(by_differences).max()
        np.testing.assert_allclose(exact, by_differences, atol=2e-7 * scale, err_msg=block)
        np.testing.assert_allclose(
            problem.gradient(x) @ way,
            directional_difference(problem.cost, x, way, 1e-6),
            rtol=1e-5, atol=1e-6, err_msg=block,
        )  # fmt: skip


@pytest.mark.parametrize(("model", "form"), MOST_ENTRIES)
def test_the_pattern_does_not_grow(model, form):
    symmetric = model.endswith("symmetric")
    study = GaitStudy(model=model, multipliers=form, nodes=19 if symmetric else 18)
    assert GaitProgram(study.formulation()).num_entries <= MOST_ENTRIES[model, form]


@pytest.mark.parametrize(("model", "form"), CASES)
def test_no_entry_is_listed_twice(model, form):
    problem = program(model, form)
    assert declared(problem).sum() == problem.num_entries


@pytest.mark.parametrize("model", MODELS)
def test_a_joint_of_one_leg_knows_nothing_of_the_other_leg(model):
    problem = program(model)
    mask, names = declared(problem), np.array(problem.design.names)
    rows = [
        i for i, name in enumerate(problem.row_names)
        if name.startswith("equations of motion") and name.endswith("knee_flexion_r")
    ]  # fmt: skip
    seen = {name.split(" | ")[0] for name in names[mask[rows].any(axis=0)]}
    assert "knee_flexion_r" in seen
    assert "vasti_r force" in seen
    # In a symmetric walker the right leg's variables are also the left leg's, half a cycle on.
    strangers = [name for name in seen if name.endswith(("_l", "_l force"))]
    assert strangers == []
    contacts = {name.split()[2] for name in seen if name.startswith("contact force")}
    assert contacts <= {"heel_r", "toe_r", "foot_r"}


def test_the_smoothing_reaches_values_and_derivatives_alike():
    problem, x = program("planar-symmetric"), jiggled("planar-symmetric")
    sharp = problem.cost(x)
    try:
        problem.smoothing = 30.0
        assert problem.cost(x) != pytest.approx(sharp, rel=1e-4)
        by_differences = differences(problem.cost, x)[0]
        np.testing.assert_allclose(problem.gradient(x), by_differences, atol=1e-7)
    finally:
        problem.smoothing = 1.0
    assert problem.cost(x) == sharp


def test_the_same_x_gives_the_same_numbers_in_any_order():
    problem, x = program("planar"), jiggled("planar")
    rows, jacobian, cost = problem.rows(x), problem.jacobian(x), problem.cost(x)
    problem.rows(guess("planar"))
    y = x.copy()
    np.testing.assert_array_equal(problem.jacobian(y), jacobian)
    # The residual is computed in another way once the derivatives are there.
    np.testing.assert_allclose(problem.rows(y), rows, rtol=1e-9, atol=1e-9)
    assert problem.cost(y) == pytest.approx(cost, rel=1e-12)
    y[:] = guess("planar")  # a caller's array may change after the call
    assert problem.cost(y) == pytest.approx(problem.cost(guess("planar").copy()), rel=1e-12)
    assert problem.cost(y) != pytest.approx(cost, rel=1e-6)
