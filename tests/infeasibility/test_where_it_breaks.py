"""Where a law breaks: joint, direction, instant, and the muscles at their limit."""

from __future__ import annotations

import functools

import numpy as np
import pytest
from infeasibility_cases import relaxation_of

from drakegait.infeasibility.conflict import Relaxed
from drakegait.infeasibility.place import Place, _at_point, _when, place_of, short_muscles

# Unsolved: solves of other tests leave their walk in a shared one.
unsolved = functools.cache(relaxation_of.__wrapped__)


def broken(law: str, row_name: str, amount: float) -> Place:
    """The place where one row of the reference walk breaks `law` by `amount` units."""
    relaxation = unsolved("weak")
    elastic = relaxation.elastic
    missing = np.zeros(len(elastic.ends))
    missing[[elastic.row_names[i] for i in elastic.ends].index(row_name)] = amount
    relaxed = Relaxed(frozenset((law,)), relaxation._first, missing, (), True, {})
    place = place_of(relaxation, relaxed, law)
    assert place is not None
    return place


@pytest.mark.parametrize(
    ("joint", "amount", "what", "helper"),
    [
        # Plant signs: plus is plantarflexion, knee flexion, hip extension; a row that is too
        # high (missing < 0) has a moment in the plus sense without a source.
        ("ankle_dorsiflexion_r", -10.0, "right ankle plantarflexion", "soleus_r"),
        ("ankle_dorsiflexion_r", 10.0, "right ankle dorsiflexion", "tibialis_anterior_r"),
        ("knee_flexion_r", -10.0, "right knee flexion", "hamstrings_r"),
        ("knee_flexion_l", 10.0, "left knee extension", "vasti_l"),
        ("hip_flexion_l", -10.0, "left hip extension", "gluteus_maximus_l"),
        ("hip_flexion_r", 10.0, "right hip flexion", "iliopsoas_r"),
    ],
)
def test_the_missing_moment_has_joint_direction_and_muscles(joint, amount, what, helper):
    place = broken("muscles", f"equations of motion | right single support 0.14 | {joint}", amount)
    assert place.what == what
    assert place.missing == pytest.approx(20.0)  # ten tolerances of 2 N m
    assert place.unit == "N m"
    assert helper in place.helpers
    assert all(name.endswith(joint[-2:]) for name in place.helpers)
    assert place.moment > 0.0


def test_the_instant_is_told_from_the_leg_that_lacks():
    name = "equations of motion | right loading 0.50 | ankle_dorsiflexion_l"
    place = broken("muscles", name, -10.0)
    assert place.when == "right loading; the left leg pushes off"
    assert 2.0 < place.percent < 10.0
    own = broken("muscles", name[:-1] + "r", -10.0)
    assert own.when == "right loading; the right leg takes the load"


@pytest.mark.parametrize(
    ("name", "leg"),
    [
        ("hip_rotation_l", "; the left leg pushes off"),
        ("hip_rotation_r", "; the right leg takes the load"),
        ("toe_r z", "; the right leg takes the load"),
        ("hat_list", ""),
        ("hat_rotation", ""),
    ],
)
def test_the_leg_is_that_at_the_end_of_the_name(name, leg):
    program = unsolved("weak").program
    point = int(np.flatnonzero((program.points.phases == 0) & (program.points.shares > 0.0))[0])
    assert _when(program, point, name) == f"right loading{leg}"


def test_of_the_whole_stride_there_is_no_instant():
    place = broken("speed", "average speed | stride | hat_x", 3.0)
    assert np.isnan(place.percent) and place.when == ""
    assert place.missing == pytest.approx(0.3)
    values = unsolved("weak").program.values(unsolved("weak").elastic.unknowns(
        unsolved("weak")._first
    ))  # fmt: skip
    reached = values.placement[:2].sum() / values.stride_time
    assert place.sentence == f"The walk reaches {reached:.2f} m/s"


@pytest.mark.parametrize(
    ("law", "row", "amount", "clause"),
    [
        ("mechanics", "clearance | right heel rise 0.50 | toe_l", 2.0,
         "The left toe is 20 mm in the ground at"),
        ("mechanics", "foot contact | right single support 0.14 | toe_r z", -5.0,
         "The right toe is 10 mm too far off its print at"),
        ("friction", "friction | right single support 0.14 | foot_r", 0.01,
         "The right foot would need friction of 0."),
        ("mechanics", "bound | stride | contact force toe_r z | control point 8", 2.0,
         "The bound of contact force toe_r z | control point 8 is off by "),
        ("phase durations", "phase duration | right loading | time", 0.5,
         "The phase duration (time) is off by 0.05 s"),
    ],
)
def test_other_laws_break_in_words(law, row, amount, clause):
    assert broken(law, row, amount).sentence.startswith(clause)


def test_a_foot_that_turns_is_off_by_an_angle():
    program = unsolved("weak").program
    said = _at_point(program, np.zeros(0), 0, "foot contact", "foot_r yaw", 0.02, "rad")
    assert said == "the right foot is turned 1.1 degrees too far on its print"


def test_a_kept_law_has_no_place():
    relaxation = unsolved("weak")
    missing = np.zeros(len(relaxation.elastic.ends))
    relaxed = Relaxed(frozenset(), relaxation._first, missing, (), True, {})
    assert place_of(relaxation, relaxed, "muscles") is None


def test_sentences_name_saturated_muscles():
    place = Place("muscles", "left hip abduction", "right toe off", 61.6, 11.7, "N m",
                  ("GMEDP", "TFL"))  # fmt: skip
    assert place.sentence == (
        "Left hip abduction lacks 12 N m at 62 % of the stride (right toe off): "
        "GMEDP, TFL saturated"
    )


def test_all_joints_that_lack_a_moment_name_their_muscles():
    relaxation = unsolved("weak")
    elastic = relaxation.elastic
    names = [elastic.row_names[i] for i in elastic.ends]
    missing = np.zeros(len(elastic.ends))
    where = "equations of motion | right single support 0.14 |"
    missing[names.index(f"{where} ankle_dorsiflexion_r")] = -10.0
    missing[names.index(f"{where} knee_flexion_l")] = 3.0
    missing[names.index(f"{where} hip_flexion_l")] = 0.1  # too little to count
    relaxed = Relaxed(frozenset(("muscles",)), relaxation._first, missing, (), True, {})
    found = short_muscles(relaxation, relaxed)
    assert any(name in found for name in ("soleus_r", "gastrocnemius_r"))
    assert any(name in found for name in ("vasti_l", "rectus_femoris_l"))
    assert "iliopsoas_l" not in found
