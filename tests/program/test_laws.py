"""The rows and costs of the program say what the laws say, by name and in physical units."""

from __future__ import annotations

import numpy as np
import pytest
from by_hand import ByHand, contacts, mask
from program_cases import CASES, MODELS, jiggled, numbers_of, program

from drakegait.walker import coordinates, feet


def by_kind(problem, x, kind: str) -> dict[tuple[str, str], float]:
    """Physical values of the rows of a law by (place, what)."""
    physical = problem.rows(x) * problem.row_scale
    found = {}
    for name, value in zip(problem.row_names, physical, strict=True):
        law, place, what = name.split(" | ")
        if law == kind:
            found[place, what] = value
    return found


def assert_rows(problem, x, kind: str, expected: dict[tuple[str, str], float], atol: float):
    found = by_kind(problem, x, kind)
    assert found.keys() == expected.keys()
    for key, value in expected.items():
        assert found[key] == pytest.approx(value, abs=atol, rel=1e-7), (kind, key)


@pytest.fixture(params=CASES, ids=lambda case: "-".join(case))
def case(request):
    model, form = request.param
    problem, x = program(model, form), jiggled(model, form)
    hand = ByHand(problem, x)
    places = [problem.place_name(k) for k in range(len(hand.tau))]
    return problem, x, hand, places


def test_equations_of_motion(case):
    problem, x, hand, places = case
    residual = hand.residual()
    if problem.formulation.lifted:
        residual = residual - hand.values.residuals
    names = problem.formulation.walker.coordinate_names
    expected = {
        (place, name): residual[k, i]
        for k, place in enumerate(places)
        for i, name in enumerate(names)
    }
    assert_rows(problem, x, "equations of motion", expected, 1e-6)
    rows = numbers_of(problem, "equations of motion")
    slack = 0.0 if problem.formulation.lifted else 1.0
    np.testing.assert_array_equal(problem.upper[rows], slack)
    np.testing.assert_array_equal(problem.lower[rows], -slack)
    tolerance = {"N": 5.0, "N m": 2.0}
    for row in rows:
        turns = "hat_x hat_y hat_z".find(problem.row_names[row].split(" | ")[2]) < 0
        assert problem.row_units[row] == ("N m" if turns else "N")
        assert problem.row_scale[row] == tolerance[problem.row_units[row]]


def test_multipliers_leave_the_smallest_residual(case):
    problem, x, hand, places = case
    residual = hand.values.residuals
    expected = {}
    for k, place in enumerate(places):
        loaded, _ = hand.rows_of_ground(k)
        product = hand.walker.skeleton.contact_jacobian(hand.q[k]) @ residual[k]
        expected |= {
            (place, name): product[row] for row, name in enumerate(feet.ROW_NAMES) if loaded[row]
        }
    if problem.formulation.lifted:  # a constraint C e = 0
        assert_rows(problem, x, "least-squares contact forces", expected, 1e-8)
        rows = numbers_of(problem, "least-squares contact forces")
        assert not problem.lower[rows].any()
        assert not problem.upper[rows].any()
    else:  # holds by construction
        np.testing.assert_allclose(residual, hand.residual(), atol=1e-6)
        assert np.abs(list(expected.values())).max() < 1e-8 * np.abs(residual).max()


def test_foot_contact(case):
    problem, x, hand, places = case
    expected = {}
    for k, place in enumerate(places):
        _, placed = hand.rows_of_ground(k)
        position, target = hand.contact_positions(k), hand.footprint(k)
        expected |= {
            (place, name): position[name] - target[name]
            for row, name in enumerate(feet.ROW_NAMES)
            if placed[row]
        }
    assert_rows(problem, x, "foot contact", expected, 1e-10)
    rows = numbers_of(problem, "foot contact")
    np.testing.assert_array_equal(problem.upper[rows], 1.0)
    np.testing.assert_array_equal(problem.lower[rows], -1.0)
    for row in rows:
        yaw = problem.row_names[row].endswith("yaw")
        assert problem.row_scale[row] == (0.01 if yaw else 0.002)


def test_clearance(case):
    problem, x, hand, places = case
    expected = {}
    for k, place in enumerate(places):
        _, placed = hand.rows_of_ground(k)
        heights = hand.contact_positions(k)
        expected |= {
            (place, point): heights[f"{point} z"]
            for point in feet.POINT_NAMES
            if not placed[feet.ROW_NAMES.index(f"{point} z")]
        }
    assert_rows(problem, x, "clearance", expected, 1e-10)
    rows = numbers_of(problem, "clearance")
    assert not problem.lower[rows].any()
    assert np.isinf(problem.upper[rows]).all()


def test_every_contact_point_is_placed_or_cleared(case):
    problem, _, hand, places = case
    for place in places:
        for point in feet.POINT_NAMES:
            placed = numbers_of(problem, "foot contact |", f"| {place} |", f"{point} z")
            cleared = numbers_of(problem, "clearance |", f"| {place} |", point)
            assert len(placed) + len(cleared) == 1, (place, point)


def test_friction_and_free_moment(case):
    problem, x, hand, places = case
    contact, weight = problem.formulation.contact, problem.formulation.body_weight
    length = hand.walker.foot.toe - hand.walker.foot.heel
    reactions, grip, twist = hand.ground_reactions(), {}, {}
    for k, place in enumerate(places):
        loaded, _ = hand.rows_of_ground(k)
        force = dict(zip(feet.ROW_NAMES, hand.multipliers[k] * loaded, strict=True))
        for foot, side in enumerate("rl"):
            if not loaded[7 * foot : 7 * foot + 7].any():
                continue
            fx, fy, normal = reactions[k, foot]
            slack = (contact.friction * normal) ** 2 - fx**2 - fy**2 - 1e-6 * weight**2
            grip[place, f"foot_{side}"] = slack
            heel_down = loaded[feet.ROW_NAMES.index(f"heel_{side} z")]
            arm = contact.patch_radius + (length if heel_down else 0.0)
            limit = contact.friction * (
                contact.patch_radius * force[f"heel_{side} z"] + arm * force[f"toe_{side} z"]
            )
            moment = force[f"foot_{side} yaw"]  # about the upward vertical: left is positive
            twist[place, f"foot_{side} turned left"] = limit - moment
            twist[place, f"foot_{side} turned right"] = limit + moment
    assert_rows(problem, x, "friction", grip, 1e-6 * weight**2 * 1e-3)
    if problem.formulation.planar:
        assert by_kind(problem, x, "free moment") == {}
    else:
        assert_rows(problem, x, "free moment", twist, 1e-8)
    for kind in ("friction", "free moment"):
        rows = numbers_of(problem, f"{kind} |")
        assert not problem.lower[rows].any()
        assert np.isinf(problem.upper[rows]).all()


def test_the_ground_only_pushes(case):
    problem, x, hand, places = case
    if not problem.formulation.lifted:
        expected = {
            (place, point): hand.multipliers[k, row]
            for k, place in enumerate(places)
            for point, row in zip(feet.POINT_NAMES, feet.VERTICAL_ROWS, strict=True)
            if hand.rows_of_ground(k)[0][row]
        }
        assert_rows(problem, x, "normal force", expected, 1e-6)
        assert not problem.lower[numbers_of(problem, "normal force")].any()
        return
    for name, low, high in zip(
        problem.design.names, problem.design.lower, problem.design.upper, strict=True
    ):
        if name.startswith("contact force"):
            assert low == (0.0 if " z |" in name else -np.inf), name
            assert high == np.inf


def test_excitations(case):
    problem, x, hand, places = case
    values, names = hand.muscle_values(), hand.walker.muscles.names
    expected = {
        (place, f"{name} {side}"): values[k, m, i]
        for k, place in enumerate(places)
        for m, name in enumerate(names)
        for i, side in enumerate(("off", "full"))
    }
    assert_rows(problem, x, "excitation", expected, 1e-7)
    rows = numbers_of(problem, "excitation |")
    is_off = np.array([problem.row_names[row].endswith(" off") for row in rows])
    off, full = rows[is_off], rows[~is_off]
    assert not problem.lower[off].any()
    assert np.isinf(problem.upper[off]).all()
    assert not problem.upper[full].any()
    assert np.isinf(problem.lower[full]).all()


def test_joint_limits_are_anatomical(case):
    problem, x, hand, places = case
    kind = problem.formulation.walker.skeleton.kind
    signs, names = coordinates.anatomical_signs(kind), coordinates.names(kind)
    rows = by_kind(problem, x, "joint limit")
    limits = problem.formulation.limits
    assert len(rows) == len(limits) * len(places)
    for limit in limits:
        column = names.index(limit.coordinate)
        for k, place in enumerate(places):
            (row,) = numbers_of(problem, "joint limit", f"| {place} |", limit.coordinate)
            angle = signs[column] * hand.q[k, column]
            assert rows[place, limit.coordinate] == pytest.approx(hand.q[k, column])
            ends = np.array([problem.lower[row], problem.upper[row]]) * problem.row_scale[row]
            low, high = np.sort(signs[column] * ends)
            assert (low, high) == pytest.approx((limit.low, limit.high))
            expected = max(limit.low - angle, angle - limit.high, 0.0)
            amount = problem.violations(x)[row] * problem.row_scale[row]
            assert amount == pytest.approx(expected, abs=1e-12)


def test_costs(case):
    problem, x, hand, _ = case
    parts = problem.cost_parts(x)
    assert parts["metabolic cost of transport"] == pytest.approx(0.01 * hand.cost_of_transport())
    assert parts["deviation"] == pytest.approx(hand.deviation())
    assert problem.cost(x) == pytest.approx(sum(parts.values()))


def test_timing(case):
    problem, x, hand, _ = case
    rows = problem.rows(x) * problem.row_scale
    (speed,) = numbers_of(problem, "average speed")
    assert rows[speed] == pytest.approx(hand.advance - 1.2 * hand.period)
    assert problem.lower[speed] == problem.upper[speed] == 0.0
    durations = numbers_of(problem, "phase duration")
    count = problem.formulation.schedule.num_phases
    np.testing.assert_allclose(rows[durations], hand.values.phase_durations[:count])
    assert rows[durations].sum() == pytest.approx(hand.period * count / 8)
    np.testing.assert_allclose(problem.lower[durations] * problem.row_scale[durations], 0.01)
    np.testing.assert_allclose(problem.upper[durations] * problem.row_scale[durations], 0.40)


@pytest.mark.parametrize("model", MODELS)
def test_contact_forces_on_events_are_those_that_both_phases_bear(model):
    problem = program(model)
    planar = model.startswith("planar")
    seen = {}
    for name in problem.design.names:
        if name.startswith("contact force"):
            row, point = name.removeprefix("contact force ").split(" | control point ")
            seen.setdefault(int(point), set()).add(row)
    schedule = problem.formulation.schedule
    for k, (phase, share) in enumerate(zip(schedule.phases, schedule.shares, strict=True)):
        bears = contacts(phase, planar)
        if share == 0.0:
            bears = min(bears, contacts(phase - 1, planar), key=len)
        assert seen[k] == bears, (k, phase, share)
        # A point that lands or leaves carries nothing at that instant: no impact.
        if share == 0.0:
            for touching in contacts(phase, planar) ^ contacts(phase - 1, planar):
                if touching.endswith(" z"):
                    assert touching not in seen[k]


def test_right_heel_strike_in_words():
    """The left toe bears the load while the right heel must be on its footprint."""
    problem = program("spatial")
    placed = {
        problem.row_names[i].split(" | ")[2]
        for i in numbers_of(problem, "foot contact | right heel strike |")
    }
    heel = {"heel_r x", "heel_r y", "heel_r z", "foot_r yaw"}
    toe = {"toe_l x", "toe_l y", "toe_l z"}
    assert placed == heel | toe | {"foot_l yaw"}
    loaded = {
        name.split(" | ")[0].removeprefix("contact force ")
        for name in problem.design.names
        if name.startswith("contact force") and name.endswith("control point 0")
    }
    assert loaded == toe | {"foot_l yaw"}
    assert mask(loaded).sum() == 4
