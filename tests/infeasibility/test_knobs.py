"""Changes that are tried: mild first, in the right direction, rounded to the safe side."""

from __future__ import annotations

import dataclasses
import math

import numpy as np
import pytest
from infeasibility_cases import TINY, limited, relaxation_of, weak

from drakegait.infeasibility.conflict import Relaxed
from drakegait.infeasibility.knobs import changed_study, knobs_for
from drakegait.infeasibility.laws import words_of_limits
from drakegait.infeasibility.place import Place
from drakegait.program.formulation import JointLimit
from drakegait.program.gait_program import GaitProgram
from drakegait.study import GaitStudy
from drakegait.walker.disorders import Asymmetry, LimitedRange, Weakness

PLACE = Place(
    "muscles", "right ankle plantarflexion", "right heel rise", 50.0, 30.0, "N m", ("SOL",),
    ("soleus_r", "gastrocnemius_r"), 60.0,
)  # fmt: skip


SHORT = ("soleus_r",)


@dataclasses.dataclass
class AtRest:
    """Stands for a relaxation whose walk is the guess from the reference, restated."""

    study: GaitStudy
    speed: float = 1.2

    def __post_init__(self):
        self.program = GaitProgram(self.study.formulation())
        self.elastic = self
        self.point = self.program.design.pack(relaxation_of("plain").program.values(
            relaxation_of("plain").elastic.unknowns(relaxation_of("plain")._first)
        ))  # fmt: skip

    def unknowns(self, point):
        return point

    def values(self, relaxed):
        values = self.program.values(relaxed.point)
        steps = 0.5 * self.speed * values.stride_time
        return dataclasses.replace(values, placement=np.array([steps, steps, 0.0, 0.0, 0.0]))


def knobs(study: GaitStudy, law: str, speed: float = 1.2):
    rest = AtRest(study, speed)
    relaxed = Relaxed(frozenset((law,)), rest.point, np.zeros(1), (), True, {})
    return knobs_for(rest, {law: relaxed}, *((PLACE, SHORT) if law == "muscles" else (None,)))


def muscle_knobs(study: GaitStudy, place: Place, short: tuple[str, ...] = ()):
    """Those of muscles that are too weak at a place: they ask the study alone."""
    rest = AtRest.__new__(AtRest)
    rest.study = study
    relaxed = Relaxed(frozenset(("muscles",)), np.zeros(1), np.zeros(1), (), True, {})
    return knobs_for(rest, {"muscles": relaxed}, place, short)


@pytest.mark.parametrize(
    ("speed", "reached", "tries"),
    [
        (2.0, 1.83, [1.8, 1.7, 1.55]),
        (2.0, 1.999, [1.95, 1.85, 1.7]),
        (0.4, 0.52, [0.55, 0.65, 0.8]),
    ],
)
def test_speeds_go_away_from_what_was_asked_beyond_what_was_reached(speed, reached, tries):
    (knob,) = knobs(TINY.replace(speed=speed), "speed", reached)
    assert knob.values == pytest.approx(tries)
    assert knob.study(tries[0]).speed == tries[0]
    assert knob.words(tries[0]) == f"at {tries[0]:g} m/s"
    assert knob.unusual == (speed > 1.5)


def test_between_a_speed_that_failed_and_one_that_worked_the_middle_is_tried():
    (knob,) = knobs(TINY.replace(speed=2.0), "speed", 1.83)
    assert knob.middle(1.65, 1.5) in (1.55, 1.6)
    assert knob.middle(1.8, 1.75) is None
    assert knob.now == 2.0 and knob.middle(2.0, 1.2) == 1.6


def test_halving_ends_where_the_difference_is_a_tenth_of_the_change():
    knob = knobs(weak(TINY, 0.2), "muscles")[0]
    assert knob.now == 0.0
    assert knob.middle(0.0, 120.0) == 60.0
    assert knob.middle(110.0, 120.0) is None and knob.middle(10.0, 20.0) == 15.0


def test_friction_grows_to_what_the_walk_needs():
    (knob,) = knobs(TINY.with_settings(friction=0.05), "friction")
    force = AtRest(TINY).program.state(AtRest(TINY).point).ground_reactions
    loaded = force[..., 2] > 0.05 * 735.75
    needed = (np.abs(force[..., 0])[loaded] / force[..., 2][loaded]).max()
    assert needed > 0.05
    assert needed <= knob.values[0] < needed + 0.05 + 1e-9
    assert list(knob.values) == sorted(knob.values)
    assert knob.study(0.3).contact.friction == 0.3 and knob.unusual


def test_a_range_opens_where_the_walk_leaves_it_and_nowhere_else():
    study = limited(TINY, "knee_flexion", -5.0, 30.0)
    rest = AtRest(study)
    columns = [study.walker.coordinate_names.index(f"knee_flexion_{side}") for side in "rl"]
    angle = np.degrees(rest.program.state(rest.point).motion.value[:, columns])
    assert angle.max() > 31.0 and angle.min() > -5.0
    (knob,) = knobs(study, "range of knee_flexion")
    assert angle.max() - 30.0 <= knob.values[0] < angle.max() - 30.0 + 1.001
    wider = knob.study(knob.values[0])
    for old, new in zip(study.limits, wider.limits, strict=True):
        assert new.low == old.low
        assert math.degrees(new.high - old.high) == pytest.approx(knob.values[0])
    assert knob.words(7) == "with knee flexion between -5 and 37 degrees"


def test_a_range_of_one_side_is_named_with_its_side():
    limits = (JointLimit("knee_flexion_r", -0.1, 0.5), JointLimit("knee_flexion_l", -0.1, 0.6))
    joint = "knee_flexion"
    assert words_of_limits(limits[:1], joint) == "right knee flexion between -5.73 and 28.6 degrees"
    assert "and left knee flexion between -5.73 and 34.4" in words_of_limits(limits, joint)


def test_the_range_of_a_disorder_opens_too():
    study = TINY.with_disorder(LimitedRange("knee", "both", -5.0, 30.0))
    (knob,) = knobs(study, "range of knee_flexion")
    wider = knob.study(10)
    assert wider.disorders == (LimitedRange("knee", "both", -5.0, 40.0),)


def test_strength_multiplies_what_the_study_states_on_both_sides_of_a_symmetric_walker():
    study = TINY.replace(strength={"soleus": 0.4})
    first, second, *_ = knobs(study, "muscles")
    assert first.unusual and first.words(40) == "with 40 % more strength of SOL"
    stronger = first.study(50).walker.muscles.f_max / study.walker.muscles.f_max
    for name, ratio in zip(study.walker.muscles.names, stronger, strict=True):
        assert ratio == pytest.approx(1.5 if name.startswith("soleus") else 1.0)
    everyone = second.study(50).walker.muscles.f_max / study.walker.muscles.f_max
    assert everyone == pytest.approx(1.5)


def test_of_one_leg_only_that_leg_becomes_stronger():
    study = GaitStudy.planar(11, interior_points=(2,) * 8).with_disorder(
        Weakness("soleus", "r", 0.5)
    )
    first = muscle_knobs(study, PLACE, SHORT)[0]
    ratio = first.study(20).walker.muscles.f_max / study.walker.muscles.f_max
    names = study.walker.muscles.names
    assert first.words(20) == "with 20 % more strength of SOL right"
    assert [names[i] for i in np.flatnonzero(ratio > 1.01)] == ["soleus_r"]


def test_strength_stated_by_abbreviations_is_multiplied_too():
    study = TINY.replace(strength=dict.fromkeys(TINY.walker.muscles.abbreviations, 0.4))
    _, everyone, *_ = knobs(study, "muscles")
    assert everyone.words(50) == "with 50 % more strength of all muscles"
    stronger = changed_study(everyone, 50.0).walker.muscles.f_max
    np.testing.assert_allclose(stronger / study.walker.muscles.f_max, 1.5)


def test_what_is_lacking_says_where_strength_begins():
    tries = knobs(weak(TINY, 0.2), "muscles")[0].values
    assert tries[0] == 30.0  # 30 of 60 N m is 50 %; half of it may do
    assert list(tries) == sorted(set(tries))
    all_lacks = dataclasses.replace(PLACE, missing=100.0, moment=1.0)  # beyond what is tried
    assert list(muscle_knobs(TINY, all_lacks)[0].values) == [900.0]


def test_a_larger_tolerance_is_only_offered_for_a_little():
    words = [knob.words(5) for knob in knobs(TINY, "muscles")]
    assert not any("off by" in text for text in words)  # 30 N m are lacking
    little = dataclasses.replace(PLACE, missing=2.5)
    last = muscle_knobs(TINY, little)[-1]
    assert last.values[0] == 5.0
    assert last.study(5.0).tolerances.moment_tolerance == 5.0


def test_ratios_of_steps_come_nearer_to_one():
    study = GaitStudy.planar(11, interior_points=(2,) * 8).with_disorder(
        Asymmetry("step_length", 1.9)
    )
    rest = AtRest.__new__(AtRest)
    rest.study = study
    values = relaxation_of("plain").program.values(
        relaxation_of("plain").elastic.unknowns(relaxation_of("plain")._first)
    )
    reached = dataclasses.replace(values, placement=np.array([0.83, 0.5, 0, 0, 0]))  # 1.66
    rest.values = lambda relaxed: reached
    relaxed = Relaxed(frozenset(("asymmetry",)), np.zeros(1), np.zeros(1), (), True, {})
    (knob,) = knobs_for(rest, {"asymmetry": relaxed}, None)
    assert knob.values == pytest.approx([1.65, 1.3, 1.0])
    assert knob.study(1.3).disorders == (Asymmetry("step_length", 1.3),)


def test_a_value_out_of_range_is_left_out():
    (knob,) = knobs(TINY.replace(speed=0.35), "speed", 0.33)
    assert changed_study(knob, 0.2) is None
    assert changed_study(knob, 0.3).speed == 0.3


def test_muscles_of_both_legs_are_named_by_side():
    study = GaitStudy.planar(11, interior_points=(2,) * 8)
    names = ("soleus_l", "vasti_r", "soleus_r")
    first = muscle_knobs(study, PLACE, names)[0]
    assert first.words(20) == "with 20 % more strength of SOL and VAS right"
    ratio = first.study(20).walker.muscles.f_max / study.walker.muscles.f_max
    stronger = {study.walker.muscles.names[i] for i in np.flatnonzero(ratio > 1.01)}
    assert stronger == {*names}


def test_whoever_names_most_muscles_means_all():
    few, many = ("soleus_r", "vasti_r"), tuple(weak(TINY, 0.2).walker.muscles.names)
    for names, groups in ((few, ["VAS, SOL", "all muscles"]), (many, ["all muscles"])):
        found = muscle_knobs(weak(TINY, 0.2), PLACE, names)
        words = [knob.words(20) for knob in found if "strength" in knob.words(20)]
        assert words == [f"with 20 % more strength of {group}" for group in groups]
