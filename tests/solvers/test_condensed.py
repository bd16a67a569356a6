"""The condensed solver: its linear algebra against dense matrices, its answers against IPOPT's."""

from __future__ import annotations

import numpy as np
import pytest

from drakegait import GaitStudy, solve
from drakegait.errors import DrakegaitError
from drakegait.program.gait_program import GaitProgram
from drakegait.program.guess import guess_from_reference
from drakegait.program.lagrangian_hessian import LagrangianHessian
from drakegait.solvers.condensed.filter import Filter
from drakegait.solvers.condensed.supported import why_not
from drakegait.solvers.condensed.system import CondensedSystem
from drakegait.solvers.options import SolverOptions
from drakegait.walker import disorders

SMALL = {
    "planar": {"nodes": 12, "interior_points": (1,) * 8},
    "planar-symmetric": {"nodes": 13, "interior_points": (1,) * 4},
    "spatial": {"nodes": 12, "interior_points": (1,) * 8},
    "spatial-symmetric": {"nodes": 13, "interior_points": (1,) * 4},
}


def study(model: str) -> GaitStudy:
    return GaitStudy(model=model, **SMALL[model])


STUDIES = {model: study(model) for model in SMALL}
STUDIES["limits"] = study("planar").with_limit("knee_flexion_r", high=1.0)
STUDIES["eq14"] = study("planar").with_settings(periodicity="eq14")
STUDIES["spasticity"] = study("planar").with_disorder(disorders.Spasticity("soleus", "l", 0.1))


class Case:
    """A program at a point off its guess, with random multipliers and weights."""

    def __init__(self, which: GaitStudy):
        self.program = GaitProgram(which.formulation())
        self.hessian = LagrangianHessian(self.program)
        self.system = CondensedSystem(self.program, self.hessian)
        random = np.random.default_rng(3)
        program = self.program
        x = guess_from_reference(program)
        self.x = x + 0.01 * random.normal(size=len(x)) * np.minimum(1.0, np.abs(x))
        self.multipliers = 0.1 * random.normal(size=program.num_constraints)
        self.equality = program.lower == program.upper
        self.stiffness = random.uniform(0.1, 1.0, program.num_constraints) * ~self.equality
        self.diagonal = random.uniform(0.1, 1.0, program.num_variables)
        self.right = random.normal(size=program.num_variables)
        self.rest = random.normal(size=program.num_constraints)
        jacobian = self.system.jacobian(self.x)
        self.system.linearise(
            self.x, self.multipliers, self.stiffness, self.diagonal, jacobian
        )
        self.jacobian = jacobian.toarray()

    def full(self) -> np.ndarray:
        """W + J^T S J, dense."""
        size = self.program.num_variables
        lower = np.zeros((size, size))
        entries = self.hessian.values(self.x, self.multipliers, 1.0)
        lower[self.hessian.rows, self.hessian.columns] = entries
        whole = lower + np.tril(lower, -1).T + np.diag(self.diagonal)
        return whole + self.jacobian.T @ (self.stiffness[:, None] * self.jacobian)


@pytest.fixture(scope="module", params=STUDIES)
def case(request: pytest.FixtureRequest) -> Case:
    return Case(STUDIES[request.param])


def test_the_condensed_matrix_is_that_of_dense_elimination(case: Case) -> None:
    size, full = case.system.num_shared, case.full()
    local = case.equality.copy()
    local[case.program.first_timing_row :] = False
    rows = case.jacobian[local]
    by_shared = -np.linalg.solve(rows[:, size:], rows[:, :size])
    whole = np.vstack([np.eye(size), by_shared])
    expected = whole.T @ full @ whole
    scale = np.abs(expected).max()
    np.testing.assert_allclose(case.system.matrix.toarray(), expected, atol=1e-11 * scale)


def test_a_solution_satisfies_the_full_system(case: Case) -> None:
    shift = 1.0
    while not case.system.factor(shift):
        shift *= 10.0
    dx, dy = case.system.solve(case.right, case.rest)
    full, size = case.full(), case.system.num_shared
    full[np.arange(size), np.arange(size)] += shift
    np.testing.assert_allclose(full @ dx + case.jacobian.T @ dy, case.right, atol=1e-8)
    np.testing.assert_allclose((case.jacobian @ dx + case.rest)[case.equality], 0.0, atol=1e-9)
    assert not dy[~case.equality].any()


def test_factorising_tells_an_indefinite_matrix(case: Case) -> None:
    lowest = np.linalg.eigvalsh(case.system.matrix.toarray())[0]
    assert not case.system.factor(-lowest - 1e6 * max(1.0, abs(lowest)))


def test_the_filter_takes_less_violation_or_less_cost_only() -> None:
    filter_ = Filter(1.0)
    assert filter_.accepts(1.0, 5.0, (0.5, 9.0), slope=1.0, step=1.0)
    assert filter_.accepts(0.5, 9.0, (0.6, 4.0), slope=1.0, step=1.0)
    assert not filter_.accepts(0.6, 4.0, (0.6, 4.0), slope=1.0, step=1.0)
    assert not filter_.accepts(0.6, 4.0, (1.1, 9.0), slope=1.0, step=1.0)  # as the first was
    assert not filter_.accepts(0.6, 4.0, (np.inf, np.inf), slope=1.0, step=1.0)
    filter_.clear()
    # Hardly any violation and a steep descent: the cost must fall.
    assert not filter_.accepts(1e-9, 4.0, (0.0, 4.0), slope=-1.0, step=1.0)


@pytest.mark.parametrize(
    ("which", "options", "reason"),
    [
        (study("planar").replace(multipliers="projected"), {}, "projected"),
        (study("planar"), {"second_derivatives": "limited-memory"}, "derivatives"),
    ],
)
def test_programs_without_that_structure_are_named(
    which: GaitStudy, options: dict[str, str], reason: str
) -> None:
    program = GaitProgram(which.formulation())
    assert reason in why_not(program, SolverOptions(**options))
    assert not why_not(GaitProgram(study("planar").formulation()), SolverOptions())


@pytest.mark.solve
def test_the_optimum_meets_the_kkt_conditions_and_ipopts_cost() -> None:
    which = GaitStudy.planar_symmetric(nodes=13, interior_points=(2, 2, 6, 4))
    mine = solve(which, refine=False)
    assert mine.converged
    other = solve(which, refine=False, guess=mine, solver="ipopt-mumps")
    assert other.converged
    assert other.cost["total"] == pytest.approx(mine.cost["total"], rel=1e-3)
    assert other.outcome.iterations < 0.7 * mine.outcome.iterations  # nothing left to do


@pytest.mark.solve
def test_the_same_study_gives_the_same_bits() -> None:
    which = GaitStudy.planar_symmetric(nodes=13, interior_points=(1, 1, 2, 1))
    first, second = (solve(which, refine=False) for _ in range(2))
    np.testing.assert_array_equal(
        first.values.coordinate_coefficients, second.values.coordinate_coefficients
    )


def test_a_limit_on_time_ends_the_solve_with_a_gait() -> None:
    gait = solve(study("planar-symmetric"), refine=False, time_limit=0.1)
    assert gait.outcome.status == "time_limit"
    assert np.isfinite(gait.metabolic.cost_of_transport)


def test_unknown_solvers_are_refused() -> None:
    with pytest.raises(DrakegaitError, match="condensed"):
        SolverOptions(solver="dense")
