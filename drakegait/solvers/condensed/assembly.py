"""From dense blocks at control points to one dense matrix in the shared unknowns.

Control points whose windows begin at the same knot are added up by one matrix product
before they are put into place.
"""

from __future__ import annotations

import numpy as np
import scipy.sparse

from drakegait.program.gait_program import GaitProgram


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
        # The few unknowns of timing and placement, and how each point's late variables are made
        # of them.
        late = slice(layout.time, layout.multipliers)
        index, factor = program.selection.index[:, late], program.selection.factor[:, late]
        self._late = np.unique(index[index >= 0])
        self._late_map = np.zeros((*index.shape, len(self._late)))
        point, position = np.nonzero(index >= 0)
        column = np.searchsorted(self._late, index[point, position])
        self._late_map[point, position, column] = factor[point, position]
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
        own, num = 3 * n + m, len(blocks)
        intervals, functions = self._intervals, self._functions
        full = np.zeros((intervals, intervals, functions, functions))
        by_late = np.zeros((len(self._late), intervals, functions))
        # Pairs of basis rows, and the blocks with those rows' orders beside the points.
        pairs = basis[:, :, None, :, None] * basis[:, None, :, None, :]
        motion = blocks[:, : 3 * n, : 3 * n].reshape(num, n, 3, n, 3)
        motion = motion.transpose(0, 2, 4, 1, 3).reshape(num, 9, n * n)
        cross = blocks[:, : 3 * n, 3 * n : own].reshape(num, n, 3, m)
        cross = cross.transpose(0, 2, 1, 3).reshape(num, 3, n * m)
        force = blocks[:, 3 * n : own, 3 * n : own].reshape(num, m * m)
        late = np.swapaxes(self._late_map, 1, 2) @ blocks[:, own:, :own]
        with_late = np.empty((num, len(self._late), width, functions))
        along = late[:, :, : 3 * n].reshape(num, -1, n, 3) @ basis[:, None]
        with_late[..., :n] = along.transpose(0, 1, 3, 2)
        with_late[..., n:] = basis[:, None, 0, :, None] * late[:, :, None, 3 * n :]
        for which, window in self._groups:
            count = len(which)
            part = np.empty((width, width, functions, functions))
            b = pairs[which].transpose(3, 4, 0, 1, 2).reshape(width * width, count, 9)
            by_motion = b.reshape(width * width, -1) @ motion[which].reshape(count * 9, -1)
            part[:, :, :n, :n] = by_motion.reshape(width, width, n, n)
            by_cross = b[:, :, ::3].reshape(width * width, -1) @ cross[which].reshape(count * 3, -1)
            part[:, :, :n, n:] = by_cross.reshape(width, width, n, m)
            part[:, :, n:, :n] = part[:, :, :n, n:].transpose(1, 0, 3, 2)
            part[:, :, n:, n:] = (b[:, :, 0] @ force[which]).reshape(width, width, m, m)
            full[np.ix_(window, window)] += part
            by_late[:, window] += with_late[which].sum(axis=0)
        total, spread = intervals * functions, self._spread
        square = full.transpose(0, 2, 1, 3).reshape(total, total)
        matrix += spread.T @ (spread.T @ square).T
        beside = by_late.reshape(len(self._late), total) @ spread
        matrix[self._late] += beside
        matrix[:, self._late] += beside.T
        corner = np.swapaxes(self._late_map, 1, 2) @ blocks[:, own:, own:] @ self._late_map
        matrix[np.ix_(self._late, self._late)] += corner.sum(axis=0)
