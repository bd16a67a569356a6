"""Moments and forces without a source, eliminated at every control point.

Where the equations of motion may break, each of their rows has a reserve r of its own,

    R dy - C^T dlambda - de + dr = -c_1,      dr = -D dy_1,

with y_1 their multipliers and D how far a row gives way for its multiplier. With B the change
of the local unknowns (lambda, e) with r and H their second derivatives, stationarity in r gives

    (D^-1 + B^T H B) dr = B^T (b - H dl_0 - (H A + W) dy),

A being their change with the shared unknowns y, W the mixed second derivatives, dl_0 what makes
up for the rows. It is solved in r / D^(1/2), so that a row that cannot give way is no exception.
"""

from __future__ import annotations

import numpy as np

from drakegait.solvers.condensed.local_elimination import LocalElimination

_LEAST = 0.1  # eigenvalue of I + D^(1/2) B^T H B D^(1/2)


class Reserves:
    """The elimination of r at all control points.

    Args:
        elimination: of the local unknowns.
        local, mixed: H and W, see `Linearisation`.
        compliance: D, physical units (num, n).

    Attributes:
        share: of D that is used (num,). Less than 1 where the problem is not convex in r.
        by_shared: change of the local unknowns with the shared ones, reserves following
            (num, 14 + n, shared).
        reduction: what their following takes from the second derivatives by shared unknowns
            (num, shared, shared).
    """

    def __init__(
        self,
        elimination: LocalElimination,
        local: np.ndarray,
        mixed: np.ndarray,
        compliance: np.ndarray,
    ):
        contact = elimination.contact
        multipliers = elimination.inverse @ contact
        residuals = np.eye(contact.shape[2]) - np.swapaxes(contact, 1, 2) @ multipliers
        by_reserve = np.concatenate([multipliers, residuals], axis=1)
        by_reserve *= np.sqrt(compliance)[:, None]
        own = np.swapaxes(by_reserve, 1, 2) @ local @ by_reserve
        lowest = np.linalg.eigvalsh(own)[:, 0]
        with np.errstate(divide="ignore"):
            self.share = np.minimum(1.0, (1.0 - _LEAST) / np.maximum(-lowest, 0.0))
        self._by_reserve = by_reserve * np.sqrt(self.share)[:, None, None]
        self._own = np.eye(contact.shape[2]) + self.share[:, None, None] * own
        self._along = np.swapaxes(self._by_reserve, 1, 2)
        cross = self._along @ (local @ elimination.by_shared + mixed)
        following = np.linalg.solve(self._own, cross)
        self.by_shared = elimination.by_shared - self._by_reserve @ following
        self.reduction = np.swapaxes(cross, 1, 2) @ following

    def follow(self, rest: np.ndarray) -> np.ndarray:
        """Change of the local unknowns with r where b - H dl_0 is `rest` (num, 14 + n)."""
        wanted = self._along @ rest[..., None]
        return (self._by_reserve @ np.linalg.solve(self._own, wanted))[..., 0]
