"""What moves along a stride, as plain arrays."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

MOST_INSTANTS = 100_001  # in one piece, so that arrays fit into memory


@dataclass(frozen=True, eq=False)
class Motion:
    """Coordinates and muscle forces at K instants, in plant signs and SI units.

    Attributes:
        tau: fraction of the stride (K,); any real number, the stride repeats.
        time: tau T (K,) [s].
        q, v, a: coordinates, velocities, accelerations (K, num_coordinates) [m, rad, and per s,
            per s^2]; hat_x contains the steady advance of the walker.
        forces: tendon forces f^m (K, num_muscles) [N].
        force_rates, force_accelerations: their time derivatives [N/s], [N/s^2].
    """

    tau: np.ndarray
    time: np.ndarray
    q: np.ndarray
    v: np.ndarray
    a: np.ndarray
    forces: np.ndarray
    force_rates: np.ndarray
    force_accelerations: np.ndarray

    @classmethod
    def from_derivatives(
        cls,
        tau: np.ndarray,
        stride_time: float,
        stride_length: float,
        coordinates: tuple[np.ndarray, np.ndarray, np.ndarray],
        forces: tuple[np.ndarray, np.ndarray, np.ndarray],
    ) -> Motion:
        """From periodic functions of tau.

        Args:
            coordinates: value and first two derivatives by tau, (K, num_coordinates) each, hat_x
                without the advance stride_length * tau of docs/formulation.md 6.7.
            forces: likewise (K, num_muscles).
        """
        q, v, a = (x / stride_time**order for order, x in enumerate(coordinates))
        q, v = q.copy(), v.copy()
        q[:, 0] += stride_length * tau
        v[:, 0] += stride_length / stride_time
        rates = (x / stride_time**order for order, x in enumerate(forces))
        return cls(tau, tau * stride_time, q, v, a, *rates)
