"""The embedded gaits: where the feet stand, mirror images, extremes, derivatives, scaling."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest

from drakegait.errors import InvalidInput, UnknownName
from drakegait.reference import DeviationSettings, Reference
from drakegait.walker.coordinates import coordinates, index, mirror, names, to_anatomical
from drakegait.walker.subject import Subject

TAU = np.arange(500) / 500
ALL = [("spatial", x) for x in ("normal", "asymmetric", "measured")]
ALL += [("planar", x) for x in ("planar", "normal", "asymmetric", "measured")]
BODY_WEIGHT = 75.0 * 9.81


def _rotation(axis: str, angle: np.ndarray) -> np.ndarray:
    i, j = {"x": (1, 2), "y": (2, 0), "z": (0, 1)}[axis]
    matrix = np.zeros(angle.shape + (3, 3))
    matrix[...] = np.eye(3)
    matrix[..., i, i] = matrix[..., j, j] = np.cos(angle)
    matrix[..., i, j], matrix[..., j, i] = -np.sin(angle), np.sin(angle)
    return matrix


def _contact_points(reference: Reference, tau: np.ndarray, height: float) -> dict[str, np.ndarray]:
    """Heel and toe (num_instants, 3) from the chain of body segments, written out by hand."""
    values = reference.coordinate_values(tau)
    named = dict(zip(reference.coordinates, values.T, strict=True))
    zero = np.zeros_like(tau)
    turn = lambda axis, name: _rotation(axis, named.get(name, zero))  # noqa: E731
    hat = turn("y", "hat_tilt") @ turn("x", "hat_list") @ turn("z", "hat_rotation")
    advance = reference.foot_placement.stride_length * tau
    origin = np.stack([named["hat_x"] + advance, named.get("hat_y", zero), named["hat_z"]], -1)
    half_width = 0.0464 * height if reference.kind == "spatial" else 0.0
    points = {}
    for side, sign in (("r", -1.0), ("l", 1.0)):
        thigh = hat @ turn("y", f"hip_flexion_{side}") @ turn("x", f"hip_adduction_{side}")
        thigh = thigh @ turn("z", f"hip_rotation_{side}")
        shank = thigh @ turn("y", f"knee_flexion_{side}")
        foot = shank @ turn("y", f"ankle_dorsiflexion_{side}")
        ankle = origin + hat @ np.array([0.0, sign * half_width, 0.0])
        ankle = ankle - height * (0.245 * thigh[..., 2] + 0.246 * shank[..., 2])
        points[f"heel_{side}"] = ankle + height * foot @ np.array([-0.03333, 0.0, -0.039])
        points[f"toe_{side}"] = ankle + height * foot @ np.array([0.07889, 0.0, -0.039])
    return points


@pytest.mark.parametrize("height", [1.80, 1.55])
@pytest.mark.parametrize(
    ("kind", "name"), [("spatial", "normal"), ("spatial", "asymmetric"), ("planar", "planar")]
)
def test_feet_stand_where_the_placement_says(kind, name, height):
    reference = Reference.embedded(kind, Subject(height=height), name)
    placement = reference.foot_placement
    ends = np.cumsum(reference.phase_fractions)
    phase = np.searchsorted(ends, TAU, side="right") + 1
    points = _contact_points(reference, TAU, height)
    stands = {
        "heel_r": (-0.03333, (1, 2, 3), 0.0), "toe_r": (0.07889, (4, 5, 6), 0.0),
        "heel_l": (-0.03333, (5, 6, 7), placement.step_length_left),
        "toe_l": (0.07889, (8,), placement.step_length_left),
    }  # fmt: skip
    squares = []
    for point, (forward, phases, x) in stands.items():
        right = point.endswith("r")
        heading = placement.toe_angle_right if right else placement.toe_angle_left
        side = -0.5 if right else 0.5
        stand = np.array([x, side * placement.step_width, 0.0])
        stand = stand + forward * height * np.array([np.cos(heading), np.sin(heading), 0.0])
        squares.append(((points[point][np.isin(phase, phases)] - stand) ** 2).sum(axis=1))
    assert np.sqrt(np.concatenate(squares).mean()) < 0.0020 * height / 1.80
    assert min(p[:, 2].min() for p in points.values()) > -0.0075


def test_measured_gait_slides_but_stands_on_the_ground():
    reference = Reference.embedded("spatial", name="measured")
    points = _contact_points(reference, np.linspace(0.13, 0.33, 21), 1.80)
    middle = 0.5 * (points["heel_r"] + points["toe_r"]).mean(axis=0)
    assert abs(middle[2]) < 0.01
    assert abs(middle[0] - 0.041) < 0.01  # half way from heel to toe, ankle at x = 0
    assert reference.speed == pytest.approx(1.323 * np.sqrt(1.80 / 1.70), rel=2e-3)


@pytest.mark.parametrize(("kind", "name"), [("spatial", "normal"), ("planar", "planar")])
def test_left_side_is_the_mirror_image_half_a_stride_later(kind, name):
    reference = Reference.embedded(kind, name=name)
    now, later = reference.coordinate_values(TAU), reference.coordinate_values(TAU + 0.5)
    assert np.abs(now - mirror(kind, later)).max() < 2e-5
    forces, shifted = reference.ground_reactions(TAU), reference.ground_reactions(TAU + 0.5)
    assert np.abs(forces[:, 1] - shifted[:, 0] * [1, -1, 1]).max() < 1e-6 * BODY_WEIGHT
    assert reference.phase_fractions[:4] == pytest.approx(reference.phase_fractions[4:])
    other = Reference.embedded(kind, name="asymmetric")
    values = other.coordinate_values(TAU)
    assert np.abs(values - mirror(kind, other.coordinate_values(TAU + 0.5))).max() > 0.05


def test_extremes_have_the_anatomical_sense():
    reference = Reference.embedded("spatial")
    tau = np.arange(2000) / 2000
    degrees = np.degrees(to_anatomical("spatial", reference.coordinate_values(tau)))
    expected = {  # min, max, percent of the stride at min and max
        "hip_flexion_r": (-19.3, 28.4, 55.1, 90.8), "knee_flexion_r": (4.6, 61.3, 98.5, 74.7),
        "ankle_dorsiflexion_r": (-22.3, 17.7, 66.2, 43.8),
        "hip_adduction_r": (-1.6, 6.1, 67.2, 18.6), "hip_adduction_l": (-1.6, 6.1, 17.2, 68.6),
        "hip_rotation_r": (-7.9, 1.6, 59.7, 80.0), "hip_rotation_l": (-7.9, 1.6, 9.7, 30.0),
        "hip_flexion_l": (-19.3, 28.4, 5.1, 40.8), "hat_tilt": (-0.7, 1.9, 6.2, 27.4),
        "hat_rotation": (-4.4, 4.4, 10.0, 60.0),
    }  # fmt: skip
    for name, (low, high, low_at, high_at) in expected.items():
        curve = degrees[:, index("spatial")[name]]
        assert curve.min() == pytest.approx(low, abs=0.06), name
        assert curve.max() == pytest.approx(high, abs=0.06), name
        assert 100 * tau[curve.argmin()] == pytest.approx(low_at, abs=0.3) or name == "hat_tilt"
        assert 100 * tau[curve.argmax()] == pytest.approx(high_at, abs=0.3) or name == "hat_tilt"


@pytest.mark.parametrize(("kind", "name"), ALL)
def test_derivatives_agree_with_differences(kind, name):
    reference = Reference.embedded(kind, name=name)
    tau, step = np.array([0.013, 0.31, 0.5, 0.77, 0.999]), 1e-5
    for function, orders in ((reference.coordinate_values, 3), (reference.ground_reactions, 1)):
        for order in range(orders):
            numeric = (function(tau + step, order) - function(tau - step, order)) / (2 * step)
            exact = function(tau, order + 1)
            assert np.allclose(numeric, exact, rtol=1e-4, atol=1e-5 * np.abs(exact).max())


@pytest.mark.parametrize(("kind", "name"), ALL)
def test_shapes_and_period(kind, name):
    reference = Reference.embedded(kind, name=name)
    n = len(coordinates(kind))
    assert reference.coordinates == names(kind) and reference.name == name
    for tau in (0.3, np.array([0.3]), np.full((2, 4), 0.3)):
        assert reference.coordinate_values(tau).shape == np.shape(tau) + (n,)
        assert reference.ground_reactions(tau, 2).shape == np.shape(tau) + (2, 3)
    assert np.allclose(reference.coordinate_values(TAU), reference.coordinate_values(TAU + 3))
    assert np.allclose(reference.ground_reactions(TAU), reference.ground_reactions(TAU - 2))
    assert len(reference.phase_fractions) == 8
    assert sum(reference.phase_fractions) == pytest.approx(1.0, abs=1e-14)
    with pytest.raises(dataclasses.FrozenInstanceError):
        reference.kind = "planar"


@pytest.mark.parametrize("kind", ["spatial", "planar"])
def test_forces_carry_the_body_and_do_not_ring(kind):
    reference = Reference.embedded(kind)
    forces = reference.ground_reactions(TAU)
    total = forces.sum(axis=1).mean(axis=0)
    assert total[2] == pytest.approx(BODY_WEIGHT, rel=0.005)
    assert np.abs(total[:2]).max() < 0.005 * BODY_WEIGHT
    toe_off = sum(reference.phase_fractions[:6])
    swing = (toe_off + 0.02 < TAU) & (TAU < 0.98)
    assert np.abs(forces[swing, 0]).max() < 0.003 * BODY_WEIGHT
    assert forces[:, 0, 0].argmin() < 0.3 * 500 < forces[:, 0, 0].argmax() < 0.6 * 500
    rows = reference.ground_reactions(np.array([0.0, 0.01, 0.02]))[:, 1, 2] / BODY_WEIGHT
    assert rows == pytest.approx([1.08930, 1.04851, 0.99148])
    assert (forces[:, :, 1] == 0).all() == (kind == "planar")


def test_scaling_with_height_and_mass():
    base, tall = Reference.embedded("spatial"), Reference.embedded("spatial", Subject(height=2.0))
    ratio = 2.0 / 1.80
    assert tall.stride_time == pytest.approx(base.stride_time * np.sqrt(ratio))
    assert tall.speed == pytest.approx(base.speed * np.sqrt(ratio))
    assert tall.foot_placement == base.foot_placement.scaled(ratio)
    scale = np.where([c.is_rotation for c in coordinates("spatial")], 1.0, ratio)
    assert np.allclose(tall.coordinate_values(TAU), scale * base.coordinate_values(TAU))
    heavy = Reference.embedded("spatial", Subject(mass=150.0))
    assert np.allclose(heavy.ground_reactions(TAU), 2 * base.ground_reactions(TAU))
    assert base.speed == pytest.approx(1.3461, abs=2e-4)
    assert base.foot_placement.stride_length == pytest.approx(0.80068 * 1.80, abs=1e-4)


def test_sigma_is_the_rms_deviation():
    reference = Reference.embedded("spatial")
    sigma = dict(zip(reference.coordinates, reference.coordinate_sigma, strict=True))
    expected = {
        "hip_flexion_r": 0.2937, "knee_flexion_l": 0.3002, "ankle_dorsiflexion_r": 0.1888,
        "hip_adduction_r": 0.0382, "hip_rotation_l": 0.0556, "hat_list": 0.0325,
        "hat_tilt": 0.0154, "hat_rotation": 0.0539,
    }  # fmt: skip
    for name, value in expected.items():
        assert sigma[name] == pytest.approx(value, abs=1e-4)
    # published for this subject: 0.084, 0.019, 0.41 of the force before it was rescaled by 1.11
    assert reference.force_sigma[0] / BODY_WEIGHT == pytest.approx([0.084, 0.019, 0.41], rel=0.15)
    assert np.allclose(reference.force_sigma[0], reference.force_sigma[1])


def test_printed_rule_divides_by_root_time_and_leaves_weights():
    rms = Reference.embedded("spatial")
    printed = dataclasses.replace(rms, deviation=DeviationSettings(sigma_rule="printed"))
    root = np.sqrt(rms.stride_time)
    assert np.allclose(printed.coordinate_sigma * root, rms.coordinate_sigma)
    assert np.allclose(printed.force_sigma * root, rms.force_sigma)
    assert np.allclose(printed.coordinate_weight, rms.coordinate_weight)
    assert np.allclose(printed.force_weight, rms.force_weight)


@pytest.mark.parametrize("kind", ["spatial", "planar"])
def test_weights_by_group(kind):
    angle = np.array([c.is_rotation for c in coordinates(kind)])
    three = Reference.embedded(kind)
    single = Reference.embedded(kind, deviation=DeviationSettings(groups="single"))
    for group in (angle, ~angle):
        sigma, omega = three.coordinate_sigma[group], three.coordinate_weight[group]
        assert np.allclose(omega, sigma / sigma.max()) and omega.max() == 1.0
    sigma = single.coordinate_sigma
    assert np.allclose(single.coordinate_weight, sigma / sigma.max())
    assert three.force_weight[:, 2] == pytest.approx([1.0, 1.0])
    assert (three.force_weight[:, 1] == 0).all() == (kind == "planar")
    assert (three.coordinate_sigma > 0).all() and (three.force_sigma > 0).all()


def test_unknown_names_are_listed():
    with pytest.raises(UnknownName, match="spatial, planar"):
        Reference.embedded("flat")
    with pytest.raises(UnknownName, match="normal, asymmetric, measured"):
        Reference.embedded("spatial", name="planar")
    with pytest.raises(UnknownName, match="did you mean 'normal'"):
        Reference.embedded("planar", name="norml")
    with pytest.raises(UnknownName, match="sigma_rule"):
        DeviationSettings(sigma_rule="std")
    with pytest.raises(InvalidInput, match="derivative of the forces"):
        Reference.embedded("planar").ground_reactions(0.1, 3)
