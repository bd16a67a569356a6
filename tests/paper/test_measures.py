"""What is measured on gaits, on a gait whose answer is known."""

from __future__ import annotations

import numpy as np
import pytest
from gait_cases import reference_gait

from drakegait.paper import measures, timings
from drakegait.paper.own_reference import reference_of
from drakegait.study import GaitStudy
from drakegait.transcription.splines import PeriodicQuintic


@pytest.fixture(scope="module")
def gait():
    return reference_gait("planar-symmetric")


def test_a_gait_does_not_differ_from_itself_and_its_legs_are_equal(gait):
    names = measures.angle_names(gait)
    assert "hat_tilt" in names and "hat_z" not in names
    assert measures.angle_changes(gait, gait, names) == pytest.approx(0.0)
    assert measures.reaction_change(gait, gait) == 0.0
    for measure in (measures.foot_lift, measures.excitation_height, measures.excitation_width):
        assert measure(gait, "right") == pytest.approx(measure(gait, "left"), rel=0.02)
    assert measures.late_stance_force(gait, "right") == pytest.approx(
        measures.late_stance_force(gait, "left"), abs=2.0
    )


def test_a_moved_knee_shows_in_its_own_row_only(gait):
    name = "knee_flexion_r"
    moved = gait.with_nodal_values(**{name: gait.nodal_values[name] + np.radians(2.0)})
    names = measures.angle_names(gait)
    changes = dict(zip(names, measures.angle_changes(gait, moved, names), strict=True))
    # The walker is symmetric, so that both knees have moved.
    assert changes["knee_flexion_r"] == pytest.approx(2.0)
    assert changes["knee_flexion_l"] == pytest.approx(2.0)
    assert changes["hip_flexion_r"] == pytest.approx(0.0, abs=1e-9)
    assert measures.spread(np.array(list(changes.values()))) == pytest.approx(2.0)
    assert measures.largest_angle(moved, name) == pytest.approx(
        measures.largest_angle(gait, name) + 2.0
    )
    assert measures.mean_angle(moved, name, (1, 2)) == pytest.approx(
        measures.mean_angle(gait, name, (1, 2)) + 2.0
    )


def test_antagonists_are_read_at_the_peak_and_together(gait):
    muscle, others = "tibialis_anterior_r", ("soleus_r", "gastrocnemius_r")
    peak = measures.excitation_peak(gait, muscle, 0.0, 100.0)
    assert measures.excitation_at_peak(gait, muscle, (muscle,), 0.0, 100.0) == peak
    assert measures.shared_excitation(gait, muscle, (muscle,), 0.0, 100.0) == peak
    there = measures.excitation_at_peak(gait, muscle, others, 0.0, 100.0)
    shared = measures.shared_excitation(gait, muscle, others, 0.0, 100.0)
    assert min(there, peak) <= shared <= peak  # together at the peak, and perhaps more elsewhere
    halves = ((0.0, 50.0), (50.0, 100.0))
    assert shared == max(
        measures.shared_excitation(gait, muscle, others, *ends) for ends in halves
    )


def test_the_change_of_an_angle_is_split_over_the_stride(gait):
    moved = gait.with_nodal_values(hat_tilt=gait.nodal_values["hat_tilt"] + np.radians(1.5))
    for ends in ((0.0, 50.0), (50.0, 100.0)):
        assert measures.angle_change(gait, moved, "hat_tilt", *ends) == pytest.approx(1.5)
        assert measures.angle_change(gait, gait, "hat_tilt", *ends) == 0.0


def test_heights_and_forces_are_those_of_a_walk(gait):
    assert 30.0 < measures.foot_lift(gait, "right") < 300.0  # [mm]
    assert 20.0 < measures.late_stance_force(gait, "right") < 130.0  # [% BW]
    ours, reference = measures.ranges(gait, "hip_flexion_r")
    assert ours == pytest.approx(reference, rel=0.05)  # it is the reference


def test_a_gait_as_its_own_reference_has_no_deviation(gait):
    walk = reference_of(gait, "itself")
    study = GaitStudy.planar(nodes=19, reference=walk)
    tau = np.linspace(0.0, 1.0, 57)
    motion = gait.motion(tau).q.copy()
    motion[:, 0] -= gait.stride_length * tau
    np.testing.assert_allclose(study.reference_walk.coordinate_values(tau), motion, atol=1e-12)
    forces = gait.sample(401).ground_reaction_force.values
    np.testing.assert_allclose(
        walk.ground_reactions(np.arange(1, 400) / 400.0), forces[1:-1], atol=1e-6
    )
    assert walk.speed == pytest.approx(gait.speed)
    assert sum(walk.phase_fractions) == pytest.approx(1.0)


def test_the_papers_polynomials_are_our_splines():
    nodes = 13
    spline = PeriodicQuintic(nodes)
    nodal = np.random.default_rng(0).normal(size=(4, nodes - 1))
    system, right = timings.polynomial_system(nodes - 1)
    wanted = timings.polynomials(np.linalg.solve(system, right @ nodal.T), nodal)
    at = (np.arange(nodes - 1) + 0.3) / (nodes - 1)
    ours = spline.evaluate(spline.coefficients(nodal), at)
    np.testing.assert_allclose(wanted, ours.T, atol=1e-9)


def test_times_are_measured():
    study = GaitStudy.planar_symmetric(nodes=13, interior_points=(1, 1, 3, 2))
    found = timings.splines(study, repeats=2)
    assert all(value > 0.0 for value in found.values())
    assert found["unknowns_per_curve"] == 60
