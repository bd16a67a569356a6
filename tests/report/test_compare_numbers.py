"""The numbers of a comparison: parts add up, equal legs give zeros, a mirror swaps sides."""

import dataclasses
import functools

import numpy as np
import pytest
from gait_cases import changed, reference_gait

from drakegait.check import check
from drakegait.gait import Gait
from drakegait.program.gait_program import GaitProgram
from drakegait.program.guess import guess_from_reference
from drakegait.quantities import GRAVITY
from drakegait.report.comparison_curves import BAND_SHARE, OTHER_ANGLES, SAGITTAL_ANGLES
from drakegait.report.comparison_tables import GaitNumbers, rows
from drakegait.report.cost_split import PARTS, CostSplit, phase_shares
from drakegait.report.curves import GaitCurves
from drakegait.report.joint_moments import power
from drakegait.report.measures import find
from drakegait.report.powers import JOINTS, ground_impulses, joint_work, peaks
from drakegait.report.spatiotemporal import spatiotemporal
from drakegait.report.symmetry import UNIT, symmetry, symmetry_index
from drakegait.study import GaitStudy
from drakegait.walker import coordinates

INSTANTS = 1001


def curves(gait: Gait) -> GaitCurves:
    return GaitCurves(gait, "gait", INSTANTS)


@functools.cache
def limping() -> Gait:
    """A spatial gait of unequal legs, no solution: 19 nodes, so that a node lies at half time."""
    study = GaitStudy.spatial(nodes=19)
    program = GaitProgram(study.formulation())
    values = program.values(guess_from_reference(program))
    gait = Gait(study, values, reference_gait("spatial").outcome, {})
    nodal = gait.nodal_values
    swing = np.sin(2 * np.pi * np.arange(18) / 18)
    gait = gait.with_nodal_values(
        knee_flexion_r=nodal["knee_flexion_r"] + 0.05 * swing,
        hip_adduction_l=nodal["hip_adduction_l"] - 0.02,
        soleus_r=0.8 * nodal["soleus_r"],
        vasti_l=1.2 * nodal["vasti_l"] + 20.0,
    )
    placement = gait.values.placement + [0.03, -0.03, 0.02, 0.01, 0.0]
    return changed(gait, placement=placement)


def uneven() -> Gait:
    """The same with a longer right step in time, and unequal stances."""
    gait = limping()
    return changed(gait, events=gait.values.events + [0, 0, 0.005, 0, 0.02, 0.02, 0.01, 0])


def mirrored(gait: Gait) -> Gait:
    """The mirror image, half a stride later: what the right leg did the left does now."""
    values, half = gait.values, (gait.study.nodes - 1) // 2
    assert values.events[4] == pytest.approx(0.5) and gait.study.nodes % 2 == 1
    names = gait.coordinate_names
    swap = [names.index(coordinates.coordinates("spatial")[i].mirror_of) for i in range(len(names))]
    motion = coordinates.mirror_signs("spatial")[:, None] * values.coordinate_coefficients[swap]
    motion = np.roll(motion, -half, axis=1)
    right, left, angle_right, angle_left, width = values.placement
    # World x starts below the new right foot's first print.
    motion[0] += 0.5 * (right + left) - left
    count = len(gait.muscle_names) // 2
    forces = np.roll(values.force_coefficients, (count, -half), axis=(0, 1))
    events = np.concatenate([values.events[4:] - 0.5, values.events[:4] + 0.5])
    return changed(
        gait, coordinate_coefficients=motion, force_coefficients=forces, events=events,
        placement=np.array([left, right, -angle_left, -angle_right, width]),
    )  # fmt: skip


# Energy ----------------------------------------------------------------------------------------


@pytest.mark.parametrize("gait", [limping, functools.partial(reference_gait, "planar")])
def test_parts_of_the_cost_add_up_to_the_cost_of_transport(gait):
    gait = gait()
    split, energy = CostSplit.of(gait), gait.metabolic
    assert split.total == pytest.approx(energy.cost_of_transport, rel=1e-12)
    assert split.by_part.sum() + split.basal == pytest.approx(energy.cost_of_transport, rel=1e-12)
    assert sorted(phase for part in PARTS.values() for phase in part) == list(range(8))
    for name, cost in energy.by_muscle.items():
        side = "right" if name.endswith("_r") else "left"
        assert split.of_group(name[:-2], side) == pytest.approx(cost, rel=1e-9)


def test_basal_rate_is_a_part_of_its_own():
    gait = limping()
    basal = dataclasses.replace(gait, study=gait.study.with_settings(basal=True))
    split = CostSplit.of(basal)
    assert split.basal == pytest.approx(1.2 * 75.0 / basal.speed)
    assert split.total == pytest.approx(basal.metabolic.cost_of_transport)


def test_cost_of_a_phase_is_the_integral_over_that_phase():
    gait = limping()
    split, events = CostSplit.of(gait), np.append(gait.values.events, 1.0)
    tau = np.linspace(0.0, 1.0, 8001)
    power_of = gait.sample(8001).muscle_power
    for side, leg, first in (("r", 0, 0), ("l", 1, 4)):
        names = [name for name in gait.muscle_names if name.endswith(side)]
        total = power_of.sel(muscle=names).sum("muscle").values
        for own in (0, 2, 6):
            phase = (own + first) % 8
            inside = (tau >= events[phase]) & (tau <= events[phase + 1])
            energy = np.trapezoid(total[inside], tau[inside]) / gait.speed
            assert split.values[:, leg, own].sum() == pytest.approx(energy, rel=0.02, abs=0.05)


def test_shares_of_the_phases_are_their_durations():
    gait = limping()
    shares = phase_shares(gait.values.events)
    np.testing.assert_allclose(shares.sum(axis=1), 1.0 / len(shares))
    np.testing.assert_allclose(
        shares.sum(axis=0) * gait.stride_time, gait.phase_durations, atol=1e-12
    )


# Work and impulses -----------------------------------------------------------------------------


def test_work_of_a_joint_is_the_integral_of_its_power():
    item = curves(limping())
    measures = joint_work(item)
    time = item.percent / 100.0 * item.gait.stride_time
    for joint in JOINTS:
        for side in ("right", "left"):
            gives = find(measures, f"{joint.lower()}_work_generated", side)
            takes = find(measures, f"{joint.lower()}_work_absorbed", side)
            assert gives >= 0.0 and takes >= 0.0
            net = np.trapezoid(power(item, joint, side), time)
            assert gives - takes == pytest.approx(net, abs=1e-6)


def test_joints_residual_and_feet_together_do_no_net_work():
    """A walker on level ground has the same energy after a stride (theorem of work)."""
    gait = limping()
    measures, report = joint_work(curves(gait)), check(gait)
    net = sum(
        find(measures, "leg_work_generated", side) - find(measures, "leg_work_absorbed", side)
        for side in ("right", "left")
    )
    others = report.residual_work_J + report.contact_work_J
    size = find(measures, "leg_work_generated", "right") * 75.0
    assert abs(others) > 0.02 * size  # it is no solution: there is something to balance
    assert 75.0 * net + others == pytest.approx(0.0, abs=1e-3 * size)


def test_ground_carries_the_weight_and_the_residual():
    gait = limping()
    item = curves(gait)
    impulses = ground_impulses(item)
    carried = sum(find(impulses, "vertical_impulse", side) for side in ("right", "left"))
    residual = item.data.equation_residual.sel(coordinate="hat_z").values[:-1].mean()
    weight = gait.study.walker.skeleton.total_mass * GRAVITY
    wanted = (weight - residual) * gait.stride_time / item.body_weight
    assert carried == pytest.approx(wanted, rel=1e-3)


def test_peaks_of_the_vertical_force_are_those_of_the_halves_of_stance():
    item = curves(limping())
    impulses = ground_impulses(item)
    for side in ("right", "left"):
        up = item.ground_reaction(side, "vertical")[:-1]
        share = (item.percent[:-1] - item.heel_strike(side)) % 100.0 / item.toe_off(side)
        for name, half in (("first", share <= 0.5), ("second", (share >= 0.5) & (share <= 1.0))):
            assert find(impulses, f"{name}_peak", side) == pytest.approx(up[half].max())


# Symmetry --------------------------------------------------------------------------------------


def test_index_of_equal_legs_is_zero_and_it_is_bounded():
    assert symmetry_index(3.0, 3.0) == 0.0
    assert symmetry_index(1.1, 0.9) == pytest.approx(20.0)
    assert symmetry_index(2.0, 0.0) == pytest.approx(200.0)
    assert symmetry_index(0.0, 2.0) == pytest.approx(-200.0)
    assert np.isnan(symmetry_index(0.0, 0.0))


def test_symmetric_gait_has_no_asymmetry():
    for measure in symmetry(curves(reference_gait("planar-symmetric"))):
        assert measure.value == pytest.approx(0.0, abs=1e-6), measure.label


def test_mirror_image_swaps_the_sides_of_everything():
    gait = limping()
    first, second = (
        GaitNumbers(curves(item), check(item)) for item in (gait, mirrored(gait))
    )  # fmt: skip
    other = {"right": "left", "left": "right", "": ""}
    sided = 0
    for read in ("steps", "cost", "ground", "work", "peaks", "cost_by_part"):
        mine, image = getattr(first, read), getattr(second, read)
        for measure in mine:
            if measure.name == "deviation":  # where the walker is counts from the right print
                continue
            swapped = find(image, measure.name, other[measure.side])
            assert swapped == pytest.approx(measure.value, rel=2e-3, abs=2e-4), measure
            unequal = measure.side and abs(
                find(mine, measure.name, other[measure.side]) - measure.value
            ) > 0.01 * abs(measure.value)  # fmt: skip
            sided += bool(unequal)
    assert sided > 40  # most would notice sides that are mixed up
    for measure in first.symmetry:
        sign = -1.0 if measure.unit == UNIT else 1.0
        image = find(second.symmetry, measure.name)
        assert image == pytest.approx(sign * measure.value, rel=5e-3, abs=0.02), measure


# Steps -----------------------------------------------------------------------------------------


@pytest.mark.parametrize("gait", [uneven, functools.partial(reference_gait, "planar")])
def test_steps_and_times_fit_together(gait):
    gait = gait()
    measures = spatiotemporal(curves(gait))

    def of(name, side=""):
        return find(measures, name, side)

    assert of("stride_length") == pytest.approx(
        sum(of("step_length", s) for s in ("right", "left"))
    )
    assert of("stride_time") == pytest.approx(sum(of("step_time", s) for s in ("right", "left")))
    assert of("speed") == pytest.approx(of("stride_length") / of("stride_time"))
    assert of("cadence") == pytest.approx(120.0 / of("stride_time"))
    durations = gait.phase_durations / gait.stride_time * 100.0
    assert of("double_support") == pytest.approx(durations[[0, 1, 4, 5]].sum())
    assert of("single_support", "right") == pytest.approx(durations[[2, 3]].sum())
    assert of("single_support", "left") == pytest.approx(durations[[6, 7]].sum())
    for side in ("right", "left"):
        assert of("stance", side) + of("swing", side) == pytest.approx(100.0)
        assert of("stance_time", side) == pytest.approx(
            0.01 * of("stance", side) * of("stride_time")
        )
        assert -1.0 < of("toe_clearance", side) < 5.0
    assert of("stance", "right") == pytest.approx(durations[:6].sum())


def test_right_step_is_how_far_the_right_foot_lands_ahead():
    gait = uneven()
    measures = spatiotemporal(curves(gait))
    assert find(measures, "step_length", "right") == pytest.approx(gait.placement.step_length_right)
    # And its time ends with the stride, at right heel strike.
    assert find(measures, "step_time", "right") == pytest.approx(
        (1.0 - gait.values.events[4]) * gait.stride_time
    )


def test_angles_in_the_table_are_those_of_the_curves():
    item = curves(limping())
    found = peaks(item)
    knee = item.coordinate("knee_flexion_r")
    assert find(found, "knee_flexion_max", "right") == pytest.approx(knee.max())
    assert find(found, "knee_flexion_range", "right") == pytest.approx(np.ptp(knee))
    # Plantarflexion at push-off is negative dorsiflexion, and its moment is an extensor's.
    assert find(found, "ankle_dorsiflexion_min", "right") < -5.0
    assert find(found, "ankle_plantarflexor_moment", "right") > 0.5


# Differences and bands -------------------------------------------------------------------------


def test_a_gait_does_not_differ_from_itself():
    item = GaitNumbers(curves(limping()), check(limping()))
    for read in ("steps", "cost", "cost_by_part", "ground", "work", "peaks", "symmetry"):
        for row in rows([getattr(item, read)] * 2):
            assert row.changes == (0.0,)
            assert row.shares[0] == 0.0 or np.isnan(row.shares[0])


def test_what_only_one_walker_has_is_missing_in_the_other():
    spatial, planar = (
        spatiotemporal(curves(reference_gait(model))) for model in ("spatial", "planar")
    )
    table = {row.name: row for row in rows([planar, spatial])}
    assert np.isnan(table["step_width"].values[0]) and table["step_width"].values[1] > 0.0
    assert np.isnan(table["step_width"].changes[0]) and np.isnan(table["step_width"].shares[0])


def test_reference_walk_lies_in_the_middle_of_its_band():
    """The gait of these tests is the reference itself."""
    item = GaitCurves(reference_gait("spatial"), "reference")
    walk = item.gait.study.reference_walk
    for quantity in (*SAGITTAL_ANGLES, *OTHER_ANGLES):
        for side in ("right", "left"):
            percent, low, high = quantity.band(item, side)
            own = np.interp(percent, *quantity.own(item, side))
            row = walk.coordinates.index(f"{quantity.name}_{side[0]}")
            sigma = np.degrees(walk.coordinate_sigma[row])
            np.testing.assert_allclose(high - low, 2 * BAND_SHARE * sigma, rtol=0.01)
            assert np.abs(0.5 * (low + high) - own).max() < 0.2 * sigma
