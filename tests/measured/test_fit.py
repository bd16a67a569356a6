"""The least-squares fit: derivatives, and a stride that needs no change gets none."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from measured_cases import SUBJECT

from drakegait.measured.fit import INSTANTS, StrideFit, StrideTarget
from drakegait.measured.levenberg_marquardt import minimise
from drakegait.reference.reference import Reference
from drakegait.walker.coordinates import names
from drakegait.walker.rotation_sequence import rotation_angles, rotation_matrix
from drakegait.walker.skeleton import Skeleton

TAU = np.arange(INSTANTS) / INSTANTS


@pytest.fixture(params=["spatial", "planar"])
def fit(request):
    reference = Reference.embedded(request.param, SUBJECT)
    forces = reference.ground_reactions(TAU).sum(axis=1)
    events = np.concatenate([[0.0], np.cumsum(reference.phase_fractions)[:-1]])
    target = StrideTarget(
        coordinates=reference.coordinate_values(TAU), forces=forces, events=events,
        placement=reference.foot_placement, stride_time=reference.stride_time,
    )  # fmt: skip
    return StrideFit(Skeleton.load(request.param, SUBJECT), target)


def test_slopes_are_the_derivatives_of_the_rows(fit):
    rng = np.random.default_rng(3)
    x = np.concatenate([fit._measured.ravel(), fit._free_placement()])
    x = x + 0.02 * rng.standard_normal(x.size)
    way = rng.standard_normal(x.size)
    step = 1e-6
    difference = (fit._rows(x + step * way) - fit._rows(x - step * way)) / (2.0 * step)
    slopes = fit._slopes(x) @ way
    assert np.abs(slopes - difference).max() < 1e-5 * np.abs(slopes).max()


def test_a_stride_on_the_ground_stays_what_it_is(fit):
    _, after = fit.solve()
    change = fit.spline.evaluate(after.coefficients, TAU).T - fit.target.coordinates
    turns = fit._angles
    assert np.degrees(np.sqrt((change[:, turns] ** 2).mean())) < 0.5
    assert np.sqrt(np.nanmean(fit.contact_errors(after)[:, :6] ** 2)) < 0.002
    assert np.nanmin(fit.free_heights(after)) > -0.002


def test_a_bent_stride_is_put_back_on_its_feet(fit):
    """Ankles that are 4 degrees off are straightened; standing points come within 2 mm."""
    coordinates = fit.target.coordinates.copy()
    coordinates[:, -1] += np.radians(4.0)
    bent = StrideFit(
        fit.skeleton,
        StrideTarget(coordinates=coordinates, forces=fit.target.forces, events=fit.target.events,
                     placement=fit.target.placement, stride_time=fit.target.stride_time),
    )  # fmt: skip
    before, after = bent.solve()
    worst = [np.sqrt(np.nanmean(bent.contact_errors(x)[:, 7:13] ** 2)) for x in (before, after)]
    assert worst[0] > 0.003 and worst[1] < 0.002


def test_the_trunk_does_not_twitch_to_please_the_forces(fit):
    """Forces that contradict the motion four times a stride move it by tenths of a degree only."""
    forces = fit.target.forces.copy()
    weight = fit.skeleton.total_mass * 9.81
    forces[:, 0] += 0.1 * weight * np.sin(8.0 * np.pi * TAU)
    shaken = StrideFit(fit.skeleton, replace(fit.target, forces=forces))
    _, after = shaken.solve()
    change = fit.spline.evaluate(after.coefficients, TAU, 2).T - fit.spline.evaluate(
        shaken._measured, TAU, 2
    ).T
    tilt = names(fit.skeleton.kind).index("hat_tilt")
    assert np.degrees(np.abs(change[:, tilt]).max()) < 0.4 * (8.0 * np.pi) ** 2


def test_least_squares_of_a_line():
    x = np.linspace(0.0, 1.0, 30)
    found = minimise(
        lambda p: p[0] * np.exp(p[1] * x) - 2.0 * np.exp(-1.5 * x),
        lambda p: np.stack([np.exp(p[1] * x), p[0] * x * np.exp(p[1] * x)], axis=-1),
        np.array([1.0, 0.0]),
        1e-14,
    )
    assert found == pytest.approx([2.0, -1.5], abs=1e-6)


def test_angles_and_matrices_are_inverse():
    bag = np.random.default_rng(5).uniform(-1.2, 1.2, (50, 3))
    matrix = rotation_matrix(bag)
    assert rotation_angles(matrix) == pytest.approx(bag)
    unit = matrix @ np.swapaxes(matrix, -1, -2)
    assert np.abs(unit - np.eye(3)).max() < 1e-12
    tilt = rotation_matrix(np.array([0.3, 0.0, 0.0])) @ [1.0, 0.0, 0.0]
    assert tilt[2] < 0.0  # leaning forward lowers what is in front


def test_velocity_of_the_centre_of_mass(fit):
    q = np.random.default_rng(7).uniform(-0.5, 0.5, fit.skeleton.num_coordinates)
    step = 1e-6 * np.eye(q.size)
    center = fit.skeleton.center_of_mass
    difference = (center(q + step) - center(q - step)) / 2e-6
    assert fit.skeleton.center_of_mass_jacobian(q) == pytest.approx(difference.T, abs=1e-8)
