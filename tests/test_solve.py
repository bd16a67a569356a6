"""From a study to a gait with every solver, and every way in which a solve can end early."""

from __future__ import annotations

import dataclasses
import os
import signal
import time

import numpy as np
import pytest
import scipy.optimize
import scipy.sparse

from drakegait import rounds
from drakegait.errors import InvalidInput, UnknownName
from drakegait.program.gait_program import GaitProgram
from drakegait.program.guess import guess_from_reference
from drakegait.program.starts import starts
from drakegait.solve import solve
from drakegait.solvers.condensed import iterate_to_end
from drakegait.solvers.condensed import solve as condensed_solve
from drakegait.solvers.options import SOLVERS, SolverOptions
from drakegait.study import GaitStudy

pytestmark = pytest.mark.solve

# A walk as small as a walk can be: seconds, not minutes, with any solver.
STUDY = GaitStudy.planar_symmetric(11, interior_points=(3, 2, 6, 5))


@pytest.fixture(scope="module")
def gait():
    return solve(STUDY, refine=False, time_limit=60.0)


def program_and_x(gait) -> tuple[GaitProgram, np.ndarray]:
    program = GaitProgram(gait.study.formulation(gait.values.events))
    return program, program.design.pack(gait.values)


def test_it_converges_and_every_law_holds(gait):
    outcome = gait.outcome
    assert gait.converged
    assert (outcome.status, outcome.worst, outcome.advice) == ("converged", (), "")
    assert outcome.solver == "condensed"
    assert outcome.iterations > 10
    assert 0.0 < outcome.wall_time < 60.0
    program, x = program_and_x(gait)
    assert program.violations(x).max() < 2e-3  # in units of each row's tolerance
    assert (x >= program.design.lower - 1e-9).all()
    assert (x <= program.design.upper + 1e-9).all()
    assert gait.speed == pytest.approx(1.2, abs=1e-4)
    assert outcome.num_variables == program.num_variables
    assert outcome.num_constraints == program.num_constraints
    assert outcome.jacobian_nonzeros == program.num_entries


def test_its_cost_is_that_of_the_gait_that_is_handed_back(gait):
    program, x = program_and_x(gait)
    parts = program.cost_parts(x)
    assert gait.cost["total"] == pytest.approx(sum(parts.values()), rel=1e-6)
    for name, value in parts.items():
        assert gait.cost[name] == pytest.approx(value, rel=1e-6)


def test_it_is_checked(gait):
    assert gait.report is not None


def test_no_small_step_that_keeps_the_laws_costs_less(gait):
    """First-order optimality, found again by a linear program: no solver's word is taken."""
    program, x = program_and_x(gait)
    design, gradient, rows = program.design, program.gradient(x), program.rows(x)
    entries = (program.jacobian_rows, program.jacobian_columns)
    shape = (program.num_constraints, program.num_variables)
    jacobian = scipy.sparse.coo_array((program.jacobian(x), entries), shape=shape).tocsr()
    up, down = np.isfinite(program.upper), np.isfinite(program.lower)
    room = np.concatenate([(program.upper - rows)[up], (rows - program.lower)[down]])
    reach = 0.01
    best = scipy.optimize.linprog(
        gradient,
        A_ub=scipy.sparse.vstack([jacobian[up], -jacobian[down]]),
        b_ub=np.maximum(room, 0.0),
        bounds=np.stack(
            [np.clip(design.lower - x, -reach, 0.0), np.clip(design.upper - x, 0.0, reach)], axis=1
        ),
    )
    assert best.success
    without_laws = -reach * np.abs(gradient).sum()
    assert best.fun > 1e-3 * without_laws


@pytest.mark.parametrize("solver", SOLVERS)
def test_solvers_agree_from_the_same_gait(gait, solver):
    options = {"optimality": 1e-4} if solver != "snopt" else {}
    again = solve(
        gait.study, guess=gait, refine=False, solver=solver, time_limit=60.0, **options
    )
    assert again.outcome.solver == solver
    assert again.outcome.status == "converged", again.outcome.message
    program, x = program_and_x(again)
    assert program.violations(x).max() < 5e-3
    assert again.cost["total"] == pytest.approx(gait.cost["total"], rel=1e-3)


def test_projected_multipliers_find_the_same_walk(gait):
    """Eq. (17) put in, or held as a constraint: one set of walks."""
    study = gait.study.replace(multipliers="projected")
    again = solve(study, guess=gait, refine=False, time_limit=60.0)
    assert again.converged
    assert again.cost["total"] == pytest.approx(gait.cost["total"], rel=2e-3)


# Ends before the end -----------------------------------------------------------------------------


@pytest.mark.parametrize("solver", SOLVERS)
def test_the_time_limit_ends_it_with_a_gait(solver):
    started = time.monotonic()
    stopped = solve(STUDY, refine=False, solver=solver, time_limit=0.4)
    assert time.monotonic() - started < 8.0
    assert stopped.outcome.status == "time_limit"
    assert not stopped.converged
    assert "time limit" in stopped.outcome.message
    assert "--guess" in stopped.outcome.advice
    assert stopped.outcome.worst  # which laws are broken, and where
    assert all(" | " in name and "off by" in name for name in stopped.outcome.worst)
    assert np.isfinite(stopped.values.coordinate_coefficients).all()
    assert stopped.report is not None


@pytest.mark.parametrize("solver", SOLVERS)
def test_ctrl_c_ends_it_with_a_gait(solver):
    before = signal.getsignal(signal.SIGINT)
    told = []

    def interrupt(progress) -> None:
        told.append(progress)
        if len(told) == 2:
            os.kill(os.getpid(), signal.SIGINT)

    stopped = solve(STUDY, refine=False, solver=solver, time_limit=30.0, report=interrupt)
    assert stopped.outcome.status == "interrupted"
    assert "nterrupted" in stopped.outcome.message
    assert len(told) <= 3  # it ended soon after
    assert told[1].elapsed > told[0].elapsed
    assert stopped.outcome.worst
    assert stopped.report is not None
    assert signal.getsignal(signal.SIGINT) is before


def test_the_best_gait_of_a_stopped_solve_is_no_worse_than_the_guess():
    program = GaitProgram(STUDY.formulation())
    start = program.violations(guess_from_reference(program)).max()
    stopped = solve(STUDY, refine=False, max_iterations=12)
    assert stopped.outcome.status == "iteration_limit"
    assert stopped.outcome.iterations <= 13
    program, x = program_and_x(stopped)
    assert program.violations(x).max() <= start + 1e-6


def test_what_cannot_be_walked_is_told_with_the_law_that_is_broken():
    """Knees bent by 60 degrees throughout: the feet do not reach both prints and the trunk."""
    study = STUDY.with_limit("knee_flexion_r", 1.9).with_limit("knee_flexion_l", 1.9)
    stopped = solve(study, refine=False, max_iterations=60, time_limit=20.0)
    assert stopped.outcome.status in ("infeasible", "iteration_limit", "failed")
    assert stopped.outcome.worst
    assert stopped.outcome.advice
    assert stopped.report is not None
    assert not stopped.report.passed


# Guesses ---------------------------------------------------------------------------------------


def test_a_warm_start_needs_fewer_iterations(gait):
    again = solve(gait.study, guess=gait, refine=False, time_limit=60.0)
    assert again.converged
    assert again.outcome.iterations < 0.7 * gait.outcome.iterations
    assert again.cost["total"] == pytest.approx(gait.cost["total"], rel=1e-3)


def test_a_gait_on_other_nodes_is_a_guess(gait):
    study = GaitStudy.planar_symmetric(13, interior_points=(3, 2, 6, 5))
    finer = solve(study, guess=gait, refine=False, time_limit=60.0)
    assert finer.converged
    assert len(finer.values.coordinate_coefficients[0]) == 12
    assert finer.cost["total"] < gait.cost["total"]  # more freedom


def test_a_symmetric_gait_is_a_guess_for_both_legs_on_their_own(gait):
    points = 2 * gait.study.interior_points
    full = GaitStudy.planar(11, interior_points=points)
    started = solve(full, guess=gait, refine=False, max_iterations=1)
    assert started.cost["total"] == pytest.approx(gait.cost["total"], rel=0.2)
    kept = started.values.coordinate_coefficients - gait.values.coordinate_coefficients
    assert np.abs(kept).max() < 0.05
    back = solve(STUDY, guess=started, refine=False, time_limit=60.0)
    assert back.converged
    assert back.cost["total"] == pytest.approx(gait.cost["total"], rel=1e-2)


def test_a_gait_of_another_skeleton_is_refused_in_a_sentence(gait):
    with pytest.raises(InvalidInput, match="guess is 'planar-symmetric'"):
        solve(GaitStudy.spatial(), guess=gait, time_limit=5.0)


def test_unknown_choices_are_refused_before_anything_is_solved():
    started = time.monotonic()
    with pytest.raises(UnknownName, match="time_limit"):
        solve(STUDY, timelimit=3.0)
    with pytest.raises(UnknownName, match="ipopt-mumps"):
        solve(STUDY, solver="fmincon")
    assert time.monotonic() - started < 0.5


def test_choices_and_options_add_up():
    options = SolverOptions(max_iterations=3, time_limit=30.0)
    stopped = solve(STUDY, options=options, refine=False, optimality=1e-2)
    assert stopped.outcome.status == "iteration_limit"


# Refinement ------------------------------------------------------------------------------------


def early_heel_off() -> GaitStudy:
    """A reference that says too early a heel off: its events have to go far."""
    walk = STUDY.reference_walk
    fractions = np.asarray(walk.phase_fractions) + np.tile([0.0, 0.0, -0.05, 0.05], 2)
    return STUDY.replace(reference=dataclasses.replace(walk, phase_fractions=tuple(fractions)))


def test_events_go_further_than_their_first_bounds_let_them():
    study = early_heel_off()
    found = solve(study, refine=False, time_limit=60.0)
    assert found.converged
    formulation = study.formulation()
    moved = np.abs(found.values.events - np.array(formulation.event_centres))
    assert moved.max() > formulation.event_reach
    last = GaitProgram(found.study.formulation(found.values.events))
    assert last.violations(last.design.pack(found.values)).max() < 2e-3


@pytest.mark.parametrize(("many", "much"), [(10, 1.0), (1000, 0.005), (1000, 1.0)])
def test_a_solve_whose_events_go_far_starts_again_from_there(monkeypatch, many, much):
    """After so many iterations, or when the cost has fallen so much."""
    far = many == 10 or much < 1.0
    start = starts(13)[12]  # its events move at the last barrier parameter
    monkeypatch.setattr(iterate_to_end, "_MANY", many)
    monkeypatch.setattr(iterate_to_end, "_MUCH", much)
    ends: list[str] = []
    real = condensed_solve.iterate

    def noted(*args):
        ended = real(*args)
        ends.append(ended[2])
        return ended

    monkeypatch.setattr(condensed_solve, "iterate", noted)
    found = solve(STUDY, starts=[start], refine=False, time_limit=60.0)
    assert found.converged
    assert (ends[0] == iterate_to_end.FAR) == far


def test_control_points_are_added_where_the_check_fails():
    coarse = STUDY.replace(interior_points=(0, 0, 2, 1))
    first = solve(coarse, refine=False, time_limit=60.0)
    assert first.converged
    failing = first.report.worst_phases()
    assert failing
    refined = solve(coarse, time_limit=60.0)
    assert refined.outcome.refinements
    assert refined.study.interior_points != coarse.interior_points
    assert all(
        new >= old
        for new, old in zip(refined.study.interior_points, coarse.interior_points, strict=True)
    )
    for phase in {phase % 4 for phase in failing}:
        assert refined.study.interior_points[phase] > coarse.interior_points[phase]
    assert dataclasses.replace(refined.study, interior_points=coarse.interior_points) == coarse


def test_a_walk_whose_check_fails_nowhere_gets_no_more_control_points(gait, monkeypatch):
    monkeypatch.setattr(type(gait.report), "worst_phases", lambda report: set())
    again = solve(STUDY, guess=gait, time_limit=60.0)
    assert again.converged and again.outcome.refinements == () and again.study == gait.study


def test_a_walk_with_many_nodes_begins_at_one_with_half_as_many(gait, monkeypatch):
    monkeypatch.setattr(rounds, "MANY_NODES", 21)
    real = rounds.solver_of

    def short_with_many(name):
        def run(program, x, options, *more, **known):
            few = program.formulation.splines.num_intervals == STUDY.nodes - 1
            chosen = options if few else options.replace(max_iterations=2)
            return real(name)(program, x, chosen, *more, **known)

        return run

    monkeypatch.setattr(rounds, "solver_of", short_with_many)
    study, half = STUDY.replace(nodes=21), gait.outcome.iterations
    found = solve(study, refine=False)
    assert found.study.nodes == 21
    assert found.outcome.refinements == (f"11 -> 21 spline nodes, after {half} iterations",)
    again = solve(study, guess=gait, refine=False)
    assert found.outcome.iterations == half + again.outcome.iterations
    assert found.cost["total"] == pytest.approx(again.cost["total"], rel=1e-9)


def test_many_nodes_are_tried_alone_where_half_as_many_find_no_walk(monkeypatch):
    monkeypatch.setattr(rounds, "MANY_NODES", 21)
    study = STUDY.replace(nodes=21)
    found = rounds.Rounds.first

    def fails(self, guess, start):
        found(self, guess, start)
        if self.study.nodes == 11:
            self.solution = dataclasses.replace(self.solution, status="infeasible")

    monkeypatch.setattr(rounds.Rounds, "first", fails)
    gait = solve(study, refine=False, max_iterations=2)
    assert gait.study.nodes == 21
    assert gait.outcome.refinements == ()


def test_the_time_limit_ends_a_walk_with_many_nodes_during_the_first_half(monkeypatch):
    monkeypatch.setattr(rounds, "MANY_NODES", 21)
    stopped = solve(STUDY.replace(nodes=21), refine=False, time_limit=0.3)
    assert stopped.outcome.status == "time_limit"
    assert stopped.study.nodes == 21
