"""Every ruling of docs/formulation.md 10 can be taken the other way, by name."""

from __future__ import annotations

import json

import numpy as np
import pytest

from drakegait.cli.walk import walk
from drakegait.commands.request import WalkRequest
from drakegait.study import GaitStudy

OTHER_WAYS = {
    "B.2 as printed": {"force_length": "printed"},
    "C.1 as printed": {"activation_dynamics": "printed"},
    "full width": {"width": "full"},
    "least force": {"min_force": "0.002"},
    "force-velocity floor": {"force_velocity_floor": "0.05"},
    "energy model of 2010": {"energy.model": "umberger2010"},
    "50/65 ms": {"time_constants": "fixed"},
    "35/50 ms": {
        "time_constants": "fixed", "time_activation": "0.035", "time_deactivation": "0.05"
    },
    "no damping": {
        "damping_hip": "0", "damping_hip_rotation": "0", "damping_knee": "0", "damping_ankle": "0"
    },
    "friction": {"friction": "0.4"},
    "slope factor": {"slope_factor": "2"},
    "eccentric limit": {"f_asympt": "1.4"},
    "tendon strain": {"tendon_strain": "0.05"},
    "sigma as printed": {"sigma_rule": "printed"},
    "one group of coordinates": {"groups": "single"},
    "one tolerance": {"force_tolerance": "2"},
    "sequence": {"sequence": "123"},
    "periodicity": {"periodicity": "eq14"},
    "norm of the residual": {"eom_form": "maximum"},
    "toe torque": {"toe_torque": "on"},
}  # fmt: skip


@pytest.mark.parametrize("name", OTHER_WAYS)
def test_settings_reach_the_formulation_and_survive_json(name):
    study = GaitStudy.spatial().with_settings(**OTHER_WAYS[name])
    assert study != GaitStudy.spatial()
    assert GaitStudy.from_dict(json.loads(json.dumps(study.to_dict()))) == study
    study.formulation()


def request(**options) -> WalkRequest:
    import inspect

    parameters = inspect.signature(walk).parameters.values()
    defaults = {p.name: p.default for p in parameters if p.name != "context"}
    return WalkRequest(**(defaults | options))


@pytest.mark.parametrize("name", OTHER_WAYS)
def test_the_command_line_says_the_same(name):
    texts = [f"{key}={value}" for key, value in OTHER_WAYS[name].items()]
    study, *_ = request(set_=texts).prepare()
    assert study == GaitStudy.spatial().with_settings(**OTHER_WAYS[name])


@pytest.mark.parametrize(
    ("texts", "changes", "attribute", "value"),
    [
        (["SOL.l_slack=0.245"], {"SOL": {"l_slack": 0.245}}, "l_slack", 0.245),
        (["TA.l0=0.381"], {"TA": {"l0": 0.381}}, "l0", 0.381),
        (["soleus_r.f_max=3016"], {"soleus_r": {"f_max": 3016.0}}, "f_max", 3016.0),
    ],
)
def test_the_muscle_table_can_be_changed(texts, changes, attribute, value):
    study, *_ = request(muscle=texts).prepare()
    assert study.muscle_changes == changes
    again = GaitStudy.from_dict(json.loads(json.dumps(study.to_dict())))
    assert again == study
    found = getattr(again.walker.muscles, attribute)
    usual = getattr(GaitStudy.spatial().walker.muscles, attribute)
    (name,) = changes
    muscles = again.walker.muscles
    changed = np.array([name in (full, group) for full, group in
                        zip(muscles.names, muscles.abbreviations, strict=True)])  # fmt: skip
    np.testing.assert_array_equal(found[changed], value)
    np.testing.assert_array_equal(found[~changed], usual[~changed])


def test_several_entries_of_one_muscle_add_up():
    study, *_ = request(muscle=["SOL.l_slack=0.245", "SOL.f_max=3016", "TA.l0=0.381"]).prepare()
    assert study.muscle_changes == {
        "SOL": {"l_slack": 0.245, "f_max": 3016.0}, "TA": {"l0": 0.381}
    }  # fmt: skip


def test_the_weight_may_hang_at_the_ankle():
    study, *_ = request(added_mass=["foot_r=2.0@0,0,0"]).prepare()
    assert study == GaitStudy.spatial().with_added_mass("foot_r", 2.0, (0.0, 0.0, 0.0))


def test_a_study_saved_before_there_were_variants_is_read():
    plain = GaitStudy.planar().to_dict()
    for name in ("variants", "muscle_changes"):
        del plain[name]
    for name in ("toe_torque", "toe_torque_limit"):
        del plain["contact"][name]
    del plain["muscles"]["activation_dynamics"]
    assert GaitStudy.from_dict(plain) == GaitStudy.planar()
