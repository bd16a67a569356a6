"""Muscle groups: the table, its geometry and its scaling."""

import numpy as np
import pytest

from drakegait.errors import InvalidInput, UnknownName
from drakegait.walker import coordinates
from drakegait.walker.muscles import MuscleSet
from drakegait.walker.subject import Subject


def leg_capacity(muscles: MuscleSet, coordinate: str) -> tuple[float, float]:
    """Positive and negative isometric torque about one coordinate, all muscles at f_max [N m]."""
    torque = muscles.moment_arms[:, coordinates.index(muscles.kind)[coordinate]] * muscles.f_max
    return torque[torque > 0].sum(), -torque[torque < 0].sum()


@pytest.mark.parametrize(
    ("coordinate", "positive", "negative"),
    [
        ("hip_flexion_r", 314, 137),  # plant +: extension
        ("hip_adduction_r", 194, 150),
        ("hip_rotation_r", 95, 54),  # plant +: internal rotation
        ("knee_flexion_r", 150, 369),
        ("ankle_dorsiflexion_r", 293, 57),  # plant +: plantarflexion
        ("hip_adduction_l", 150, 194),  # left: plant + is abduction
        ("hip_rotation_l", 54, 95),
        ("hip_flexion_l", 314, 137),
        ("knee_flexion_l", 150, 369),
    ],
)
def test_isometric_torque_capacity(coordinate, positive, negative):
    capacity = leg_capacity(MuscleSet.load("spatial"), coordinate)
    assert capacity == pytest.approx((positive, negative), abs=0.6)


def test_names_are_right_leg_then_left_in_table_order():
    muscles = MuscleSet.load("spatial")
    assert muscles.num_muscles == 28
    assert muscles.names[0] == "soleus_r"
    assert muscles.names[13:15] == ("iliopsoas_r", "soleus_l")
    assert muscles.abbreviations[:3] == ("SOL", "TA", "GAS")
    planar = MuscleSet.load("planar")
    assert planar.names[:8] == (
        "iliopsoas_r", "rectus_femoris_r", "gluteus_maximus_r", "hamstrings_r", "vasti_r",
        "gastrocnemius_r", "soleus_r", "tibialis_anterior_r",
    )  # fmt: skip


def test_muscles_of_one_leg_weigh_10_88_kg():
    mass = MuscleSet.load("spatial").mass
    assert mass[:14].sum() == pytest.approx(10.885, abs=0.005)
    assert mass[:14] == pytest.approx(mass[14:])


@pytest.mark.parametrize("kind", ["spatial", "planar"])
def test_muscle_power_equals_joint_power(kind):
    """Virtual work: -f . l' = torque . q' for any posture, force and velocity."""
    rng = np.random.default_rng(1)
    muscles = MuscleSet.load(kind)
    n = muscles.moment_arms.shape[1]
    q, rate = rng.normal(size=(2, 5, n))
    force = rng.uniform(0, 1000, (5, muscles.num_muscles))
    step = 1e-6
    length_rate = (muscles.lengths(q + step * rate) - muscles.lengths(q - step * rate)) / (2 * step)
    assert muscles.length_rates(rate) == pytest.approx(length_rate, abs=1e-8)
    power = (muscles.joint_torques(force) * rate).sum(axis=-1)
    assert power == pytest.approx(-(force * length_rate).sum(axis=-1), rel=1e-6)


@pytest.mark.parametrize("kind", ["spatial", "planar"])
def test_mirrored_posture_swaps_the_legs(kind):
    rng = np.random.default_rng(2)
    muscles = MuscleSet.load(kind)
    half = muscles.num_muscles // 2
    q = rng.normal(size=muscles.moment_arms.shape[1])
    lengths, mirrored = muscles.lengths(q), muscles.lengths(coordinates.mirror(kind, q))
    assert mirrored[:half] == pytest.approx(lengths[half:])
    assert mirrored[half:] == pytest.approx(lengths[:half])


def test_muscles_do_not_act_on_the_hat():
    muscles = MuscleSet.load("spatial")
    assert not muscles.moment_arms[:, :6].any()


def test_planar_gluteus_joins_the_two_spatial_ones():
    spatial, planar = MuscleSet.load("spatial"), MuscleSet.load("planar")
    parts = [spatial.names.index(f"gluteus_maximus_{part}_r") for part in ("lateral", "medial")]
    whole = planar.names.index("gluteus_maximus_r")
    assert planar.f_max[whole] == spatial.f_max[parts].sum()
    hip_s = coordinates.index("spatial")["hip_flexion_r"]
    hip_p = coordinates.index("planar")["hip_flexion_r"]
    moment = spatial.f_max[parts] @ spatial.moment_arms[parts, hip_s]
    assert planar.f_max[whole] * planar.moment_arms[whole, hip_p] == pytest.approx(moment, rel=2e-3)


def test_scaling_to_another_subject():
    base = MuscleSet.load("spatial")
    scaled = MuscleSet.load("spatial", Subject(height=1.62, mass=60.0))
    for name in ("l_opt", "l_slack", "l0", "moment_arms"):
        assert getattr(scaled, name) == pytest.approx(0.9 * getattr(base, name))
    assert scaled.f_max == pytest.approx(0.8 * base.f_max)
    for name in ("fast_twitch", "width", "pennation"):
        assert getattr(scaled, name) == pytest.approx(getattr(base, name))


def test_strength_of_a_muscle_and_of_a_group():
    base = MuscleSet.load("spatial")
    weak = MuscleSet.load("spatial", strength={"soleus_r": 0.5, "VAS": 0.8, "iliopsoas": 2.0})
    ratio = dict(zip(weak.names, weak.f_max / base.f_max, strict=True))
    assert ratio["soleus_r"] == pytest.approx(0.5)
    assert ratio["soleus_l"] == 1.0
    assert ratio["vasti_r"] == ratio["vasti_l"] == pytest.approx(0.8)
    assert ratio["iliopsoas_l"] == pytest.approx(2.0)
    assert weak.mass / base.mass == pytest.approx(weak.f_max / base.f_max)


def test_table_entries_can_be_changed():
    base = MuscleSet.load("spatial", Subject(height=1.62))
    new = MuscleSet.load(
        "spatial", Subject(height=1.62), changes={"SOL": {"l_slack": 0.245}, "TA": {"l0": 0.381}}
    )
    assert new.l_slack[[0, 14]] == pytest.approx(0.9 * 0.245)
    assert new.l0[[1, 15]] == pytest.approx(0.9 * 0.381)
    assert np.flatnonzero(new.l_slack != base.l_slack).tolist() == [0, 14]


def test_second_planar_table():
    muscles = MuscleSet.load("planar", planar_set="gait2d")
    assert muscles.f_max[:8].tolist() == [1500, 1200, 3000, 3000, 7000, 3000, 4000, 2500]
    assert not muscles.pennation.any()


def test_arrays_are_frozen():
    with pytest.raises(ValueError, match="read-only"):
        MuscleSet.load("planar").f_max[0] = 1.0


@pytest.mark.parametrize(
    ("arguments", "error", "words"),
    [
        (dict(kind="flat"), UnknownName, "spatial, planar"),
        (dict(kind="planar", planar_set="x"), UnknownName, "table3, gait2d"),
        (dict(kind="spatial", strength={"soleus_x": 0.5}), UnknownName, "mean 'soleus_"),
        (dict(kind="spatial", strength={"SOL": 0.0}), InvalidInput, "factor from 0.01 to 10"),
        (dict(kind="spatial", strength={"SOL": float("nan")}), InvalidInput, "factor from"),
        (dict(kind="spatial", changes={"SOL": {"slack": 1.0}}), UnknownName, "l_slack"),
        (dict(kind="spatial", changes={"SOL": {"l_slack": -1.0}}), InvalidInput, "from 0.0508 to"),
    ],
)
def test_bad_input_is_named(arguments, error, words):
    with pytest.raises(error, match=words):
        MuscleSet.load(**arguments)


def test_factors_of_a_group_and_of_its_muscle_multiply():
    """What adds strength to a weak walker relies on it."""
    usual, both = MuscleSet.load("planar"), MuscleSet.load(
        "planar", strength={"SOL": 0.2, "soleus": 1.5, "soleus_l": 2.0}
    )
    ratio = dict(zip(usual.names, both.f_max / usual.f_max, strict=True))
    assert (ratio["soleus_r"], ratio["soleus_l"]) == pytest.approx((0.3, 0.6))
    assert ratio["vasti_l"] == 1.0
