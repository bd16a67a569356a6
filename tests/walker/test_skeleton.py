"""Equations of motion against independent ways to the same numbers."""

from __future__ import annotations

import numpy as np
import pinocchio as pin
import pytest
from pydrake.autodiffutils import AutoDiffXd, ExtractGradient, ExtractValue, InitializeAutoDiff
from skeleton_cases import differences, pinocchio_model, state

from drakegait.quantities import GRAVITY
from drakegait.walker import coordinates
from drakegait.walker.skeleton import Skeleton
from drakegait.walker.subject import SEGMENTS, AddedMass, Subject, segment_properties

KINDS = coordinates.SKELETONS


@pytest.fixture(params=KINDS, name="skeleton", scope="module")
def fixture_skeleton(request) -> Skeleton:
    return Skeleton.load(request.param)


def test_dynamics_agree_with_pinocchio(skeleton):
    model, order = pinocchio_model(skeleton.kind)
    data = model.createData()
    back = np.argsort(order)
    for seed in range(3):
        q, v, a = state(skeleton, seed)
        theirs = pin.crba(model, data, q[back])
        theirs = np.triu(theirs) + np.triu(theirs, 1).T
        np.testing.assert_allclose(skeleton.mass_matrix(q), theirs[np.ix_(order, order)], atol=1e-9)
        gravity = pin.computeGeneralizedGravity(model, data, q[back])[order]
        np.testing.assert_allclose(skeleton.gravity_forces(q), -gravity, atol=1e-9)
        bias = pin.nonLinearEffects(model, data, q[back], v[back])[order] - gravity
        np.testing.assert_allclose(skeleton.bias(q, v), bias, atol=1e-8)
        tau = pin.rnea(model, data, q[back], v[back], a[back])[order]
        np.testing.assert_allclose(skeleton.inverse_dynamics(q, v, a), tau, atol=1e-8)
        pin.computeRNEADerivatives(model, data, q[back], v[back], a[back])
        r, dr_dq, dr_dv, mass = skeleton.residual_derivatives(q, v, a, np.zeros(14))
        np.testing.assert_allclose(r, tau, atol=1e-8)
        np.testing.assert_allclose(dr_dq, data.dtau_dq[np.ix_(order, order)], atol=1e-8)
        np.testing.assert_allclose(dr_dv, data.dtau_dv[np.ix_(order, order)], atol=1e-8)
        np.testing.assert_allclose(mass, skeleton.mass_matrix(q), atol=1e-10)


def test_power_of_the_forces_is_the_rate_of_energy(skeleton):
    q, v, a = state(skeleton)
    h = 1e-5

    def energy(t):
        at = q + t * v + t * t / 2 * a
        return skeleton.kinetic_energy(at, v + t * a) + skeleton.potential_energy(at)

    rate = (energy(h) - energy(-h)) / (2 * h)
    assert rate == pytest.approx(v @ skeleton.inverse_dynamics(q, v, a), rel=1e-6)
    kinetic = v @ skeleton.mass_matrix(q) @ v / 2
    assert skeleton.kinetic_energy(q, v) == pytest.approx(kinetic)


def test_gravity_forces_are_the_slope_of_potential_energy(skeleton):
    q, _, _ = state(skeleton)
    slope = differences(skeleton.potential_energy, q)
    np.testing.assert_allclose(skeleton.gravity_forces(q), -slope, atol=1e-5)


def test_residual_derivatives_agree_with_differences(skeleton):
    q, v, a = state(skeleton)
    multipliers = np.random.default_rng(3).normal(scale=400, size=14)

    def residual(q, v):
        force = skeleton.contact_jacobian(q).T @ multipliers
        return skeleton.inverse_dynamics(q, v, a) - force

    r, dr_dq, dr_dv, _ = skeleton.residual_derivatives(q, v, a, multipliers)
    np.testing.assert_allclose(r, residual(q, v), atol=1e-9)
    np.testing.assert_allclose(dr_dq, differences(lambda x: residual(x, v), q), atol=2e-5)
    np.testing.assert_allclose(dr_dv, differences(lambda x: residual(q, x), v), atol=2e-5)


def test_closed_form_agrees_with_automatic_differentiation(skeleton):
    q, v, a = state(skeleton)
    rng = np.random.default_rng(4)
    multipliers, w = rng.normal(scale=400, size=14), rng.normal(size=skeleton.num_coordinates)
    n = skeleton.num_coordinates
    x = InitializeAutoDiff(np.concatenate([q, v])).ravel()
    auto_q, auto_v = x[:n], x[n:]
    auto = skeleton.inverse_dynamics(auto_q, auto_v, a)
    auto = auto - skeleton.contact_jacobian(auto_q).T @ multipliers
    r, dr_dq, dr_dv, _ = skeleton.residual_derivatives(q, v, a, multipliers)
    np.testing.assert_allclose(ExtractValue(auto).ravel(), r, atol=1e-9)
    np.testing.assert_allclose(ExtractGradient(auto), np.hstack([dr_dq, dr_dv]), atol=1e-9)
    speeds = ExtractGradient(skeleton.contact_jacobian(auto_q) @ w)[:, :n]
    np.testing.assert_allclose(skeleton.contact_velocity_derivative(q, w), speeds, atol=1e-12)


@pytest.mark.parametrize(
    "name",
    [
        "mass_matrix", "gravity_forces", "contact_points", "contact_jacobian", "foot_yaw",
        "center_of_mass", "potential_energy", "bias", "kinetic_energy",
    ],
)  # fmt: skip
def test_both_scalar_types_give_the_same_values_and_slopes(skeleton, name):
    q, v, _ = state(skeleton)
    function = getattr(skeleton, name)
    other = (v,) if name in ("bias", "kinetic_energy") else ()
    auto = np.atleast_1d(function(InitializeAutoDiff(q).ravel(), *other)).ravel()
    assert isinstance(auto[0], AutoDiffXd)
    value = np.atleast_1d(function(q, *other))
    np.testing.assert_allclose(ExtractValue(auto).ravel(), value.ravel(), atol=1e-10)
    slope = differences(lambda x: np.atleast_1d(function(x, *other)).ravel(), q)
    gradient = ExtractGradient(auto)
    gradient = gradient if gradient.size else np.zeros_like(slope)
    np.testing.assert_allclose(gradient, slope, atol=3e-5)


def test_many_instants_at_once_equal_one_at_a_time(skeleton):
    # Enough for the tree in numpy; one at a time they go through Drake.
    q, v, a = (x.reshape(2, 8, -1) for x in state(skeleton, count=16))
    multipliers = np.random.default_rng(5).normal(scale=400, size=(2, 8, 14))
    together = skeleton.residual_derivatives(q, v, a, multipliers)
    calls = {
        "contact_points": (q,), "contact_jacobian": (q,), "foot_yaw": (q,),
        "foot_yaw_gradient": (q,), "contact_velocity_derivative": (q, v), "center_of_mass": (q,),
        "mass_matrix": (q,), "bias": (q, v), "gravity_forces": (q,), "inverse_dynamics": (q, v, a),
        "kinetic_energy": (q, v), "potential_energy": (q,),
    }  # fmt: skip
    results = {name: getattr(skeleton, name)(*given) for name, given in calls.items()}
    poses = skeleton.body_poses(q)
    for at in np.ndindex(2, 8):
        one = skeleton.residual_derivatives(q[at], v[at], a[at], multipliers[at])
        for mine, theirs in zip(one, together, strict=True):
            np.testing.assert_allclose(theirs[at], mine, atol=1e-9)
        for name, given in calls.items():
            mine = getattr(skeleton, name)(*(x[at] for x in given))
            np.testing.assert_allclose(results[name][at], mine, atol=1e-9, err_msg=name)
        np.testing.assert_allclose(poses["foot_l"][1][at], skeleton.body_poses(q[at])["foot_l"][1])


def test_a_changed_posture_in_the_same_array_is_seen(skeleton):
    q, _, _ = state(skeleton)
    before = skeleton.contact_points(q)
    q[0] += 0.25
    np.testing.assert_allclose(skeleton.contact_points(q)[:, 0], before[:, 0] + 0.25)


def rotation(axis: str, angle: float) -> np.ndarray:
    c, s = np.cos(angle), np.sin(angle)
    return {
        "x": np.array([[1, 0, 0], [0, c, -s], [0, s, c]]),
        "y": np.array([[c, 0, s], [0, 1, 0], [-s, 0, c]]),
        "z": np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]]),
    }[axis]


def test_trunk_and_hips_turn_in_the_sequence_213():
    skeleton = Skeleton.load("spatial")
    q, _, _ = state(skeleton)
    poses = skeleton.body_poses(q)
    hat = rotation("y", q[4]) @ rotation("x", q[3]) @ rotation("z", q[5])
    np.testing.assert_allclose(poses["hat"][0], hat, atol=1e-12)
    np.testing.assert_allclose(poses["hat"][1], q[:3], atol=1e-12)
    for side, first in (("r", 6), ("l", 11)):
        hip = rotation("y", q[first + 1]) @ rotation("x", q[first]) @ rotation("z", q[first + 2])
        np.testing.assert_allclose(poses[f"thigh_{side}"][0], hat @ hip, atol=1e-12)
        shank = hat @ hip @ rotation("y", q[first + 3])
        np.testing.assert_allclose(poses[f"shank_{side}"][0], shank, atol=1e-12)
        foot = shank @ rotation("y", q[first + 4])
        np.testing.assert_allclose(poses[f"foot_{side}"][0], foot, atol=1e-12)


def test_names_of_the_angles_tell_their_anatomical_sense():
    skeleton = Skeleton.load("spatial")
    still = skeleton.body_poses(np.zeros(16))
    rest = skeleton.contact_points(np.zeros(16))
    for i, side in enumerate(("r", "l")):
        medial = 1 if side == "r" else -1

        def moved(name, side=side):
            q = np.zeros(16)
            q[coordinates.position("spatial", f"{name}_{side}")] = 0.1
            return skeleton.contact_points(coordinates.to_plant("spatial", q)) - rest

        heel, toe = 2 * i, 2 * i + 1
        assert moved("hip_flexion")[heel, 0] > 0.05
        assert moved("knee_flexion")[heel, 0] < -0.03
        assert moved("ankle_dorsiflexion")[toe, 2] > 0.01
        assert medial * moved("hip_adduction")[heel, 1] > 0.05
        assert medial * moved("hip_rotation")[toe, 1] > 0.01
        assert medial * still[f"thigh_{side}"][1][1] == pytest.approx(-0.0835)
    q = np.zeros(16)
    q[coordinates.position("spatial", "hat_tilt")] = 0.1
    assert skeleton.center_of_mass(q)[0] > 0.01


def mirrored_states(skeleton):
    q, v, a = state(skeleton)
    kind = skeleton.kind
    return (q, v, a), tuple(coordinates.mirror(kind, x) for x in (q, v, a))


def test_mirrored_motion_needs_mirrored_forces(skeleton):
    here, there = mirrored_states(skeleton)
    forces = skeleton.inverse_dynamics(*here)
    expected = coordinates.mirror(skeleton.kind, forces)
    np.testing.assert_allclose(skeleton.inverse_dynamics(*there), expected, atol=1e-9)
    points = skeleton.contact_points(there[0])
    expected = skeleton.contact_points(here[0])[[2, 3, 0, 1]] * np.array([1.0, -1.0, 1.0])
    np.testing.assert_allclose(points, expected, atol=1e-12)


def test_planar_skeleton_is_the_sagittal_part_of_the_spatial_one():
    planar, spatial = Skeleton.load("planar"), Skeleton.load("spatial")
    where = coordinates.positions("spatial", planar.coordinates)
    states = state(planar)
    lifted = [np.zeros(16) for _ in states]
    for full, part in zip(lifted, states, strict=True):
        full[where] = part
    forces = spatial.inverse_dynamics(*lifted)[where]
    np.testing.assert_allclose(planar.inverse_dynamics(*states), forces, atol=1e-9)
    rows = planar.contact_jacobian(states[0])
    expected = spatial.contact_jacobian(lifted[0])[:, where]
    np.testing.assert_allclose(rows, expected, atol=1e-12)
    np.testing.assert_array_equal(rows[[1, 4, 6, 8, 11, 13]], 0.0)


def test_total_mass_and_centre_of_mass(skeleton):
    assert skeleton.total_mass == pytest.approx(75.0)
    q, _, _ = state(skeleton)
    poses, segments = skeleton.body_poses(q), segment_properties(Subject())
    assert set(poses) == set(SEGMENTS)
    moment = sum(
        segments[name].mass * (poses[name][1] + poses[name][0] @ segments[name].com)
        for name in SEGMENTS
    )
    np.testing.assert_allclose(skeleton.center_of_mass(q), moment / 75.0, atol=1e-12)
    x = coordinates.position(skeleton.kind, "hat_x")
    assert skeleton.mass_matrix(q)[x, x] == pytest.approx(75.0)
    np.testing.assert_allclose(
        skeleton.gravity_forces(q)[coordinates.position(skeleton.kind, "hat_z")], -75 * GRAVITY
    )


@pytest.mark.parametrize("kind", KINDS)
def test_added_mass_adds_its_own_term_to_the_equations(kind):
    """M grows by m J^T J of the point, gravity by m J^T g: nothing else changes."""
    light, heavy = Skeleton.load(kind), Skeleton.load(kind, added_masses=[
        AddedMass("foot_r", 2.0, (0.142, 0.0, -0.0702))])  # fmt: skip
    q, _, _ = state(light)
    jacobian = light.contact_jacobian(q)[3:6]  # the point is the toe
    grown = light.mass_matrix(q) + 2.0 * jacobian.T @ jacobian
    np.testing.assert_allclose(heavy.mass_matrix(q), grown, atol=1e-10)
    pull = light.gravity_forces(q) + 2.0 * jacobian.T @ [0.0, 0.0, -GRAVITY]
    np.testing.assert_allclose(heavy.gravity_forces(q), pull, atol=1e-10)
    assert heavy.total_mass == pytest.approx(77.0)


@pytest.mark.parametrize("kind", KINDS)
def test_mass_matrix_scales_with_mass_and_height(kind):
    default = Skeleton.load(kind)
    other = Skeleton.load(kind, Subject(height=1.5, mass=100.0))
    q, _, _ = state(default)
    length, mass = 1.5 / 1.8, 100 / 75
    turns = coordinates.rotations(kind)
    size = np.where(turns, length, 1.0)  # a rotation moves a longer limb further
    scaled = mass * size[:, None] * size * default.mass_matrix(np.where(turns, q, 0.0))
    np.testing.assert_allclose(other.mass_matrix(np.where(turns, q, 0.0)), scaled, atol=1e-9)
    flat = length * default.contact_points(np.where(turns, q, 0.0))
    np.testing.assert_allclose(other.contact_points(np.where(turns, q, 0.0)), flat, atol=1e-12)
