"""Steps that bend at bounds: inside them, and Newton's own to first order."""

from __future__ import annotations

import numpy as np
import pytest

from drakegait.solvers.condensed.bent_steps import OVERSHOOT, along, bent


def test_a_small_change_is_not_bent() -> None:
    changes = np.array([-0.5, -0.1, 0.0, 0.3, 7.0])
    np.testing.assert_allclose(bent(changes), 1.0 + changes, rtol=1e-15)


def test_bending_starts_smoothly() -> None:
    step = 1e-6
    left, right = bent(np.array([-0.5 - step])), bent(np.array([-0.5 + step]))
    assert (right - left)[0] / (2.0 * step) == pytest.approx(1.0, abs=1e-5)


def test_what_is_bent_falls_with_the_change_and_stays_positive() -> None:
    shares = bent(-np.linspace(0.0, OVERSHOOT, 200))
    assert (np.diff(shares) <= 0.0).all()
    assert shares.min() == pytest.approx(0.1)


def test_no_step_leaves_the_bounds() -> None:
    random = np.random.default_rng(2)
    low, high = random.uniform(1e-6, 1.0, 50), random.uniform(1e-6, 1.0, 50)
    w = random.normal(size=50)
    for scale in (0.1, 1.0, 100.0):
        moved = along(w, scale * random.normal(size=50), low, high) - w
        assert (moved > -low).all()
        assert (moved < high).all()


def test_only_unknowns_near_a_bound_are_bent_and_both_sides_alike() -> None:
    free = np.array([np.inf, np.inf])
    change = np.array([9.0, -9.0])
    np.testing.assert_array_equal(along(np.zeros(2), change, free, free), change)
    one = np.array([1.0])
    down = along(np.zeros(1), -2.0 * one, one, np.array([np.inf]))
    up = along(np.zeros(1), 2.0 * one, np.array([np.inf]), one)
    assert up == -down
    assert -1.0 < down[0] < -0.5
