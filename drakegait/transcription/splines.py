"""Periodic quintic splines on a uniform grid of normalised time.

The quintic spline through N nodes of one period whose derivatives 0 to 4 agree at both ends has
N - 1 free values. Garcia-Vallejo & Schiehlen (2012) store it as polynomials of each interval; on a
uniform grid the same function is a sum of shifted copies of one bell (cardinal B-spline; Schoenberg
1973), so that a value depends on six neighbouring coefficients only.
"""

from __future__ import annotations

import math

import numpy as np

from drakegait.errors import InvalidInput

SUPPORT = 6  # a quintic bell covers six intervals; so many coefficients meet at an instant
_MAX_DERIVATIVE = 4  # the fifth derivative jumps at the nodes


def _bell_polynomials() -> np.ndarray:
    """The six pieces of the quintic bell as polynomials.

    With B(x) = 1/5! sum_m (-1)^m C(6, m) (x + 3 - m)_+^5, entry [p, i] is the coefficient of t^p
    in B(t + 2 - i), 0 <= t < 1: the weight of the i-th of the six coefficients around t.
    """
    pieces = np.zeros((SUPPORT, SUPPORT))
    for i in range(SUPPORT):
        for m in range(SUPPORT - i):
            sign_and_count = (-1) ** m * math.comb(SUPPORT, m)
            for p in range(SUPPORT):
                pieces[p, i] += sign_and_count * math.comb(5, p) * (5 - i - m) ** (5 - p)
    return pieces / math.factorial(5)


def _derivatives(pieces: np.ndarray) -> list[np.ndarray]:
    """The pieces and their derivatives with respect to t, orders 0 to 4."""
    orders = [pieces]
    for _ in range(_MAX_DERIVATIVE):
        powers = np.arange(1, len(orders[-1]))[:, None]
        orders.append(powers * orders[-1][1:])
    return orders


_PIECES = _derivatives(_bell_polynomials())


class PeriodicQuintic:
    """Quintic splines of period 1 in tau = t / T, four times continuously differentiable.

    A function is a row of `num_intervals` = M = num_nodes - 1 coefficients. Node j lies at
    tau = j / M; the first and the last node are one and the same value. Coefficient k belongs to
    the bell centred on node k, hence the value at node j is [1 26 66 26 1]/120 times the
    coefficients j-2 .. j+2, indices modulo M. The map between nodal values and coefficients is
    circulant with eigenvalues in [2/15, 1]: always invertible.

    Args:
        num_nodes: N, both ends counted; at least 8.

    Raises:
        InvalidInput: fewer than 8 nodes, or not a whole number.
    """

    def __init__(self, num_nodes: int):
        whole = isinstance(num_nodes, (int, np.integer)) and not isinstance(num_nodes, bool)
        if not whole or num_nodes < 8:
            raise InvalidInput("num_nodes", num_nodes, "a whole number of at least 8")
        self.num_nodes = int(num_nodes)
        self.num_intervals = self.num_nodes - 1
        self.node_times = np.arange(self.num_intervals) / self.num_intervals
        self._nodal_from_coefficients = self.dense_basis(self.node_times)
        self._coefficients_from_nodal = np.linalg.inv(self._nodal_from_coefficients)

    def basis(self, tau: np.ndarray, derivative: int = 0) -> tuple[np.ndarray, np.ndarray]:
        """Weights of the six coefficients that a value depends on.

        Args:
            tau: normalised times of any shape; any real number, the period is 1.
            derivative: order 0 to 4 with respect to tau.

        Returns:
            (weights, first): weights (..., 6) of the coefficients first .. first + 5 and their
            first index (...,), an integer to be taken modulo `num_intervals` (it is negative or
            beyond the end near the ends of the period).
        """
        if derivative not in range(_MAX_DERIVATIVE + 1):
            raise InvalidInput("derivative", derivative, f"0 to {_MAX_DERIVATIVE}")
        position = np.asarray(tau, dtype=float) * self.num_intervals
        interval = np.floor(position)
        powers = np.vander((position - interval).ravel(), SUPPORT - derivative, increasing=True)
        weights = powers @ (_PIECES[derivative] * float(self.num_intervals) ** derivative)
        return weights.reshape(position.shape + (SUPPORT,)), interval.astype(int) - 2

    def windowed_basis(
        self, tau: np.ndarray, first: np.ndarray, width: int, derivative: int = 0
    ) -> np.ndarray:
        """Weights of `width` neighbouring coefficients, starting at a fixed one.

        Serves a program whose sparsity must not change while tau moves. Coefficients of the
        support of tau that lie outside the window are left out: choose it wide enough.

        Args:
            tau: normalised times (...,), also beyond the ends of the period.
            first: first coefficient of each window (...,), broadcast with tau, modulo M.
            width: number of coefficients in the window, at most `num_intervals`.
            derivative: order 0 to 4 with respect to tau.

        Returns:
            Weights (..., width) of the coefficients first .. first + width - 1 modulo M; zero
            where tau is outside a coefficient's support.
        """
        if not 1 <= width <= self.num_intervals:
            raise InvalidInput("width", width, f"1 to {self.num_intervals} coefficients")
        tau, first = np.broadcast_arrays(np.asarray(tau, dtype=float), np.asarray(first, dtype=int))
        weights, start = self.basis(tau, derivative)
        place = (start - first)[..., None] + np.arange(SUPPORT)
        window = np.zeros(tau.shape + (self.num_intervals,))
        np.put_along_axis(window, place % self.num_intervals, weights, axis=-1)
        return window[..., :width]

    def dense_basis(self, tau: np.ndarray, derivative: int = 0) -> np.ndarray:
        """Weights of all coefficients (..., M) at times tau (...,)."""
        return self.windowed_basis(tau, 0, self.num_intervals, derivative)

    def evaluate(
        self, coefficients: np.ndarray, tau: np.ndarray, derivative: int = 0
    ) -> np.ndarray:
        """Values (..., K) of the functions with `coefficients` (..., M) at times tau (K,)."""
        return np.asarray(coefficients) @ self.dense_basis(tau, derivative).T

    def coefficients(self, nodal_values: np.ndarray) -> np.ndarray:
        """Coefficients (..., M) of the splines through `nodal_values` (..., M)."""
        return np.asarray(nodal_values) @ self._coefficients_from_nodal.T

    def nodal_values(self, coefficients: np.ndarray) -> np.ndarray:
        """Values (..., M) at the nodes of splines with `coefficients` (..., M)."""
        return np.asarray(coefficients) @ self._nodal_from_coefficients.T

    def fit(self, tau_samples: np.ndarray, values: np.ndarray) -> np.ndarray:
        """Coefficients (..., M) of the splines closest to samples in the least-squares sense.

        Args:
            tau_samples: normalised times (K,), spread over the whole period.
            values: samples (..., K).

        Raises:
            InvalidInput: the samples are not finite or leave a coefficient undetermined.
        """
        values = np.asarray(values, dtype=float)
        tau_samples = np.asarray(tau_samples, dtype=float)
        if tau_samples.ndim != 1 or values.shape[-1:] != tau_samples.shape:
            raise InvalidInput("shape of the samples", values.shape, f"(..., {tau_samples.size})")
        if not (np.isfinite(values).all() and np.isfinite(tau_samples).all()):
            raise InvalidInput("samples", "nan or infinite", "finite numbers")
        basis = self.dense_basis(tau_samples)
        rows = values.reshape(-1, tau_samples.size)
        solution, _, rank, _ = np.linalg.lstsq(basis, rows.T, rcond=1e-10)
        if rank < self.num_intervals:
            raise InvalidInput(
                "number of samples", tau_samples.size,
                f"enough to determine {self.num_intervals} coefficients all over the period",
            )  # fmt: skip
        return solution.T.reshape(values.shape[:-1] + (self.num_intervals,))
