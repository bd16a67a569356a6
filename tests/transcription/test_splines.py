"""Periodic quintic splines: the same functions as scipy's, smooth, exact, well conditioned."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.interpolate import BSpline, make_interp_spline

from drakegait.errors import InvalidInput
from drakegait.transcription.splines import PeriodicQuintic

RNG = np.random.default_rng(7)


@pytest.mark.parametrize("num_nodes", [8, 18, 35])
@pytest.mark.parametrize("derivative", range(5))
def test_interpolation_is_that_of_scipy(num_nodes, derivative):
    spline = PeriodicQuintic(num_nodes)
    nodal = RNG.normal(size=spline.num_intervals)
    times = np.linspace(0.0, 1.0, num_nodes)
    other = make_interp_spline(times, np.append(nodal, nodal[0]), k=5, bc_type="periodic")
    tau = np.linspace(0.0, 0.999, 200)
    ours = spline.evaluate(spline.coefficients(nodal), tau, derivative)
    theirs = other(tau, nu=derivative)
    assert np.abs(ours - theirs).max() < 1e-9 * np.abs(theirs).max()


@pytest.mark.parametrize("derivative", range(5))
def test_each_coefficient_is_a_bell_centred_on_its_node(derivative):
    spline = PeriodicQuintic(18)
    h, k = 1.0 / 17, 8
    bell = BSpline.basis_element(h * np.arange(k - 3, k + 4), extrapolate=False)
    tau = np.linspace(0.0, 0.999, 301)
    expected = np.nan_to_num(bell.derivative(derivative)(tau) if derivative else bell(tau))
    ours = spline.dense_basis(tau, derivative)[:, k]
    assert np.allclose(ours, expected, atol=1e-10 * np.abs(expected).max())
    assert np.isclose(spline.dense_basis(0.0)[0], 66 / 120)


@pytest.mark.parametrize("num_nodes", [8, 19])
def test_derivatives_0_to_4_are_continuous_at_every_node(num_nodes):
    spline = PeriodicQuintic(num_nodes)
    coefficients = RNG.normal(size=spline.num_intervals)
    nodes = np.arange(num_nodes) / spline.num_intervals
    for derivative in range(5):
        left = spline.evaluate(coefficients, nodes - 1e-11, derivative)
        right = spline.evaluate(coefficients, nodes + 1e-11, derivative)
        assert np.allclose(left, right, atol=1e-6 * np.abs(right).max())


def test_derivatives_agree_with_differences():
    spline = PeriodicQuintic(18)
    coefficients = RNG.normal(size=17)
    tau, step = RNG.uniform(size=50), 1e-6
    for derivative in range(4):
        ahead = spline.evaluate(coefficients, tau + step, derivative)
        behind = spline.evaluate(coefficients, tau - step, derivative)
        exact = spline.evaluate(coefficients, tau, derivative + 1)
        assert np.allclose((ahead - behind) / (2 * step), exact, atol=1e-6 * np.abs(exact).max())


def test_circulant_matrix_and_its_eigenvalues():
    spline = PeriodicQuintic(18)
    matrix = spline.nodal_values(np.eye(17)).T
    row = np.zeros(17)
    row[[-2, -1, 0, 1, 2]] = np.array([1, 26, 66, 26, 1]) / 120
    assert np.allclose(matrix, [np.roll(row, j) for j in range(17)], atol=1e-14)
    angle = 2 * np.pi * np.arange(17) / 17
    expected = (66 + 52 * np.cos(angle) + 2 * np.cos(2 * angle)) / 120
    assert np.allclose(np.sort(np.linalg.eigvalsh(matrix)), np.sort(expected))
    assert expected.min() > 2 / 15 and np.linalg.cond(matrix) < 7.5


@settings(max_examples=60, deadline=None)
@given(num_nodes=st.integers(8, 60), tau=st.floats(-2.0, 3.0), seed=st.integers(0, 99))
def test_identities_at_any_time(num_nodes, tau, seed):
    spline = PeriodicQuintic(num_nodes)
    weights, first = spline.basis(tau)
    assert weights.shape == (6,) and (weights >= -1e-15).all() and np.isclose(weights.sum(), 1.0)
    coefficients = np.random.default_rng(seed).normal(size=spline.num_intervals)
    value = weights @ coefficients[(first + np.arange(6)) % spline.num_intervals]
    assert np.isclose(value, spline.dense_basis(tau) @ coefficients, atol=1e-12)
    again = spline.dense_basis(tau + 1.0) @ coefficients
    assert np.isclose(value, again, atol=1e-9)


@pytest.mark.parametrize("derivative", range(5))
def test_window_holds_the_same_weights(derivative):
    spline = PeriodicQuintic(18)
    tau = np.array([-0.02, 0.0, 0.03, 0.5, 0.99, 1.0, 1.04])
    weights, support = spline.basis(tau, derivative)
    first = support - np.array([0, 1, 2, 3, 0, 1, 2])
    window = spline.windowed_basis(tau, first, 10, derivative)
    for k in range(len(tau)):
        expected = np.zeros(10)
        offset = support[k] - first[k]
        expected[offset : offset + 6] = weights[k]
        assert np.array_equal(window[k], expected)
    around = spline.windowed_basis(tau, first + 17, 10, derivative)
    assert np.array_equal(window, around)


def test_window_that_ends_early_drops_only_what_is_outside():
    spline = PeriodicQuintic(18)
    weights, first = spline.basis(0.4)
    assert np.array_equal(spline.windowed_basis(0.4, first + 2, 4), weights[2:])
    assert np.array_equal(spline.windowed_basis(0.4, first - 3, 6), [0, 0, 0, *weights[:3]])
    assert spline.windowed_basis(0.4, first, 17).sum() == pytest.approx(1.0)


def test_nodal_values_and_coefficients_are_inverse():
    spline = PeriodicQuintic(25)
    nodal = RNG.normal(size=(3, 4, 24))
    assert np.allclose(spline.nodal_values(spline.coefficients(nodal)), nodal)
    values = spline.evaluate(spline.coefficients(nodal), spline.node_times)
    assert np.allclose(values, nodal)


def test_fit_finds_a_spline_again_and_is_a_least_squares_solution():
    spline = PeriodicQuintic(18)
    coefficients = RNG.normal(size=(3, 17))
    tau = np.linspace(0.0, 1.0, 100, endpoint=False)
    samples = spline.evaluate(coefficients, tau)
    assert np.allclose(spline.fit(tau, samples), coefficients)
    noisy = samples + RNG.normal(size=samples.shape)
    residual = spline.evaluate(spline.fit(tau, noisy), tau) - noisy
    assert np.abs(residual @ spline.dense_basis(tau)).max() < 1e-10


def test_interpolation_error_falls_with_the_sixth_power():
    tau = np.linspace(0.0, 1.0, 997)
    errors = []
    for num_nodes in (13, 25, 49):
        spline = PeriodicQuintic(num_nodes)
        coefficients = spline.coefficients(np.sin(2 * np.pi * spline.node_times))
        errors.append(np.abs(spline.evaluate(coefficients, tau) - np.sin(2 * np.pi * tau)).max())
    rates = np.log2(np.array(errors[:-1]) / errors[1:])
    assert (np.abs(rates - 6.0) < 0.3).all()


def test_bad_input_is_refused():
    spline = PeriodicQuintic(18)
    for num_nodes in (7, 0, 18.0, True, "18"):
        with pytest.raises(InvalidInput, match="num_nodes"):
            PeriodicQuintic(num_nodes)
    for derivative in (-1, 5):
        with pytest.raises(InvalidInput, match="derivative"):
            spline.basis(0.1, derivative)
    for width in (0, 18):
        with pytest.raises(InvalidInput, match="width"):
            spline.windowed_basis(0.1, 0, width)
    few = np.linspace(0.0, 1.0, 12, endpoint=False)
    with pytest.raises(InvalidInput, match="number of samples"):
        spline.fit(few, np.ones(12))
    half = np.linspace(0.0, 0.5, 100)  # many, but leaving the second half free
    with pytest.raises(InvalidInput, match="number of samples"):
        spline.fit(half, np.ones(100))
    with pytest.raises(InvalidInput, match="finite"):
        spline.fit(few, np.full(12, np.nan))
    with pytest.raises(InvalidInput, match="shape"):
        spline.fit(few, np.ones(11))
