"""Other forms of the problem: the same laws, other rows."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from program_cases import (
    FORMS,
    declared,
    dense_jacobian,
    differences,
    directional_difference,
)
from program_cases import guess as any_guess
from program_cases import jiggled as any_jiggled
from program_cases import program as any_program
from pydrake.autodiffutils import ExtractGradient, ExtractValue, InitializeAutoDiff

from drakegait.errors import UnknownName
from drakegait.program.gait_program import GaitProgram
from drakegait.program.lagrangian_hessian import LagrangianHessian
from drakegait.program.mathematical_program import mathematical_program
from drakegait.program.variants import Variants
from drakegait.reference.periodicity import force_periodicity
from drakegait.study import GaitStudy

EQ14 = Variants(periodicity="eq14")
EQ29 = Variants(eom_form="maximum")
BOTH = Variants(periodicity="eq14", eom_form="maximum")
CASES = [
    (model, form, variants)
    for model in ("planar", "planar-symmetric", "spatial-symmetric")
    for form in FORMS
    for variants in (EQ14, EQ29)
] + [("spatial", "lifted", BOTH)]
IDS = [f"{m}-{f}-{v.periodicity}-{v.eom_form}" for m, f, v in CASES]


def program(model: str, form: str = "lifted", **statements):
    return any_program(model, form, limits=(), **statements)


def guess(model: str, form: str = "lifted", **statements) -> np.ndarray:
    return any_guess(model, form, limits=(), **statements)


def jiggled(model: str, form: str = "lifted", **statements) -> np.ndarray:
    return any_jiggled(model, form, limits=(), **statements)


def rows_of(problem, kind: str) -> np.ndarray:
    return np.array([i for i, name in enumerate(problem.row_names) if name.startswith(kind)])


def test_defaults_add_nothing():
    problem = program("planar")
    assert problem.stride_rows == []
    assert len(problem.row_names) == problem.num_constraints
    assert rows_of(problem, "periodic ends").size == rows_of(problem, "largest residual").size == 0


def test_variants_are_settings_and_part_of_the_study():
    study = GaitStudy.planar().with_settings(periodicity="eq14", eom_form="maximum")
    assert study.variants == BOTH
    assert study.formulation().variants == BOTH
    assert GaitStudy.from_dict(study.to_dict()) == study
    with pytest.raises(UnknownName, match="eq14"):
        GaitStudy.planar().with_settings(periodicity="eq15")


@pytest.mark.parametrize(("model", "form", "variants"), CASES, ids=IDS)
def test_every_entry_of_the_new_rows(model, form, variants):
    problem = program(model, form, variants=variants)
    x = jiggled(model, form, variants=variants)
    first = problem.first_timing_row
    assert len(problem.row_names) == problem.num_constraints == len(problem.row_scale)
    assert len(problem.row_units) == problem.num_constraints
    by_differences = differences(lambda y: problem.rows(y)[first:], x)
    size = 1e-3 + np.abs(by_differences).max(axis=1, keepdims=True)
    wrong = np.abs(dense_jacobian(problem, x)[first:] - by_differences) / size
    assert wrong.max() < 1e-6
    outside = np.where(declared(problem)[first:], 0.0, np.abs(by_differences) / size)
    assert outside.max() < 1e-9
    assert declared(problem).sum() == problem.num_entries


@pytest.mark.parametrize(("model", "form", "variants"), CASES, ids=IDS)
def test_drake_sees_the_same_rows(model, form, variants):
    problem = program(model, form, variants=variants)
    x = jiggled(model, form, variants=variants)
    drake, dense, at = mathematical_program(problem), dense_jacobian(problem, x), 0
    np.testing.assert_array_equal(np.sort(drake.rows), np.arange(problem.num_constraints))
    for binding in drake.constraints:
        where = np.array(drake.program.FindDecisionVariableIndices(binding.variables()), int)
        value = binding.evaluator().Eval(InitializeAutoDiff(x[where])[:, 0])
        rows = drake.rows[at : at + len(value)]
        at += len(value)
        np.testing.assert_allclose(ExtractValue(value)[:, 0], problem.rows(x)[rows], atol=1e-6)
        np.testing.assert_allclose(
            ExtractGradient(value), dense[rows][:, where], rtol=1e-7, atol=1e-7
        )
        assert np.count_nonzero(dense[rows]) == np.count_nonzero(dense[rows][:, where])


@pytest.mark.parametrize("variants", [EQ14, EQ29], ids=["eq14", "eq29"])
@pytest.mark.parametrize("model", ["planar", "spatial-symmetric"])
def test_exact_second_derivatives(model, variants):
    problem = program(model, variants=variants)
    x = jiggled(model, variants=variants)
    exact, random = LagrangianHessian(problem), np.random.default_rng(3)
    multipliers = random.normal(size=problem.num_constraints)

    def gradient(y):
        slopes = problem.jacobian(y) * multipliers[problem.jacobian_rows]
        return problem.gradient(y) + np.bincount(
            problem.jacobian_columns, slopes, problem.num_variables
        )

    entries = exact.values(x, multipliers, 1.0)
    way = random.uniform(-1.0, 1.0, x.size)
    found = np.bincount(exact.rows, entries * way[exact.columns], x.size)
    off = exact.rows != exact.columns
    found += np.bincount(exact.columns[off], (entries * way[exact.rows])[off], x.size)
    by_differences = directional_difference(gradient, x, way, 2e-6)
    np.testing.assert_allclose(found, by_differences, atol=2e-5 * np.abs(by_differences).max())


# Equation (14) ---------------------------------------------------------------------------------


@pytest.mark.parametrize("model", ["planar", "spatial", "planar-symmetric", "spatial-symmetric"])
def test_ends_hold_exactly_for_curves_whose_nodal_values_obey_eq_14(model):
    problem = program(model, variants=EQ14)
    splines, rows = problem.formulation.splines, rows_of(problem, "periodic ends")
    assert np.abs(problem.rows(jiggled(model, variants=EQ14))[rows]).max() > 1e-3
    values = problem.values(guess(model, variants=EQ14))
    changed = {}
    for name in ("coordinate_coefficients", "force_coefficients"):
        nodal = splines.nodal_values(getattr(values, name))
        # A symmetric walker's own curves repeat after half a stride: forcing one end spoils the
        # other half, and packing averages them. Constants obey (14) in any case.
        if problem.formulation.symmetric:
            nodal = np.repeat(nodal[:, 3:4], splines.num_intervals, axis=1)
            if name.startswith("coordinate"):
                nodal[:] = 0.0
        forced = force_periodicity(np.column_stack([nodal, nodal[:, 0]]))
        forced = force_periodicity(forced)
        changed[name] = splines.coefficients(forced[:, :-1])
    x = problem.design.pack(replace(values, **changed))
    assert np.abs(problem.rows(x)[rows]).max() < 1e-9


@pytest.mark.parametrize("model", ["planar", "planar-symmetric", "spatial-symmetric"])
def test_three_values_of_each_curve_are_bound(model):
    """The paper's free values are f_3 .. f_(N-2); rows are independent of each other."""
    problem = program(model, variants=EQ14)
    rows, names = rows_of(problem, "periodic ends"), problem.formulation.walker.coordinate_names
    muscles = problem.formulation.walker.muscles.names
    curves = [n for n in (*names, *muscles)
              if not (problem.formulation.symmetric and n.endswith("_l"))]  # fmt: skip
    assert len(rows) == 3 * len(curves)
    block = dense_jacobian(problem, guess(model, variants=EQ14))[rows]
    assert np.linalg.matrix_rank(block, tol=1e-9) == len(rows)


def test_default_sizes_are_those_of_the_papers_free_values():
    study = GaitStudy.spatial(nodes=18, multipliers="projected").with_settings(periodicity="eq14")
    problem = GaitProgram(study.formulation())
    assert problem.num_variables == 44 * 17 + 13
    assert problem.num_variables - rows_of(problem, "periodic ends").size == 44 * 14 + 13


# Equation (29) ---------------------------------------------------------------------------------


@pytest.mark.parametrize("form", FORMS)
def test_largest_residuals_are_those_of_eq_28(form):
    one, other = program("planar", form), program("planar", form, variants=EQ29)
    x = jiggled("planar", form)
    assert one.num_variables == other.num_variables
    residual = np.abs(one.values(x).residuals) / one.formulation.row_tolerances
    rows = rows_of(other, "largest residual")
    assert len(rows) == 9
    np.testing.assert_allclose(other.rows(x)[rows], residual.max(axis=0), rtol=1e-9)
    np.testing.assert_array_equal(other.upper[rows], 1.0)


def test_residuals_are_bounded_in_one_place_only():
    one, other = program("planar"), program("planar", variants=EQ29)
    where = [i for i, name in enumerate(one.design.names) if name.startswith("residual")]
    assert np.all(one.design.upper[where] == 1.0)
    assert np.all(np.isinf(other.design.upper[where]))
    assert other.num_constraints == one.num_constraints + 9
    projected = program("planar", "projected")
    maximum = program("planar", "projected", variants=EQ29)
    points = projected.points.num
    assert maximum.num_constraints == projected.num_constraints - 9 * points + 9
    assert rows_of(maximum, "equations of motion").size == 0


@pytest.mark.parametrize("form", FORMS)
def test_both_forms_start_from_the_same_walk(form):
    x, y = guess("planar", form), guess("planar", form, variants=EQ29)
    stop = program("planar").design.offsets["residuals"]
    np.testing.assert_allclose(x[:stop], y[:stop], atol=1e-12)
