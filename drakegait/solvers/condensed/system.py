"""The linear system of an interior-point step, condensed to a dense matrix.

    [ W + J_I^T S J_I   J_E^T ] [ dx ]   [ b  ]
    [ J_E               0     ] [ dy ] = [ -c ]

W is the Hessian of the Lagrangian plus the barrier's diagonal, S the stiffness of inequality
rows. Contact forces and residuals are eliminated at their control points
(`LocalElimination`), which leaves spline coefficients, timing and placement: a few hundred
unknowns with a matrix K that is positive definite where the step is one of descent.
Rows of no control point that are equalities (average speed) keep their multipliers.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import scipy.linalg
import scipy.sparse

from drakegait.program.equations_of_motion import EquationsOfMotion
from drakegait.program.excitation import Excitation
from drakegait.program.gait_program import GaitProgram
from drakegait.program.hessian_blocks import NUM_LATE
from drakegait.program.lagrangian_hessian import LagrangianHessian
from drakegait.program.least_squares_multipliers import LeastSquaresMultipliers
from drakegait.program.local_rows import DenseRows
from drakegait.solvers.condensed.assembly import Assembly
from drakegait.solvers.condensed.local_elimination import LocalElimination
from drakegait.solvers.condensed.sparse_structure import SparseStructure
from drakegait.walker import feet

_ELIMINATED = (EquationsOfMotion, LeastSquaresMultipliers)


@dataclass(frozen=True)
class Linearisation:
    """Everything that one step needs of the program at one point.

    Attributes:
        jacobian: of all rows, sparse.
        lagrangian: Hessian of the Lagrangian and the excitation rows' stiffness, sparse.
        stiffness: S of all rows, 0 for equalities (num_constraints,).
        diagonal: the barrier's second derivatives by the unknowns (num_variables,).
        elimination: of the local unknowns.
    """

    jacobian: scipy.sparse.csr_array
    lagrangian: scipy.sparse.csr_array
    stiffness: np.ndarray
    diagonal: np.ndarray
    elimination: LocalElimination


class CondensedSystem:
    """Factors and solves the systems of one program."""

    def __init__(self, program: GaitProgram, hessian: LagrangianHessian):
        self._program, self._hessian = program, hessian
        self.num_shared = program.design.offsets["multipliers"]
        self._assembly = Assembly(program, self.num_shared)
        shape = (program.num_constraints, program.num_variables)
        self._jacobian = SparseStructure(program.jacobian_rows, program.jacobian_columns, shape)
        off = hessian.rows != hessian.columns
        self._off = np.flatnonzero(off)
        size = program.num_variables
        self._lagrangian = SparseStructure(
            np.concatenate([hessian.rows, hessian.columns[off]]),
            np.concatenate([hessian.columns, hessian.rows[off]]),
            (size, size),
        )
        self._locate_local()
        self._classify_rows()

    def _locate_local(self) -> None:
        program, layout = self._program, self._program.points.layout
        columns = slice(layout.multipliers, layout.size)
        self._local = program.selection.index[:, columns]  # (num, 14 + n), -1 where none
        self._local_scale = program.selection.factor[:, columns]
        numbers = {type(item): k for k, item in enumerate(program.constraints)}
        self._balance, self._least = (program.row_numbers[numbers[kind]] for kind in _ELIMINATED)
        self._balance_scale, self._least_scale = (
            program.constraints[numbers[kind]].scale for kind in _ELIMINATED
        )

    def _classify_rows(self) -> None:
        program = self._program
        self.equality = program.lower == program.upper
        self._dense_rows: list[tuple[DenseRows, np.ndarray]] = []
        for constraint, numbers in zip(program.constraints, program.row_numbers, strict=True):
            if isinstance(constraint, (*_ELIMINATED, Excitation)):
                continue
            if not isinstance(constraint, DenseRows) or self.equality[numbers[numbers >= 0]].any():
                raise NotImplementedError(constraint.kind)
            self._dense_rows.append((constraint, numbers))
        shared = np.arange(program.first_timing_row, program.num_constraints)
        self._shared_equalities = shared[self.equality[shared]]
        self._shared_inequalities = shared[~self.equality[shared]]
        excitation = next(
            numbers
            for item, numbers in zip(program.constraints, program.row_numbers, strict=True)
            if isinstance(item, Excitation)
        )
        self._others = np.ones(program.num_constraints)  # inequalities but excitation
        self._others[excitation[excitation >= 0]] = 0.0

    # Factor ------------------------------------------------------------------------------

    def jacobian(self, x: np.ndarray) -> scipy.sparse.csr_array:
        """Derivatives of all rows at `x`."""
        return self._jacobian.matrix(self._program.jacobian(x))

    def linearise(
        self,
        x: np.ndarray,
        multipliers: np.ndarray,
        stiffness: np.ndarray,
        diagonal: np.ndarray,
        jacobian: scipy.sparse.csr_array,
    ) -> None:
        """Evaluate second derivatives at `x` and build K.

        Args:
            multipliers: of all rows (num_constraints,).
            stiffness, diagonal, jacobian: see `Linearisation`.
        """
        state = self._program.state(x)
        entries, curvature = self._hessian.values_and_blocks(x, multipliers, 1.0, stiffness)
        lagrangian = self._lagrangian.matrix(np.concatenate([entries, entries[self._off]]))
        elimination = LocalElimination.at(state, curvature)
        self.at = Linearisation(jacobian, lagrangian, stiffness, diagonal, elimination)
        size, n = self.num_shared, state.q.shape[1]
        by_shared = elimination.by_shared
        late = by_shared.shape[2] - NUM_LATE
        # Lagrangian by local unknowns, and by these and the shared ones, physical units.
        local = self._local_hessian(lagrangian, diagonal)
        mixed = np.zeros_like(by_shared)
        blocks = curvature.blocks
        mixed[:, : feet.NUM_ROWS, : 3 * n : 3] = curvature.physical.multipliers
        mixed[:, feet.NUM_ROWS :, : 3 * n : 3] = curvature.physical.residuals
        time = slice(late, late + blocks.multiplier_time.shape[2])
        mixed[:, : feet.NUM_ROWS, time] = blocks.multiplier_time
        mixed[:, feet.NUM_ROWS :, time] = blocks.residual_time
        mixed[self._local < 0] = 0.0
        half = np.swapaxes(by_shared, 1, 2) @ (mixed + 0.5 * local @ by_shared)
        dense = half + np.swapaxes(half, 1, 2)
        for constraint, numbers in self._dense_rows:
            rows = elimination.rows_by_shared(
                constraint.partials(state), constraint.num_rows, blocks.tau_by_time
            )
            weight = np.append(stiffness, 0.0)[numbers] / constraint.scale**2
            dense += np.swapaxes(rows, 1, 2) @ (weight[:, :, None] * rows)
        matrix = lagrangian[:size, :size].toarray()
        matrix[np.arange(size), np.arange(size)] += diagonal[:size]
        self._assembly.add(matrix, dense, blocks.b)
        rows = jacobian[self._shared_inequalities][:, :size].toarray()
        matrix += rows.T @ (stiffness[self._shared_inequalities][:, None] * rows)
        self._border = jacobian[self._shared_equalities][:, :size].toarray()
        self.matrix = matrix

    def _local_hessian(
        self, lagrangian: scipy.sparse.csr_array, diagonal: np.ndarray
    ) -> np.ndarray:
        """Second derivatives by local unknowns (num, 14 + n, 14 + n), physical units."""
        start = self.num_shared
        corner = lagrangian[start:, start:].tocoo()
        num, count = self._local.shape
        out = np.zeros((num, count, count))
        point, position = self._places
        row, column = corner.row, corner.col
        same = point[row] == point[column]
        out[point[row][same], position[row][same], position[column][same]] = corner.data[same]
        size = np.where(self._local >= 0, self._local_scale, 1.0)
        out /= size[:, :, None] * size[:, None]
        which = np.arange(count)
        safe = np.where(self._local >= 0, self._local, 0)
        out[:, which, which] += np.where(self._local >= 0, diagonal[safe], 0.0) / size**2
        return out

    @cached_property
    def _places(self) -> tuple[np.ndarray, np.ndarray]:
        """Control point and position there of every local unknown."""
        num = self._program.num_variables - self.num_shared
        point, position = np.zeros(num, dtype=int), np.zeros(num, dtype=int)
        k, i = np.nonzero(self._local >= 0)
        point[self._local[k, i] - self.num_shared] = k
        position[self._local[k, i] - self.num_shared] = i
        return point, position

    def factor(self, shift: float) -> bool:
        """Factorise K + shift I; False if that is not positive definite."""
        matrix = self.matrix.copy()
        size = len(matrix)
        matrix[np.arange(size), np.arange(size)] += shift
        if len(self._border):
            # On the border's null space nothing changes; elsewhere K need not be definite.
            self._weight = np.abs(np.diag(self.matrix)).mean()
            matrix += self._weight * self._border.T @ self._border
        try:
            self._factor = scipy.linalg.cho_factor(
                matrix, lower=True, overwrite_a=True, check_finite=False
            )
        except scipy.linalg.LinAlgError:
            return False
        if not np.isfinite(self._factor[0][-1, -1]):
            return False
        self.shift = shift
        if len(self._border):
            self._by_border = scipy.linalg.cho_solve(self._factor, self._border.T)
            self._schur = self._border @ self._by_border
        return True

    # Solve -------------------------------------------------------------------------------

    def solve(self, b: np.ndarray, c: np.ndarray, refine: int = 2) -> tuple[np.ndarray, np.ndarray]:
        """dx and the equalities' dy (at their rows, 0 elsewhere) for right-hand sides b and c.

        Args:
            b: (num_variables,); c: (num_constraints,), read at equality rows.
        """
        x, y = self._once(b, c)
        for _ in range(refine):
            rest_b, rest_c = self._residual(x, y, b, c)
            more_x, more_y = self._once(rest_b, rest_c)
            x, y = x + more_x, y + more_y
        return x, y

    def _times(self, x: np.ndarray) -> np.ndarray:
        """(W + J_I^T S J_I) x."""
        at = self.at
        out = at.lagrangian @ x + at.diagonal * x
        out[: self.num_shared] += self.shift * x[: self.num_shared]
        return out + at.jacobian.T @ (self._others * at.stiffness * (at.jacobian @ x))

    def _residual(
        self, x: np.ndarray, y: np.ndarray, b: np.ndarray, c: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray]:
        rest_b = b - self._times(x) - self.at.jacobian.T @ y
        return rest_b, np.where(self.equality, c + self.at.jacobian @ x, 0.0)

    def _once(self, b: np.ndarray, c: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        jacobian, size = self.at.jacobian, self.num_shared
        x = np.zeros(len(b))
        x[size:] = self._follow(c)  # at fixed shared unknowns
        wanted = b - self._times(x)
        # b_u + T^T b_w, with T the local unknowns by the shared ones
        weights = self._weigh(wanted)
        reduced = (wanted - jacobian.T @ weights)[:size]
        rows = self._shared_equalities
        y = np.zeros(len(c))
        if len(rows):
            rest = c[rows] + jacobian[rows] @ x
            reduced = reduced - self._weight * self._border.T @ rest
            shared = scipy.linalg.cho_solve(self._factor, reduced, check_finite=False)
            y[rows] = np.linalg.solve(self._schur, self._border @ shared + rest)
            shared -= self._by_border @ y[rows]
        else:
            shared = scipy.linalg.cho_solve(self._factor, reduced, check_finite=False)
        step = np.zeros(len(b))
        step[:size] = shared
        step[size:] = self._follow(jacobian @ step)
        x += step
        y += self._weigh(b - self._times(x))
        return x, y

    def _follow(self, rows: np.ndarray) -> np.ndarray:
        """Local unknowns that make up for `rows` of the eliminated laws, scaled."""
        padded = np.append(rows, 0.0)
        balance = padded[self._balance] * self._balance_scale
        least = padded[self._least] * self._least_scale
        local = np.concatenate(self.at.elimination.local(balance, least), axis=1)
        out = np.zeros(self._program.num_variables - self.num_shared)
        used = self._local >= 0
        out[self._local[used] - self.num_shared] = local[used] / self._local_scale[used]
        return out

    def _weigh(self, b: np.ndarray) -> np.ndarray:
        """Multipliers of the eliminated laws that balance `b` in the local unknowns."""
        used = self._local >= 0
        local = np.zeros(self._local.shape)
        local[used] = b[self._local[used]] / self._local_scale[used]
        count = feet.NUM_ROWS
        balance, least = self.at.elimination.rows(local[:, :count], local[:, count:])
        out = np.zeros(len(self.equality) + 1)
        out[self._balance] = balance * self._balance_scale
        out[self._least] = least * self._least_scale
        return out[:-1]
