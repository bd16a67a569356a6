"""Inverse dynamics of the reference stride: identities, limits, and what is known of walking."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest

from drakegait.report.reference_dynamics import reference_dynamics
from drakegait.study import GaitStudy
from drakegait.walker.disorders import Prosthesis


@pytest.fixture(params=["spatial", "planar"])
def study(request):
    return getattr(GaitStudy, request.param)()


def test_work_of_the_joints_is_what_the_body_and_the_feet_keep(study):
    """Over a stride the energy is what it was: joints and ground contacts do no net work, but for
    the residual and the contacts, whose feet are off their prints by millimetres."""
    found = reference_dynamics(study)
    period = study.reference_walk.stride_time
    work = found.powers.sum(axis=1).mean() * period
    amount = np.abs(found.powers).sum(axis=1).mean() * period
    assert abs(work) < 0.1 * amount


def test_the_trunk_is_borne(study):
    found = reference_dynamics(study)
    weight = study.subject.mass * 9.81
    assert np.sqrt((found.residual**2).mean(axis=0)).max() < 0.01 * weight


def test_numbers_of_ordinary_walking(study):
    """Winter's peaks per body mass: ankle plantarflexor 1.6 N m/kg, its power 3 to 3.5 W/kg, knee
    extensor 0.6, hip extensor and flexor 0.6 to 0.9."""
    found, mass = reference_dynamics(study), study.subject.mass
    moment = dict(zip(found.joints, found.moments.T / mass, strict=True))
    power = dict(zip(found.joints, found.powers.T / mass, strict=True))
    assert 1.3 < -moment["ankle_dorsiflexion_r"].min() < 1.9
    assert 0.40 < moment["ankle_dorsiflexion_r"].argmin() / 400 < 0.55
    assert 2.5 < power["ankle_dorsiflexion_r"].max() < 4.0
    assert 0.4 < -moment["knee_flexion_r"].min() < 0.9
    assert 0.5 < -moment["hip_flexion_r"].min() < 1.1 and 0.5 < moment["hip_flexion_r"].max() < 1.1
    # A leg in the air moves itself only.
    assert np.abs(moment["ankle_dorsiflexion_r"][280:]).max() < 0.1


def test_equal_legs_have_equal_moments(study):
    """The embedded stride is symmetric: left is right, half a stride later."""
    found = reference_dynamics(study)
    for name in ("hip_flexion", "knee_flexion", "ankle_dorsiflexion"):
        right, left = (found.moments[:, found.joints.index(f"{name}_{side}")] for side in "rl")
        assert np.abs(np.roll(left, 200) - right).max() < 0.02 * np.abs(right).max()


def test_it_belongs_to_the_walker_without_changes(study):
    changed = study.with_added_mass("foot_r", 2.0).with_disorder(Prosthesis("r", 4))
    for one, other in zip(
        dataclasses.astuple(reference_dynamics(study))[1:3],
        dataclasses.astuple(reference_dynamics(changed))[1:3],
        strict=True,
    ):
        np.testing.assert_array_equal(one, other)


def test_without_forces_there_is_none(study):
    walk = dataclasses.replace(study.reference_walk, forces=None)
    assert reference_dynamics(study.replace(reference=walk)) is None
