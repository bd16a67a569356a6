"""Groups of physical quantities at control points, with their derivatives."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Curve:
    """Functions of time at the control points, (num, num_functions) each.

    Attributes:
        value, rate, acceleration: x, x', x'' [per s, per s^2].
        by_tau: derivatives of those three by tau, stacked (3, num, num_functions).
    """

    value: np.ndarray
    rate: np.ndarray
    acceleration: np.ndarray
    by_tau: np.ndarray


@dataclass(frozen=True)
class Dynamics:
    """Residual r of the skeleton under its contact forces, before muscles.

    r = M q'' + k - q_r - C^T lambda, eq. (15), with its partial derivatives; the
    derivative by the accelerations is the mass matrix.
    """

    residual: np.ndarray
    by_q: np.ndarray
    by_v: np.ndarray
    mass_matrix: np.ndarray


@dataclass(frozen=True)
class MultiplierDerivatives:
    """d lambda* of eq. (17) by the motion and the muscle forces, (num, 14, ...)."""

    by_q: np.ndarray
    by_v: np.ndarray
    by_a: np.ndarray
    by_f: np.ndarray
