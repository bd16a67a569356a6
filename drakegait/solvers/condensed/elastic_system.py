"""The system of an elastic program, led back to that of the program that it is made of.

A soft row has up to three diagonal unknowns: its slack, p and n, with barrier stiffnesses S_s,
S_p, S_n. They are springs in series: eliminated, the row has

    1 / S = 1 / S_s + 1 / S_p + 1 / S_n

in place of S_s. An equality has no slack; its multiplier stays, and it gives way by
D = 1 / S_p + 1 / S_n. The stiffness of a soft bound adds to the diagonal of its unknown.
"""

from __future__ import annotations

import numpy as np
import scipy.sparse

from drakegait.program.elastic import SHARE, ElasticProgram
from drakegait.program.lagrangian_hessian import LagrangianHessian
from drakegait.solvers.condensed.sparse_structure import SparseStructure
from drakegait.solvers.condensed.system import CondensedSystem
from drakegait.walker.corners import CornerSlopes


class ElasticSystem:
    """Factors and solves the systems of one elastic program; see `CondensedSystem`."""

    def __init__(self, elastic: ElasticProgram):
        program = elastic.program
        self._elastic, self._inner_size = elastic, program.num_variables
        self._inner_count = program.num_constraints
        self._inner = CondensedSystem(program, LagrangianHessian(program), SHARE)
        shape = (elastic.num_constraints, elastic.num_variables)
        self._jacobian = SparseStructure(elastic.jacobian_rows, elastic.jacobian_columns, shape)
        self.equality = elastic.lower == elastic.upper
        self._soft_equality = self.equality[elastic.ends]
        self._of_program = elastic.ends < self._inner_count
        self._locate_inner()

    def _locate_inner(self) -> None:
        """The program's own entries in the extended Jacobian: its rows, without p and n."""
        elastic = self._elastic
        numbered = self._jacobian.matrix(np.arange(len(elastic.jacobian_rows), dtype=float))
        rows = np.repeat(np.arange(elastic.num_constraints), np.diff(numbered.indptr))
        own = (rows < self._inner_count) & (numbered.indices < self._inner_size)
        self._own = np.flatnonzero(own)
        counts = np.bincount(rows[own], minlength=self._inner_count)
        self._own_starts = np.concatenate([[0], np.cumsum(counts)])
        self._own_columns = numbered.indices[own]

    def jacobian(self, x: np.ndarray) -> scipy.sparse.csr_array:
        """Derivatives of all rows at the extended unknowns `x`."""
        return self._jacobian.matrix(self._elastic.jacobian(x))

    def linearise(
        self,
        x: np.ndarray,
        multipliers: np.ndarray,
        stiffness: np.ndarray,
        diagonal: np.ndarray,
        jacobian: scipy.sparse.csr_array,
        corners: CornerSlopes | None = None,
    ) -> None:
        """Evaluate second derivatives at `x` and build K; see `CondensedSystem`."""
        elastic, size, count = self._elastic, self._inner_size, self._inner_count
        own = scipy.sparse.csr_array(
            (jacobian.data[self._own], self._own_columns, self._own_starts), shape=(count, size)
        )
        self._springs = diagonal[size:]  # of p and n
        signs = np.ones(len(self._springs))
        signs[len(elastic.short) :] = -1.0
        give = elastic.spread(signs / self._springs)
        slack = np.where(self._soft_equality, 1.0, stiffness[elastic.ends])
        self._stiffness = np.where(self._soft_equality, 0.0, slack / (1.0 + slack * give))
        of_rows, of_unknowns = stiffness[:count].copy(), diagonal[:size].copy()
        inside = self._of_program
        of_rows[elastic.ends[inside]] = self._stiffness[inside]
        of_unknowns[elastic.freed] += self._stiffness[~inside]
        compliance = np.zeros(count)
        soft = self._soft_equality
        compliance[elastic.ends[soft]] = give[soft]
        self._inner.linearise(
            x[:size], multipliers[:count], of_rows, of_unknowns, own, compliance, corners
        )
        # Where reserves are used with less than their D, p and n are stiffer.
        used = np.ones(len(elastic.ends))
        used[soft] = self._inner.give[elastic.ends[soft]] / give[soft]
        self._springs = self._springs / np.concatenate([used[elastic.short], used[elastic.over]])
        self._at = jacobian

    def factor(self, shift: float, convexity: float = 0.0) -> bool:
        """Factorise; False if K is not positive definite; see `CondensedSystem`."""
        return self._inner.factor(shift, convexity)

    def least_convexity(self) -> float:
        """The share of convexity that K needs; see `CondensedSystem`."""
        return self._inner.least_convexity()

    def solve(self, b: np.ndarray, c: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """dx and the equalities' dy (at their rows, 0 elsewhere) for right-hand sides b and c.

        Args:
            b: (num_variables,); c: (num_constraints,), read at equality rows.
        """
        elastic, size, count = self._elastic, self._inner_size, self._inner_count
        ends, soft = elastic.ends, self._soft_equality
        free = elastic.spread(b[size:] / self._springs)  # p - n where nothing holds them
        rest = c[:count].copy()
        rest[ends[soft]] += free[soft]
        pulled = np.zeros(len(c))
        pulled[ends] = self._stiffness * free
        dx, dy = self._inner.solve(b[:size] - (self._at.T @ pulled)[:size], rest)
        change = np.concatenate([dx, np.zeros(len(b) - size)])
        y = np.zeros(len(c))
        y[:count] = dy
        # What each soft row pulls with, its multiplier if it is an equality.
        pull = np.where(soft, y[ends], self._stiffness * ((self._at @ change)[ends] + free))
        change[size:] = b[size:] - np.concatenate([pull[elastic.short], -pull[elastic.over]])
        change[size:] /= self._springs
        return change, y
