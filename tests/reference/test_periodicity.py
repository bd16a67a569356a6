"""Eq. (14): the ends agree, periodic data stay, drifting data become smooth."""

from __future__ import annotations

import numpy as np
import pytest

from drakegait.errors import InvalidInput
from drakegait.reference.periodicity import fit_periodic, force_periodicity
from drakegait.transcription.splines import PeriodicQuintic

RNG = np.random.default_rng(3)
FIRST = np.array([-11, 18, -9, 2, 0, 0]) / 6
SECOND = np.array([35, -104, 114, -56, 11, 0]) / 12
THIRD = np.array([-17, 71, -118, 98, -41, 7]) / 4


def test_the_formulas_have_the_stated_order():
    for h in (1.0, 0.5):
        for power in range(6):
            samples = (h * np.arange(6.0)) ** power
            for order, weights in enumerate((FIRST, SECOND, THIRD), 1):
                expected = {1: 1.0, 2: 2.0, 3: 6.0}[order] if power == order else 0.0
                if power < order + 3:
                    assert np.isclose(weights @ samples / h**order, expected, atol=1e-12)


@pytest.mark.parametrize("count", [8, 11, 12, 18, 19, 101])
def test_four_equations_hold_at_both_ends(count):
    values = RNG.normal(size=(3, count))
    forced = force_periodicity(values)
    assert np.array_equal(forced[:, 0], forced[:, -1])
    for order, weights in enumerate((FIRST, SECOND, THIRD), 1):
        ahead = forced[:, :6] @ weights
        back = forced[:, :-7:-1] @ weights * (-1) ** order
        assert np.allclose(ahead, back, atol=1e-10)
    assert np.array_equal(forced[:, 2:-2], values[:, 2:-2])
    assert not np.shares_memory(forced, values)


def test_forcing_is_a_projection_that_keeps_constants():
    values = RNG.normal(size=20)
    once = force_periodicity(values)
    assert np.allclose(force_periodicity(once), once, atol=1e-12)
    assert np.allclose(force_periodicity(np.full(20, 3.7)), 3.7)


def test_periodic_data_are_changed_by_the_fourth_power_of_the_step():
    errors = []
    for intervals in (24, 48, 96):
        tau = np.linspace(0.0, 1.0, intervals + 1)
        smooth = np.sin(2 * np.pi * tau + 0.7) + 0.3 * np.cos(4 * np.pi * tau)
        errors.append(np.abs(force_periodicity(smooth) - smooth).max())
    assert errors[0] < 6e-3
    assert (np.log2(np.array(errors[:-1]) / errors[1:]) > 3.5).all()


def test_drift_of_five_per_cent_costs_the_stated_derivatives():
    # third derivative of the true curve: (2 pi)^3 = 248; second (2 pi)^2 = 39.5
    spline, dense = PeriodicQuintic(19), np.linspace(0.0, 1.0, 20001)
    tau = np.linspace(0.0, 1.0, 19)
    drifting = np.sin(2 * np.pi * tau + 0.7) + 0.05 * tau

    def largest(nodal: np.ndarray, derivative: int) -> float:
        return np.abs(spline.evaluate(spline.coefficients(nodal[:-1]), dense, derivative)).max()

    forced = force_periodicity(drifting)
    assert largest(drifting, 3) == pytest.approx(1218, rel=0.005)
    assert largest(forced, 3) == pytest.approx(336, rel=0.005)
    assert largest(drifting, 2) == pytest.approx(45.8, rel=0.005)
    assert largest(forced, 2) == pytest.approx(39.5, rel=0.005)


def test_noise_gain_of_the_end_value():
    gain = np.array([force_periodicity(row)[0] for row in np.eye(40)])
    assert np.abs(gain).sum() == pytest.approx(8.4, abs=0.05)
    assert np.linalg.norm(gain) == pytest.approx(3.5, abs=0.05)


def test_fit_of_closed_data_is_least_squares_and_of_open_data_closes():
    spline, tau = PeriodicQuintic(25), np.linspace(0.0, 1.0, 101)
    closed = np.sin(2 * np.pi * tau)
    fitted = fit_periodic(spline, tau, np.array([closed, closed + 0.1 * tau]), ["a", "b"])
    curves = spline.evaluate(fitted, tau)
    assert np.abs(curves[0] - closed).max() < 1e-5
    inside = (tau > 0.15) & (tau < 0.85)
    assert np.abs(curves[1] - closed - 0.1 * tau)[inside].max() < 2e-3
    third = spline.evaluate(fitted, np.linspace(0, 1, 2001), 3)
    assert np.abs(third[1]).max() < 3.0 * np.abs(third[0]).max()
    naive = spline.fit(tau[:-1], (closed + 0.1 * tau)[:-1])
    assert np.abs(spline.evaluate(naive, np.linspace(0, 1, 2001), 3)).max() > 4e3


def test_units_do_not_matter():
    """Which curves are open is told from their own range: millimetres or radians."""
    spline, tau = PeriodicQuintic(25), np.linspace(0.0, 1.0, 101)
    closed = np.sin(2 * np.pi * tau)
    curves = np.array([closed + 0.003 * tau, closed + 0.1 * tau])
    size = np.array([[1000.0], [0.001]])
    plain, other = (fit_periodic(spline, tau, x, ["a", "b"]) for x in (curves, size * curves))
    np.testing.assert_allclose(other, size * plain, rtol=1e-9, atol=1e-9 * np.abs(other).max())


def test_refusals():
    with pytest.raises(InvalidInput, match="number of values"):
        force_periodicity(np.ones(7))
    spline, tau = PeriodicQuintic(25), np.linspace(0.0, 1.0, 101)
    with pytest.raises(InvalidInput, match="difference of knee"):
        fit_periodic(spline, tau, tau[None], ["knee"])
    with pytest.raises(InvalidInput, match="number of rows"):
        fit_periodic(spline, tau[::5], tau[None, ::5], ["knee"])
