"""Drake's bindings against the arrays: two ways to one program."""

from __future__ import annotations

import numpy as np
import pytest
from program_cases import CASES, dense_jacobian, guess, jiggled, program, study
from pydrake.autodiffutils import ExtractGradient, ExtractValue, InitializeAutoDiff

from drakegait.program.gait_program import GaitProgram
from drakegait.program.mathematical_program import mathematical_program


def positions(drake, binding) -> np.ndarray:
    """Where a binding's variables are in the design vector."""
    return np.array(drake.program.FindDecisionVariableIndices(binding.variables()), dtype=int)


@pytest.fixture(params=CASES, ids=lambda case: "-".join(case))
def case(request):
    # A program of its own, which has evaluated nothing yet.
    model, form = request.param
    fresh = GaitProgram(study(model, form).formulation())
    return program(model, form), mathematical_program(fresh), jiggled(model, form), fresh


def test_rows_are_those_of_the_arrays_each_once(case):
    arrays, drake, x, _ = case
    np.testing.assert_array_equal(np.sort(drake.rows), np.arange(arrays.num_constraints))
    parts = [
        binding.evaluator().Eval(x[positions(drake, binding)]) for binding in drake.constraints
    ]
    np.testing.assert_allclose(np.concatenate(parts), arrays.rows(x)[drake.rows], atol=1e-6)
    lower = np.concatenate([b.evaluator().lower_bound() for b in drake.constraints])
    upper = np.concatenate([b.evaluator().upper_bound() for b in drake.constraints])
    np.testing.assert_array_equal(lower, arrays.lower[drake.rows])
    np.testing.assert_array_equal(upper, arrays.upper[drake.rows])
    assert len(drake.program.GetAllConstraints()) == len(drake.constraints) + 1  # the bounds
    assert len(drake.program.GetAllCosts()) == len(drake.costs)


@pytest.mark.parametrize("shared", [False, True], ids=["alone", "after the costs"])
def test_derivatives_are_those_of_the_arrays(case, shared):
    arrays, drake, x, fresh = case
    if shared:  # as a solver does: costs first, then the constraints read what is there
        fresh.cost(x)
    dense, at = dense_jacobian(arrays, x), 0
    for binding in drake.constraints:
        evaluator, where = binding.evaluator(), positions(drake, binding)
        value = evaluator.Eval(InitializeAutoDiff(x[where])[:, 0])
        rows = drake.rows[at : at + len(value)]
        at += len(value)
        np.testing.assert_allclose(ExtractValue(value)[:, 0], arrays.rows(x)[rows], atol=1e-6)
        jacobian = ExtractGradient(value)
        np.testing.assert_allclose(jacobian, dense[rows][:, where], rtol=1e-7, atol=1e-7)
        # All that a row depends on is among the variables of its binding ...
        assert np.count_nonzero(dense[rows]) == np.count_nonzero(dense[rows][:, where])
        # ... and in the pattern that Drake's solvers take for the truth.
        pattern = np.array(evaluator.gradient_sparsity_pattern())
        declared = np.zeros(jacobian.shape, dtype=bool)
        declared[pattern[:, 0], pattern[:, 1]] = True
        assert not jacobian[~declared].any()
        assert len(pattern) == declared.sum()
    total = sum(len(b.evaluator().gradient_sparsity_pattern()) for b in drake.constraints)
    assert total == arrays.num_entries


def test_costs_are_those_of_the_arrays(case):
    arrays, drake, x, _ = case
    for binding, cost in zip(drake.costs, arrays.costs, strict=True):
        where = positions(drake, binding)
        evaluator = binding.evaluator()
        assert evaluator.get_description() == cost.kind
        expected = arrays.cost_parts(x)[cost.kind]
        assert evaluator.Eval(x[where]) == pytest.approx([expected])
        value = evaluator.Eval(InitializeAutoDiff(x[where])[:, 0])
        gradient = np.zeros(x.size)
        gradient[where] = ExtractGradient(value)[0]
        np.testing.assert_allclose(gradient, arrays.cost_gradient(cost, x), atol=1e-10)


def test_names_and_bounds(case):
    arrays, drake, _, _ = case
    assert [variable.get_name() for variable in drake.variables] == arrays.design.names
    descriptions = [binding.evaluator().get_description() for binding in drake.constraints]
    assert len(set(descriptions)) == len(descriptions)
    for k in range(arrays.points.num):
        assert arrays.place_name(k) in descriptions[k]
    (box,) = drake.program.bounding_box_constraints()
    where = positions(drake, box)
    np.testing.assert_array_equal(box.evaluator().lower_bound(), arrays.design.lower[where])
    np.testing.assert_array_equal(box.evaluator().upper_bound(), arrays.design.upper[where])
    assert sorted(where) == list(range(arrays.num_variables))


def test_other_derivatives_than_the_identity_go_through_the_chain_rule():
    arrays = program("planar-symmetric")
    drake, x = mathematical_program(arrays), jiggled("planar-symmetric")
    dense, random = dense_jacobian(arrays, x), np.random.default_rng(2)
    at = 0
    for binding in drake.constraints:
        where = positions(drake, binding)
        seed = random.normal(size=(len(where), 3))
        value = binding.evaluator().Eval(InitializeAutoDiff(x[where], seed)[:, 0])
        rows = drake.rows[at : at + len(value)]
        at += len(value)
        expected = dense[rows][:, where] @ seed
        np.testing.assert_allclose(ExtractGradient(value), expected, rtol=1e-6, atol=1e-5)


def test_derivatives_that_look_like_the_identity_go_through_the_chain_rule_too():
    arrays = program("planar-symmetric")
    drake, x = mathematical_program(arrays), jiggled("planar-symmetric")
    binding, dense = drake.constraints[0], dense_jacobian(arrays, x)
    where = positions(drake, binding)
    seed = np.eye(len(where))
    seed[[1, 2]] = seed[[2, 1]]
    value = binding.evaluator().Eval(InitializeAutoDiff(x[where], seed)[:, 0])
    expected = dense[drake.rows[: len(value)]][:, where] @ seed
    np.testing.assert_allclose(ExtractGradient(value), expected, rtol=1e-6, atol=1e-5)


def test_bindings_follow_their_argument_not_an_earlier_evaluation():
    arrays = program("planar")
    drake = mathematical_program(arrays)
    here, there = jiggled("planar", seed=1), guess("planar")
    for x, evaluated in ((here, there), (there, here), (here, here)):
        arrays.cost(evaluated)
        expected = program("planar").rows(x)[drake.rows].copy()
        arrays.cost(evaluated)
        parts = [b.evaluator().Eval(x[positions(drake, b)]) for b in drake.constraints]
        np.testing.assert_allclose(np.concatenate(parts), expected, atol=1e-6)
