"""A study is validated when made, changed by copies and survives a round trip through JSON."""

from __future__ import annotations

import dataclasses
import json
import math

import numpy as np
import pytest

from drakegait.errors import DrakegaitError, InvalidInput, UnknownName
from drakegait.program.formulation import JointLimit
from drakegait.reference.reference import Reference
from drakegait.settings import by_name, find
from drakegait.study import (
    MODELS,
    SETTINGS_GROUPS,
    GaitStudy,
)
from drakegait.walker.subject import AddedMass, Subject


@pytest.mark.parametrize(
    ("statements", "error", "words"),
    [
        ({"model": "biped"}, UnknownName, "model is 'biped', but must be one of spatial"),
        ({"multipliers": "free"}, UnknownName, "multipliers is 'free'"),
        ({"nodes": 9}, InvalidInput, "nodes is 9, .* from 10 to 141"),
        ({"nodes": 142}, InvalidInput, "nodes is 142"),
        ({"nodes": 18.0}, InvalidInput, "nodes is 18.0, .* whole number"),
        ({"nodes": True}, InvalidInput, "nodes is True"),
        ({"model": "planar-symmetric", "nodes": 18}, InvalidInput, "nodes is 18, .* odd"),
        ({"speed": math.nan}, InvalidInput, "speed is nan"),
        ({"speed": "1.2"}, InvalidInput, "speed is '1.2'"),
        ({"speed": 3.0}, InvalidInput, r"speed is 3.0, .* from 0.3 to 2.5 \[m/s\]"),
        ({"energy_weight": -1.0}, InvalidInput, "energy weight is -1.0"),
        ({"deviation_weight": math.inf}, InvalidInput, "deviation weight is inf"),
        ({"energy_weight": 0.0, "deviation_weight": 0.0}, InvalidInput, "at least one"),
        ({"reference": Reference.embedded("planar")}, InvalidInput, "reference is 'planar'"),
        ({"interior_points": (3, 3, 3)}, InvalidInput, "8 whole numbers"),
        ({"interior_points": (3, 3, 3, 3, 3, 3, 3, 3.5)}, InvalidInput, "8 whole numbers"),
        ({"limits": (JointLimit("knee", 0.0, 1.0),)}, UnknownName, "'knee'"),
        ({"limits": (JointLimit("hat_x", 0.0, 1.0),)}, UnknownName, "'hat_x'"),
        ({"model": "planar", "limits": (JointLimit("hat_y", 0.0, 1.0),)}, UnknownName, "'hat_y'"),
    ],
)
def test_bad_statements_are_refused_by_name_value_and_range(statements, error, words):
    with pytest.raises(error, match=words):
        GaitStudy(**statements)


@pytest.mark.parametrize("model", MODELS)
def test_every_model_has_a_maker_with_valid_defaults(model):
    study = getattr(GaitStudy, model.replace("-", "_"))()
    assert study.model == model
    assert study.symmetric == model.endswith("symmetric")
    assert study.skeleton_kind == model.split("-")[0]
    assert study.schedule.num_phases == (4 if study.symmetric else 8)
    formulation = study.formulation()
    assert formulation.splines.num_intervals == study.nodes - 1
    assert formulation.walker.skeleton.kind == study.skeleton_kind


def test_a_changed_copy_leaves_the_study_alone():
    study = GaitStudy.spatial()
    heavy = study.with_added_mass("foot_r", 2.0).with_added_mass("hat", 5.0, (0.1, 0.0, 0.3))
    assert study.added_masses == ()
    assert heavy.added_masses == (AddedMass("foot_r", 2.0), AddedMass("hat", 5.0, (0.1, 0.0, 0.3)))
    added = heavy.walker.skeleton.total_mass - study.walker.skeleton.total_mass
    assert added == pytest.approx(7.0)
    stiff = study.with_limit("knee_flexion_r", high=0.7)
    assert stiff.limits == (JointLimit("knee_flexion_r", -math.inf, 0.7),) and not study.limits
    with pytest.raises(dataclasses.FrozenInstanceError):
        study.speed = 1.0
    with pytest.raises(InvalidInput, match="odd"):
        GaitStudy.planar_symmetric().replace(nodes=20)


def test_unknown_muscles_are_refused_when_the_walker_is_built():
    with pytest.raises(UnknownName, match="solus_r.*mean 'soleus_r'"):
        GaitStudy.spatial(strength={"solus_r": 0.5}).formulation()


@pytest.mark.parametrize(
    ("what", "one", "other"),
    [
        ("added mass", {"added_masses": (AddedMass("foot_r", 2.0),)},
         {"added_masses": (AddedMass("foot_r", 2.0), AddedMass("foot_l", 2.0))}),
        ("strength", {"strength": {"soleus_r": 0.5}},
         {"strength": {"soleus_r": 0.5, "soleus_l": 0.5}}),
        ("muscle_changes", {"muscle_changes": {"soleus_l": {"l_slack": 0.24}}},
         {"muscle_changes": {f"soleus_{side}": {"l_slack": 0.24} for side in "rl"}}),
        ("limit", {"limits": (JointLimit("knee_flexion_r", 0.0, 0.7),)},
         {"limits": tuple(JointLimit(f"knee_flexion_{side}", 0.0, 0.7) for side in "rl")}),
    ],
)  # fmt: skip
def test_a_symmetric_walker_has_nothing_on_one_side_alone(what, one, other):
    with pytest.raises(InvalidInput, match=f"{what}.*both sides"):
        GaitStudy.planar_symmetric(19, **one).formulation()
    GaitStudy.planar(18, **one).formulation()
    GaitStudy.planar_symmetric(19, **other).formulation()


# Constants ---------------------------------------------------------------------------------


def test_constants_change_by_name_and_read_text():
    study = GaitStudy.planar().with_settings(friction="0.4", basal="on", a_rel=0.3)
    study = study.with_settings(**{"energy.model": "umberger2010", "passive.scale": "0.5"})
    assert study.contact.friction == 0.4 and study.energy.basal is True
    assert study.muscles.a_rel == 0.3 and study.passive.scale == 0.5
    assert study.energy.model == "umberger2010" and study.passive.model == "riener_edrich"
    for bad in ({"friction": "slippery"}, {"friction": 9.0}, {"basal": 1.0}, {"model": "x"}):
        with pytest.raises(DrakegaitError, match=next(iter(bad))):
            study.with_settings(**bad)


def test_every_constant_has_one_name_and_finds_its_group():
    known = by_name(SETTINGS_GROUPS)
    total = sum(len(dataclasses.fields(group)) for group in SETTINGS_GROUPS.values())
    assert len(known) == total
    for name, (group, item) in known.items():
        assert (
            find(SETTINGS_GROUPS, name)
            == find(SETTINGS_GROUPS, f"{group}.{item.name}")
            == (group, item)
        )
        default = getattr(getattr(GaitStudy(), group), item.name)
        assert default == item.default, name
        assert item.metadata["meaning"]
        assert "unit" in item.metadata or "options" in item.metadata or "flag" in item.metadata


@pytest.mark.parametrize("name", sorted(by_name(SETTINGS_GROUPS)))
def test_every_constant_can_be_set_to_each_end_of_its_range(name):
    _, item = find(SETTINGS_GROUPS, name)
    meta, study = item.metadata, GaitStudy()
    if "options" in meta:
        allowed, refused = meta["options"], ["nonsense"]
    elif meta.get("flag"):
        allowed, refused = [True, False], [1.0]
    else:
        low, high = meta["low"], meta["high"]
        allowed, refused = [low, high], [low - 1.0, high * 1.01 + 1.0, math.nan]
    for value in refused:
        with pytest.raises(DrakegaitError, match=item.name):
            study.with_settings(**{name: value})
    if name == "time_activation" or name == "time_deactivation":
        return  # only together: deactivation is within once and twice the activation
    for value in allowed:
        group, _ = find(SETTINGS_GROUPS, name)
        assert getattr(getattr(study.with_settings(**{name: value}), group), item.name) == value


def test_the_rules_of_deviation_are_those_of_the_study_whatever_its_reference():
    own = Reference.embedded("planar", Subject(), "planar")
    usual, printed = GaitStudy.planar(reference=own), GaitStudy.planar(reference=own).with_settings(
        sigma_rule="printed"
    )
    assert usual.reference_walk.deviation.sigma_rule != "printed"
    expected = GaitStudy.planar().with_settings(sigma_rule="printed").reference_walk
    np.testing.assert_array_equal(
        printed.reference_walk.coordinate_sigma, expected.coordinate_sigma
    )
    assert (expected.coordinate_sigma != usual.reference_walk.coordinate_sigma).any()


# Round trip --------------------------------------------------------------------------------


def test_a_study_survives_json():
    study = (
        GaitStudy(
            model="planar", nodes=21, speed=0.9, subject=Subject(height=1.6, mass=55.0),
            energy_weight=0.3, deviation_weight=2.0, strength={"SOL": 0.7},
            planar_muscles="gait2d", multipliers="projected",
            interior_points=(5, 4, 6, 7, 5, 4, 6, 8),
        )
        .with_added_mass("thigh_l", 1.5, (0.0, 0.05, -0.1))
        .with_limit("knee_flexion_r", 0.0, 1.0)
        .with_settings(friction=0.5, basal=True, sigma_rule="printed", moment_tolerance=1.0)
    )  # fmt: skip
    again = GaitStudy.from_dict(json.loads(json.dumps(study.to_dict())))
    assert again == study
    assert again.schedule == study.schedule
    np.testing.assert_array_equal(again.walker.muscles.f_max, study.walker.muscles.f_max)


def test_open_limits_survive_json():
    study = GaitStudy.planar().with_limit("knee_flexion_r", high=0.7)
    assert GaitStudy.from_dict(json.loads(json.dumps(study.to_dict()))) == study


def test_unknown_keys_are_refused():
    plain = GaitStudy().to_dict() | {"sped": 1.2}
    with pytest.raises(UnknownName, match="'sped'.*mean 'speed'"):
        GaitStudy.from_dict(plain)
