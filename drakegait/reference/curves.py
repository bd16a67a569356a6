"""Periodic functions of normalised time tau = t / T, with exact derivatives."""

from __future__ import annotations

import math
from typing import Protocol

import numpy as np
from pydrake.trajectories import PiecewisePolynomial

from drakegait.errors import InvalidInput
from drakegait.transcription.splines import PeriodicQuintic

_ROUNDING = 1e-14  # relative difference of the two ends of a period


class PeriodicCurves(Protocol):
    """Several functions of period 1."""

    def values(self, tau: np.ndarray, derivative: int = 0) -> np.ndarray:
        """Derivative of the given order with respect to tau, (..., num_functions)."""
        ...


class HarmonicCurves:
    """Finite Fourier series: mean + sum_k cos_k cos(2 pi k tau) + sin_k sin(2 pi k tau), k >= 1.

    Args:
        mean: (num_functions,).
        cosines, sines: (num_functions, num_harmonics).
    """

    def __init__(self, mean: np.ndarray, cosines: np.ndarray, sines: np.ndarray):
        self._mean = mean
        self._weights = np.hstack([cosines, sines]).T
        self._frequencies = 2.0 * math.pi * np.arange(1, cosines.shape[1] + 1)

    def values(self, tau: np.ndarray, derivative: int = 0) -> np.ndarray:
        # d^n cos(w t) / dt^n = w^n cos(w t + n pi/2), likewise for the sine
        phase = np.asarray(tau, dtype=float)[..., None] * self._frequencies
        phase = phase + derivative * math.pi / 2.0
        growth = self._frequencies**derivative
        waves = np.concatenate([growth * np.cos(phase), growth * np.sin(phase)], axis=-1)
        result = waves @ self._weights
        return result + self._mean if derivative == 0 else result


class SplineCurves:
    """Periodic quintic splines.

    Args:
        spline: the common grid.
        coefficients: (num_functions, spline.num_intervals).
    """

    def __init__(self, spline: PeriodicQuintic, coefficients: np.ndarray):
        self.spline = spline
        self.coefficients = coefficients

    def values(self, tau: np.ndarray, derivative: int = 0) -> np.ndarray:
        return self.spline.dense_basis(tau, derivative) @ self.coefficients.T


class SampledCurves:
    """Periodic cubic splines through samples: twice continuously differentiable.

    Passes through every sample, which suits forces: their steep ends would be lost in a spline of
    few nodes.

    Args:
        tau: (K,) increasing from 0 to 1.
        samples: (K, num_functions); first and last row equal.

    Raises:
        InvalidInput: samples that are not finite, or whose ends differ.
    """

    def __init__(self, tau: np.ndarray, samples: np.ndarray):
        self.tau = np.asarray(tau, dtype=float)
        self.samples = np.asarray(samples, dtype=float)
        if not np.isfinite(self.samples).all():
            raise InvalidInput("samples of a periodic curve", "nan or inf", "finite numbers")
        gap = float(np.abs(self.samples[-1] - self.samples[0]).max())
        if gap > _ROUNDING * np.abs(self.samples).max():
            raise InvalidInput("last samples minus first", gap, "0, as the curves are periodic")
        # Drake's and not scipy's: importing scipy.interpolate would cost every command 0.25 s.
        spline = PiecewisePolynomial.CubicWithContinuousSecondDerivatives(
            self.tau, self.samples.T, periodic_end_condition=True
        )
        self._orders = [spline, spline.derivative(1), spline.derivative(2)]

    def __reduce__(self) -> tuple[type[SampledCurves], tuple[np.ndarray, np.ndarray]]:
        return SampledCurves, (self.tau, self.samples)  # Drake's splines cannot be pickled

    def values(self, tau: np.ndarray, derivative: int = 0) -> np.ndarray:
        if derivative not in range(3):
            raise InvalidInput("derivative of the forces", derivative, "0 to 2")
        tau = np.asarray(tau, dtype=float) % 1.0
        found = self._orders[derivative].vector_values(tau.ravel())
        return found.T.reshape(*tau.shape, self.samples.shape[1])
