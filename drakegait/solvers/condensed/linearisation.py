"""What one step of the condensed system needs to know of the program at one point."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse

from drakegait.program.hessian_blocks import HessianBlocks
from drakegait.solvers.condensed.local_elimination import LocalElimination


@dataclass(frozen=True)
class Linearisation:
    """Everything that one step needs of the program at one point.

    Attributes:
        jacobian: of all rows, sparse.
        blocks, bends: Hessian of the Lagrangian and the excitation rows' stiffness, at the
            control points and of the timing rows.
        stiffness: S of all rows, 0 for equalities (num_constraints,).
        diagonal: the barrier's second derivatives by the unknowns (num_variables,).
        elimination: of the local unknowns.
        local, mixed: second derivatives by local unknowns, and by those and the shared ones, with
            the barrier and the inequality rows (num, 14 + n, 14 + n), (num, 14 + n, shared).
    """

    jacobian: scipy.sparse.csr_array
    blocks: HessianBlocks
    bends: np.ndarray
    stiffness: np.ndarray
    diagonal: np.ndarray
    elimination: LocalElimination
    local: np.ndarray
    mixed: np.ndarray
