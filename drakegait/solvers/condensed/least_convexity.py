"""How much of the muscles' lack of convexity K needs at the least.

With C = K + L, where L is what the muscles lack to be convex (`convexity`), K + t L = C - (1 - t) L
is positive definite for t > 1 - 1 / lambda, lambda the largest eigenvalue of L v = lambda C v. A
Lanczos iteration finds it with a dozen solves by the factor of C, which is there.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from scipy.sparse.linalg import ArpackError, LinearOperator, eigsh

from drakegait.solvers.condensed.cyclic_band import CyclicBandFactor, CyclicBandMatrix

_BASIS, _ACCURACY = 12, 0.05  # vectors of the iteration; relative, of the eigenvalue


def least_share(
    lack: CyclicBandMatrix,
    convex: CyclicBandMatrix,
    factor: CyclicBandFactor,
    towards: np.ndarray | None = None,
) -> tuple[float, np.ndarray | None]:
    """The t from which on C - (1 - t) L is positive definite, to some per cent of 1 - t.

    Args:
        lack, convex: L and C (size, size).
        factor: of C.
        towards: where to start, the direction of a matrix much like it.

    Returns:
        t, 0 to 1, and the direction that needs it (size,); 1 and None where it was not found.
    """
    size = lack.band.size
    if towards is None:
        towards = np.random.default_rng(0).standard_normal(size)

    def operator(times: Callable[[np.ndarray], np.ndarray]) -> LinearOperator:
        return LinearOperator((size, size), matvec=times, dtype=float)

    try:
        values, vectors = eigsh(
            operator(lack.__matmul__), 1, operator(convex.__matmul__), which="LA",
            Minv=operator(factor.solve), v0=towards, ncv=min(_BASIS, size), tol=_ACCURACY,
        )  # fmt: skip
    except ArpackError:  # no convergence
        return 1.0, None
    if not values[0] > 1.0:
        return 0.0, vectors[:, 0]
    return float(1.0 - 1.0 / values[0]), vectors[:, 0]
