"""The elastic program: the same laws, each with a price; derivatives against differences."""

from __future__ import annotations

import numpy as np
import pytest

from drakegait import GaitStudy
from drakegait.program.elastic import SHARE, ElasticHessian, ElasticProgram
from drakegait.program.gait_program import GaitProgram
from drakegait.program.guess import guess_from_reference

STEP = 1e-6


@pytest.fixture(scope="module")
def elastic() -> ElasticProgram:
    study = GaitStudy.planar_symmetric(11, interior_points=(3, 2, 6, 5))
    for side in "rl":
        study = study.with_limit(f"knee_flexion_{side}", 0.0, 0.5)
    return ElasticProgram.of(GaitProgram(study.formulation()))


@pytest.fixture(scope="module")
def extended(elastic) -> np.ndarray:
    program = elastic.program
    generator = np.random.default_rng(3)
    start = elastic.start(np.clip(np.zeros(program.num_variables), *_inside(program)))
    return start + 0.01 * generator.random(len(start))


def _inside(program):
    return program.design.lower + 0.02, program.design.upper - 0.02


def _jacobian(elastic, z, direction) -> np.ndarray:
    products = elastic.jacobian(z) * direction[elastic.jacobian_columns]
    return np.bincount(elastic.jacobian_rows, products, elastic.num_constraints)


def test_without_anything_missing_it_is_the_program(elastic):
    program = elastic.program
    x = np.clip(np.zeros(program.num_variables), *_inside(program))
    z = np.concatenate([x, np.zeros(elastic.num_variables - len(x))])
    rows = elastic.rows(z)
    assert rows[: program.num_constraints] == pytest.approx(program.rows(x))
    assert elastic.cost(z) == pytest.approx(SHARE * program.cost(x))
    assert (elastic.unknowns(z) == x).all()


def test_its_start_makes_every_soft_row_hold(elastic):
    program = elastic.program
    x = np.clip(np.zeros(program.num_variables), *_inside(program))
    violations = elastic.violations(elastic.start(x))
    assert violations[elastic.ends] == pytest.approx(0.0, abs=1e-9)
    hard = np.setdiff1d(np.arange(program.num_constraints), elastic.ends)
    assert violations[hard] == pytest.approx(program.violations(x)[hard])


def test_what_is_missing_has_the_sign_of_what_must_be_added(elastic):
    program = elastic.program
    x = np.clip(np.zeros(program.num_variables), *_inside(program))
    missing = elastic.missing(elastic.start(x))
    rows = np.concatenate([program.rows(x), np.zeros(elastic.num_constraints)])[elastic.ends]
    short = rows < elastic.lower[elastic.ends] - 1e-9
    own = elastic.ends < program.num_constraints
    assert short[own].any()
    assert (missing[own & short] > 0.0).all()
    assert missing[own].min() < 0.0


def test_first_derivatives_are_those_of_differences(elastic, extended):
    direction = np.random.default_rng(5).normal(size=elastic.num_variables)
    elastic.prices = np.random.default_rng(6).random(len(elastic.ends))
    ahead, behind = extended + STEP * direction, extended - STEP * direction
    slope = (elastic.cost(ahead) - elastic.cost(behind)) / (2.0 * STEP)
    assert elastic.gradient(extended) @ direction == pytest.approx(slope, rel=1e-5)
    rows = (elastic.rows(ahead) - elastic.rows(behind)) / (2.0 * STEP)
    scale = np.abs(rows).max()
    assert _jacobian(elastic, extended, direction) == pytest.approx(rows, abs=1e-6 * scale)


def test_second_derivatives_are_those_of_differences(elastic, extended):
    hessian = ElasticHessian(elastic)
    generator = np.random.default_rng(7)
    direction = generator.normal(size=elastic.num_variables)
    weights = generator.normal(size=elastic.num_constraints)

    def slope(z):
        by_rows = np.bincount(
            elastic.jacobian_columns,
            elastic.jacobian(z) * weights[elastic.jacobian_rows],
            elastic.num_variables,
        )
        return elastic.gradient(z) + by_rows

    difference = (slope(extended + STEP * direction) - slope(extended - STEP * direction)) / (
        2.0 * STEP
    )
    entries = hessian.values(extended, weights, 1.0)
    lower = np.bincount(
        hessian.rows, entries * direction[hessian.columns], elastic.num_variables
    )
    mirrored = entries * direction[hessian.rows] * (hessian.rows != hessian.columns)
    product = lower + np.bincount(hessian.columns, mirrored, elastic.num_variables)
    assert product == pytest.approx(difference, abs=1e-4 * np.abs(difference).max())


def test_freed_bounds_become_rows(elastic):
    freed = elastic.ends[elastic.ends >= elastic.program.num_constraints]
    assert len(freed) == len(elastic.freed)
    names = [elastic.row_names[i] for i in freed]
    assert any("step length" in name for name in names)
    assert any("contact force" in name for name in names)
    assert np.isinf(elastic.design.lower).sum() >= len(freed)


def test_only_what_has_a_bound_there_can_be_off_on_a_side(elastic):
    for which, bounds in ((elastic.short, elastic.lower), (elastic.over, elastic.upper)):
        has = np.zeros(len(elastic.ends), dtype=bool)
        has[which] = True
        np.testing.assert_array_equal(has, np.isfinite(bounds[elastic.ends]))
    assert len(elastic.short) + len(elastic.over) < 2 * len(elastic.ends)
    assert (elastic.design.lower < elastic.design.upper).all()


def test_excitations_and_least_squares_forces_never_break(elastic):
    kinds = {elastic.row_names[i].split(" | ")[0] for i in range(elastic.program.num_constraints)}
    soft = {elastic.row_names[i].split(" | ")[0] for i in elastic.ends}
    assert kinds - soft == {"excitation", "least-squares contact forces"}


def test_friction_is_dearer_and_held_more_closely(elastic):
    slips, prices = elastic.slips, ElasticProgram.of(elastic.program).prices
    assert slips.any() and (prices[slips] == 100.0).all()
    assert (prices[~slips] == 1.0).all()
    assert elastic.held[slips].max() < 0.1 * elastic.held[~slips].min()


def test_off_counts_in_what_is_held_and_without_hard_rows_nothing_is(elastic):
    program = elastic.program
    extended = elastic.start(guess_from_reference(program))
    size = program.num_variables
    small = extended.copy()
    small[size:] = 0.0
    small[size + 2] = 3.0
    off = np.abs(elastic.missing(small)) / elastic.held
    assert off[elastic.short[2]] == pytest.approx(3.0 / elastic.held[elastic.short[2]])
    assert np.count_nonzero(off) == 1
    broken = extended.copy()
    broken[:size] += 1.0  # excitations far out of their bounds
    assert np.isinf(elastic.off(broken)).all()
