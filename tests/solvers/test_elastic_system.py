"""Elastic programs in the condensed solver: the algebra of a step against dense matrices."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

from drakegait import GaitStudy
from drakegait.program.elastic import ElasticHessian, ElasticProgram
from drakegait.program.gait_program import GaitProgram
from drakegait.program.guess import guess_from_reference
from drakegait.solvers.condensed.border import Border
from drakegait.solvers.condensed.cyclic_band import CyclicBand, CyclicBandMatrix
from drakegait.solvers.condensed.elastic_system import ElasticSystem
from drakegait.solvers.condensed.reserves import Reserves
from drakegait.walker.disorders import Asymmetry

SYMMETRIC = {"nodes": 13, "interior_points": (1,) * 4}
BOTH = {"nodes": 12, "interior_points": (1,) * 8}
STUDIES = {
    "planar-symmetric": GaitStudy(model="planar-symmetric", **SYMMETRIC),
    "unequal steps": GaitStudy(model="planar", **BOTH).with_disorder(Asymmetry("step_length", 1.2)),
    "limits": GaitStudy(model="planar", **BOTH).with_limit("knee_flexion_r", high=0.5),
    "spatial": GaitStudy(model="spatial", **BOTH),
}


class Case:
    """An elastic program at its guess, with random multipliers and stiffnesses."""

    def __init__(self, study: GaitStudy):
        random = np.random.default_rng(1)
        program = GaitProgram(study.formulation())
        self.elastic = elastic = ElasticProgram.of(program)
        self.system = ElasticSystem(elastic)
        self.x = elastic.start(guess_from_reference(program))
        self.multipliers = 0.1 * random.normal(size=elastic.num_constraints)
        self.equality = elastic.lower == elastic.upper
        self.stiffness = 10.0 ** random.uniform(-3, 3, elastic.num_constraints) * ~self.equality
        self.diagonal = 10.0 ** random.uniform(-3, 3, elastic.num_variables)
        self.right = random.normal(size=elastic.num_variables)
        self.rest = random.normal(size=elastic.num_constraints)
        jacobian = self.system.jacobian(self.x)
        self.system.linearise(
            self.x, self.multipliers, self.stiffness, self.diagonal, jacobian
        )
        self.jacobian = jacobian.toarray()
        self.shift = 1.0
        while not self.system.factor(self.shift):
            self.shift *= 10.0

    def full(self) -> np.ndarray:
        """W + J^T S J of the extended unknowns, dense, with the shift of the shared ones."""
        size = self.elastic.num_variables
        lower, hessian = np.zeros((size, size)), ElasticHessian(self.elastic)
        entries = hessian.values(self.x, self.multipliers, 1.0)
        lower[hessian.rows, hessian.columns] = entries
        whole = lower + np.tril(lower, -1).T + np.diag(self.diagonal)
        shared = self.elastic.program.design.offsets["multipliers"]
        whole[np.arange(shared), np.arange(shared)] += self.shift
        return whole + self.jacobian.T @ (self.stiffness[:, None] * self.jacobian)


@pytest.fixture(scope="module", params=STUDIES)
def case(request: pytest.FixtureRequest) -> Case:
    return Case(STUDIES[request.param])


def test_a_step_solves_the_full_system_of_x_p_and_n(case: Case) -> None:
    dx, dy = case.system.solve(case.right, case.rest)
    assert case.elastic.freed.size and case.equality[case.elastic.ends].any()
    np.testing.assert_allclose(case.full() @ dx + case.jacobian.T @ dy, case.right, atol=1e-7)
    np.testing.assert_allclose((case.jacobian @ dx + case.rest)[case.equality], 0.0, atol=1e-9)
    assert not dy[~case.equality].any()


def test_it_factorises_only_where_the_step_is_one_of_descent(case: Case) -> None:
    """On the null space of the equalities the matrix must be positive definite."""
    rows = case.jacobian[case.equality]
    _, _, right = np.linalg.svd(rows)
    free = right[len(rows) :]
    reduced = free @ case.full() @ free.T
    # In units in which stiff directions do not hide soft ones.
    size = 1.0 / np.sqrt(np.abs(np.diag(reduced)))
    assert np.linalg.eigvalsh(size[:, None] * reduced * size)[0] > 0.0


def _elimination(random: np.random.Generator) -> SimpleNamespace:
    """Contact rows, the inverse of their Gram matrix, and a map to local unknowns."""
    contact = random.normal(size=(4, 3, 5))
    inverse = np.linalg.inv(contact @ np.swapaxes(contact, 1, 2))
    return SimpleNamespace(
        contact=contact, inverse=inverse, by_shared=random.normal(size=(4, 8, 6))
    )


def test_where_local_unknowns_are_not_convex_reserves_are_stiffer() -> None:
    random = np.random.default_rng(2)
    local = random.normal(size=(4, 8, 8))
    local = local @ np.swapaxes(local, 1, 2)
    local[1:] *= -1.0
    mixed, compliance = random.normal(size=(4, 8, 6)), random.uniform(0.1, 10.0, (4, 5))
    compliance[3] *= 1e-9
    reserves = Reserves(_elimination(random), local, mixed, compliance)
    assert reserves.share[0] == 1.0 and reserves.share[3] == 1.0  # nothing to make up for
    assert (reserves.share[1:3] < 1.0).all()
    assert np.linalg.eigvalsh(reserves._own)[:, 0].min() > 0.099


def test_reserves_that_cannot_give_way_change_nothing() -> None:
    random = np.random.default_rng(2)
    elimination, local = _elimination(random), np.tile(np.eye(8), (4, 1, 1))
    reserves = Reserves(elimination, local, random.normal(size=(4, 8, 6)), np.zeros((4, 5)))
    np.testing.assert_array_equal(reserves.by_shared, elimination.by_shared)
    assert not reserves.reduction.any()
    assert not reserves.follow(random.normal(size=(4, 8))).any()


@pytest.mark.parametrize("compliance", [0.0, 1e-6, 0.3, 1e9])
def test_a_border_gives_way_as_far_as_its_compliance(compliance: float) -> None:
    random = np.random.default_rng(3)
    root, rows = random.normal(size=(6, 6)), random.normal(size=(2, 6))
    matrix, give = root @ root.T + np.eye(6), np.array([compliance, 0.0])
    b, c = random.normal(size=6), random.normal(size=2)
    expected = np.linalg.solve(
        np.block([[matrix, rows.T], [rows, -np.diag(give)]]), np.concatenate([b, -c])
    )
    border = Border(rows, give)
    band = CyclicBand(np.zeros((0, 0), dtype=int), 6, np.arange(6))
    weighed = CyclicBandMatrix(band, matrix.ravel().copy())
    border.weigh(weighed, weighed.copy())
    border.factored(weighed.factor())
    x, y = border.solve(b, c)
    np.testing.assert_allclose(np.concatenate([x, y]), expected, atol=1e-9)
