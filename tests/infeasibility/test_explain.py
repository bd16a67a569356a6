"""Walkers that cannot: the named laws are in conflict, and what is said to help helps."""

from __future__ import annotations

import dataclasses
import functools

import pytest
from gait_cases import reference_gait
from infeasibility_cases import STUDIES, TINY, limited, relaxation_of, weak

from drakegait.errors import InvalidInput
from drakegait.gait import Gait
from drakegait.infeasibility import attempts as attempts_module
from drakegait.infeasibility import explain as explain_module
from drakegait.infeasibility import remedies as remedies_module
from drakegait.infeasibility.explain import explain
from drakegait.infeasibility.explanation import Explanation
from drakegait.infeasibility.laws import laws_of
from drakegait.infeasibility.place import place_of
from drakegait.program.gait_program import GaitProgram
from drakegait.solve import solve
from drakegait.study import GaitStudy

pytestmark = pytest.mark.solve

# Fine enough for walks that pass the check, which a remedy must.
WALK = GaitStudy.planar_symmetric(19)
CASES = {
    "too weak": (weak(WALK, 0.2), "muscles"),
    "too fast": (weak(WALK, 0.5).replace(speed=2.2), "speed"),
    "too slippery": (WALK.with_settings(friction=0.02).replace(speed=2.05), "friction"),
    "too stiff": (limited(WALK, "hip_flexion", -2.0, 2.0), "range of hip_flexion"),
}  # fmt: skip


def unsolved(study: GaitStudy, status: str = "infeasible") -> Gait:
    """A gait of `study` as a solve without success leaves it."""
    STUDIES["unsolved"] = study
    relaxation = relaxation_of.__wrapped__("unsolved")
    values = relaxation.program.values(relaxation.elastic.unknowns(relaxation._first))
    outcome = dataclasses.replace(reference_gait("planar-symmetric").outcome, status=status)
    return Gait(study, values, outcome, {})


@functools.cache
def explained(name: str) -> Explanation:
    return explain(unsolved(CASES[name][0]), remedies=1)


def test_a_walker_too_weak_can_walk_with_moments_from_nowhere_and_only_so():
    """The quick part of an explanation: which law is in the way, where, and which is not."""
    relaxation = relaxation_of("weak")
    least = relaxation.least()
    assert least.converged and "speed" in least.broken
    helped = relaxation.give_up(("muscles",), least)
    assert helped.converged and not helped.broken
    assert relaxation.give_up(("phase durations",), least).broken
    place = place_of(relaxation, helped, "muscles")
    assert place.missing > TINY.tolerances.moment_tolerance
    assert place.muscles and "saturated" in place.sentence
    # What the joint lacks is what the equations of motion lack, all other laws held.
    program, x = relaxation.program, relaxation.elastic.unknowns(helped.point)
    off = program.violations(x)
    names = [program.row_names[i] for i in (off > 0.02).nonzero()[0]]
    assert names and all(name.startswith("equations of motion") for name in names)
    assert not any("hat_" in name for name in names)


def test_a_whole_explanation_ends_with_a_remedy_that_walks(monkeypatch):
    monkeypatch.setattr(remedies_module, "_MAX_HALVINGS", 0)
    study = CASES["too weak"][0]
    found = explain(unsolved(study), remedies=1)
    assert (found.verdict, found.ended) == ("conflict", None)
    assert found.conflict == ("muscles", "speed") and found.smallest and found.unique
    assert found.place.law == "muscles" and found.place.missing > 4.0  # the tolerance, N m
    (remedy,) = found.remedies
    assert remedy.gait.converged and remedy.gait.report.passed
    assert remedy.gait.study.strength == remedy.study.strength
    ratio = remedy.study.walker.muscles.f_max / study.walker.muscles.f_max
    percent = 100.0 * (ratio.max() - 1.0)
    assert 20.0 < percent <= 240.0 and f"{percent:.0f} % more strength" in str(found)
    assert "solved again, check passed" in str(found)


@pytest.mark.slow
@pytest.mark.parametrize("name", CASES)
def test_the_law_that_was_made_too_hard_is_in_the_conflict(name):
    found = explained(name)
    assert found.verdict == "conflict" and found.ended is None
    assert CASES[name][1] in found.conflict
    assert found.smallest
    known = {law.name: law for law in laws_of(GaitProgram(CASES[name][0].formulation()))}
    assert {known[law].words for law in found.conflict} == {*found.stated, *found.others}


@pytest.mark.slow
@pytest.mark.parametrize("name", CASES)
def test_the_study_itself_has_no_walk_where_its_remedy_has_one(name):
    study = CASES[name][0]
    found = explained(name)
    assert found.remedies
    remedy = found.remedies[0]
    assert remedy.gait.converged and remedy.gait.report.passed
    assert remedy.study.speed <= study.speed
    # The very same start, with and without the change.
    asked = solve(study, guess=remedy.gait, max_iterations=200)
    helped = solve(remedy.study, guess=remedy.gait, max_iterations=200)
    assert not (asked.converged and asked.report.passed)
    assert helped.converged and helped.report.passed


@pytest.mark.slow
@pytest.mark.parametrize("name", ["too weak", "too fast"])
def test_a_walker_lacks_a_moment_at_an_instant_of_the_half_stride_that_is_enforced(name):
    place = explained(name).place
    assert place.law == "muscles" and place.unit == "N m"
    assert place.missing > TINY.tolerances.moment_tolerance
    assert place.helpers and 0.0 <= place.percent <= 50.0
    assert ("saturated" in str(explained(name))) == bool(place.muscles)


@pytest.mark.slow
def test_a_walker_too_fast_lacks_it_where_muscles_are_saturated():
    assert explained("too fast").place.muscles


@pytest.mark.slow
def test_a_study_that_has_a_walk_is_told_so():
    found = explain(unsolved(WALK))
    assert found.verdict == "walks"
    assert found.gait.converged and found.gait.report.passed
    assert found.gait.study.speed == WALK.speed
    assert not found.conflict and not found.remedies
    assert str(found).startswith("Feasible after all")


def test_out_of_time_it_says_that_nothing_is_known():
    found = explain(unsolved(CASES["too weak"][0]), time_limit=1.0)
    assert (found.verdict, found.ended) == ("unknown", "time_limit")
    assert str(found) == "The time for the explanation ran out; nothing is known yet."


def test_ctrl_c_while_the_solve_is_continued_ends_at_once(monkeypatch):
    asked = unsolved(TINY, "iteration_limit")
    ended = unsolved(TINY, "interrupted")
    monkeypatch.setattr(attempts_module, "solve", lambda study, **more: ended)
    monkeypatch.setattr(explain_module, "Relaxation", None)  # nothing else may be begun
    found = explain(asked)
    assert (found.verdict, found.ended) == ("unknown", "interrupted")


def test_what_needs_no_explanation_or_cannot_have_one_is_refused():
    with pytest.raises(InvalidInput, match="gait to explain is 'converged'"):
        explain(unsolved(TINY, "converged"))
    for name, value in (("time_limit", 0.0), ("remedies", 9), ("time_limit", "long")):
        with pytest.raises(InvalidInput, match=name):
            explain(unsolved(TINY), **{name: value})
    with pytest.raises(InvalidInput, match="eom_form"):
        explain(dataclasses.replace(unsolved(TINY), study=TINY.with_settings(eom_form="maximum")))
