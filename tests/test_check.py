"""The judge judged: each item must answer to the law that it claims to measure."""

from __future__ import annotations

import dataclasses
import io
import json

import numpy as np
import pytest
from gait_cases import changed, program_and_guess, reference_gait, restated

from drakegait.check import CheckItem, CheckReport, check
from drakegait.errors import InvalidInput
from drakegait.judgement import Judged, ground_forces
from drakegait.walker import feet
from drakegait.walker.skeleton import Skeleton

MODELS = ("spatial", "planar", "spatial-symmetric", "planar-symmetric")


@pytest.fixture(scope="module")
def gait():
    return reference_gait("spatial")


@pytest.fixture(scope="module")
def report(gait):
    return check(gait)


def tolerant(gait, **tolerances):
    return restated(gait, gait.study.with_settings(**tolerances))


def raised(gait, height):
    """The gait with the walker lifted by `height` [m]."""
    coefficients = gait.values.coordinate_coefficients.copy()
    coefficients[gait.coordinate_names.index("hat_z")] += height
    return changed(gait, coordinate_coefficients=coefficients)


# The path of its own -----------------------------------------------------------------------


@pytest.mark.parametrize("model", MODELS)
def test_scipys_splines_are_the_splines_of_the_gait(model):
    gait = reference_gait(model)
    tau = np.linspace(0.0, 1.0, 77)
    own, other = Judged(gait, 100).motion_at(tau), gait.motion(tau)
    for field in dataclasses.fields(own):
        expected = getattr(other, field.name)
        np.testing.assert_allclose(
            getattr(own, field.name), expected, atol=1e-11 * max(1.0, np.abs(expected).max())
        )


@pytest.mark.parametrize("model", ["spatial", "planar"])
def test_residual_is_no_longer_than_that_of_the_program(model):
    """Eq. (17) makes the shortest residual; the program's own contact forces leave a longer one."""
    from drakegait.loads import loads_along

    _, program, x = program_and_guess(model)
    gait, state = reference_gait(model), program.state(x)
    loads = loads_along(gait.study.walker, gait.motion(state.tau), program.points.phases)
    inside = program.points.shares > 0.0
    ours = np.linalg.norm(loads.residual, axis=1)[inside]
    theirs = np.linalg.norm(state.residual, axis=1)[inside]
    assert np.all(ours <= theirs * (1.0 + 1e-9))
    # Same law: what the forces of the program leave open is the same sum of forces.
    contact = np.einsum("kri,kr->ki", state.contact_jacobian, state.multipliers)
    np.testing.assert_allclose(
        (loads.contact + loads.residual)[inside], (contact + state.residual)[inside], atol=1e-7
    )


@pytest.mark.parametrize("model", MODELS)
def test_costs_agree_with_the_program(model):
    """The rectangle rule of the check against the trapezoids of the control points."""
    _, program, x = program_and_guess(model)
    parts, report = program.cost_parts(x), check(reference_gait(model))
    energy = parts["metabolic cost of transport"] * 100.0
    assert report.metabolic_cost_of_transport == pytest.approx(energy, rel=0.06)
    assert reference_gait(model).metabolic.cost_of_transport == pytest.approx(
        report.metabolic_cost_of_transport, rel=1e-9
    )
    assert report.deviation == pytest.approx(parts["deviation"], rel=0.25)


def test_more_instants_find_the_same(gait, report):
    finer = check(gait, 3000)
    for item in report.items:
        if item.name not in ("periodicity_error", "speed_error", "energy_balance_relative_error"):
            value = finer.item(item.name).value
            assert value == pytest.approx(item.value, rel=0.05, abs=0.02), item.name


# Each item answers to its law --------------------------------------------------------------


def test_sinking_is_penetration_to_the_millimetre(gait, report):
    lower = check(raised(gait, -0.010))
    assert lower.penetration_max_mm - report.penetration_max_mm == pytest.approx(10.0, abs=1e-6)
    assert not lower.item("penetration_max_mm").passed
    assert check(raised(gait, 0.050)).penetration_max_mm < 0.0


def test_a_hovering_foot_is_off_its_print(gait):
    item = check(raised(gait, 0.050)).item("foot_contact_max_mm")
    assert item.value > 45.0 and not item.passed
    assert item.where.endswith(" z") and set(item.phases) == set(range(8))


def test_a_turned_print_fails_where_that_foot_stands(gait):
    """Only phases with the left foot on the ground see its heading; 0.01 rad counts as 2 mm."""
    wide = tolerant(gait, contact_tolerance=0.02, yaw_tolerance=0.1)
    assert check(wide).item("foot_contact_max_mm").passed
    placement = wide.values.placement.copy()
    placement[3] += 0.5
    item = check(changed(wide, placement=placement)).item("foot_contact_max_mm")
    assert set(item.phases) == {0, 1, 4, 5, 6, 7}
    assert "_l" in item.where
    assert item.value == pytest.approx(0.5 * 200.0, rel=0.25)


def test_prints_follow_the_placement(gait):
    """Both left prints are a step away from the right one."""
    placement = gait.values.placement.copy()
    placement[[0, 1]] += [0.1, -0.1]  # the stride, and with it the motion, stays
    item = check(changed(gait, placement=placement)).item("foot_contact_max_mm")
    assert item.value == pytest.approx(100.0, rel=0.2) and " x" in item.where


def test_a_strong_pull_needs_too_much_excitation(gait):
    soleus = gait.nodal_values["soleus_l"] + 2500.0
    item = check(gait.with_nodal_values(soleus_l=soleus)).item("excitation_max")
    assert item.value > 1.05 and not item.passed and item.where.endswith("soleus_l")
    released = gait.nodal_values["vasti_r"].copy()
    released[::2] += 2000.0
    item = check(gait.with_nodal_values(vasti_r=released)).item("excitation_min")
    assert item.value < -0.05 and not item.passed and item.where.endswith("vasti_r")


def test_excitations_are_those_of_the_muscles(gait, report):
    u = gait.sample(1001).excitation
    assert report.excitation_max == pytest.approx(float(u.max()), abs=1e-6)
    assert report.excitation_min == pytest.approx(float(u.min()), abs=1e-6)


def test_slippery_ground_is_used_more(gait, report):
    mu = gait.study.contact.friction
    exact = check(tolerant(gait, force_tolerance=0.01))
    slippery = check(tolerant(gait, friction=mu / 4, force_tolerance=0.01))
    assert slippery.friction_ratio_max == pytest.approx(4.0 * exact.friction_ratio_max)
    usual = check(tolerant(gait, friction=mu / 4))
    assert report.friction_ratio_max < usual.friction_ratio_max


def test_horizontal_forces_within_twice_their_tolerance_are_no_slip(gait):
    """|F_xy| / max(mu N, 2 eps_m): what the equations of motion leave open does not count."""
    for tolerance in (0.01, 5.0, 60.0):
        judged = Judged(tolerant(gait, force_tolerance=tolerance), 200)
        force = judged.loads.ground_reactions
        standing = np.stack(
            [~np.isin(judged.phases, (6, 7)) & (force[:, 0] != 0.0).any(axis=1),
             ~np.isin(judged.phases, (2, 3)) & (force[:, 1] != 0.0).any(axis=1)], axis=1,
        )  # fmt: skip
        held = np.maximum(judged.gait.study.contact.friction * force[..., 2], 2.0 * tolerance)
        used = np.where(standing, np.hypot(force[..., 0], force[..., 1]) / held, -np.inf)
        found = {item.name: item for item in ground_forces(judged)}["friction_ratio_max"]
        assert found.value == pytest.approx(used.max())


def test_a_free_moment_beyond_the_grip_is_one_more_unexplained_moment(gait):
    """It is judged like a row of the equations of motion: up to twice eps_m passes."""
    item = {one.name: one for one in check(gait, 200).items}["free_moment_excess_Nm"]
    assert item.high == 2.0 * gait.study.tolerances.moment_tolerance
    slippery = check(tolerant(gait, friction=0.02, patch_radius=0.0), 200)
    assert slippery.free_moment_excess_Nm > check(gait, 200).free_moment_excess_Nm


def test_the_free_moment_that_the_ground_can_hold(gait):
    """mu [r N_A + (AB + r) N_B] about the heel while down, else mu r N_B (formulation.md 6.9)."""
    judged = Judged(tolerant(gait, moment_tolerance=0.01), 200)
    contact, length = gait.study.contact, judged.walker.foot.length
    heel_down = {0: (0, 1, 2), 1: (4, 5, 6)}  # right, left; phases from 0
    toe_down = {0: (1, 2, 3, 4, 5), 1: (5, 6, 7, 0, 1)}
    largest = -np.inf
    for instant, phase in enumerate(judged.phases):
        for foot in range(2):
            rows = judged.loads.multipliers[instant, 7 * foot : 7 * foot + 7]
            if phase in heel_down[foot]:
                lever = contact.patch_radius * max(rows[2], 0.0)
                lever += (length + contact.patch_radius) * max(rows[5], 0.0)
            elif phase in toe_down[foot]:
                lever = contact.patch_radius * max(rows[5], 0.0)
            else:
                continue
            largest = max(largest, abs(rows[6]) - contact.friction * lever)
    found = check(judged.gait, 200).free_moment_excess_Nm
    assert found == pytest.approx(largest)
    # The flat foot's toe holds far more than its patch alone: the lever must be seen.
    flat = np.isin(judged.phases, (1, 2))
    assert judged.loads.point_forces[flat, 0, 1, 2].max() > 100.0


def test_levers_of_heel_and_toe(gait):
    """With only flat phases judged the worst excess is that of the flat foot's lever."""
    judged = Judged(tolerant(gait, moment_tolerance=0.01), 400)
    flat = np.flatnonzero(judged.phases == 2)
    loads, contact = judged.loads, gait.study.contact
    judged.phases, judged.tau = judged.phases[flat], judged.tau[flat]
    judged.__dict__["loads"] = dataclasses.replace(
        loads, **{f.name: getattr(loads, f.name)[flat] for f in dataclasses.fields(loads)}
    )
    items = {one.name: one for one in ground_forces(judged)}
    rows = loads.multipliers[flat]
    normal = np.maximum(rows, 0.0)
    heel, toe = contact.patch_radius, contact.patch_radius + judged.walker.foot.length
    hold = contact.friction * (heel * normal[:, 2] + toe * normal[:, 5])
    expected = np.max(np.abs(rows[:, 6]) - hold)
    assert items["free_moment_excess_Nm"].value == pytest.approx(expected)


@pytest.mark.parametrize("model", ["planar", "planar-symmetric"])
def test_a_planar_walker_neither_twists_nor_slips_sideways(model):
    judged = Judged(reference_gait(model), 200)
    assert np.all(judged.loads.pivot_moments == 0.0)
    assert np.all(judged.loads.ground_reactions[..., 1] == 0.0)
    assert check(reference_gait(model), 200).free_moment_excess_Nm <= 0.0


def test_normal_force_is_of_standing_points_only(gait, report):
    sampled = gait.sample(1001)
    heights = sampled.contact_forces.sel(axis="z").values
    standing = np.array([feet.active_rows(p)[list(feet.VERTICAL_ROWS)] for p in range(8)])
    heights = np.where(standing[sampled.phase.values - 1], heights, np.inf)
    assert report.normal_force_min_N <= heights.min() + 1e-6
    weight = 75.0 * 9.81
    assert report.item("normal_force_min_N").low == pytest.approx(-0.01 * weight)


def test_a_pull_that_nobody_asked_for_is_a_residual(gait, report):
    """20 N m more at the knee must be found in the equations of motion."""
    arm = gait.study.walker.muscles.moment_arms
    muscle = gait.muscle_names.index("vasti_r")
    more = 60.0 / np.abs(arm[muscle]).max()
    edited = gait.with_nodal_values(vasti_r=gait.nodal_values["vasti_r"] + more)
    item = check(edited).item("equations_of_motion_max_Nm")
    assert not item.passed and item.value > 20.0


@pytest.mark.parametrize("model", MODELS)
def test_energy_balances_for_any_motion(model):
    """Power = rate of energy is a law, solved or not."""
    assert check(reference_gait(model)).energy_balance_relative_error < 1e-3


@pytest.mark.parametrize("method", ["bias", "mass_matrix", "kinetic_energy", "gravity_forces"])
def test_energy_balance_sees_wrong_mechanics(gait, report, method, monkeypatch):
    """It rises far above its rounding; for walking, 30 % of kinetic energy is little work."""
    right = getattr(Skeleton, method)
    monkeypatch.setattr(Skeleton, method, lambda *args: 1.3 * right(*args))
    wrong = check(gait).energy_balance_relative_error
    assert wrong > 100.0 * report.energy_balance_relative_error


def test_residual_and_contact_work_close_the_stride(gait, report):
    """Over a stride the energy is the same again: what muscles and joints do not give, they do."""
    judged = Judged(gait, 1000)
    own = np.sum((judged.loads.passive + judged.loads.muscles) * judged.motion.v, axis=1)
    work = judged.stride_time * float(judged.mean(own))
    assert report.residual_work_J + report.contact_work_J == pytest.approx(-work, abs=1e-3)
    for name in ("residual_work_J", "contact_work_J"):
        assert not report.item(name).judged and "% of the muscles' work" in report.item(name).where


def test_another_wanted_speed_is_a_speed_error(gait, report):
    assert report.item("speed_error").passed
    item = check(restated(gait, gait.study.replace(speed=1.25)), 200).item("speed_error")
    assert item.value == pytest.approx(0.05, abs=1e-6) and not item.passed


def test_strides_join(gait, report):
    assert report.periodicity_error < 1e-9


def test_both_sides_of_an_event_are_judged(gait):
    judged = Judged(gait, 100)
    np.testing.assert_array_equal(judged.phases[-16:], [*range(8), *range(8)])
    np.testing.assert_allclose(judged.tau[-8:-1], gait.values.events[1:])
    assert judged.tau[-1] == 1.0


def test_a_nan_never_passes(gait):
    coefficients = gait.values.force_coefficients.copy()
    coefficients[0, 3] = np.nan
    report = check(changed(gait, force_coefficients=coefficients), 200)
    assert not report.passed
    assert not report.item("equations_of_motion_max_Nm").passed


def test_one_nan_among_good_values_is_the_worst(gait):
    judged = Judged(gait, 100)
    values = np.zeros((len(judged.tau), 2))
    values[40, 1] = np.nan
    for largest, limit in ((True, 1.0), (False, -1.0)):
        one = judged.worst("x", "x", values, "", limit, ("a", "b"), largest)
        assert np.isnan(one.value) and not one.passed and one.where.endswith(", b")
        assert one.phases == (judged.phases[40],)


# The report --------------------------------------------------------------------------------


def item(value, **bounds):
    return CheckItem("x", "something", value, "N", **bounds)


@pytest.mark.parametrize(
    ("one", "passed"),
    [
        (item(1.0, high=1.0), True),
        (item(1.1, high=1.0), False),
        (item(-0.05, low=-0.05), True),
        (item(-0.06, low=-0.05), False),
        (item(float("nan"), high=1.0), False),
        (item(1e9), True),
    ],
)
def test_limits_are_inclusive(one, passed):
    assert one.passed is passed and CheckReport(100, (one,)).passed is passed


def test_passed_means_that_every_item_does(report):
    assert not report.passed  # a guess is not a solution
    failing = [one for one in report.items if not one.passed]
    mended = [dataclasses.replace(one, low=-np.inf, high=np.inf) for one in report.items]
    assert CheckReport(1000, tuple(mended)).passed
    mended[0] = failing[0]
    assert not CheckReport(1000, tuple(mended)).passed


def test_every_value_is_an_attribute(report):
    for one in report.items:
        assert getattr(report, one.name) == one.value
    assert len({one.name for one in report.items}) == len(report.items)


def test_limits_are_twice_the_tolerances(gait):
    report = check(tolerant(gait, force_tolerance=7.0, moment_tolerance=3.0), 100)
    assert report.item("equations_of_motion_max_N").high == 14.0
    assert report.item("equations_of_motion_max_Nm").high == 6.0
    assert report.item("foot_contact_max_mm").high == pytest.approx(4.0)
    assert report.item("penetration_max_mm").high == pytest.approx(4.0)
    assert report.item("excitation_min").low == -0.05
    assert report.item("excitation_max").high == pytest.approx(1.05)
    assert report.item("friction_ratio_max").high == pytest.approx(1.02)
    assert report.item("energy_balance_relative_error").high == 0.01


def test_worst_phases_are_those_that_fail(report):
    phases = report.worst_phases()
    assert phases == {phase for one in report.items for phase in one.phases}
    assert phases and phases <= set(range(8))
    assert all(one.passed == (not one.phases) for one in report.items if ", " in one.where)


def test_places_are_in_gait_terms(report, gait):
    where = report.item("equations_of_motion_max_Nm").where
    phase, percent, joint = where.split(", ")
    assert phase in feet.PHASE_NAMES and percent.endswith(" %") and joint in gait.coordinate_names


def test_a_report_survives_json(report):
    assert CheckReport.from_dict(json.loads(json.dumps(report.to_dict()))) == report


def test_the_table_can_be_printed(report):
    from rich.console import Console

    console = Console(file=io.StringIO(), width=160)
    console.print(report.table())
    text = console.file.getvalue()
    assert "NOT passed" in text and "FAILS" in text
    for row in report.rows():
        assert row[0] in text


@pytest.mark.parametrize("instants", [99, 0, -5, 1e3, True, None])
def test_too_few_instants_are_refused(gait, instants):
    with pytest.raises(InvalidInput, match="instants"):
        check(gait, instants)
