"""Matrices that couple neighbouring knots: sums, products and factors against dense ones."""

from __future__ import annotations

import numpy as np
import pytest

from drakegait.solvers.condensed.cyclic_band import CyclicBand, CyclicBandMatrix
from drakegait.transcription.splines import SUPPORT

FUNCTIONS, LATE = 3, 4


def periodic(intervals: int) -> np.ndarray:
    """Every function has its own unknown at every knot, by function."""
    return np.arange(FUNCTIONS * intervals).reshape(FUNCTIONS, intervals).T


def symmetric(intervals: int) -> np.ndarray:
    """Two functions are each other's half a period later, the third is its own."""
    half = intervals // 2
    one, own = np.arange(intervals), intervals + np.tile(np.arange(half), 2)
    return np.stack([one, np.roll(one, -half), own], axis=1)


def fixed(intervals: int) -> np.ndarray:
    """Some coefficients are no unknowns, as of a joint that is locked for a while."""
    index = periodic(intervals)
    kept = np.ones(index.shape, dtype=bool)
    kept[2:4, 1] = False
    return np.where(kept, np.cumsum(kept.T).reshape(index.T.shape).T - 1, -1)


LAYOUTS = {
    "periodic": periodic(23),
    "just three groups": periodic(15),
    "one group": periodic(9),
    "symmetric": symmetric(34),
    "fixed": fixed(17),
}


class Case:
    """A random matrix whose unknowns meet within the support of an instant."""

    def __init__(self, index: np.ndarray, beside: int = 0):
        random = np.random.default_rng(5)
        size = index.max() + 1 + LATE
        late = np.arange(size - LATE, size)
        others = np.append(np.arange(beside), late)
        self.band = CyclicBand(index, size, others)
        stored = np.zeros(self.band.length)
        self.dense = np.zeros((size, size))
        for k in range(len(index)):
            window = index[(k + np.arange(SUPPORT)) % len(index)].ravel()
            window = np.unique(window[window >= 0])
            root = random.normal(size=(len(window), len(window)))
            block = root @ root.T + np.eye(len(window))
            self.dense[np.ix_(window, window)] += block
            rows, columns = (part.ravel() for part in np.meshgrid(window, window, indexing="ij"))
            upper = rows <= columns
            weight = np.where(rows == columns, 0.5, 1.0)
            places = self.band.places(rows[upper], columns[upper])
            np.add.at(stored, places, (block.ravel() * weight)[upper])
        self.matrix = CyclicBandMatrix.halved(self.band, stored)
        rows = random.normal(size=(len(others), size))
        self.matrix.add_rows(others, rows)
        self.dense[others] += rows
        self.dense[:, others] += rows.T
        diagonal = np.abs(self.dense).sum(axis=1)  # surely positive definite
        self.matrix.add_diagonal(diagonal)
        self.dense += np.diag(diagonal)


@pytest.fixture(params=[(name, beside) for name in LAYOUTS for beside in (0, 7)], ids=str)
def case(request: pytest.FixtureRequest) -> Case:
    name, beside = request.param
    return Case(LAYOUTS[name], beside)


def test_it_is_the_dense_matrix(case: Case) -> None:
    np.testing.assert_allclose(case.matrix.toarray(), case.dense, atol=1e-10)
    np.testing.assert_allclose(case.matrix.diagonal(), np.diag(case.dense), atol=1e-10)


def test_products_and_sums_are_those_of_dense_matrices(case: Case) -> None:
    x = np.random.default_rng(6).normal(size=(len(case.dense), 2))
    twice = case.matrix.plus(case.matrix, 0.5)
    np.testing.assert_allclose(twice @ x, 1.5 * case.dense @ x, atol=1e-9)
    np.testing.assert_allclose(case.matrix @ x[:, 0], case.dense @ x[:, 0], atol=1e-9)


def test_its_factor_solves(case: Case) -> None:
    right = np.random.default_rng(7).normal(size=(len(case.dense), 3))
    factor = case.matrix.copy().factor()
    assert factor is not None
    expected = np.linalg.solve(case.dense, right)
    scale = np.abs(expected).max()
    np.testing.assert_allclose(factor.solve(right), expected, atol=1e-12 * scale)
    np.testing.assert_allclose(factor.solve(right[:, 1]), expected[:, 1], atol=1e-12 * scale)


@pytest.mark.parametrize("share", [0.999, 1.001])
def test_factorising_tells_whether_all_eigenvalues_are_positive(case: Case, share: float) -> None:
    lowest = np.linalg.eigvalsh(case.dense)[0]
    case.matrix.add_diagonal(-share * lowest)
    assert (case.matrix.factor() is None) == (share > 1.0)


def test_stored_entries_grow_with_the_knots_not_with_their_square() -> None:
    short, long = (CyclicBand(periodic(m), FUNCTIONS * m, np.arange(0)) for m in (40, 80))
    assert long.length < 2.3 * short.length < 0.6 * long.size**2


def test_unknowns_in_no_order_of_knots_are_one_dense_group() -> None:
    index = periodic(30)
    index[20, 0] = index[3, 0]  # the same coefficient at two places
    band = CyclicBand(index, index.max() + 1, np.arange(0))
    assert band.num_corner == band.size and band.length == band.size**2
