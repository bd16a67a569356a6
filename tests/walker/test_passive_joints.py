"""Passive moments: published check values, derivatives, signs, scaling."""

from __future__ import annotations

import numpy as np
import pytest

from drakegait.errors import DrakegaitError
from drakegait.walker import coordinates
from drakegait.walker.passive_joints import PassiveJoints, PassiveSettings
from drakegait.walker.subject import Subject

# hip flexion / knee flexion / DORSIflexion in degrees; moments in hip flexion, knee flexion and
# ankle PLANTARflexion, N m (Riener & Edrich's formulas evaluated by hand).
TABLE = [
    ((0, 0, 0), (8.58, 10.42, 6.39)),
    ((28, 5, 0), (0.58, 8.83, 5.70)),
    ((5, 10, 8), (7.40, 4.06, 11.67)),
    ((-15, 8, 12), (19.03, 3.64, 17.75)),
    ((-10, 40, -15), (14.93, -4.35, -0.66)),
    ((20, 62, 0), (7.12, -4.08, 0.95)),
    ((90, 90, 0), (0.30, -3.54, -0.11)),
    ((20, 120, 0), (8.25, -10.23, -0.80)),
    ((0, 0, 20), (8.58, 19.55, 42.36)),
]


def posture(kind: str, side: str = "r", **degrees: float) -> np.ndarray:
    """Plant coordinates of a posture given by anatomical names and degrees."""
    q = np.zeros(len(coordinates.names(kind)))
    for name, value in degrees.items():
        q[coordinates.position(kind, f"{name}_{side}")] = np.radians(value)
    return coordinates.to_plant(kind, q)


@pytest.mark.parametrize("kind", coordinates.SKELETONS)
@pytest.mark.parametrize("side", ["r", "l"])
@pytest.mark.parametrize(("angles", "moments"), TABLE)
def test_published_sagittal_moments(kind, side, angles, moments):
    hip, knee, ankle = angles
    q = posture(kind, side, hip_flexion=hip, knee_flexion=knee, ankle_dorsiflexion=ankle)
    forces = coordinates.to_anatomical(kind, PassiveJoints(kind).forces(q, np.zeros_like(q)))
    where = coordinates.index(kind)
    found = [
        forces[where[f"hip_flexion_{side}"]],
        forces[where[f"knee_flexion_{side}"]],
        -forces[where[f"ankle_dorsiflexion_{side}"]],
    ]
    np.testing.assert_allclose(found, moments, atol=0.006)


@pytest.mark.parametrize("model", ["riener_edrich", "double_exponential"])
@pytest.mark.parametrize("side", ["r", "l"])
def test_every_joint_is_pushed_back_at_both_ends_of_its_range(model, side):
    passive = PassiveJoints("spatial", settings=PassiveSettings(model=model))
    ends = {
        "hip_flexion": (-60, 130),
        "knee_flexion": (-12, 160),
        "ankle_dorsiflexion": (-60, 40),
        "hip_adduction": (-50, 50),
        "hip_rotation": (-75, 75),
    }
    for joint, (low, high) in ends.items():
        row = coordinates.position("spatial", f"{joint}_{side}")
        for angle, sign in ((low, 1), (high, -1)):
            q = posture("spatial", side, **{joint: angle})
            force = coordinates.to_anatomical("spatial", passive.forces(q, 0 * q))[row]
            assert sign * force > 3.0, (joint, angle)


def test_lateral_moments_vanish_in_gait_and_are_odd():
    passive = PassiveJoints("spatial")
    row = coordinates.position("spatial", "hip_adduction_r")
    values = [
        passive.forces(posture("spatial", hip_adduction=angle), np.zeros(16))[row]
        for angle in (20, -20, 45, -45)
    ]
    assert 0 < abs(values[0]) < 0.005
    np.testing.assert_allclose(values[0::2], np.negative(values[1::2]), rtol=1e-12)


def test_double_exponential_of_the_knee_by_hand():
    passive = PassiveJoints("planar", settings=PassiveSettings(model="double_exponential"))
    bend = np.radians(20.0)  # flexion; the formula counts extension
    by_hand = -(-6.09 * np.exp(33.94 * (-bend - 0.13)) + 11.03 * np.exp(-11.33 * (-bend + 2.4)))
    q = posture("planar", knee_flexion=20.0)
    row = coordinates.position("planar", "knee_flexion_r")
    assert passive.forces(q, 0 * q)[row] == pytest.approx(by_hand, rel=1e-12)


@pytest.mark.parametrize("kind", coordinates.SKELETONS)
@pytest.mark.parametrize("side", ["r", "l"])
@pytest.mark.parametrize(
    ("joint", "angle", "moment"),  # rad and N m, anatomical; the other term is below 1e-4 there
    [
        ("hip_flexion", 1.81, -2.44), ("hip_flexion", -0.6981, 1.51),
        ("knee_flexion", -0.13, 6.09), ("knee_flexion", 2.4, -11.03),
        ("ankle_dorsiflexion", 0.52, -2.03), ("ankle_dorsiflexion", -0.74, 0.18),
    ],
)  # fmt: skip
def test_double_exponential_at_the_ends_of_the_range(kind, side, joint, angle, moment):
    """There one term is its factor (Anderson 1999)."""
    passive = PassiveJoints(kind, settings=PassiveSettings(model="double_exponential"))
    q = posture(kind, side, **{joint: np.degrees(angle)})
    forces = coordinates.anatomical_signs(kind) * passive.forces(q, 0 * q)
    assert forces[coordinates.position(kind, f"{joint}_{side}")] == pytest.approx(moment, abs=1e-3)


@pytest.mark.parametrize("kind", coordinates.SKELETONS)
@pytest.mark.parametrize("model", ["riener_edrich", "double_exponential"])
def test_derivatives_agree_with_differences(kind, model):
    settings = PassiveSettings(model=model, damping_ankle=0.3, scale=1.4)
    passive = PassiveJoints(kind, Subject(height=1.7), settings)
    rng = np.random.default_rng(1)
    n = len(coordinates.names(kind))
    q, v = rng.normal(scale=0.6, size=(2, 3, n))  # beyond the cap of the exponents too
    dq, dv = passive.derivatives(q)
    h = 1e-6
    for i, e in enumerate(np.eye(n)):
        change = (passive.forces(q + h * e, v) - passive.forces(q - h * e, v)) / (2 * h)
        np.testing.assert_allclose(dq[..., i], change, rtol=1e-6, atol=1e-5)
        change = (passive.forces(q, v + e) - passive.forces(q, v - e)) / 2
        np.testing.assert_allclose(np.broadcast_to(dv[:, i], (3, n)), change, atol=1e-9)
    # One instant gives what many give.
    np.testing.assert_allclose(passive.forces(q, v)[1], passive.forces(q[1], v[1]), rtol=1e-12)


@pytest.mark.parametrize("kind", coordinates.SKELETONS)
@pytest.mark.parametrize("model", ["riener_edrich", "double_exponential"])
def test_curvature_agrees_with_differences_of_the_derivatives(kind, model):
    passive = PassiveJoints(kind, Subject(height=1.7), PassiveSettings(model=model, scale=1.4))
    rng = np.random.default_rng(3)
    n = len(coordinates.names(kind))
    q = rng.normal(scale=0.6, size=(4, n))  # beyond the cap of the exponents too
    weights = rng.normal(size=q.shape)
    found = passive.curvature(q, weights)

    def slope(q):
        return np.einsum("...i,...ij->...j", weights, passive.derivatives(q)[0])

    h = 1e-6
    for i, e in enumerate(np.eye(n)):
        change = (slope(q + h * e) - slope(q - h * e)) / (2 * h)
        np.testing.assert_allclose(found[..., i], change, rtol=1e-6, atol=1e-4)
    np.testing.assert_allclose(found, np.swapaxes(found, -1, -2), rtol=1e-12)
    np.testing.assert_allclose(passive.curvature(q[1], weights[1]), found[1], rtol=1e-12)


def test_beyond_the_cap_nothing_bends():
    passive = PassiveJoints("spatial")
    row = coordinates.position("spatial", "hip_adduction_r")
    postures = [posture("spatial", hip_adduction=angle) for angle in (60.0, 80.0)]
    bent = [passive.curvature(q, np.ones(16))[row, row] for q in postures]
    assert abs(bent[0]) > 1e3
    assert abs(bent[1]) < 1e-6


def test_terms_grow_only_linearly_far_outside_the_range():
    passive = PassiveJoints("spatial")
    q = posture("spatial", knee_flexion=-120.0)
    far = [passive.forces(k * q, 0 * q) for k in (1.0, 2.0, 3.0)]
    assert np.all(np.isfinite(far))
    first, second, third = np.array(far)[:, coordinates.position("spatial", "knee_flexion_r")]
    assert third - second == pytest.approx(second - first, rel=1e-6)
    assert third < 3e4


def test_damping_takes_power_from_knee_and_hip_only():
    passive = PassiveJoints("spatial")
    q, v = np.zeros(16), np.ones(16)
    change = passive.forces(q, v) - passive.forces(q, 0 * v)
    expected = {"hip_flexion": 1.0, "hip_adduction": 1.0, "hip_rotation": 0.1, "knee_flexion": 0.4}
    for name, value in zip(coordinates.names("spatial"), change, strict=True):
        assert value == pytest.approx(-expected.get(name[:-2], 0.0)), name


def test_elastic_moments_scale_with_mass_times_height_and_mirror_images_are_equal():
    rng = np.random.default_rng(2)
    q = rng.normal(scale=0.3, size=16)
    rest = np.zeros(16)
    default = PassiveJoints("spatial").forces(q, rest)
    heavy = PassiveJoints("spatial", Subject(mass=90.0, height=1.5)).forces(q, rest)
    np.testing.assert_allclose(heavy, default * 90 * 1.5 / (75 * 1.8), rtol=1e-12)
    mirrored = PassiveJoints("spatial").forces(coordinates.mirror("spatial", q), rest)
    np.testing.assert_allclose(mirrored, coordinates.mirror("spatial", default), atol=1e-12)
    none = PassiveJoints("spatial", settings=PassiveSettings(scale=0.0)).forces(q, rest)
    np.testing.assert_array_equal(none, 0.0)


def test_unknown_model_is_refused():
    with pytest.raises(DrakegaitError, match="riener_edrich"):
        PassiveSettings(model="riener")
