"""The least share of convexity against eigenvalues of dense matrices."""

from __future__ import annotations

import numpy as np
import pytest
import scipy.linalg

from drakegait.solvers.condensed.cyclic_band import CyclicBand, CyclicBandMatrix
from drakegait.solvers.condensed.least_convexity import least_share
from drakegait.transcription.splines import SUPPORT

KNOTS, FUNCTIONS = 20, 3
INDEX = np.arange(KNOTS * FUNCTIONS).reshape(FUNCTIONS, KNOTS).T
BAND = CyclicBand(INDEX, INDEX.size, np.arange(0))


def banded(random: np.random.Generator, rank: int) -> CyclicBandMatrix:
    """A sum of positive semidefinite matrices over the unknowns that an instant knows."""
    stored = np.zeros(BAND.length)
    for k in range(KNOTS):
        window = np.unique(INDEX[(k + np.arange(SUPPORT)) % KNOTS])
        root = random.normal(size=(len(window), rank))
        rows, columns = (part.ravel() for part in np.meshgrid(window, window, indexing="ij"))
        upper = rows <= columns
        weight = np.where(rows == columns, 0.5, 1.0)
        places = BAND.places(rows[upper], columns[upper])
        np.add.at(stored, places, ((root @ root.T).ravel() * weight)[upper])
    return CyclicBandMatrix.halved(BAND, stored)


def convex_and_lack(scale: float) -> tuple[CyclicBandMatrix, CyclicBandMatrix]:
    """C, and so many times an L; the more of it, the more K = C - L lacks."""
    random = np.random.default_rng(8)
    convex, lack = banded(random, 12), banded(random, 1)
    lack.stored *= scale
    return convex, lack


@pytest.mark.parametrize("scale", [2.0, 10.0])
def test_it_is_the_share_from_which_on_the_matrix_is_positive_definite(scale: float) -> None:
    convex, lack = convex_and_lack(scale)
    share, direction = least_share(lack, convex, convex.copy().factor())
    largest = scipy.linalg.eigh(lack.toarray(), convex.toarray(), eigvals_only=True)[-1]
    assert 0.05 < 1.0 - 1.0 / largest < 0.95  # else it would say nothing
    assert 1.0 - share == pytest.approx(1.0 / largest, rel=0.05)
    for times, positive in ((1.2, True), (0.8, False)):
        matrix = convex.plus(lack, times * share - 1.0)
        assert (matrix.factor() is not None) == positive
    # Along its direction that matrix is flat.
    curvature = direction @ (convex.plus(lack, share - 1.0) @ direction)
    assert abs(curvature) < 0.05 * (direction @ (convex @ direction))


def test_nothing_is_needed_where_nothing_lacks() -> None:
    convex, lack = convex_and_lack(0.1)
    share, _ = least_share(lack, convex, convex.copy().factor())
    assert share == 0.0


def test_the_direction_of_the_matrix_before_is_a_start_and_no_more() -> None:
    convex, lack = convex_and_lack(10.0)
    factor = convex.copy().factor()
    share, direction = least_share(lack, convex, factor)
    again, _ = least_share(lack, convex, factor, direction)
    other, _ = least_share(lack, convex, factor, np.arange(1.0, INDEX.size + 1.0))
    assert again == pytest.approx(share, rel=0.05)
    assert other == pytest.approx(share, rel=0.05)
