"""Solving on to the very optimum, and derivatives there against solving again, group by group."""

from __future__ import annotations

import dataclasses

import pytest
from gait_cases import reference_gait

from drakegait.cli import main
from drakegait.commands import sensitivities as command
from drakegait.errors import InvalidInput
from drakegait.exact import OPTIONS, solve_exactly
from drakegait.gait import Gait
from drakegait.parameters import parameters
from drakegait.sensitivities import Sensitivities, Sensitivity
from drakegait.solve import solve
from drakegait.study import GaitStudy
from drakegait.walker.disorders import Orthosis

# One parameter of each group that the walk hangs on; both ankles wear an orthosis.
STUDY = GaitStudy.planar_symmetric(19).with_disorder(Orthosis("both", stiffness=50.0, mass=0.4))
ONE_OF_EACH = (
    "speed", "body mass", "added mass foot", "mass centre shank", "inertia thigh", "strength vasti",
    "fibre length soleus", "orthosis both stiffness", "orthosis both mass",
    "tolerances.moment_tolerance", "tolerances.contact_tolerance", "passive.damping_knee",
)  # fmt: skip
SHARE = 2e-4  # of a parameter's step: with 2e-3 bounds become active in between


@pytest.fixture(scope="module")
def usual():
    return solve(STUDY, refine=False, time_limit=300.0)


@pytest.fixture(scope="module")
def exact(usual):
    return solve_exactly(usual, time_limit=300.0)


@pytest.fixture(scope="module")
def estimates(usual):
    return usual.sensitivities()


@pytest.fixture(scope="module")
def answers(exact):
    return exact.sensitivities()


@pytest.mark.solve
def test_nothing_is_left_of_the_optimality_conditions(usual, exact, estimates, answers):
    assert usual.converged and exact.converged
    assert not estimates.exact and answers.exact
    assert answers.stationarity < 1e-6 < estimates.stationarity
    assert exact.cost["total"] == pytest.approx(usual.cost["total"], rel=1e-3)
    assert exact.study == usual.study  # the same control points: the same program


@pytest.mark.solve
def test_only_there_the_two_weights_have_opposite_answers(estimates, answers):
    """Both twice as large: the same walk. A barrier that stays as it is moves it all the same."""
    energy, deviation = answers["energy_weight"].energy, answers["deviation_weight"].energy
    assert energy < 0.0
    assert energy == pytest.approx(-deviation, rel=1e-3)
    apart = estimates["energy_weight"].energy + estimates["deviation_weight"].energy
    assert abs(apart) > 0.01 * abs(energy)


@pytest.mark.solve
@pytest.mark.parametrize("name", ONE_OF_EACH)
def test_derivatives_are_what_solving_again_gives(exact, answers, name):
    parameter = next(p for p in parameters(exact.study) if p.name == name)
    step = SHARE * parameter.step
    ends = []
    for value in (parameter.value + step, parameter.value - step):
        solved = solve(
            parameter.study(value), guess=exact, refine=False, time_limit=300.0, **OPTIONS
        )
        assert solved.converged
        ends.append((solved.cost["total"], 100.0 * solved.cost["metabolic cost of transport"]))
    cost, energy = ((above - below) / (2.0 * step) for above, below in zip(*ends, strict=True))
    assert answers[name].cost == pytest.approx(cost, rel=3e-3)
    assert answers[name].energy == pytest.approx(energy, rel=1e-2)


# Refusals and the command ------------------------------------------------------------------------


def test_a_gait_that_did_not_converge_is_refused():
    with pytest.raises(InvalidInput, match="time_limit.*a gait that converged"):
        solve_exactly(reference_gait("planar-symmetric"))


def test_a_program_without_second_derivatives_is_refused():
    gait = converged(reference_gait("planar-symmetric", multipliers="projected"))
    with pytest.raises(InvalidInput, match="projected.*lifted"):
        solve_exactly(gait)


def converged(gait):
    """The same, as if a solver had found it."""
    return dataclasses.replace(gait, outcome=dataclasses.replace(gait.outcome, status="converged"))


def run(*arguments: str) -> int:
    with pytest.raises(SystemExit) as ending:
        main(["sensitivities", *arguments])
    return ending.value.code or 0


@pytest.mark.solve
def test_the_command_says_where_it_went(usual, tmp_path, capsys):
    usual.save(tmp_path / "gait.nc")
    assert run(str(tmp_path), "--count", "3", "--exact") == 0
    printed = capsys.readouterr().out
    assert "Solved on to the optimum" in printed
    assert "estimates" not in printed


def test_where_the_optimum_is_not_found_the_answers_are_those_of_the_gait(
    tmp_path, capsys, monkeypatch
):
    """Of the very gait that was given, which a search that got lost must not replace."""
    gait = converged(reference_gait("planar-symmetric"))
    gait.save(tmp_path / "gait.nc")
    lost = dataclasses.replace(
        gait.outcome, status="iteration_limit", message="Too many iterations."
    )
    monkeypatch.setattr(
        command, "solve_exactly", lambda gait: dataclasses.replace(gait, outcome=lost)
    )
    entry = Sensitivity("thing", "walk", "m", 2.0, -1.5, 3.0, 0.1, -0.15, 0.3)

    def answers(asked):
        assert asked.outcome.status == "converged"
        return Sensitivities((entry,), 4.0, 350.0, 1e-5, False, "somebody")

    monkeypatch.setattr(Gait, "sensitivities", answers)
    assert run(str(tmp_path), "--count", "3", "--exact") == 0
    printed = capsys.readouterr().out
    assert "not found" in printed and "Too many iterations." in printed
    assert "estimates" in printed


def test_ctrl_c_while_it_solves_on_ends_the_command(tmp_path, monkeypatch, capsys):
    gait = converged(reference_gait("planar-symmetric"))
    gait.save(tmp_path / "gait.nc")
    stopped = dataclasses.replace(gait.outcome, status="interrupted")
    monkeypatch.setattr(
        command, "solve_exactly", lambda gait: dataclasses.replace(gait, outcome=stopped)
    )
    assert run(str(tmp_path), "--exact") != 0
    assert "interrupted" in capsys.readouterr().err
