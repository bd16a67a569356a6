"""Disorders on their way through guess, solve, check, files, figures and the command line."""

from __future__ import annotations

import functools

import numpy as np
import pytest
from gait_cases import changed, reference_gait, restated

from drakegait.check import check
from drakegait.commands.walk import _who
from drakegait.errors import DrakegaitError
from drakegait.gait import Gait
from drakegait.solve import solve
from drakegait.study import GaitStudy
from drakegait.walker import disorders as dis
from drakegait.walker.disorders.reading import READERS, read_disorders


def items(gait: Gait) -> dict:
    return {item.name: item for item in check(gait, 200).items}


def with_disorder(*disorders) -> Gait:
    """The reference walk as the answer of a walker with the same muscles."""
    gait = reference_gait("planar")
    return restated(gait, gait.study.with_disorder(*disorders))


# The check judges the changed walker ----------------------------------------------------------


def test_the_check_has_no_further_items_without_disorders():
    names = set(items(reference_gait("planar")))
    assert not {n for n in names if n.startswith(("spastic", "limit", "step_", "stance_"))}


@pytest.mark.parametrize(
    "disorder",
    [dis.JointStiffness("knee", "l", 200.0, 40.0), dis.LegLength("shank", "l", -0.05),
     dis.Orthosis("r", 400.0, 20.0), dis.Contracture("soleus", "l", 0.6)],
    ids=lambda item: item.kind,
)  # fmt: skip
def test_the_check_judges_the_changed_walker(disorder):
    normal, changed_one = items(reference_gait("planar")), items(with_disorder(disorder))
    name = "foot_contact_max_mm" if disorder.kind == "leg_length" else "equations_of_motion_max_Nm"
    assert changed_one[name].value > 1.2 * normal[name].value


def test_a_muscle_below_its_floor_fails_the_check():
    gait = with_disorder(dis.Spasticity("vasti", "l", 0.4))
    item = items(gait)["spastic_excitation_margin"]
    assert item.value < -0.1 and not item.passed and "vasti_l" in item.where and item.phases
    assert items(with_disorder(dis.Spasticity("vasti", "l", 0.0))).keys() == items(
        reference_gait("planar")
    ).keys()


def test_a_joint_beyond_its_range_fails_the_check():
    knee = np.degrees(reference_gait("planar").nodal_values["knee_flexion_l"]).max()
    inside = items(with_disorder(dis.LimitedRange("knee", "l", -10.0, knee + 5.0)))
    outside = items(with_disorder(dis.LimitedRange("knee", "l", -10.0, knee - 10.0)))
    assert inside["limit_excess_degrees"].passed
    assert not outside["limit_excess_degrees"].passed
    assert outside["limit_excess_degrees"].value == pytest.approx(10.0, abs=3.0)


def test_ratios_are_checked():
    gait = with_disorder(dis.Asymmetry("step_length", 1.2), dis.Asymmetry("stance_time", 1.1))
    placement = gait.values.placement.copy()
    placement[:2] = 0.72, 0.6
    events = gait.values.events.copy()
    events[6] = 1.1 * (1.0 + events[2] - events[4])
    found = items(changed(gait, placement=placement, events=events))
    assert found["step_length_ratio_error"].passed and found["stance_time_ratio_error"].passed
    found = items(gait)
    assert not found["step_length_ratio_error"].passed
    assert "wanted 1.2" in found["step_length_ratio_error"].where


# Command line -----------------------------------------------------------------------------------


def test_what_is_typed_is_what_is_studied():
    given = dict.fromkeys(READERS) | {
        "weakness": ["soleus_l=0.5", "VAS=0.8"],
        "contracture": ["gastrocnemius_r=0.9"],
        "spasticity": ["hamstrings_l=.1"],
        "stiffness": ["ankle_r=40@-5:0.5", "knee=10"],
        "range_": ["knee_l=5:45", "hip_r=:30"],
        "leg_length": ["shank_l=-0.02"],
        "prosthesis": ["transtibial_r=category4", "transtibial_l=2@1.5"],
        "orthosis": ["ankle_l=60@5+0.4", "ankle_r=1e2"],
        "asymmetry": ["step_length=1.1"],
        "pain": ["foot_r=2"],
    }
    assert read_disorders(given) == (
        dis.Weakness("soleus", "l", 0.5), dis.Weakness("VAS", "both", 0.8),
        dis.Contracture("gastrocnemius", "r", 0.9), dis.Spasticity("hamstrings", "l", 0.1),
        dis.JointStiffness("ankle", "r", 40.0, -5.0, 0.5), dis.JointStiffness("knee", "both", 10.0),
        dis.LimitedRange("knee", "l", 5.0, 45.0), dis.LimitedRange("hip", "r", high=30.0),
        dis.LegLength("shank", "l", -0.02), dis.Prosthesis("r", 4), dis.Prosthesis("l", 2, 1.5),
        dis.Orthosis("l", 60.0, 5.0, mass=0.4), dis.Orthosis("r", 100.0),
        dis.Asymmetry("step_length", 1.1), dis.Pain("foot", "r", 2.0),
    )  # fmt: skip


@pytest.mark.parametrize("name", READERS)
def test_every_option_gives_its_own_example(name):
    (_, example), _ = READERS[name]
    (item,) = read_disorders({name: [example]})
    assert item.kind == name.strip("_")


@pytest.mark.parametrize(
    ("name", "text"),
    [("weakness", "soleus_l"), ("weakness", "soleus_l=half"), ("weakness", "=0.5"),
     ("stiffness", "ankle=40@x"), ("stiffness", "ankle=1.2.3"), ("range_", "knee_l=:"),
     ("range_", "knee_l=5"), ("prosthesis", "transtibial_r=4.5"), ("prosthesis", "femoral_r=4"),
     ("orthosis", "knee_r=50"), ("asymmetry", "step_length_r=1.1"), ("pain", "foot_r=much")],
)  # fmt: skip
def test_what_cannot_be_read_is_refused_with_an_example(name, text):
    with pytest.raises(DrakegaitError, match="--.* is .* for example"):
        read_disorders({name: [text]})


def test_the_sentence_names_every_disorder():
    study = GaitStudy.planar().with_disorder(dis.Prosthesis("r"), dis.Weakness("soleus", "l", 0.5))
    words = _who(study)
    assert "transtibial prosthesis right, category 4" in words
    assert "soleus left with 50 % of its strength" in words


# Solves -----------------------------------------------------------------------------------------


@functools.cache
def solved(*disorders, **statements) -> Gait:
    return solve(GaitStudy.planar(18, disorders=disorders, **statements), refine=False)


@pytest.mark.solve
@pytest.mark.slow
def test_a_prosthesis_walks_and_pushes_off_less(tmp_path):
    gait = solved(dis.Prosthesis("r"))
    assert gait.converged
    assert not any(name.endswith("_r") and name.startswith(("soleus", "gastro", "tibialis"))
                   for name in gait.muscle_names)  # fmt: skip
    sample = gait.sample()
    step = gait.stride_time / 200.0
    power = {
        side: sample.joint_power.sel(joint=f"ankle_dorsiflexion_{side}").values for side in "rl"
    }
    work = {side: step * float(np.sum(p[:-1])) for side, p in power.items()}
    assert work["r"] < 0.0 < work["l"]  # a passive foot only loses energy
    push_off = {side: step * float(np.maximum(p[:-1], 0.0).sum()) for side, p in power.items()}
    assert push_off["r"] < 0.8 * push_off["l"]
    assert np.abs(sample.joint_moment_muscle.sel(joint="ankle_dorsiflexion_r")).max() == 0.0
    # It survives a file, and its figures have the muscles of the other leg.
    gait.save(tmp_path / "gait.nc")
    again = Gait.load(tmp_path / "gait.nc")
    assert again.study == gait.study and again.muscle_names == gait.muscle_names
    pytest.importorskip("matplotlib")
    from drakegait.report.figures import plot

    assert plot(again, tmp_path / "figures")


@pytest.mark.solve
def test_a_gait_of_another_set_of_muscles_is_a_guess():
    """Muscles that both walkers have keep their forces, those that only one has start at rest."""
    whole = reference_gait("planar")
    study = whole.study.with_disorder(dis.Prosthesis("r"))
    fewer = solve(study, guess=whole, max_iterations=1, refine=False)
    assert fewer.muscle_names == study.walker.muscles.names
    again = solve(whole.study, guess=fewer, max_iterations=1, refine=False)
    assert again.muscle_names == whole.muscle_names
