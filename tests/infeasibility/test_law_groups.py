"""Groups of laws: every row has one home, and the words say what the study says."""

from __future__ import annotations

import numpy as np
import pytest
from infeasibility_cases import TINY, limited

from drakegait.errors import InvalidInput
from drakegait.infeasibility.laws import cheap_prices, laws_of
from drakegait.program.elastic import ElasticProgram
from drakegait.program.gait_program import GaitProgram
from drakegait.study import GaitStudy
from drakegait.walker.disorders import Asymmetry

SPATIAL = GaitStudy.spatial(11, interior_points=(2,) * 8)
STUDIES = {
    "planar-symmetric": TINY,
    "limits": limited(limited(TINY, "knee_flexion", 0, 50), "ankle_dorsiflexion", -10, 10),
    "spatial": SPATIAL,
    "projected": SPATIAL.replace(multipliers="projected"),
    "toe torque": SPATIAL.with_settings(toe_torque=True),
    "unequal": SPATIAL.with_disorder(Asymmetry("step_length", 1.2)),
    "eq14": TINY.with_settings(periodicity="eq14"),
}


def program_of(name: str) -> GaitProgram:
    return GaitProgram(STUDIES[name].formulation())


@pytest.mark.parametrize("name", STUDIES)
def test_every_row_and_bound_that_may_break_is_in_exactly_one_group(name):
    program = program_of(name)
    elastic = ElasticProgram.of(program)
    soft = np.zeros(elastic.num_constraints, dtype=bool)
    soft[elastic.ends] = True
    count = np.sum([law.rows for law in laws_of(program)], axis=0)
    assert (count == soft[: program.num_constraints]).all()
    freed = np.zeros(program.num_variables, dtype=bool)
    freed[elastic.freed] = True
    bounds = np.sum([law.variables for law in laws_of(program)], axis=0)
    assert (bounds == freed).all()


def test_every_group_has_something_and_stated_ones_come_first():
    for name in STUDIES:
        laws = laws_of(program_of(name))
        assert all(law.rows.any() or law.variables.any() for law in laws)
        stated = [law.stated for law in laws]
        assert stated == sorted(stated, reverse=True)


def test_muscles_are_the_joints_and_mechanics_the_trunk():
    program = program_of("spatial")
    laws = {law.name: law for law in laws_of(program)}
    for law, of_trunk in (("muscles", False), ("mechanics", True)):
        rows = [program.row_names[i] for i in np.flatnonzero(laws[law].rows)]
        moved = [row for row in rows if row.startswith("equations of motion")]
        assert moved
        assert all((" hat_" in row) == of_trunk for row in moved)


def test_each_limited_joint_is_a_group_of_its_own_and_words_have_its_numbers():
    laws = {law.name: law.words for law in laws_of(program_of("limits"))}
    assert laws["range of knee_flexion"] == "knee flexion between 0 and 50 degrees"
    assert laws["range of ankle_dorsiflexion"] == "ankle dorsiflexion between -10 and 10 degrees"
    assert laws["speed"] == "a speed of 1.2 m/s"
    assert laws["friction"] == "friction of 0.6"
    assert laws["phase durations"] == "contact phases of 0.01 to 0.4 s"


def test_one_open_end_is_not_called_a_range():
    study = limited(TINY, "knee_flexion", -np.inf, 20)
    laws = {law.name: law.words for law in laws_of(GaitProgram(study.formulation()))}
    assert laws["range of knee_flexion"] == "knee flexion of at most 20 degrees"


def test_unequal_steps_are_named_by_their_ratio():
    laws = {law.name: law for law in laws_of(program_of("unequal"))}
    assert laws["asymmetry"].words == "step length right over left 1.2"
    assert laws["asymmetry"].stated


def test_a_single_largest_residual_is_refused():
    program = GaitProgram(TINY.with_settings(eom_form="maximum").formulation())
    with pytest.raises(InvalidInput, match="eom_form is 'maximum'"):
        laws_of(program)


def test_friction_that_is_given_up_costs_by_what_slips():
    """A horizontal force of a tenth of the body weight costs the same on every ground."""
    costs = []
    for friction in (0.02, 0.6):
        program = GaitProgram(TINY.with_settings(friction=friction).formulation())
        elastic = ElasticProgram.of(program)
        price = cheap_prices(elastic)[elastic.slips]
        row = (0.1 * program.formulation.body_weight) ** 2 / elastic.row_scale[elastic.ends]
        costs.append(float((price * row[elastic.slips])[0]))
        assert (cheap_prices(elastic) < 0.01 * elastic.prices).all()
    assert costs[0] == pytest.approx(costs[1])
