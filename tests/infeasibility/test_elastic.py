"""The elastic program: the same laws, each with a price; derivatives against differences."""

from __future__ import annotations

import numpy as np
import pytest
from infeasibility_cases import relaxation_of

from drakegait.infeasibility.elastic import SHARE, ElasticHessian, ElasticProgram

STEP = 1e-6


@pytest.fixture(scope="module")
def elastic() -> ElasticProgram:
    return relaxation_of("limited").elastic


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
    assert len(freed)
    names = [elastic.row_names[i] for i in freed]
    assert any("step length" in name for name in names)
    assert np.isinf(elastic.design.lower).sum() >= len(freed)
