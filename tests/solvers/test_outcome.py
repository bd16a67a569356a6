"""How a solve ended: return codes, sentences, advice, options."""

from __future__ import annotations

import pytest

from drakegait.errors import InvalidInput, UnknownName
from drakegait.program.gait_program import GaitProgram, Violation
from drakegait.solvers.advice import advice_for
from drakegait.solvers.options import SOLVERS, SolverOptions
from drakegait.solvers.outcome import STATUSES, Outcome
from drakegait.solvers.solution import MESSAGES, status_of_ipopt
from drakegait.study import GaitStudy


def violation(kind: str) -> Violation:
    return Violation(f"{kind} | right heel off | toe_r", kind, 3.0, 0.006, "m")


@pytest.mark.parametrize(
    ("code", "status"),
    # IPOPT's ApplicationReturnStatus.
    [(0, "converged"), (1, "acceptable"), (2, "infeasible"), (-1, "iteration_limit"),
     (-2, "infeasible"), (-4, "time_limit"), (-5, "time_limit"), (-3, "failed"), (3, "failed"),
     (4, "failed"), (-10, "failed"), (-13, "failed"), (-199, "failed")],
)  # fmt: skip
def test_ipopt_codes(code, status):
    assert status_of_ipopt(code, None) == status


@pytest.mark.parametrize("reason", ["interrupted", "time_limit"])
def test_who_stopped_the_solve_decides_unless_it_was_done(reason):
    assert status_of_ipopt(5, reason) == reason
    assert status_of_ipopt(-1, reason) == reason
    assert status_of_ipopt(0, reason) == "converged"


def test_every_status_has_a_sentence():
    assert set(MESSAGES) == set(STATUSES)
    assert all(text.endswith(".") for text in MESSAGES.values())


def test_only_converged_is_converged():
    for status in STATUSES:
        outcome = Outcome("ipopt", status, "", 1, 0.1, 0.1, 1, 1, 1)
        assert outcome.converged == (status == "converged")


def test_advice_is_for_those_who_need_it():
    assert advice_for("converged", []) == ""
    for status in STATUSES:
        if status != "converged":
            for worst in ([], [violation("foot contact")]):
                assert advice_for(status, worst).endswith(".")


@pytest.mark.parametrize("status", ["time_limit", "interrupted", "iteration_limit"])
def test_who_was_stopped_may_go_on(status):
    assert "--guess" in advice_for(status, [violation("friction")])


@pytest.mark.parametrize(
    ("law", "words"),
    [("equations of motion", "moment_tolerance"), ("foot contact", "contact_tolerance"),
     ("friction", "slippery"), ("free moment", "patch_radius"), ("excitation", "strength"),
     ("joint limit", "widen"), ("average speed", "speed"), ("phase duration", "speed"),
     ("clearance", "swing foot"), ("normal force", "pull")],
)  # fmt: skip
@pytest.mark.parametrize("status", ["infeasible", "failed", "acceptable"])
def test_advice_speaks_of_the_law_that_is_broken(law, words, status):
    text = advice_for(status, [violation(law), violation("clearance")])
    assert words in text
    assert "right heel off" in text


def test_every_law_of_a_program_has_its_advice():
    for form in ("lifted", "projected"):
        study = GaitStudy(model="spatial", nodes=10, interior_points=(0,) * 8, multipliers=form)
        program = GaitProgram(study.with_limit("knee_flexion_r", 0.0).formulation())
        for law in sorted({name.split(" | ")[0] for name in program.row_names}):
            text = advice_for("infeasible", [violation(law)])
            assert "another starting gait" not in text, law


@pytest.mark.parametrize("solver", SOLVERS)
def test_options_know_the_solvers(solver):
    assert SolverOptions(solver=solver).solver == solver


@pytest.mark.parametrize(
    ("choices", "name"),
    [({"time_limit": 0.0}, "time_limit"), ({"max_iterations": 0}, "max_iterations"),
     ({"optimality": -1.0}, "optimality"), ({"feasibility": float("nan")}, "feasibility")],
)  # fmt: skip
def test_options_out_of_range_are_refused(choices, name):
    with pytest.raises(InvalidInput, match=name):
        SolverOptions(**choices)


def test_unknown_solver_or_option_is_refused_with_the_known_ones():
    with pytest.raises(UnknownName, match="ipopt-mumps, ipopt, snopt"):
        SolverOptions(solver="fmincon")
    with pytest.raises(UnknownName, match="time_limit"):
        SolverOptions().replace(timelimit=3.0)
