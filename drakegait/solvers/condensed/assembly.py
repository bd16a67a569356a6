"""From dense blocks at control points to one dense matrix in the shared unknowns.

Control points whose windows begin at the same knot are added up by one matrix product
before they are put into place.
"""

from __future__ import annotations

import numpy as np
import scipy.sparse

from drakegait.program.gait_program import GaitProgram
from drakegait.program.hessian_blocks import NUM_LATE


class Assembly:
    """Adds blocks in motion, forces and late variables (num, shared, shared) to a matrix.

    Args:
        program: whose coefficients, timing and placement are the unknowns.
        size: number of these unknowns.
    """

    def __init__(self, program: GaitProgram, size: int):
        points, splines = program.points, program.formulation.splines
        layout = points.layout
        self._n, self._m, self._width = layout.num_coordinates, layout.num_muscles, layout.width
        self._intervals = splines.num_intervals
        self._functions = self._n + self._m
        first = points.first % self._intervals
        self._groups = [
            (np.flatnonzero(first == k), (k + np.arange(self._width)) % self._intervals)
            for k in np.unique(first)
        ]
        self._spread = self._coefficients(program, size)
        index = program.selection.index[:, layout.time : layout.multipliers]
        self._late_index = np.where(index >= 0, index, size)
        self._late_factor = program.selection.factor[:, layout.time : layout.multipliers]
        self._size = size

    def _coefficients(self, program: GaitProgram, size: int) -> scipy.sparse.csr_array:
        """Full coefficients, knot by knot, from the unknowns."""
        parts = [program.design.selection(name) for name in ("coordinates", "forces")]
        index = np.concatenate([part.index for part in parts])
        factor = np.concatenate([part.factor for part in parts])
        rows = np.arange(index.size).reshape(self._intervals, self._functions).T
        used = index >= 0
        return scipy.sparse.csr_array(
            (factor[used], (rows[used], index[used])), shape=(index.size, size)
        )

    def add(self, matrix: np.ndarray, blocks: np.ndarray, basis: np.ndarray) -> None:
        """Add `blocks` (num, shared, shared), symmetric, to `matrix` (size, size).

        Args:
            basis: weights of the window's coefficients for the orders 0, 1, 2, (num, 3, width).
        """
        n, m, width = self._n, self._m, self._width
        own = 3 * n + m
        total = self._intervals * self._functions
        full = np.zeros((self._intervals, self._intervals, self._functions, self._functions))
        with_late = np.empty((len(blocks), NUM_LATE, self._functions, width))
        late = blocks[:, own:, :own]
        with_late[:, :, :n] = late[:, :, : 3 * n].reshape(-1, NUM_LATE, n, 3) @ basis[:, None]
        with_late[:, :, n:] = late[:, :, 3 * n :, None] * basis[:, None, None, 0]
        by_late = np.zeros((self._size + 1, self._intervals, self._functions))
        for which, window in self._groups:
            b = basis[which]
            part = np.empty((width, width, self._functions, self._functions))
            pairs = np.einsum("kau,kbv->uvabk", b, b).reshape(width * width, -1)
            motion = blocks[which, : 3 * n, : 3 * n].reshape(-1, n, 3, n, 3)
            motion = motion.transpose(2, 4, 0, 1, 3).reshape(-1, n * n)
            part[:, :, :n, :n] = (pairs @ motion).reshape(width, width, n, n)
            b0 = b[:, 0]
            pairs = np.einsum("kau,kv->uvak", b, b0).reshape(width * width, -1)
            cross = blocks[which, : 3 * n, 3 * n : own].reshape(-1, n, 3, m)
            cross = cross.transpose(2, 0, 1, 3).reshape(-1, n * m)
            part[:, :, :n, n:] = (pairs @ cross).reshape(width, width, n, m)
            part[:, :, n:, :n] = part[:, :, :n, n:].transpose(1, 0, 3, 2)
            pairs = np.einsum("ku,kv->uvk", b0, b0).reshape(width * width, -1)
            force = blocks[which, 3 * n : own, 3 * n : own].reshape(-1, m * m)
            part[:, :, n:, n:] = (pairs @ force).reshape(width, width, m, m)
            full[np.ix_(window, window)] += part
            # At most a few dozen points share a window: one by one for the late variables.
            for k in which:
                rows = with_late[k] * self._late_factor[k][:, None, None]
                target = np.ix_(self._late_index[k], window)
                np.add.at(by_late, target, rows.transpose(0, 2, 1))
        square = full.transpose(0, 2, 1, 3).reshape(total, total)
        spread = self._spread
        matrix += spread.T @ (spread.T @ square).T
        cross = by_late[: self._size].reshape(self._size, total) @ spread
        matrix += cross + cross.T
        corner = blocks[:, own:, own:] * self._late_factor[:, :, None]
        corner = corner * self._late_factor[:, None]
        padded = np.zeros((self._size + 1, self._size + 1))
        index = self._late_index
        np.add.at(padded, (index[:, :, None], index[:, None]), corner)
        matrix += padded[:-1, :-1]
