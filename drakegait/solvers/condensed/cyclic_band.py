"""Symmetric matrices that couple neighbouring knots of periodic splines, and their factors.

Unknowns are ordered by knot. Two of them meet where their knots are at most five apart, so that
groups of five or more consecutive knots couple with the groups next to them only. The last group,
which the period joins to the first, and the unknowns of no knot (timing, placement) come last and
may meet all others:

    [ D_0  E_0'            F_0' ]
    [ E_0  D_1  E_1'       F_1' ]
    [      E_1  D_2  ..    ..   ]
    [           ..   ..    ..   ]
    [ F_0  F_1  ..   ..    C    ]

Eliminating one group after the other fills nothing in. Time and memory thus grow with the number
of knots, where those of a dense matrix grow with its third and second power.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import scipy.linalg
from scipy.linalg.blas import dtrsm
from scipy.linalg.lapack import dpotrf, dtrtrs

from drakegait.transcription.splines import SUPPORT

_LOWER = {"lower": 1}


class Group(NamedTuple):
    """The blocks of a group's columns: D, and below it E and F, which are stored together."""

    own: np.ndarray
    below: np.ndarray
    following: np.ndarray
    corner: np.ndarray


class CyclicBand:
    """Which unknowns are in which group, and where pairs of them are stored.

    Args:
        index: unknown of every coefficient (intervals, functions), -1 for none. If all unknowns
            stand for two coefficients half a period apart, as in a symmetric walker, the period
            of the unknowns is half as long.
        size: number of unknowns.
        beside: unknowns that may meet all others wherever their knots are.

    Attributes:
        size, length: of the matrix, and of its stored entries.
    """

    def __init__(self, index: np.ndarray, size: int, beside: np.ndarray):
        self.size = size
        ring, knots = _rings(index, size)
        knots[beside] = -1
        groups = _groups(knots, ring)
        self.order = np.argsort(groups, kind="stable")
        self._position = np.empty(size, dtype=int)
        self._position[self.order] = np.arange(size)
        counts = np.bincount(groups)
        self._starts = np.concatenate([[0], np.cumsum(counts)])
        self._group = groups
        # Stored blocks: (D, [E; F]) of every group but the last, then C.
        self._places: list[tuple[int, int, int]] = []  # of D, of [E; F], rows of E
        offset, last = 0, len(counts) - 1
        border = counts[last]
        for k in range(last):
            own, following = counts[k], counts[k + 1] if k + 1 < last else 0
            self._places.append((offset, offset + own * own, following))
            offset += own * (own + following + border)
        self._corner = offset
        self.length = offset + border * border
        self._corner_start = self._starts[last]

    @property
    def num_corner(self) -> int:
        """Number of unknowns in C."""
        return self.size - int(self._corner_start)

    def in_corner(self, unknowns: np.ndarray) -> np.ndarray:
        """Rows of C of `unknowns`, which must be there."""
        rows = self._position[unknowns] - self._corner_start
        assert (rows >= 0).all()
        return rows

    def places(self, rows: np.ndarray, columns: np.ndarray) -> np.ndarray:
        """Where pairs of unknowns are stored; of D and C both triangles are, of E and F one."""
        one, other = self._position[rows], self._position[columns]
        swapped = self._group[rows] < self._group[columns]
        row, column = np.where(swapped, other, one), np.where(swapped, one, other)
        lower, group = self._group[self.order[row]], self._group[self.order[column]]
        last = len(self._starts) - 2
        within = column - self._starts[group]
        out = self._corner + (row - self._corner_start) * self.num_corner + within
        for k, (own, beside, following) in enumerate(self._places):
            here = group == k
            count = self._starts[k + 1] - self._starts[k]
            assert np.isin(lower[here], [k, k + 1, last]).all()
            inside = here & (lower == k)
            out[inside] = own + ((row - self._starts[k]) * count + within)[inside]
            inside = here & (lower == k + 1) & (lower < last)
            out[inside] = beside + ((row - self._starts[k + 1]) * count + within)[inside]
            inside = here & (lower == last)
            beyond = row - self._corner_start + following
            out[inside] = beside + (beyond * count + within)[inside]
        return out

    def blocks(self, stored: np.ndarray) -> tuple[list[Group], np.ndarray]:
        """Views of every group's blocks, and C."""
        border, groups = self.num_corner, []
        for k, (own, beside, following) in enumerate(self._places):
            count = self._starts[k + 1] - self._starts[k]
            rows = following + border
            below = stored[beside : beside + rows * count].reshape(rows, count)
            groups.append(
                Group(
                    stored[own:beside].reshape(count, count),
                    below, below[:following], below[following:],
                )
            )  # fmt: skip
        return groups, stored[self._corner :].reshape(border, border)

    def parts(self, x: np.ndarray) -> tuple[list[np.ndarray], np.ndarray]:
        """Views of the groups' parts and the corner's in ordered rows."""
        bounds = zip(self._starts[:-2], self._starts[1:-1], strict=True)
        return [x[low:high] for low, high in bounds], x[self._corner_start :]


@dataclass
class CyclicBandMatrix:
    """A symmetric matrix with the structure of `band`; `stored` is laid out as that says."""

    band: CyclicBand
    stored: np.ndarray

    @classmethod
    def halved(cls, band: CyclicBand, stored: np.ndarray) -> CyclicBandMatrix:
        """A matrix whose D and C are to be added to their transposes."""
        groups, corner = band.blocks(stored)
        for block in (*(group.own for group in groups), corner):
            block += block.T.copy()
        return cls(band, stored)

    def plus(self, other: CyclicBandMatrix, share: float) -> CyclicBandMatrix:
        """self + share * other, with arrays of its own."""
        return CyclicBandMatrix(self.band, self.stored + share * other.stored)

    def copy(self) -> CyclicBandMatrix:
        """The same with arrays of its own."""
        return CyclicBandMatrix(self.band, self.stored.copy())

    def diagonal(self) -> np.ndarray:
        """The diagonal (size,)."""
        groups, corner = self.band.blocks(self.stored)
        out = np.empty(self.band.size)
        out[self.band.order] = np.concatenate(
            [*(np.diagonal(group.own) for group in groups), np.diagonal(corner)]
        )
        return out

    def add_diagonal(self, values: np.ndarray | float) -> None:
        """Add to the diagonal."""
        ordered = np.broadcast_to(values, self.band.size)[self.band.order]
        parts, last = self.band.parts(ordered)
        groups, corner = self.band.blocks(self.stored)
        for group, part in zip(groups, parts, strict=True):
            group.own.reshape(-1)[:: len(part) + 1] += part
        corner.reshape(-1)[:: len(corner) + 1] += last

    def add_corner(self, unknowns: np.ndarray, values: np.ndarray) -> None:
        """Add `values` (k, k) to the rows and columns of k unknowns of the corner."""
        rows = self.band.in_corner(unknowns)
        self.band.blocks(self.stored)[1][np.ix_(rows, rows)] += values

    def add_pairs(self, rows: np.ndarray, columns: np.ndarray, values: np.ndarray) -> None:
        """Add `values` (k,) to k pairs of unknowns of the corner, and to the pairs turned round."""
        corner = self.band.blocks(self.stored)[1]
        rows, columns = self.band.in_corner(rows), self.band.in_corner(columns)
        np.add.at(corner, (rows, columns), values)
        np.add.at(corner, (columns, rows), values)

    def add_rows(self, unknowns: np.ndarray, rows: np.ndarray) -> None:
        """Add `rows` (k, size) to the rows of unknowns of the corner, and to the columns."""
        groups, corner = self.band.blocks(self.stored)
        which = self.band.in_corner(unknowns)
        parts, last = self.band.parts(rows[:, self.band.order].T)
        for group, part in zip(groups, parts, strict=True):
            group.corner[which] += part.T
        corner[which] += last.T
        corner[:, which] += last

    def __matmul__(self, x: np.ndarray) -> np.ndarray:
        ordered = x[self.band.order]
        product = np.zeros_like(ordered)
        groups, corner = self.band.blocks(self.stored)
        (parts, last), (out, out_last) = self.band.parts(ordered), self.band.parts(product)
        out_last += corner @ last
        for k, group in enumerate(groups):
            out[k] += group.own @ parts[k] + group.corner.T @ last
            out_last += group.corner @ parts[k]
            if len(group.following):
                out[k] += group.following.T @ parts[k + 1]
                out[k + 1] += group.following @ parts[k]
        result = np.empty_like(product)
        result[self.band.order] = product
        return result

    def toarray(self) -> np.ndarray:
        """Dense (size, size)."""
        return self @ np.eye(self.band.size)

    def factor(self) -> CyclicBandFactor | None:
        """The Cholesky factor, in the place of the matrix; None if it is not positive definite."""
        groups, corner = self.band.blocks(self.stored)
        for k, group in enumerate(groups):
            # A C-ordered array is its transpose in LAPACK's order.
            _, info = dpotrf(group.own.T, **_LOWER, clean=0, overwrite_a=1)
            if info:
                return None
            dtrsm(1.0, group.own.T, group.below.T, side=0, **_LOWER, overwrite_b=1)
            corner -= group.corner @ group.corner.T
            if len(group.following):
                after = groups[k + 1]
                after.own[...] -= group.following @ group.following.T
                after.corner[...] -= group.corner @ group.following.T
        _, info = dpotrf(corner.T, **_LOWER, clean=0, overwrite_a=1)
        if info or not np.isfinite(corner[-1, -1]):
            return None
        return CyclicBandFactor(self.band, self.stored)


@dataclass(frozen=True)
class CyclicBandFactor:
    """L of K = L L^T, in the blocks of `CyclicBandMatrix`; of D and C their transposes' lower."""

    band: CyclicBand
    stored: np.ndarray

    def solve(self, right: np.ndarray) -> np.ndarray:
        """K^-1 times `right` (size,) or (size, k)."""
        x = np.array(right[self.band.order], order="F")
        groups, corner = self.band.blocks(self.stored)
        parts, last = self.band.parts(x)
        for k, group in enumerate(groups):
            parts[k][...] = _triangular(group.own, parts[k])
            last -= group.corner @ parts[k]
            if len(group.following):
                parts[k + 1] -= group.following @ parts[k]
        last[...] = scipy.linalg.cho_solve((corner.T, True), last, check_finite=False)
        for k, group in reversed([*enumerate(groups)]):
            parts[k] -= group.corner.T @ last
            if len(group.following):
                parts[k] -= group.following.T @ parts[k + 1]
            parts[k][...] = _triangular(group.own, parts[k], transposed=1)
        out = np.empty_like(x)
        out[self.band.order] = x
        return out


def _triangular(own: np.ndarray, right: np.ndarray, transposed: int = 0) -> np.ndarray:
    solution, _ = dtrtrs(own.T, right, **_LOWER, trans=transposed)
    return solution.reshape(right.shape)


def _rings(index: np.ndarray, size: int) -> tuple[int, np.ndarray]:
    """Number of knots in the unknowns' period, and the knot of every unknown or -1.

    A length of 0 says that the unknowns have no such order.
    """
    intervals = len(index)
    for ring in (intervals, intervals // 2):
        knots = np.full(size, -1)
        place = np.broadcast_to(np.arange(intervals)[:, None] % ring, index.shape)
        used = index >= 0
        knots[index[used]] = place[used]
        if (knots[index[used]] == place[used]).all():
            return ring, knots
    return 0, np.full(size, -1)


def _groups(knots: np.ndarray, ring: int) -> np.ndarray:
    """Group of every unknown; the last one holds those of no knot, too."""
    count = max(1, ring // (SUPPORT - 1))
    bounds = np.linspace(0, ring, count + 1).astype(int)
    groups = np.searchsorted(bounds, knots, side="right") - 1
    groups[knots < 0] = count - 1
    return groups
