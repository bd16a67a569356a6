"""Equality rows of no control point, such as the average speed, which keep their multipliers.

    [ K  B^T ] [ dx ]   [  b ]
    [ B  -D  ] [ y  ] = [ -c ]

D is how far a row gives way for its multiplier: zero, but for laws that may break.
"""

from __future__ import annotations

import numpy as np

from drakegait.solvers.condensed.cyclic_band import CyclicBandFactor, CyclicBandMatrix

_LITTLE = 1e-30  # compliance that is none


class Border:
    """The rows B beside a matrix K, of which a multiple of B^T B makes more.

    On the null space of B nothing changes by that; elsewhere K need not be definite.

    Args:
        rows: B (num, size).
        compliance: the diagonal of D (num,).

    Attributes:
        factor: of K + B^T w B.
    """

    def __init__(self, rows: np.ndarray, compliance: np.ndarray):
        self._rows, self._compliance = rows, compliance
        self._few = np.flatnonzero(rows.any(axis=0))  # timing and placement

    def weigh(self, matrix: CyclicBandMatrix, plain: CyclicBandMatrix) -> None:
        """Add B^T w B to `matrix`, w about as large as entries of `plain`."""
        typical = np.abs(plain.diagonal()).mean()
        # With w of at most 1 / D, K + B^T w B is definite only if the whole system is as it should.
        self._weight = np.minimum(typical, 1.0 / np.maximum(self._compliance, _LITTLE))
        self._left = 1.0 - self._weight * self._compliance
        few = self._rows[:, self._few]
        matrix.add_corner(self._few, (self._weight * few.T) @ few)

    def factored(self, factor: CyclicBandFactor) -> None:
        """Take note of the factor of K + B^T w B."""
        self.factor = factor
        self._by_row = factor.solve(self._rows.T)
        self._schur = self._rows @ self._by_row * self._left + np.diag(self._compliance)

    def solve(self, b: np.ndarray, c: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """dx and y."""
        reduced = b - (self._weight * self._rows.T) @ c
        x = self.factor.solve(reduced)
        y = np.linalg.solve(self._schur, self._rows @ x + c)
        return x - self._by_row @ (self._left * y), y
