"""The two sequences of rotations describe the same body."""

from __future__ import annotations

import numpy as np
import pytest

from drakegait.errors import InvalidInput
from drakegait.reference.reference import Reference
from drakegait.reference.sequence import in_sequence
from drakegait.study import GaitStudy
from drakegait.walker import coordinates
from drakegait.walker.dynamics_curvature import DynamicsCurvature, Weights
from drakegait.walker.rotation_sequence import convert
from drakegait.walker.skeleton import Skeleton


@pytest.fixture(scope="module")
def skeletons() -> dict[str, Skeleton]:
    return {name: Skeleton.load("spatial", sequence=name) for name in ("213", "123")}


def posture(seed: int = 0, *lead: int) -> np.ndarray:
    return np.random.default_rng(seed).normal(scale=0.4, size=(*lead, 16))


def test_order_of_the_joints(skeletons):
    for name, skeleton in skeletons.items():
        order = {joint: skeleton.plant.GetJointByName(joint).position_start()
                 for joint in coordinates.names("spatial")}  # fmt: skip
        for x, y, z in (("hat_list", "hat_tilt", "hat_rotation"),
                        ("hip_adduction_l", "hip_flexion_l", "hip_rotation_l")):  # fmt: skip
            first, second = (y, x) if name == "213" else (x, y)
            assert order[first] < order[second] < order[z]
        # The hip's place belongs to whichever joint comes first.
        hip = skeleton.body_poses(np.zeros(16))["thigh_l"][1]
        np.testing.assert_allclose(hip, [0.0, 0.0835, 0.0], atol=1e-12)


def test_there_and_back_again():
    q = posture(1, 5)
    np.testing.assert_allclose(convert(convert(q, "213", "123"), "123", "213"), q, atol=1e-12)
    np.testing.assert_array_equal(convert(q, "213", "213"), q)
    both = convert(q, "213", "123")
    same = [i for i, name in enumerate(coordinates.names("spatial"))
            if name[:4] in ("knee", "ankl") or name in ("hat_x", "hat_y", "hat_z")]  # fmt: skip
    np.testing.assert_array_equal(both[:, same], q[:, same])
    assert np.abs(both - q).max() > 0.05


def test_one_angle_alone_is_the_same_in_both():
    for i in range(16):
        q = np.zeros(16)
        q[i] = 0.3
        np.testing.assert_allclose(convert(q, "213", "123"), q, atol=1e-15)


def test_converted_angles_put_every_segment_in_the_same_place(skeletons):
    q = posture(2, 7)
    here = skeletons["213"].body_poses(q)
    there = skeletons["123"].body_poses(convert(q, "213", "123"))
    assert here.keys() == there.keys()
    for name in here:
        for one, other in zip(here[name], there[name], strict=True):
            np.testing.assert_allclose(one, other, atol=1e-12, err_msg=name)


def test_the_same_motion_has_the_same_energy(skeletons):
    """Mass moves alike: velocities go through the derivative of the conversion."""
    q, v, step = posture(3), posture(4), 1e-6
    q2 = convert(q, "213", "123")
    v2 = (convert(q + step * v, "213", "123") - convert(q - step * v, "213", "123")) / (2 * step)
    energy = skeletons["213"].kinetic_energy(q, v)
    assert skeletons["123"].kinetic_energy(q2, v2) == pytest.approx(energy, rel=1e-8)
    np.testing.assert_allclose(
        skeletons["123"].contact_jacobian(q2) @ v2, skeletons["213"].contact_jacobian(q) @ v,
        atol=1e-7,
    )  # fmt: skip


def test_derivatives_of_the_other_sequence(skeletons):
    skeleton, random = skeletons["123"], np.random.default_rng(5)
    q, v, a, e, w = (random.normal(scale=s, size=16) for s in (0.4, 2.0, 9.0, 1.0, 1.0))
    multipliers, nu = random.normal(scale=50.0, size=(2, 14))
    none = np.zeros(14)

    def residual(at):
        return skeleton.residual_derivatives(at, v, a, multipliers)[0]

    def slope(at):
        parts = skeleton.residual_derivatives(at, v, a, multipliers)
        return w @ parts[1] + nu @ skeleton.contact_velocity_derivative(at, e)

    shift = 1e-6 * np.eye(16)

    def differences(function):
        return np.stack([(function(q + s) - function(q - s)) / 2e-6 for s in shift], -1)

    _, by_q, _, mass = skeleton.residual_derivatives(q, v, a, multipliers)
    expected = differences(residual)
    np.testing.assert_allclose(by_q, expected, atol=1e-6 * np.abs(expected).max())
    np.testing.assert_allclose(mass, skeleton.mass_matrix(q), atol=1e-9)
    weights = Weights(w[None], nu[None], none[None])
    curvature = DynamicsCurvature(skeleton).evaluate(
        q[None], v[None], a[None], multipliers[None], e[None], weights
    )
    expected = differences(slope)
    np.testing.assert_allclose(curvature.qq[0], expected, atol=1e-6 * np.abs(expected).max())


# Reference and study ---------------------------------------------------------------------------


def test_the_reference_keeps_its_postures(skeletons):
    reference = Reference.embedded("spatial")
    other = in_sequence(reference, "123")
    tau = np.linspace(0.0, 1.0, 37)
    q, q2 = reference.coordinate_values(tau), other.coordinate_values(tau)
    np.testing.assert_allclose(q2, convert(q, "213", "123"), atol=1e-6)
    assert np.degrees(np.abs(q2 - q)).max() > 0.5
    np.testing.assert_allclose(
        skeletons["213"].contact_points(q), skeletons["123"].contact_points(q2), atol=1e-6
    )
    assert in_sequence(reference, "213") is reference
    planar = Reference.embedded("planar")
    assert in_sequence(planar, "123") is planar


def test_a_study_has_walker_and_reference_in_one_sequence():
    study = GaitStudy.spatial().with_settings(sequence="123")
    tau = np.array([0.1, 0.6])
    q = GaitStudy.spatial().reference_walk.coordinate_values(tau)
    np.testing.assert_allclose(
        study.walker.skeleton.contact_points(study.reference_walk.coordinate_values(tau)),
        GaitStudy.spatial().walker.skeleton.contact_points(q), atol=1e-6,
    )  # fmt: skip


def test_a_planar_walker_has_no_sequence():
    with pytest.raises(InvalidInput, match="sequence is '123'"):
        GaitStudy.planar().with_settings(sequence="123").formulation()
