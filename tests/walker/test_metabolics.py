"""Metabolic rate of muscle against the tabulated law and its limits."""

from types import SimpleNamespace

import numpy as np
import pytest
from muscle_cases import random_inputs

from drakegait.walker.metabolics import EnergySettings, energy_rate
from drakegait.walker.muscle_dynamics import MuscleFunctions, muscle_constants
from drakegait.walker.muscle_settings import MuscleSettings
from drakegait.walker.muscles import MuscleSet

MUSCLES = MuscleSet.load("spatial")


def rate(a, u, nu, fast, length=1.0, F=1.0, force=0.0, smoothing=0.0, **settings):
    """Rate of a muscle in a given fibre state."""
    energy = EnergySettings(**settings)
    speed = 5.2 / 0.41 if energy.fast_speed == "hill" else energy.fixed_fast_speed
    muscle = SimpleNamespace(fast_twitch=fast, fast_speed=speed)
    fibres = SimpleNamespace(
        activation=a, velocity=nu, length=length, force=force,
        force_length=F, force_length_top=1.0,
    )  # fmt: skip
    return energy_rate(np, muscle, energy, fibres, u, smoothing)


@pytest.mark.parametrize(
    ("drive", "fast", "h_am", "h_short", "h_long"),
    [
        (0.1, 0.2, 19.1, 0.6, 12.5), (0.1, 0.5, 33.5, 0.5, 12.5),
        (0.3, 0.2, 36.9, 5.2, 37.5), (0.3, 0.5, 64.8, 4.5, 37.5),
        (0.5, 0.2, 50.1, 14.4, 62.5), (0.5, 0.5, 88.1, 12.6, 62.5),
        (1.0, 0.2, 75.9, 57.7, 125.0), (1.0, 0.5, 133.5, 50.4, 125.0),
    ],
)  # fmt: skip
def test_tabulated_heat_rates(drive, fast, h_am, h_short, h_long):
    assert rate(drive, drive, 0.0, fast).activation_maintenance == pytest.approx(h_am, abs=0.06)
    assert rate(drive, drive, -2.0, fast).shortening_lengthening == pytest.approx(h_short, abs=0.06)
    assert rate(drive, drive, 1.0, fast).shortening_lengthening == pytest.approx(h_long, abs=0.06)


def test_drive_is_excitation_above_activation_and_the_mean_below():
    reference = rate(0.6, 0.6, 0.0, 0.5).activation_maintenance
    assert rate(0.2, 0.6, 0.0, 0.5).activation_maintenance == pytest.approx(reference)
    assert rate(0.8, 0.4, 0.0, 0.5).activation_maintenance == pytest.approx(reference)


def test_slow_twitch_shortening_heat_is_capped_at_100_watts_per_kg():
    heat = rate(1.0, 1.0, -9.0, 0.0, aerobic_scaling=1.0).shortening_lengthening
    assert heat == pytest.approx(100.0)
    assert rate(1.0, 1.0, -4.8, 0.0, aerobic_scaling=1.0).shortening_lengthening == pytest.approx(
        100
    )
    heat = rate(1.0, 1.0, -12.0, 1.0, aerobic_scaling=1.0).shortening_lengthening
    assert heat == pytest.approx(153.0)


def test_beyond_optimal_length_heat_falls_with_overlap():
    short, long = (rate(0.5, 0.5, 1.0, 0.5, length=x, F=0.5) for x in (0.9, 1.1))
    ratio = long.activation_maintenance / short.activation_maintenance
    assert ratio == pytest.approx(0.4 + 0.6 * 0.5)
    assert long.shortening_lengthening / short.shortening_lengthening == pytest.approx(0.5)


def test_work_is_positive_when_shortening_and_not_scaled():
    for scaling in (1.0, 1.5):
        work = rate(0.5, 0.5, -2.0, 0.5, force=0.3, aerobic_scaling=scaling).work
        assert work == pytest.approx(0.3 * 2.0 * 0.25e6 / 1059.7)
    assert rate(0.5, 0.5, 2.0, 0.5, force=0.3).work < 0
    assert rate(0.5, 0.5, 2.0, 0.5, force=0.3, model="umberger2010").work == 0.0


def test_2010_lengthening_heat_is_0_3_of_slow_shortening():
    ratio = [
        rate(0.5, 0.5, 1.0, 0.5, model=m).shortening_lengthening
        for m in ("umberger2010", "umberger2003")
    ]
    assert ratio[0] / ratio[1] == pytest.approx(0.3 / 4)


def test_scaling_multiplies_heat():
    one, more = (rate(0.4, 0.5, -1.0, 0.4, aerobic_scaling=s) for s in (1.0, 1.5))
    assert more.activation_maintenance == pytest.approx(1.5 * one.activation_maintenance)
    assert more.shortening_lengthening == pytest.approx(1.5 * one.shortening_lengthening)


def test_silent_muscle_costs_the_least_heat():
    assert rate(0.0, 0.0, 0.0, 0.5).total == 1.0
    assert rate(0.0, 0.0, 0.0, 0.5, least_heat=0.0).total == 0.0
    assert rate(0.0, 0.0, 0.0, 0.5, heat_floor="activation").total == pytest.approx(1.5)


def test_negative_power_is_allowed_unless_forbidden():
    lengthening = dict(a=0.5, u=0.1, nu=1.0, fast=0.5, length=1.3, F=0.6, force=0.9)
    assert rate(**lengthening).total < 0
    assert rate(**lengthening, forbid_negative_power=True).total == 0.0


def test_fast_speed_from_hill_constants_lowers_heat_by_5_percent():
    fixed, hill = (rate(0.5, 0.5, 1.0, 0.5, fast_speed=s) for s in ("fixed", "hill"))
    ratio = hill.shortening_lengthening / fixed.shortening_lengthening
    assert ratio == pytest.approx(12 * 0.41 / 5.2)


def test_orderly_recruitment_uses_slow_fibres_first():
    weak, strong = (rate(u, u, 0.0, 0.5, recruitment="orderly") for u in (0.01, 1.0))
    weak_all_slow = rate(0.01, 0.01, 0.0, 0.0)
    assert weak.activation_maintenance == pytest.approx(
        weak_all_slow.activation_maintenance, rel=0.05
    )
    whole = rate(1.0, 1.0, 0.0, 0.5)
    assert strong.activation_maintenance == pytest.approx(whole.activation_maintenance)


def test_basal_power_is_off_by_default():
    assert EnergySettings().basal_power(75.0) == 0.0
    assert EnergySettings(basal=True).basal_power(75.0) == pytest.approx(90.0)


@pytest.mark.parametrize("nu", [-6.0, -2.0, 0.0, 1.0])
@pytest.mark.parametrize(("a", "u"), [(0.0, 0.0), (0.01, 0.0), (0.3, 0.6), (0.6, 0.3)])
def test_smoothing_tends_to_the_exact_law(a, u, nu):
    for model in ("umberger2003", "umberger2010"):
        exact = rate(a, u, nu, 0.4, force=0.3, model=model).total
        errors = [
            abs(rate(a, u, nu, 0.4, force=0.3, model=model, smoothing=s).total - exact)
            for s in (1.0, 1e-2, 1e-4)
        ]
        assert errors[0] < 0.03 * abs(exact) + 1.0
        assert errors[2] < 0.1 * errors[0] + 1e-6
        assert errors[2] < 5e-3


def test_parts_sum_to_the_power_of_each_muscle():
    functions = MuscleFunctions(MUSCLES)
    s = functions.states(random_inputs(MUSCLES, 20))
    heat = s["heat_activation_maintenance"] + s["heat_shortening_lengthening"]
    assert s["power"] == pytest.approx(np.maximum(heat, MUSCLES.mass) + s["work_rate"])


def test_work_rate_is_force_times_shortening_speed_of_the_fibres():
    """The tendon force times the rate of the projected fibre length is the same power."""
    z = random_inputs(MUSCLES, 20)
    z[..., 1] = 0.0  # constant force: the tendon keeps its length
    work = MuscleFunctions(MUSCLES).states(z)["work_rate"]
    assert work == pytest.approx(-z[..., 0] * z[..., 4], rel=1e-9)


def test_fast_speed_of_each_muscle():
    fixed, hill = (
        muscle_constants(MUSCLES, MuscleSettings(), EnergySettings(fast_speed=s)).fast_speed
        for s in ("fixed", "hill")
    )
    assert fixed == pytest.approx(np.full(28, 12.0))
    assert hill == pytest.approx(np.full(28, 5.2 / 0.41))


def test_mass_follows_tension_and_density():
    energy = EnergySettings(specific_tension=0.5e6, density=1000.0)
    mass = muscle_constants(MUSCLES, MuscleSettings(), energy).mass
    assert mass == pytest.approx(MUSCLES.mass * 0.5 * 1000 / 1059.7)
