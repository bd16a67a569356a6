"""Torques at the toe of the foot that stands alone: rows, derivatives, and what stays."""

from __future__ import annotations

import numpy as np
import pytest
from program_cases import dense_jacobian, directional_difference
from program_cases import jiggled as any_jiggled
from program_cases import program as any_program

from drakegait.loads import loads_along
from drakegait.motion import Motion
from drakegait.program.lagrangian_hessian import LagrangianHessian
from drakegait.study import GaitStudy
from drakegait.walker import feet
from drakegait.walker.feet import ContactSettings
from drakegait.walker.skeleton import Skeleton

ALLOWED = ContactSettings(toe_torque=True)
MODELS = ("spatial", "planar", "spatial-symmetric", "planar-symmetric")
FORMS = ("lifted", "projected")
# One flat foot and one toe for each leg that stands alone.
POINTS = {True: (0, 0, 1, 1), False: (0, 0, 1, 1, 0, 0, 1, 1)}


def program(model: str, form: str = "lifted"):
    points = POINTS[model.endswith("symmetric")]
    return any_program(model, form, limits=(), contact=ALLOWED, interior_points=points)


def jiggled(model: str, form: str = "lifted") -> np.ndarray:
    points = POINTS[model.endswith("symmetric")]
    return any_jiggled(model, form, limits=(), contact=ALLOWED, interior_points=points)


def names(mask: np.ndarray) -> set[str]:
    return {name for name, holds in zip(feet.TORQUE_NAMES, mask[feet.NUM_ROWS :], strict=True)
            if holds}  # fmt: skip


def test_torques_act_in_phases_3_4_7_8():
    found = [names(feet.active_rows(phase, torques=True)) for phase in range(8)]
    right, left = {"foot_r roll"}, {"foot_l roll"}
    assert found == [set(), set(), right, right | {"foot_r pitch"},
                     set(), set(), left, left | {"foot_l pitch"}]  # fmt: skip
    planar = [names(feet.active_rows(phase, True, True)) for phase in range(8)]
    assert planar == [set()] * 3 + [{"foot_r pitch"}] + [set()] * 3 + [{"foot_l pitch"}]
    for phase in range(8):
        for is_planar in (False, True):
            np.testing.assert_array_equal(
                feet.active_rows(phase, is_planar, True)[: feet.NUM_ROWS],
                feet.active_rows(phase, is_planar),
            )


def test_the_walker_is_then_held_in_every_phase():
    """Contacts, torques and joints together number at least the coordinates."""
    for planar, coordinates, joints in ((False, 16, 10), (True, 9, 6)):
        counts = [feet.active_rows(p, planar, True).sum() + joints for p in range(8)]
        assert min(counts) >= coordinates
        assert min(feet.active_rows(p, planar).sum() + joints for p in range(8)) < coordinates


def test_torques_vanish_where_a_second_foot_comes_or_goes():
    at = [names(feet.loaded_rows_at_start(phase, torques=True)) for phase in range(8)]
    assert [bool(x) for x in at] == [False, False, False, True, False, False, False, True]
    assert at[3] == {"foot_r roll", "foot_r pitch"}


@pytest.mark.parametrize("kind", ["spatial", "planar"])
def test_rows_of_the_skeleton_are_angular_velocities(kind):
    skeleton = Skeleton.load(kind, toe_torque=True)
    plain = Skeleton.load(kind)
    random = np.random.default_rng(0)
    q, w = random.normal(scale=0.4, size=(2, skeleton.num_coordinates))
    rows = skeleton.contact_jacobian(q)
    assert rows.shape == (18, skeleton.num_coordinates)
    np.testing.assert_array_equal(rows[:14], plain.contact_jacobian(q))
    step = 1e-6
    for foot, name in enumerate(("foot_r", "foot_l")):
        turns = [skeleton.body_poses(q + s * step * w)[name][0] for s in (-1, 1)]
        rate = (turns[1] - turns[0]) / (2 * step) @ skeleton.body_poses(q)[name][0].T
        np.testing.assert_allclose(
            rows[14 + 2 * foot : 16 + 2 * foot] @ w, [rate[2, 1], rate[0, 2]], atol=1e-8
        )

    def differences(function):
        shift = step * np.eye(len(q))
        return np.stack([(function(q + s) - function(q - s)) / (2 * step) for s in shift], -1)

    np.testing.assert_allclose(
        skeleton.contact_velocity_derivative(q, w),
        differences(lambda at: skeleton.contact_jacobian(at) @ w), atol=1e-7,
    )  # fmt: skip
    multipliers, zero = random.normal(size=18), np.zeros_like(q)
    _, by_q, _, _ = skeleton.residual_derivatives(q, zero, zero, multipliers)
    np.testing.assert_allclose(
        by_q,
        differences(lambda at: skeleton.residual_derivatives(at, zero, zero, multipliers)[0]),
        atol=1e-5,
    )


@pytest.mark.parametrize("form", FORMS)
@pytest.mark.parametrize("model", MODELS)
def test_first_derivatives(model, form):
    problem, x, random = program(model, form), jiggled(model, form), np.random.default_rng(1)
    dense = dense_jacobian(problem, x)
    for _ in range(4):
        way = random.normal(size=x.size)
        by_differences = directional_difference(problem.rows, x, way, 1e-6)
        size = 1.0 + np.abs(by_differences)
        assert np.max(np.abs(dense @ way - by_differences) / size) < 1e-5
        np.testing.assert_allclose(
            problem.gradient(x) @ way, directional_difference(problem.cost, x, way, 1e-6),
            rtol=1e-5, atol=1e-6,
        )  # fmt: skip


@pytest.mark.parametrize("model", MODELS)
def test_second_derivatives(model):
    problem, x = program(model), jiggled(model)
    exact, random = LagrangianHessian(problem), np.random.default_rng(3)
    multipliers = random.normal(size=problem.num_constraints)

    def gradient(y):
        slopes = problem.jacobian(y) * multipliers[problem.jacobian_rows]
        by_rows = np.bincount(problem.jacobian_columns, slopes, problem.num_variables)
        return problem.gradient(y) + by_rows

    entries, off = exact.values(x, multipliers, 1.0), exact.rows != exact.columns
    torques = [i for i, name in enumerate(problem.design.names)
               if "roll" in name or "pitch" in name]  # fmt: skip
    assert torques
    chosen = np.zeros(x.size)
    chosen[torques] = random.uniform(-1.0, 1.0, len(torques))
    for way in (random.uniform(-1.0, 1.0, x.size), chosen):
        found = np.bincount(exact.rows, entries * way[exact.columns], x.size)
        found += np.bincount(exact.columns[off], (entries * way[exact.rows])[off], x.size)
        by_differences = directional_difference(gradient, x, way, 2e-6)
        size = np.abs(by_differences).max()
        assert size > 1e-3 or model.startswith("planar")  # pitching in a plane does not bend
        np.testing.assert_allclose(found, by_differences, atol=2e-5 * (size + 1e-3))


@pytest.mark.parametrize("model", ["spatial", "planar"])
def test_what_the_program_projects_is_what_the_check_finds(model):
    problem, x = program(model, "projected"), jiggled(model, "projected")
    state = problem.state(x)
    motion = Motion(
        state.tau, state.tau, state.q, state.v, state.motion.acceleration,
        state.forces.value, state.forces.rate, state.forces.acceleration,
    )  # fmt: skip
    loads = loads_along(problem.formulation.walker, motion, state.points.phases)
    inside = state.points.shares > 0.0
    np.testing.assert_allclose(loads.multipliers[inside], state.multipliers[inside], atol=1e-6)
    np.testing.assert_allclose(loads.residual[inside], state.residual[inside], atol=1e-6)
    assert np.abs(loads.toe_torques[inside]).max() > 1.0


@pytest.mark.parametrize("form", FORMS)
def test_torques_are_bounded(form):
    problem = program("planar", form)
    if form == "lifted":
        design = problem.design
        where = [i for i, name in enumerate(design.names) if "pitch" in name]
        np.testing.assert_allclose((design.scale * design.upper)[where], 20.0)
        np.testing.assert_allclose((design.scale * design.lower)[where], -20.0)
    else:
        rows = [i for i, name in enumerate(problem.row_names) if name.startswith("toe torque")]
        assert len(rows) == len(problem.points.loaded[:, 14:].nonzero()[0])
        np.testing.assert_array_equal(problem.row_scale[rows], 20.0)


def test_a_study_without_them_has_none():
    assert not GaitStudy.spatial().contact.toe_torque
    assert GaitStudy.planar().with_settings(toe_torque="on").contact == ALLOWED
