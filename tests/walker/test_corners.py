"""Corners that Newton's method gets across: exact where nothing is crossed, and no swinging."""

from __future__ import annotations

import casadi
import muscle_cases as cases
import numpy as np
import pytest

from drakegait.walker.corners import Corners, CornerSlopes, corner, noted
from drakegait.walker.muscles import MuscleSet

WIDTH = 1e-3


class Slope:
    """f = weight * max(z, 0) + (z - 1)^2 / 2, the corner rounded over WIDTH."""

    def __init__(self, weight: float):
        corners, z = Corners(), casadi.SX.sym("z")
        value = weight * corner(corners, z, casadi.SX(WIDTH)) + 0.5 * (z - 1.0) ** 2
        curvature, held, holds = corners.hessian(value, z)
        (shift,) = (symbol for symbol in casadi.symvar(value) if symbol.name() == "shift")
        value = casadi.substitute(value, shift, 0.0)
        self._crossing = casadi.Function("f", [z, held], [curvature, holds])
        hessian, gradient = casadi.hessian(value, z)
        self._exact = casadi.Function("f", [z], [gradient, hessian])

    def gradient(self, z: float) -> float:
        return float(self._exact(z)[0])

    def exact(self, z: float) -> float:
        return float(self._exact(z)[1])

    def fresh(self, z: float) -> np.ndarray:
        return np.array([z, z / np.hypot(z, WIDTH)])

    def crossing(self, z: float, held: np.ndarray) -> tuple[float, np.ndarray]:
        curvature, holds = self._crossing(z, held)
        return float(curvature), np.asarray(holds).ravel()


def test_where_nothing_moves_a_corner_has_its_own_curvature() -> None:
    slope = Slope(2.0)
    for z in (-1.0, -WIDTH, 0.0, 0.3 * WIDTH, 2.0):
        curvature, holds = slope.crossing(z, slope.fresh(z))
        assert curvature == pytest.approx(slope.exact(z), rel=1e-9)
        np.testing.assert_allclose(holds, slope.fresh(z), rtol=1e-9)


def test_across_a_corner_the_curvature_is_twice_that_of_the_chord() -> None:
    weight, reach = 2.0, 0.7
    slope = Slope(weight)
    for z in (reach, -reach):
        chord = weight / (2.0 * reach)  # the slope changes by `weight` over 2 reach
        curvature, _ = slope.crossing(z, slope.fresh(-z))
        assert curvature - 1.0 == pytest.approx(2.0 * chord, rel=1e-4)
        assert slope.exact(z) - 1.0 < 1e-4 * chord


@pytest.mark.parametrize("start", [3.0, 1.0, -0.5, -40.0])
def test_newton_finds_an_optimum_in_a_corner_between_whose_sides_it_would_swing(start) -> None:
    slope = Slope(2.0)

    def newton(z: float, crossing: bool, most: int) -> int:
        held = slope.fresh(z)
        for count in range(most):
            if abs(slope.gradient(z)) < 1e-9:
                return count
            curvature, held = slope.crossing(z, held)
            z -= slope.gradient(z) / (curvature if crossing else slope.exact(z))
        return most

    assert newton(start, True, 100) <= 15
    assert newton(start, False, 100) == 100


def test_a_corner_that_bends_down_keeps_its_curvature() -> None:
    slope = Slope(-2.0)
    curvature, _ = slope.crossing(0.7, slope.fresh(-0.7))
    assert curvature == pytest.approx(slope.exact(0.7), rel=1e-12)


def test_noting_a_corner_leaves_its_value() -> None:
    assert noted(np, np.array([-1.0, 2.0]), 0.1) == 0.0
    assert corner(np, np.array([-1.0, 2.0]), 0.0) == pytest.approx([0.0, 2.0])


@pytest.mark.parametrize("name", cases.VARIANTS)
def test_muscles_curve_as_they_do_until_a_step_crosses_a_corner(name) -> None:
    muscles = MuscleSet.load("spatial")
    functions, random = cases.variant(name, muscles), np.random.default_rng(4)
    z = cases.random_inputs(muscles, 5)
    weights = random.normal(size=z.shape[:-1] + (3,))
    exact, corners = functions.hessian(z, weights), CornerSlopes()
    most = np.abs(exact).max()
    for _ in range(2):
        again = functions.hessian(z, weights, 1.0, corners)
        assert np.abs(again - exact).max() <= 1e-9 * most
    # Fibres turn from shortening to lengthening or back: their heats have a corner there.
    turned = z.copy()
    turned[..., 4] = -z[..., 4]
    weights[...] = [0.0, 0.0, 1.0]
    more = functions.hessian(turned, weights, 1.0, corners) - functions.hessian(turned, weights)
    values = np.linalg.eigvalsh(more / np.abs(more).max())
    assert values.max() > 0.5
    assert values.min() > -1e-9
