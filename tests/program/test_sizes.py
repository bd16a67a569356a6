"""How large each model's program is, stated exactly: what grows costs time, and nobody notices.

A change that is meant to change a size changes it here, and says so in its commit.
"""

from __future__ import annotations

from dataclasses import astuple, dataclass

import numpy as np
import pytest

from drakegait.program.gait_program import GaitProgram
from drakegait.program.lagrangian_hessian import LagrangianHessian
from drakegait.solvers.condensed.system import CondensedSystem
from drakegait.study import GaitStudy


@dataclass(frozen=True)
class Sizes:
    """Sizes of a study's program.

    Attributes:
        points: control points.
        variables, rows: of the program.
        jacobian, hessian: entries that may be other than zero; of the Hessian of the Lagrangian
            those of the lower triangle.
        core: unknowns that the condensed solver is left with, a dense matrix.
    """

    points: int
    variables: int
    rows: int
    jacobian: int
    hessian: int
    core: int


KNOWN = {
    ("spatial", 18): Sizes(76, 2399, 6799, 402125, 128981, 761),
    ("spatial", 35): Sizes(152, 4795, 13595, 989073, 319650, 1509),
    ("spatial-symmetric", 19): Sizes(40, 1263, 3573, 209499, 62392, 403),
    ("planar", 18): Sizes(76, 1349, 3857, 137314, 40028, 435),
    ("planar-symmetric", 19): Sizes(40, 710, 2028, 71306, 19124, 230),
    ("planar-symmetric", 35): Sizes(76, 1347, 3855, 166248, 47042, 430),
}
"""The studies whose times are measured (benchmarks/walks.py), with nothing else said."""


@pytest.fixture(scope="module", params=KNOWN, ids=lambda key: f"{key[0]} {key[1]}")
def case(request: pytest.FixtureRequest):
    model, nodes = request.param
    study = GaitStudy(model=model, nodes=nodes)
    program = GaitProgram(study.formulation())
    hessian = LagrangianHessian(program)
    return KNOWN[request.param], study, program, hessian, CondensedSystem(program, hessian)


def test_nothing_has_grown_silently(case):
    known, study, program, hessian, system = case
    found = Sizes(
        study.schedule.num_points, program.num_variables, program.num_constraints,
        program.num_entries, len(hessian.rows), system.num_shared,
    )  # fmt: skip
    assert astuple(found) == astuple(known)


def test_the_solver_is_given_these_entries_each_once(case):
    _, _, program, hessian, system = case
    assert (hessian.rows >= hessian.columns).all()
    places = hessian.rows * np.int64(program.num_variables) + hessian.columns
    assert len(np.unique(places)) == len(places)
    jacobian = system.jacobian(np.clip(0.1, program.design.lower, program.design.upper))
    assert jacobian.shape == (program.num_constraints, program.num_variables)
    assert jacobian.nnz == program.num_entries
