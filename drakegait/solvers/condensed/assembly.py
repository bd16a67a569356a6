"""From dense blocks at control points to one matrix in the shared unknowns.

Control points in the same interval between knots are added up by one matrix product. Two
coefficients meet only within the support of one instant, so blocks of all pairs of functions are
kept by knot and distance before they are put into place.
"""

from __future__ import annotations

import numpy as np
import scipy.sparse

from drakegait.program.excitation import MuscleChain
from drakegait.program.gait_program import GaitProgram
from drakegait.program.hessian_blocks import NUM_LATE, HessianBlocks
from drakegait.solvers.condensed.cyclic_band import CyclicBand, CyclicBandMatrix
from drakegait.transcription.splines import SUPPORT


class Assembly:
    """Makes a matrix from blocks in motion, forces and late variables (num, shared, shared).

    Args:
        program: whose coefficients, timing and placement are the unknowns.
        size: number of these unknowns.
    """

    def __init__(self, program: GaitProgram, size: int):
        points, splines = program.points, program.formulation.splines
        layout = points.layout
        self._n, self._m = layout.num_coordinates, layout.num_muscles
        self._intervals, self._size = splines.num_intervals, size
        self._functions = self._n + self._m
        self._spans = MuscleChain(program.formulation)
        self._low, self._high = np.triu_indices(SUPPORT)  # the earlier and the later coefficient
        self._forward = self._low * SUPPORT + self._high
        self._backward = self._high * SUPPORT + self._low
        self._first = points.first
        parts = [program.design.selection(name) for name in ("coordinates", "forces")]
        index = np.concatenate([part.index for part in parts]).T
        factor = np.concatenate([part.factor for part in parts]).T
        # Rows of no control point may join any unknowns.
        free = program.jacobian_rows >= program.first_timing_row
        beside = np.unique(program.jacobian_columns[free])
        self.band = CyclicBand(index, size, beside[beside < size])
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
        later = (np.arange(self._intervals)[:, None] + np.arange(SUPPORT)) % self._intervals
        rows, columns = index[:, None, :, None], index[later][:, :, None]
        used = (rows >= 0) & (columns >= 0)
        scale = np.where(used, factor[:, None, :, None] * factor[later][:, :, None], 0.0)
        scale[:, 0] *= 0.5  # the matrix is this and its transpose
        rows, columns = np.broadcast_arrays(rows, columns)
        self._pair_place = np.zeros(used.shape, dtype=int)
        self._pair_place[used] = self.band.places(rows[used], columns[used])
        self._pair_place = self._pair_place.ravel()
        self._pair_scale = scale.reshape(-1, self._functions, self._functions)
        used = index.ravel() >= 0
        entries = factor.ravel()[used], (np.flatnonzero(used), index.ravel()[used])
        self._spread = scipy.sparse.csr_array(entries, shape=(index.size, self._size))

    def matrix(self, dense: np.ndarray, blocks: HessianBlocks) -> CyclicBandMatrix:
        """The sum of all blocks.

        Args:
            dense: (num, shared, shared), symmetric, by coordinates of the orders 0, 1, 2, forces
                of order 0 and late variables.
            blocks: of the Hessian; `force`, `cross`, `late_motion` and `late_force` are added.
        """
        pairs, beside = self._sums(dense, blocks)
        pairs *= self._pair_scale
        stored = np.bincount(self._pair_place, pairs.ravel(), self.band.length)
        matrix = CyclicBandMatrix.halved(self.band, stored)
        matrix.add_rows(self._late, beside @ self._spread)
        own = 3 * self._n + self._m
        corner = np.swapaxes(self._late_map, 1, 2) @ dense[:, own:, own:] @ self._late_map
        matrix.add_corner(self._late, corner.sum(axis=0))
        return matrix

    def _groups(
        self, rows: np.ndarray
    ) -> tuple[np.ndarray, list[tuple[np.ndarray, np.ndarray, np.ndarray]]]:
        """Basis rows of their support (num, orders, 6), and of every interval between knots the
        points there, their coefficients' knots and the places of pairs of those."""
        ahead = (rows != 0.0).any(axis=1).argmax(axis=1)
        ahead = np.minimum(ahead, rows.shape[2] - SUPPORT)
        support = ahead[:, None, None] + np.arange(SUPPORT)
        first = (self._first + ahead) % self._intervals
        found = []
        for k in np.unique(first):
            place = (k + self._low) % self._intervals * SUPPORT + self._high - self._low
            window = (k + np.arange(SUPPORT)) % self._intervals
            found.append((np.flatnonzero(first == k), window, place))
        return np.take_along_axis(rows, support, axis=2), found

    def _sums(self, dense: np.ndarray, blocks: HessianBlocks) -> tuple[np.ndarray, np.ndarray]:
        """By knot and distance (intervals * 6, functions, functions), and with the late
        unknowns (late, intervals * functions)."""
        n, m, functions = self._n, self._m, self._functions
        own, num = 3 * n + m, len(dense)
        basis, groups = self._groups(blocks.rows)
        b = basis[:, :3]
        # Products of two basis rows, and the blocks with those rows' orders beside the points.
        products = (b[:, :, None, :, None] * b[:, None, :, None]).reshape(num, 9, -1)
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

        pairs = np.zeros((self._intervals * SUPPORT, functions, functions))
        beside = np.zeros((self._intervals, late.shape[2]))
        part = np.empty((len(self._forward), functions, functions))
        own_part = part.reshape(len(part), -1)[:, n * (functions + 1) :: functions + 1]
        for which, window, place in groups:
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
            rows = basis[which].reshape(count * 4, SUPPORT)
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
