"""Forward differences of a program's own values, and how few evaluations they need."""

from __future__ import annotations

import numpy as np
import pytest
import scipy.sparse
from program_cases import program, study

from drakegait.errors import InvalidInput
from drakegait.program.differences import DifferencedProgram, colours
from drakegait.program.guess import guess_from_reference
from drakegait.solve import solve
from drakegait.study import GaitStudy

MODELS = ("planar", "planar-symmetric", "spatial-symmetric")


def test_columns_of_one_colour_share_no_row():
    random = np.random.default_rng(0)
    dense = random.uniform(size=(30, 40)) < 0.08
    colour = colours(scipy.sparse.csc_array(dense.astype(float)))
    for one in range(colour.max() + 1):
        assert dense[:, colour == one].sum(axis=1).max() <= 1
    assert dense.sum(axis=1).max() <= colour.max() + 1 < 40


def test_known_patterns():
    assert (colours(scipy.sparse.csc_array(np.eye(5))) == 0).all()
    assert sorted(colours(scipy.sparse.csc_array(np.ones((1, 4))))) == [0, 1, 2, 3]
    band = scipy.sparse.diags_array([1.0, 1.0, 1.0], offsets=[-1, 0, 1], shape=(9, 9)).tocsc()
    assert colours(scipy.sparse.csc_array(band)).max() <= 4


@pytest.mark.parametrize("model", MODELS)
def test_they_agree_with_the_exact_derivatives(model):
    exact = program(model, limits=())
    formulation = study(model, limits=()).formulation()
    coloured = DifferencedProgram(formulation)
    one_by_one = DifferencedProgram(formulation, coloured=False)
    x = guess_from_reference(exact)
    x = x + 0.02 * np.random.default_rng(1).uniform(-1.0, 1.0, x.size)
    jacobian, gradient = exact.jacobian(x), exact.gradient(x)
    for differenced in (coloured, one_by_one):
        found = differenced.jacobian(x)
        np.testing.assert_allclose(found, jacobian, atol=2e-6 * np.abs(jacobian).max())
        np.testing.assert_allclose(
            differenced.gradient(x), gradient, atol=1e-5 * np.abs(gradient).max()
        )
    assert coloured.num_colours < exact.num_variables == one_by_one.num_colours
    # Once for x itself and once for each colour, for gradient and Jacobian together.
    assert coloured.evaluations == coloured.num_colours + 1
    assert one_by_one.evaluations == exact.num_variables + 1


def test_values_are_those_of_the_program():
    exact = program("planar", limits=())
    differenced = DifferencedProgram(study("planar", limits=()).formulation())
    x = guess_from_reference(exact)
    np.testing.assert_allclose(differenced.rows(x), exact.rows(x), atol=1e-9)
    assert differenced.cost(x) == pytest.approx(exact.cost(x), rel=1e-12)


def test_drakes_solvers_are_refused():
    with pytest.raises(InvalidInput, match="ipopt-mumps with finite differences"):
        solve(GaitStudy.planar(), solver="ipopt", derivatives="finite-differences")
