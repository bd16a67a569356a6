"""From dense blocks at control points to one dense matrix in the shared unknowns.

Control points whose windows begin at the same knot are added up by one matrix product.
Two coefficients meet only within a window, so blocks of all pairs of functions are kept by
knot and distance before they are put into place.
"""

from __future__ import annotations

import numpy as np
import scipy.sparse

from drakegait.program.excitation import MuscleChain
from drakegait.program.gait_program import GaitProgram
from drakegait.program.hessian_blocks import NUM_LATE, HessianBlocks


class Assembly:
    """Makes a matrix from blocks in motion, forces and late variables (num, shared, shared).

    Args:
        program: whose coefficients, timing and placement are the unknowns.
        size: number of these unknowns.
    """

    def __init__(self, program: GaitProgram, size: int):
        points, splines = program.points, program.formulation.splines
        layout = points.layout
        self._n, self._m, self._width = layout.num_coordinates, layout.num_muscles, layout.width
        self._intervals, self._size = splines.num_intervals, size
        self._functions = self._n + self._m
        self._spans = MuscleChain(program.formulation, points)
        low, high = np.triu_indices(self._width)  # the earlier and the later coefficient
        self._forward = low * self._width + high
        self._backward = high * self._width + low
        first = points.first % self._intervals
        self._groups = []
        for k in np.unique(first):
            place = (k + low) % self._intervals * self._width + high - low
            window = (k + np.arange(self._width)) % self._intervals
            self._groups.append((np.flatnonzero(first == k), window, place))
        parts = [program.design.selection(name) for name in ("coordinates", "forces")]
        index = np.concatenate([part.index for part in parts]).T
        factor = np.concatenate([part.factor for part in parts]).T
        self._locate(np.ascontiguousarray(index), np.ascontiguousarray(factor))
        # The few unknowns of timing and placement, and how each point's late variables are made
        # of them.
        late = slice(layout.time, layout.multipliers)
        index, factor = program.selection.index[:, late], program.selection.factor[:, late]
        self._late = np.unique(index[index >= 0])
        self._late_map = np.zeros((*index.shape, len(self._late)))
        point, position = np.nonzero(index >= 0)
        column = np.searchsorted(self._late, index[point, position])
        self._late_map[point, position, column] = factor[point, position]

    def _locate(self, index: np.ndarray, factor: np.ndarray) -> None:
        """Where pairs of full coefficients (intervals, functions) go in the matrix."""
        later = (np.arange(self._intervals)[:, None] + np.arange(self._width)) % self._intervals
        rows, columns = index[:, None, :, None], index[later][:, :, None]
        used = (rows >= 0) & (columns >= 0)
        scale = np.where(used, factor[:, None, :, None] * factor[later][:, :, None], 0.0)
        scale[:, 0] *= 0.5  # the matrix is this and its transpose
        self._pair_place = np.where(used, rows * self._size + columns, 0).ravel()
        self._pair_scale = scale.reshape(-1, self._functions, self._functions)
        used = index.ravel() >= 0
        entries = factor.ravel()[used], (np.flatnonzero(used), index.ravel()[used])
        self._spread = scipy.sparse.csr_array(entries, shape=(index.size, self._size))

    def matrix(self, dense: np.ndarray, blocks: HessianBlocks) -> np.ndarray:
        """The sum of all blocks (size, size), symmetric.

        Args:
            dense: (num, shared, shared), symmetric, by coordinates of the orders 0, 1, 2, forces
                of order 0 and late variables.
            blocks: of the Hessian; `force`, `cross`, `late_motion` and `late_force` are added.
        """
        pairs, beside = self._sums(dense, blocks)
        pairs *= self._pair_scale
        size = self._size
        half = np.bincount(self._pair_place, pairs.ravel(), size * size).reshape(size, size)
        matrix = half + half.T
        beside = beside @ self._spread
        matrix[self._late] += beside
        matrix[:, self._late] += beside.T
        own = 3 * self._n + self._m
        corner = np.swapaxes(self._late_map, 1, 2) @ dense[:, own:, own:] @ self._late_map
        matrix[np.ix_(self._late, self._late)] += corner.sum(axis=0)
        return matrix

    def _sums(self, dense: np.ndarray, blocks: HessianBlocks) -> tuple[np.ndarray, np.ndarray]:
        """By knot and distance (intervals * width, functions, functions), and with the late
        unknowns (late, intervals * functions)."""
        n, m, width, functions = self._n, self._m, self._width, self._functions
        own, num = 3 * n + m, len(dense)
        b = blocks.rows[:, :3]
        # Products of two basis rows, and the blocks with those rows' orders beside the points.
        products = (b[:, :, None, :, None] * b[:, None, :, None]).reshape(num, 9, width * width)
        upper = products[:, :, self._forward]
        motion = dense[:, : 3 * n, : 3 * n].reshape(num, n, 3, n, 3)
        motion = motion.transpose(0, 2, 4, 1, 3).reshape(num, 9, n * n)
        force = dense[:, 3 * n : own, 3 * n : own].reshape(num, m * m)
        own_force = blocks.force.transpose(0, 2, 3, 1).reshape(num, 9, m)
        meeting = dense[:, : 3 * n, 3 * n : own].reshape(num, n, 3, m)
        meeting = meeting.transpose(0, 2, 1, 3).reshape(num, 3, n * m)
        spans = self._spans
        crossed = blocks.cross[:, spans.muscle_of_span] * -spans.arm_of_span[:, None, None]
        crossed = crossed.transpose(0, 3, 2, 1).reshape(num, 9, -1)  # orders of length, of force
        span = spans.coordinate_of_span * m + spans.muscle_of_span
        late = self._with_late(dense[:, own:, :own], blocks)

        pairs = np.zeros((self._intervals * width, functions, functions))
        beside = np.zeros((self._intervals, late.shape[2]))
        part = np.empty((len(self._forward), functions, functions))
        own_part = part.reshape(len(part), -1)[:, n * (functions + 1) :: functions + 1]
        for which, window, place in self._groups:
            count = len(which)
            whole, half = products[which], upper[which]
            flat = half.reshape(count * 9, -1).T
            by_motion = flat @ motion[which].reshape(count * 9, -1)
            part[:, :n, :n] = by_motion.reshape(-1, n, n)
            part[:, n:, n:] = (half[:, 0].T @ force[which]).reshape(-1, m, m)
            own_part += flat @ own_force[which].reshape(count * 9, -1)
            across = whole[:, ::3].reshape(count * 3, -1).T @ meeting[which].reshape(count * 3, -1)
            across[:, span] += whole.reshape(count * 9, -1).T @ crossed[which].reshape(
                count * 9, -1
            )
            across = across.reshape(-1, n, m)
            part[:, :n, n:] = across[self._forward]
            part[:, n:, :n] = np.swapaxes(across[self._backward], 1, 2)
            pairs[place] += part
            rows = blocks.rows[which].reshape(count * 4, width)
            beside[window] += rows.T @ late[which].reshape(count * 4, -1)
        beside = beside.reshape(self._intervals, -1, functions).transpose(1, 0, 2)
        return pairs, beside.reshape(len(self._late), -1)

    def _with_late(self, dense: np.ndarray, blocks: HessianBlocks) -> np.ndarray:
        """Late unknowns with functions by order (num, 4, late * functions)."""
        n, num = self._n, len(dense)
        by_order = np.empty((num, dense.shape[1], 4, self._functions))
        by_order[..., :n] = np.swapaxes(blocks.late_motion, 2, 3)
        by_order[..., n:] = np.swapaxes(blocks.late_force, 2, 3)
        by_order[:, :, :3, :n] += np.swapaxes(dense[..., : 3 * n].reshape(num, -1, n, 3), 2, 3)
        by_order[:, :, 0, n:] += dense[..., 3 * n :]
        late = np.swapaxes(self._late_map, 1, 2) @ by_order.reshape(num, dense.shape[1], -1)
        return late.reshape(num, -1, 4, self._functions).transpose(0, 2, 1, 3).reshape(num, 4, -1)


def add_square(matrix: np.ndarray, rows: np.ndarray, weight: np.ndarray) -> None:
    """Add rows^T diag(weight) rows at each control point; rows (num, k, n), weight (num, k)."""
    matrix += np.swapaxes(rows, 1, 2) @ (weight[:, :, None] * rows)


def own_blocks(blocks: HessianBlocks, shared: int) -> np.ndarray:
    """Blocks by motion and by late unknowns at their places in (num, shared, shared)."""
    num, n = blocks.motion.shape[:2]
    out = np.zeros((num, shared, shared))
    out[:, : 3 * n, : 3 * n] = blocks.motion.reshape(num, 3 * n, 3 * n)
    out[:, shared - NUM_LATE :, shared - NUM_LATE :] = blocks.late
    return out
