"""What a study states reaches the program: weights, tolerances, limits, speed; and its failures."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest
from program_cases import MODELS, guess, jiggled, numbers_of, program, study

from drakegait.errors import InvalidInput
from drakegait.program.formulation import JointLimit
from drakegait.program.gait_program import GaitProgram
from drakegait.program.guess import guess_from_reference, guess_from_values
from drakegait.walker import coordinates

ENERGY, DEVIATION = "metabolic cost of transport", "deviation"


def variant(model: str, form: str = "lifted", **statements) -> GaitProgram:
    return GaitProgram(study(model, form, **statements).formulation())


def with_tolerances(model: str, form: str = "lifted", **values) -> GaitProgram:
    tolerant = study(model, form).with_settings(**values)
    return GaitProgram(tolerant.formulation())


# Weights ---------------------------------------------------------------------------------------


@pytest.mark.parametrize("form", ["lifted", "projected"])
def test_weights_multiply_and_zero_removes_the_term(form):
    x = jiggled("planar", form)
    both = program("planar", form).cost_parts(x)
    only_energy = variant("planar", form, deviation_weight=0.0, energy_weight=2.5)
    assert only_energy.cost_parts(x) == {ENERGY: pytest.approx(2.5 * both[ENERGY])}
    only_deviation = variant("planar", form, energy_weight=0.0, deviation_weight=0.3)
    assert only_deviation.cost_parts(x) == {DEVIATION: pytest.approx(0.3 * both[DEVIATION])}
    # What does not touch the deviation has no slope without the energy.
    forces = [i for i, name in enumerate(only_deviation.design.names) if " force | " in name]
    if form == "lifted":
        assert not only_deviation.gradient(x)[forces].any()
    np.testing.assert_allclose(
        only_energy.gradient(x) / 2.5 + only_deviation.gradient(x) / 0.3,
        program("planar", form).gradient(x),
        atol=1e-10,
    )


def test_basal_rate_adds_its_share_per_metre():
    x = jiggled("planar-symmetric")
    plain = program("planar-symmetric")
    resting = GaitProgram(study("planar-symmetric").with_settings(basal=True).formulation())
    values = plain.values(x)
    rate = resting.formulation.walker.energy_settings.basal_power(75.0)  # [W]
    per_metre = rate * values.stride_time / values.placement[:2].sum()
    assert rate > 50.0
    difference = resting.cost_parts(x)[ENERGY] - plain.cost_parts(x)[ENERGY]
    assert difference == pytest.approx(0.01 * per_metre)


# Tolerances ------------------------------------------------------------------------------------


def test_a_larger_tolerance_changes_the_bound_and_not_the_physics():
    strict, loose = program("planar", "projected"), with_tolerances(
        "planar", "projected", force_tolerance=100.0, moment_tolerance=50.0
    )
    x = guess("planar", "projected")
    rows = numbers_of(strict, "equations of motion")
    np.testing.assert_allclose(
        strict.rows(x)[rows] * strict.row_scale[rows],
        loose.rows(x)[rows] * loose.row_scale[rows],
        rtol=1e-9, atol=1e-9,
    )  # fmt: skip
    largest = np.abs(strict.rows(x)[rows] * strict.row_scale[rows]).max()
    assert strict.violations(x)[rows].max() > 0.0
    assert largest < 50.0
    assert not loose.violations(x)[rows].any()  # nothing is left to hold


def test_lifted_residuals_are_bounded_by_the_tolerance():
    loose = with_tolerances("planar", force_tolerance=7.0, moment_tolerance=3.0)
    design = loose.design
    for name, low, high, scale in zip(
        design.names, design.lower, design.upper, design.scale, strict=True
    ):
        if name.startswith("residual"):
            tolerance = 7.0 if name.split()[1] in ("hat_x", "hat_z") else 3.0
            assert (low * scale, high * scale) == pytest.approx((-tolerance, tolerance)), name


def test_contact_tolerances():
    strict, loose = program("spatial"), with_tolerances(
        "spatial", contact_tolerance=0.004, yaw_tolerance=0.1
    )
    x = jiggled("spatial")
    rows = numbers_of(strict, "foot contact")
    yaw = np.array([strict.row_names[i].endswith("yaw") for i in rows])
    ratio = strict.rows(x)[rows] / loose.rows(x)[rows]
    np.testing.assert_allclose(ratio, np.where(yaw, 10.0, 2.0))


def test_slippery_ground_leaves_no_grip():
    x = jiggled("spatial")
    ice = GaitProgram(study("spatial").with_settings(friction=0.02).formulation())
    rows = numbers_of(ice, "friction |")
    assert not program("spatial").violations(guess("spatial"))[rows].any()
    assert (ice.violations(x)[rows] > 0.0).mean() > 0.5


# Limits ----------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", ["hip_flexion_l", "ankle_dorsiflexion_r", "knee_flexion_r"])
def test_a_limit_holds_exactly_up_to_the_angle_that_the_walk_reaches(name):
    x = guess("planar")
    plain = program("planar")
    values = plain.values(x)
    tau = plain.state(x).tau
    column = coordinates.names("planar").index(name)
    sign = coordinates.anatomical_signs("planar")[column]
    angle = sign * plain.formulation.splines.evaluate(values.coordinate_coefficients[column], tau)
    for low, high, amount in (
        (-np.inf, angle.max() + 1e-6, 0.0),
        (-np.inf, angle.max() - 0.01, 0.01),
        (angle.min() - 1e-6, np.inf, 0.0),
        (angle.min() + 0.02, np.inf, 0.02),
    ):
        limited = variant("planar", limits=(JointLimit(name, low, high),))
        rows = numbers_of(limited, "joint limit")
        violated = limited.violations(x)[rows] * limited.row_scale[rows]
        assert violated.max() == pytest.approx(amount, abs=1e-9)
        if amount:
            where = int(np.argmax(violated))
            peak = np.argmax(angle) if np.isfinite(high) else np.argmin(angle)
            assert limited.place_name(int(peak)) in limited.row_names[rows[where]]


def test_no_limit_no_row():
    assert numbers_of(variant("planar", limits=()), "joint limit").size == 0


def test_an_empty_range_is_refused():
    with pytest.raises(InvalidInput, match="knee_flexion_r"):
        JointLimit("knee_flexion_r", 0.5, 0.5)


# Speed -----------------------------------------------------------------------------------------


@pytest.mark.parametrize("speed", [0.9, 1.2, 1.5])
def test_the_guess_walks_at_the_wanted_speed(speed):
    problem = variant("planar", speed=speed)
    x = guess_from_reference(problem)
    (row,) = numbers_of(problem, "average speed")
    assert abs(problem.rows(x)[row]) < 1e-9
    values = problem.values(x)
    assert values.placement[:2].sum() / values.stride_time == pytest.approx(speed)


# Guess -----------------------------------------------------------------------------------------


@pytest.mark.parametrize("model", MODELS)
def test_the_guess_is_the_reference_walk_with_forces_that_nearly_fit(model):
    problem, x = program(model), guess(model)
    design, formulation = problem.design, problem.formulation
    assert (x >= design.lower).all()
    assert (x <= design.upper).all()
    values = problem.values(x)
    tau = np.linspace(0.0, 1.0, 50, endpoint=False)
    motion = formulation.splines.evaluate(values.coordinate_coefficients, tau).T
    difference = motion - formulation.reference.coordinate_values(tau)
    assert np.abs(difference).max() < 0.12  # ten nodes cannot follow every turn
    # Static optimisation: the equations of motion fail by a few tolerances, by tens of
    # thousands of them without muscles.
    rows = numbers_of(problem, "equations of motion")
    fitted = np.sqrt(np.mean(problem.rows(x)[rows] ** 2))
    slack = x.copy()
    slack[design.offsets["forces"] : design.offsets["timing"]] = 0.0
    assert fitted < 8.0
    assert np.sqrt(np.mean(problem.rows(slack)[rows] ** 2)) > 4.0 * fitted


@pytest.mark.parametrize("form", ["lifted", "projected"])
def test_an_earlier_gait_is_its_own_guess(form):
    problem, x = program("planar", form), jiggled("planar", form)
    again = guess_from_values(problem, problem.values(x))
    np.testing.assert_allclose(again, x, atol=1e-12)


def test_without_lifted_forces_there_is_nothing_to_fit_on_other_control_points():
    """An empty quadratic program once ended the process here."""
    old, x = program("planar", "projected"), guess("planar", "projected")
    new = variant(
        "planar", interior_points=(2, 1, 3, 2, 2, 1, 3, 2), multipliers="projected"
    )
    np.testing.assert_allclose(guess_from_values(new, old.values(x)), x, atol=1e-12)


def test_an_earlier_gait_keeps_its_motion_on_other_control_points():
    old, x = program("planar"), guess("planar")
    values = old.values(x)
    new = variant("planar", interior_points=(2, 1, 3, 2, 2, 1, 3, 2))
    y = guess_from_values(new, values)
    kept = new.values(y)
    for name in ("coordinate_coefficients", "force_coefficients", "events", "placement"):
        np.testing.assert_allclose(getattr(kept, name), getattr(values, name), atol=1e-12)
    assert new.cost_parts(y)[ENERGY] == pytest.approx(old.cost_parts(x)[ENERGY], rel=0.5)
    # The contact forces are fitted anew: they carry the body.
    vertical = sum(kept.multipliers[:, row] for row in (2, 5, 9, 12))
    carried = new.state(y).share_of_cycle @ vertical
    assert carried == pytest.approx(75.0 * 9.81, rel=0.1)


def test_lifted_and_projected_agree_on_a_walk():
    """With lambda* and e as values of the lifted unknowns, both forms say the same."""
    projected, lifted = program("spatial", "projected"), program("spatial")
    x = jiggled("spatial", "projected")
    y = lifted.design.pack(projected.values(x))
    for name, value in projected.cost_parts(x).items():
        assert lifted.cost_parts(y)[name] == pytest.approx(value, rel=1e-9)
    for law in ("equations of motion", "least-squares contact forces"):
        assert np.abs(lifted.rows(y)[numbers_of(lifted, law)]).max() < 1e-6
    by_name = dict(zip(lifted.row_names, lifted.rows(y), strict=True))
    for name, value in zip(projected.row_names, projected.rows(x), strict=True):
        if not name.startswith(("equations of motion", "normal force")):
            assert by_name[name] == pytest.approx(value, rel=1e-6, abs=1e-6), name


# Failures --------------------------------------------------------------------------------------


def test_the_worst_rows_are_named_in_gait_terms():
    problem = program("planar-symmetric")
    x = guess("planar-symmetric").copy()
    knee = [i for i, name in enumerate(problem.design.names) if name.startswith("knee_flexion_r")]
    x[knee] += 3.0  # 0.6 rad: the feet leave their prints, the knee stays in its range
    worst = problem.worst(x, 5)
    amounts = [item.amount for item in worst]
    assert amounts == sorted(amounts, reverse=True)
    assert amounts[0] == pytest.approx(problem.violations(x).max())
    for item in worst:
        law, place, what = item.name.split(" | ")
        row = problem.row_names.index(item.name)
        assert item.kind == law
        assert item.unit == problem.row_units[row]
        assert item.size == pytest.approx(item.amount * problem.row_scale[row])
        assert str(item).startswith(f"{law} | {place} | {what}: off by ")
    contacts = [item for item in problem.worst(x, 400) if item.kind == "foot contact"]
    assert contacts
    assert max(item.size for item in contacts) > 0.05  # [m]
    assert {item.unit for item in contacts} == {"m"}


def test_rows_that_hold_are_not_among_the_worst():
    problem, x = program("planar-symmetric"), guess("planar-symmetric")
    violated = int((problem.violations(x) > 0.0).sum())
    assert 0 < violated < problem.num_constraints
    assert len(problem.worst(x, problem.num_constraints)) == violated


def test_a_row_that_is_no_number_is_the_worst():
    problem = program("planar-symmetric")
    x = guess("planar-symmetric").copy()
    x[problem.design.names.index("soleus_r force | coefficient 0")] = np.nan
    with np.errstate(all="ignore"):
        worst = problem.worst(x, 1)
    assert len(worst) == 1
    assert worst[0].amount == np.inf
    assert worst[0].kind in ("equations of motion", "excitation")


def test_every_row_has_a_name_of_its_own():
    for model in MODELS:
        names = program(model).row_names
        assert len(names) == len(set(names)) == program(model).num_constraints
        assert all(len(name.split(" | ")) == 3 for name in names)


# Physics of the assembly -----------------------------------------------------------------------


@pytest.mark.parametrize("model", MODELS)
def test_shares_of_the_cycle_add_up_to_the_stride(model):
    assert program(model).state(jiggled(model)).share_of_cycle.sum() == pytest.approx(1.0)


def test_a_stride_twice_as_slow_has_a_quarter_of_the_acceleration():
    problem, x = program("planar"), guess("planar")
    y = x.copy()
    y[problem.design.names.index("stride time")] *= 2.0
    fast, slow = problem.state(x), problem.state(y)
    np.testing.assert_allclose(slow.motion.acceleration, fast.motion.acceleration / 4.0)
    np.testing.assert_allclose(slow.v, fast.v / 2.0)


def test_moving_an_event_moves_its_control_points():
    problem, x = program("planar"), guess("planar")
    values = problem.values(x)
    events = values.events + 0.01 * (np.arange(8) == 3)
    moved = problem.design.pack(dataclasses.replace(values, events=events))
    shift = problem.state(moved).tau - problem.state(x).tau
    schedule = problem.formulation.schedule
    share = np.where(schedule.phases == 3, 1.0 - schedule.shares, 0.0)
    share += np.where(schedule.phases == 2, schedule.shares, 0.0)
    np.testing.assert_allclose(shift, 0.01 * share, atol=1e-12)
