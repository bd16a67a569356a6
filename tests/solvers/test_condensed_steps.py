"""What makes steps of the condensed solver long: convexity, regularisation, targets, corners."""

from __future__ import annotations

import numpy as np
import pytest

from drakegait import GaitStudy
from drakegait.program import physical_hessian as physical
from drakegait.program.gait_program import GaitProgram
from drakegait.program.guess import guess_from_reference
from drakegait.program.lagrangian_hessian import LagrangianHessian
from drakegait.program.recentring import recentred
from drakegait.solvers.condensed.centrality import Targets
from drakegait.solvers.condensed.convexity import convex_excess
from drakegait.solvers.condensed.interior_point import InteriorPoint
from drakegait.solvers.condensed.iterate import Multipliers
from drakegait.solvers.condensed.regularisation import Regularisation
from drakegait.solvers.condensed.solve import solve_condensed
from drakegait.solvers.condensed.system import CondensedSystem
from drakegait.solvers.monitor import Monitor
from drakegait.solvers.options import SolverOptions

SMALL = GaitStudy.planar_symmetric(nodes=13, interior_points=(1,) * 4)
MUSCLES = SMALL.walker.muscles


@pytest.fixture(scope="module")
def program() -> GaitProgram:
    return GaitProgram(SMALL.formulation())


def random_hessians(scale: float = 1.0) -> np.ndarray:
    values = np.random.default_rng(5).normal(size=(3, MUSCLES.num_muscles, 6, 6))
    return scale * (values + np.swapaxes(values, 2, 3))


def test_with_the_excess_no_muscle_has_negative_curvature() -> None:
    hessian = random_hessians()
    excess = convex_excess(hessian, MUSCLES)
    for part in (excess, hessian + excess):
        lowest = np.linalg.eigvalsh(part)[..., 0]
        assert np.all(lowest > -1e-9 * np.abs(part).max(axis=(2, 3)))
    assert np.linalg.eigvalsh(hessian)[..., 0].max() < 0.0  # there was something to do


def test_convex_muscles_need_nothing() -> None:
    root = random_hessians()
    convex = root @ np.swapaxes(root, 2, 3)
    assert np.abs(convex_excess(convex, MUSCLES)).max() < 1e-9 * np.abs(convex).max()


class Linearised:
    """A system at the guess with random multipliers."""

    def __init__(self, program: GaitProgram):
        random = np.random.default_rng(3)
        self.system = CondensedSystem(program, LagrangianHessian(program))
        x = guess_from_reference(program)
        rows = program.num_constraints
        equality = program.lower == program.upper
        stiffness = random.uniform(0.1, 1.0, rows) * ~equality
        diagonal = random.uniform(0.1, 1.0, program.num_variables)
        jacobian = self.system.jacobian(x)
        self.system.linearise(x, 0.1 * random.normal(size=rows), stiffness, diagonal, jacobian)


def test_convexity_is_added_as_if_the_muscles_were_convex(
    program: GaitProgram, monkeypatch: pytest.MonkeyPatch
) -> None:
    before = Linearised(program).system
    assert before.factor(1e6, convexity=1.0)
    own = physical._muscles

    def convex(*arguments: object) -> tuple[np.ndarray, np.ndarray]:
        hessian, first = own(*arguments)
        return hessian + convex_excess(hessian, MUSCLES), first

    monkeypatch.setattr(physical, "_muscles", convex)
    after = Linearised(program).system
    added = after.matrix.toarray() - before.matrix.toarray()
    scale = np.abs(added).max()
    assert scale > 0.0
    np.testing.assert_allclose(before._lack().toarray(), added, atol=1e-9 * scale)


def test_steps_solve_the_system_with_what_was_added(program: GaitProgram) -> None:
    system = Linearised(program).system
    assert system.factor(1e4, convexity=0.5)
    random = np.random.default_rng(4)
    b, c = random.normal(size=program.num_variables), random.normal(size=program.num_constraints)
    x, y = system.solve(b, c)
    rest_b, rest_c = system._residual(x, y, b, c)
    assert max(np.abs(rest_b).max(), np.abs(rest_c).max()) < 1e-7
    half = system._times(x)
    assert system.factor(1e4)
    size = system.num_shared
    lack = (half - system._times(x))[:size]  # what half the convexity does to x
    np.testing.assert_allclose(lack, 0.5 * (system._lack() @ x[:size]), atol=1e-9 * abs(lack).max())


class Scales:
    """A system that is positive definite once shift + 2 convexity exceeds `lacking`."""

    def __init__(self, lacking: float):
        self.lacking = lacking
        self.tried: list[tuple[float, float]] = []

    def factor(self, shift: float, convexity: float) -> bool:
        self.tried.append((shift, convexity))
        return shift + 2.0 * convexity > self.lacking

    def least_convexity(self) -> float:
        return 0.5 * self.lacking


def test_nothing_is_added_where_nothing_is_needed() -> None:
    system = Scales(-1.0)
    assert Regularisation(system).factor()
    assert system.tried == [(0.0, 0.0)]


def test_a_few_times_the_least_convexity_is_added() -> None:
    system = Scales(0.4)  # 0.2 is the least
    assert Regularisation(system).factor()
    assert system.tried == [(0.0, 0.0), (0.0, 1.0), (0.0, pytest.approx(0.52))]


def test_all_convexity_where_much_is_needed_and_multiples_of_the_identity_beyond() -> None:
    system = Scales(1.0)
    assert Regularisation(system).factor()
    assert system.tried == [(0.0, 0.0), (0.0, 1.0)]
    system = Scales(5.0)
    assert Regularisation(system).factor()
    assert system.tried[:2] == [(0.0, 0.0), (0.0, 1.0)]
    shift, convexity = system.tried[-1]
    assert convexity == 1.0
    assert 3.0 < shift <= 3.0 * 100.0


def test_a_wrong_estimate_of_the_least_convexity_costs_a_factor() -> None:
    system = Scales(1.0)
    system.least_convexity = lambda: 0.1
    assert Regularisation(system).factor()
    assert system.tried[-1] == (0.0, 1.0)


def test_a_failed_search_asks_for_more_until_there_is_no_use() -> None:
    system = Scales(-1.0)
    regularisation = Regularisation(system)
    assert regularisation.factor()
    shifts = []
    while regularisation.more():
        shifts.append(system.tried[-1][0])
    assert shifts == sorted(shifts)
    assert len(shifts) < 12
    assert shifts[-1] > 1e4


def test_equal_targets_are_the_barriers_own_gradient() -> None:
    low, high = np.array([0.5, 2.0, np.inf]), np.array([np.inf, 1.0, 4.0])
    push = Targets.equal(0.01, 3).push(low, high)
    np.testing.assert_allclose(push, [-0.02, 0.01 - 0.005, 0.0025])


def test_targets_move_only_for_products_that_would_be_far_off() -> None:
    mu, one = 0.01, np.ones(4)
    # Products of the multipliers with a distance of 1: in range, too large, too small, no bound.
    z = Multipliers(np.zeros(0), np.array([mu, 50.0 * mu, 0.01 * mu, 0.0]), np.zeros(4))
    low = np.array([1.0, 1.0, 1.0, np.inf])
    start = Targets(np.array([mu, 50.0 * mu, 0.01 * mu, 0.0]), np.zeros(4))  # nothing changes
    moved = start.corrected(mu, low, np.full(4, np.inf), z, 0.0 * one, 0.1)
    np.testing.assert_allclose(moved.high, 0.0)
    assert moved.low[0] == pytest.approx(mu)
    assert moved.low[1] == pytest.approx(40.0 * mu)  # no more than 10 mu at once
    assert moved.low[2] == pytest.approx(0.1 * mu)
    assert moved.low[3] == 0.0


def test_bounds_that_move_along_change_nothing_else(program: GaitProgram) -> None:
    """The optimum's laws do not know where the windows of events stand."""
    x = guess_from_reference(program)
    method = InteriorPoint(
        program, CondensedSystem(program, LagrangianHessian(program)), x, 1e-4, 1e-6, push=0.1
    )
    for _ in range(3):
        assert method.step()
    assert recentred(method.program, method.x, 2.0) is None
    moved = recentred(method.program, method.x, 0.0)
    assert moved is not None
    events = moved.values(method.x).events
    np.testing.assert_allclose(moved.formulation.event_centres, events, atol=1e-12)
    before = method.cost, method.primal
    lower, _ = method.gaps(method.w)
    products = np.where(method.has_low, lower, 0.0) * method.multipliers.lower
    method.move_bounds(moved, CondensedSystem(moved, LagrangianHessian(moved)))
    assert method.cost == pytest.approx(before[0], rel=1e-12)
    np.testing.assert_allclose(method.primal, before[1], atol=1e-9)
    after = np.where(method.has_low, method.gaps(method.w)[0], 0.0) * method.multipliers.lower
    np.testing.assert_allclose(after, products, rtol=1e-9)
    assert method.step()


def test_corners_narrow_with_the_barrier_and_end_at_their_own_width(program: GaitProgram) -> None:
    system = CondensedSystem(program, LagrangianHessian(program))
    x = guess_from_reference(program)
    method = InteriorPoint(program, system, x, barrier=1e-3, last_barrier=1e-6, push=0.1)
    widths = [program.smoothing]
    while not method.at_last_barrier:
        method.lower_barrier()
        widths.append(program.smoothing)
    assert widths[0] > 10.0
    assert widths == sorted(widths, reverse=True)
    assert widths[-1] == 1.0


def test_steps_remember_slopes_of_corners_also_where_bounds_move(
    program: GaitProgram, monkeypatch
) -> None:
    """A second step takes those of the first to curve across what it has crossed."""
    crossed, exact = [], []
    curvature = LagrangianHessian.local_curvature

    def both(self, state, multipliers, objective, stiffness, corners):
        plain = curvature(self, state, multipliers, objective, stiffness)
        crossing = curvature(self, state, multipliers, objective, stiffness, corners)
        crossed.append(crossing.physical.muscles)
        exact.append(plain.physical.muscles)
        return crossing

    monkeypatch.setattr(LagrangianHessian, "local_curvature", both)
    method = started(program, 1e-4)
    moved = recentred(method.program, method.x, 0.0)
    method.move_bounds(moved, CondensedSystem(moved, LagrangianHessian(moved)))
    assert method.step()
    more = [np.abs(crossed[k] - exact[k]).max() / np.abs(exact[k]).max() for k in range(2)]
    assert more[0] <= 1e-9
    assert more[1] > 1e-5


def started(program: GaitProgram, barrier: float) -> InteriorPoint:
    """A solve from the reference after one step; 1e-6 is the last barrier parameter."""
    system = CondensedSystem(program, LagrangianHessian(program))
    x = guess_from_reference(program)
    method = InteriorPoint(program, system, x, barrier, last_barrier=1e-6, push=0.1)
    assert method.step()
    return method


@pytest.mark.parametrize("barrier", [1e-4, 1e-6])
def test_at_the_last_barrier_parameter_a_step_that_turns_back_goes_half_way(
    program: GaitProgram, barrier: float
) -> None:
    method = started(program, barrier)
    back = np.zeros(len(method.w))
    back[: method.size] = -1e-9 * method._last_step / np.abs(method._last_step).max()
    assert method._longest(back) == (0.5 if method.at_last_barrier else 1.0)
    assert method._longest(-back) == 1.0


@pytest.mark.parametrize("far", [False, True])
def test_multipliers_of_another_walk_count_where_laws_nearly_hold(
    program: GaitProgram, far: bool
) -> None:
    x = guess_from_reference(program)
    if far:
        x = x + 0.05 * np.random.default_rng(6).normal(size=len(x))
    given = np.full(program.num_constraints, 0.5)
    bounds = np.zeros(program.num_variables)
    method = InteriorPoint(
        program, CondensedSystem(program, LagrangianHessian(program)), x, 1e-4, 1e-6, push=1e-2,
        known=Multipliers(given, bounds, bounds),
    )  # fmt: skip
    assert (method.violation > 15.0) == far
    np.testing.assert_array_equal(method.multipliers.rows, 0.0 if far else given)


def test_steps_go_beyond_bounds_only_where_they_bend(program: GaitProgram) -> None:
    for bends in (True, False):
        system = CondensedSystem(program, LagrangianHessian(program))
        x = guess_from_reference(program)
        method = InteriorPoint(program, system, x, 1e-4, 1e-6, push=0.1, bends=bends)
        low, _ = method.gaps(method.w)
        k = int(np.flatnonzero(np.isfinite(low))[0])
        dw = np.zeros(len(low))
        dw[k] = -2.0 * low[k]
        assert method._longest(dw) == (1.0 if bends else pytest.approx(0.49995))
        left = (method._along(dw, method._longest(dw)) - method.w + low)[k] / low[k]
        assert left == pytest.approx(0.125 if bends else 1e-4)


def test_a_short_step_does_not_look_like_the_end(program: GaitProgram) -> None:
    """A barrier problem is left by what a step changes at full length."""
    method = started(program, 1e-4)
    length, before = 0.01, method.cost
    dw = np.random.default_rng(3).normal(size=len(method.w)) * np.minimum(*method.gaps(method.w))
    dw = np.where(np.isfinite(dw), 0.1 * dw, 0.0)
    dy = np.zeros(program.num_constraints)
    method._move(method.w + length * dw, dw, dy, length, Targets.equal(1e-4, len(dw)))
    assert method.cost != before
    assert method._last_change == pytest.approx(abs(method.cost - before) / length)


@pytest.mark.parametrize("limit", [{"max_iterations": 2}, {"max_iterations": 200}])
def test_no_program_keeps_wide_corners(program: GaitProgram, limit: dict[str, float]) -> None:
    options = SolverOptions(**limit)
    x = guess_from_reference(program)
    with Monitor(60.0) as monitor:
        monitor.begin(program)
        solution = solve_condensed(program, x, options, monitor)
    assert solution.status == ("converged" if options.max_iterations > 2 else "iteration_limit")
    assert program.smoothing == 1.0
