"""Disorders in the program: every derivative against differences, and zero changes nothing."""

from __future__ import annotations

import dataclasses
import functools

import numpy as np
import pytest
from program_cases import (
    declared,
    dense_jacobian,
    differences,
    jiggled,
    numbers_of,
    program,
)
from test_lagrangian_hessian import OBJECTIVE, full, gradient, points, weights
from test_symmetry import mirrored, swapped

from drakegait.program.gait_program import GaitProgram
from drakegait.program.guess import guess_from_reference
from drakegait.program.lagrangian_hessian import LagrangianHessian
from drakegait.study import GaitStudy
from drakegait.walker import disorders as dis

# Every class that changes rows, costs or passive moments, and all of it at once.
EVERYTHING = (
    dis.Prosthesis("r", category=6),
    dis.Weakness("soleus", "l", 0.5),
    dis.Contracture("gastrocnemius", "l", 0.8),
    dis.Contracture("rectus_femoris", "both", 0.9),
    dis.Spasticity("hamstrings", "r", 0.2),
    dis.Spasticity("vasti", "l", 0.05),
    dis.JointStiffness("knee", "l", 40.0, 10.0, 1.5),
    dis.Orthosis("l", 100.0, 3.0, 20.0, 0.5, 0.4),
    dis.LegLength("thigh", "l", -0.02),
    dis.LimitedRange("hip", "r", -30.0, 60.0),
    dis.Asymmetry("step_length", 1.1),
    dis.Asymmetry("stance_time", 0.95),
    dis.Pain("foot", "r", 2.0),
    dis.Pain("knee", "both", 3.0),
)
BOTH_SIDES = (
    dis.Spasticity("soleus", "both", 0.1),
    dis.Orthosis("both", 80.0, 2.0, 0.0, 0.1),
    dis.Pain("foot", "both", 2.0),
    dis.Pain("knee", "both", 3.0),
    dis.Contracture("hamstrings", "both", 0.85),
)
CASES = {
    "planar": EVERYTHING,
    "spatial": EVERYTHING,
    "planar-symmetric": BOTH_SIDES,
    "spatial-symmetric": BOTH_SIDES,
}
TRIAL = [("planar", "lifted"), ("planar", "projected"), ("spatial", "lifted"),
         ("planar-symmetric", "lifted")]  # fmt: skip


def stated(model: str, **more) -> dict:
    return dict(interior_points=points(model), limits=(), disorders=CASES[model], **more)


@functools.cache
def with_disorders(model: str, form: str = "lifted"):
    return program(model, form, **stated(model)), jiggled(model, form, **stated(model))


@pytest.mark.parametrize(("model", "form"), TRIAL)
def test_every_entry_of_the_jacobian(model, form):
    problem, x = with_disorders(model, form)
    by_differences = differences(problem.rows, x)
    size = 1e-3 + np.abs(by_differences).max(axis=1, keepdims=True)
    wrong = np.abs(dense_jacobian(problem, x) - by_differences) / size
    row, column = np.unravel_index(np.argmax(wrong), wrong.shape)
    worst = f"{problem.row_names[row]} by {problem.design.names[column]}"
    assert wrong[row, column] < 1e-6, worst
    outside = np.where(declared(problem), 0.0, np.abs(by_differences) / size)
    assert outside.max() < 1e-9


@pytest.mark.parametrize(("model", "form"), TRIAL)
def test_every_entry_of_the_gradient(model, form):
    problem, x = with_disorders(model, form)
    by_differences = differences(lambda y: np.array([*problem.cost_parts(y).values()]), x)
    kinds = [cost.kind for cost in problem.costs]
    assert {"pain in foot_r", "pain in knee_flexion_r", "pain in knee_flexion_l"} <= set(kinds)
    assert kinds == list(problem.cost_parts(x))
    for cost, expected in zip(problem.costs, by_differences, strict=True):
        exact = problem.cost_gradient(cost, x)
        assert np.abs(exact).max() > 1e-3, cost.kind
        np.testing.assert_allclose(exact, expected, atol=1e-7, err_msg=cost.kind)


@pytest.mark.parametrize("model", CASES)
def test_every_column_of_the_hessian(model):
    problem, x = with_disorders(model)
    exact = LagrangianHessian(problem)
    multipliers, step, n = weights(problem), 2e-6, x.size
    found = full(exact, exact.values(x, multipliers, OBJECTIVE), n)
    known = full(exact, np.ones(exact.num_entries), n) > 0.0
    names = problem.design.names
    chosen = range(n) if model.startswith("planar") else range(0, n, 7)
    for i in chosen:
        way = np.zeros(n)
        way[i] = step
        rise = gradient(problem, x + way, multipliers, OBJECTIVE)
        rise -= gradient(problem, x - way, multipliers, OBJECTIVE)
        by_differences = rise / (2.0 * step)
        size = 0.1 + np.abs(by_differences).max()
        k = int(np.argmax(np.abs(found[:, i] - by_differences)))
        assert abs(found[k, i] - by_differences[k]) / size < 5e-5, f"{names[k]} by {names[i]}"
        assert np.abs(np.where(known[:, i], 0.0, by_differences)).max() / size < 1e-6, names[i]


def test_the_lower_excitation_row_is_zero_where_the_muscle_is_at_its_floor():
    """a' = (m - a)(t_1 m + t_2): the excitation is m exactly, also by the exact inverse."""
    lowest = 0.2
    spastic = (dis.Spasticity("hamstrings", "both", lowest),)
    problem = program("planar", limits=(), disorders=spastic)
    x = jiggled("planar", limits=(), disorders=spastic)
    walker = problem.formulation.walker
    state = problem.state(x)
    excitation = walker.muscle_functions.states(state.muscle_inputs)["excitation"]
    law = next(item for item in problem.constraints if item.kind == "excitation")
    below = law.lower[::2] - law.values(state)[:, ::2]  # > 0 where a row is violated
    possible = (excitation > 1e-3) & (excitation < 1.0)
    assert possible.sum() > 20
    np.testing.assert_array_equal(
        (below > 0.0)[possible], (excitation < walker.lowest_excitation)[possible]
    )
    assert walker.lowest_excitation.max() == lowest


@pytest.mark.parametrize(
    "nothing",
    [
        dis.Weakness("soleus", "l", 1.0),
        dis.Contracture("soleus", "l", 1.0),
        dis.Spasticity("soleus", "l", 0.0),
        dis.JointStiffness("ankle", "l", 0.0),
        dis.Orthosis("l", 0.0),
        dis.LegLength("shank", "l", 0.0),
        dis.Pain("foot", "l", 0.0),
    ],
    ids=lambda item: item.kind,
)
def test_a_disorder_of_size_zero_gives_the_same_program_to_the_last_bit(nothing):
    plain, x = program("planar", limits=()), jiggled("planar", limits=())
    problem = program("planar", limits=(), disorders=(nothing,))
    np.testing.assert_array_equal(problem.rows(x), plain.rows(x))
    np.testing.assert_array_equal(problem.jacobian(x), plain.jacobian(x))
    np.testing.assert_array_equal(problem.gradient(x), plain.gradient(x))
    np.testing.assert_array_equal(problem.lower, plain.lower)
    some = weights(plain)
    np.testing.assert_array_equal(
        LagrangianHessian(problem).values(x, some, 1.0),
        LagrangianHessian(plain).values(x, some, 1.0),
    )


def test_pain_is_the_mean_square_of_what_it_says():
    plain = program("planar", limits=())
    hurts = (dis.Pain("foot", "l", 2.0), dis.Pain("knee", "r", 3.0))
    problem = program("planar", limits=(), disorders=hurts)
    x = jiggled("planar", limits=())
    state, walker = plain.state(x), plain.formulation.walker
    force = state.ground_reactions[:, 1] / plain.formulation.body_weight
    moment = state.muscle_torques[:, walker.coordinate_names.index("knee_flexion_r")] / 75.0
    parts = problem.cost_parts(x)
    share = state.share_of_cycle
    assert share.sum() == pytest.approx(1.0)
    assert parts["pain in foot_l"] == pytest.approx(2.0 * (share @ (force**2).sum(axis=1)))
    assert parts["pain in knee_flexion_r"] == pytest.approx(3.0 * (share @ moment**2))
    assert problem.cost(x) == pytest.approx(
        plain.cost(x) + parts["pain in foot_l"] + parts["pain in knee_flexion_r"]
    )


def test_asymmetry_rows_are_zero_at_their_ratio():
    wanted = (dis.Asymmetry("step_length", 1.25), dis.Asymmetry("stance_time", 1.1))
    problem = program("planar", limits=(), disorders=wanted)
    x = jiggled("planar", limits=(), disorders=wanted)
    values, rows = problem.values(x), numbers_of(problem, "asymmetry")
    steps = values.placement[0] - 1.25 * values.placement[1]
    right = values.events[6] - values.events[0]  # right heel strike to right toe off
    left = 1.0 + values.events[2] - values.events[4]
    found = problem.rows(x)[rows] * problem.row_scale[rows]
    np.testing.assert_allclose(found, [steps, right - 1.1 * left], atol=1e-12)
    np.testing.assert_array_equal(problem.lower[rows], 0.0)
    np.testing.assert_array_equal(problem.upper[rows], 0.0)


def test_limited_ranges_are_limits():
    limited = (dis.LimitedRange("knee", "l", 5.0, 50.0),)
    problem = program("planar", limits=(), disorders=limited)
    rows = numbers_of(problem, "joint limit", "knee_flexion_l")
    assert len(rows) == problem.points.num
    np.testing.assert_allclose(problem.lower[rows] * problem.row_scale[rows], np.radians(5.0))
    np.testing.assert_allclose(problem.upper[rows] * problem.row_scale[rows], np.radians(50.0))


@pytest.mark.parametrize("kind", ["planar", "spatial"])
def test_mirrored_disorders_state_the_mirrored_problem(kind):
    """All rows and the costs that know no reference: hence the solutions are mirrored as well."""
    # An even number of spline intervals, and the same control points in both halves.
    chosen = dict(model=kind, nodes=11, interior_points=(1, 0, 1, 1, 1, 0, 1, 1))
    centres = program(f"{kind}-symmetric").formulation.event_centres
    here, there = (
        GaitProgram(GaitStudy(disorders=items, **chosen).formulation(np.array(centres)))
        for items in (EVERYTHING, tuple(item.mirrored() for item in EVERYTHING))
    )
    random, design = np.random.default_rng(3), here.design
    x = guess_from_reference(here)
    x = np.clip(x + random.uniform(-0.1, 0.1, x.size), design.lower, design.upper)
    events = here.values(x).events
    x = design.pack(dataclasses.replace(
        here.values(x), events=np.where(np.arange(8) == 4, 0.5, events)))  # fmt: skip
    values = here.values(x)
    image = mirrored(values)
    names = here.formulation.walker.muscles.names
    forces = np.roll(values.force_coefficients, -5, axis=1)
    which = [names.index(swapped(name)) for name in there.formulation.walker.muscles.names]
    y = there.design.pack(dataclasses.replace(image, force_coefficients=forces[which]))
    parts, others = here.cost_parts(x), there.cost_parts(y)
    assert set(parts) == {swapped(name) for name in others}
    for name, part in parts.items():
        if name != "deviation":  # the reference has a left and a right of its own
            assert others[swapped(name)] == pytest.approx(part, rel=1e-9), name
    rows = dict(zip(there.row_names, there.violations(y), strict=True))
    seen = 0
    for name, amount in zip(here.row_names, here.violations(x), strict=True):
        law, place, what = name.split(" | ")
        if law == "asymmetry":
            # L_R - r L_L and L_R - L_L / r are multiples of each other.
            ratio = 1.1 if "step" in what else 0.95
            assert rows[name] == pytest.approx(amount / ratio, rel=1e-7)
            continue
        seen += 1
        other = " | ".join(swapped(part) for part in (law, place, what))
        assert rows[other] == pytest.approx(amount, abs=1e-6, rel=1e-7), name
    assert seen > 300
