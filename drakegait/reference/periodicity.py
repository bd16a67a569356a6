"""Make measured curves close: eq. (14) of Garcia-Vallejo & Schiehlen (2012).

A measured stride does not end where it began. A periodic spline through such data oscillates; the
paper therefore replaces the two values at either end so that one-sided finite differences of
orders 0 to 3, each with an error O(h^3), agree at the first and the last node:

    f'   = (-11 f1 + 18 f2 - 9 f3 + 2 f4) / (6 h)
    f''  = (35 f1 - 104 f2 + 114 f3 - 56 f4 + 11 f5) / (12 h^2)
    f''' = (-17 f1 + 71 f2 - 118 f3 + 98 f4 - 41 f5 + 7 f6) / (4 h^3)

and with the opposite sign of odd orders backwards from the last node. With the sums
S_k = f_k + f_{N+1-k} and the differences D_k = f_k - f_{N+1-k} these four equations have one
solution, in closed form below.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from drakegait.errors import InvalidInput
from drakegait.transcription.splines import PeriodicQuintic

CLOSED = 0.005
"""Difference of both ends, relative to the range of a curve, up to which it counts as closed."""

HOPELESS = 0.5
"""Difference of both ends, relative to the range, from which it is no single stride."""


def force_periodicity(values: np.ndarray) -> np.ndarray:
    """Replace the first two and last two of N equidistant values so that both ends agree.

    Args:
        values: (..., N) samples at tau = 0, 1/(N-1), ..., 1. N >= 8; from N = 12 on the formulas
            of both ends use different samples.

    Returns:
        Copy of `values` with f_1 = f_N and equal first, second and third differences. For smooth
        periodic data it differs from them by O(h^4); f_1 is an extrapolation and may
        amplify noise eightfold.

    Raises:
        InvalidInput: fewer than 8 values.
    """
    forced = np.array(values, dtype=float)
    if forced.ndim == 0 or forced.shape[-1] < 8:
        count = forced.shape[-1] if forced.ndim else 1
        raise InvalidInput("number of values", count, "at least 8")
    total = forced + forced[..., ::-1]
    difference = forced - forced[..., ::-1]
    s3, s4, s5, s6 = (total[..., k] for k in range(2, 6))
    d3, d4, d5 = (difference[..., k] for k in range(2, 5))
    end = 297 / 190 * s3 - 811 / 475 * s4 + 369 / 475 * s5 - 63 / 475 * s6
    s2 = 11 / 9 * end + s3 / 2 - s4 / 9
    d2 = 57 / 52 * d3 - 7 / 13 * d4 + 11 / 104 * d5
    forced[..., 0] = forced[..., -1] = end
    forced[..., 1] = (s2 + d2) / 2
    forced[..., -2] = (s2 - d2) / 2
    return forced


def fit_periodic(
    spline: PeriodicQuintic, tau: np.ndarray, values: np.ndarray, names: Sequence[str]
) -> np.ndarray:
    """Periodic splines through measured curves, closed by eq. (14) where they do not close.

    A curve that closes is fitted directly. Otherwise a quintic with free ends and the same nodes
    is fitted, its nodal values are forced to be periodic and interpolated.

    Args:
        spline: the grid.
        tau: (K,) from 0 to 1, both included.
        values: (num_functions, K).
        names: of the functions, for the message.

    Returns:
        Coefficients (num_functions, spline.num_intervals).

    Raises:
        InvalidInput: too few samples, or ends that differ by more than half of a curve's range.
    """
    if tau.size < spline.num_nodes + 5:
        allowed = f"at least {spline.num_nodes + 5} for a spline of {spline.num_nodes} nodes"
        raise InvalidInput("number of rows", tau.size, allowed)
    gap = np.abs(values[:, -1] - values[:, 0])
    extent = np.ptp(values, axis=1)
    for name, curve_gap, curve_extent in zip(names, gap, extent, strict=True):
        if curve_gap > HOPELESS * curve_extent:
            raise InvalidInput(
                f"difference of {name} between first and last row", float(curve_gap),
                f"less than half of its range {curve_extent:.3g}, as the table is one full stride",
            )  # fmt: skip
    # the last row repeats the first instant: it must not count twice
    coefficients = spline.fit(tau[:-1], values[:, :-1])
    open_curves = gap > CLOSED * extent
    if open_curves.any():
        from scipy.interpolate import make_lsq_spline  # slow to import, and rarely needed

        nodes = np.append(spline.node_times, 1.0)
        knots = np.concatenate([np.zeros(5), nodes, np.ones(5)])
        try:
            free = make_lsq_spline(tau, values[open_curves].T, knots, k=5)
        except ValueError:  # nodes without samples between them
            allowed = f"spread evenly enough for a spline of {spline.num_nodes} nodes"
            raise InvalidInput("instants of the table", "uneven", allowed) from None
        forced = force_periodicity(free(nodes).T)
        coefficients[open_curves] = spline.coefficients(forced[:, :-1])
    return coefficients
