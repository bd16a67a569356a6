"""The linear system of an interior-point step, condensed to the shared unknowns.

    [ W + J_I^T S J_I   J_E^T ] [ dx ]   [ b  ]
    [ J_E               0     ] [ dy ] = [ -c ]

W is the Hessian of the Lagrangian plus the barrier's diagonal, S the stiffness of inequality
rows. Contact forces and residuals are eliminated at their control points
(`LocalElimination`), which leaves spline coefficients, timing and placement: a few hundred
unknowns with a matrix K that is positive definite where the step is one of descent, and couples
neighbouring knots only (`CyclicBandMatrix`).
Rows of no control point that are equalities (average speed) keep their multipliers (`Border`).
Equations of motion that may break have reserves, eliminated there, too (`Reserves`).
"""

from __future__ import annotations

import numpy as np
import scipy.sparse

from drakegait.program.equations_of_motion import EquationsOfMotion
from drakegait.program.excitation import Excitation
from drakegait.program.gait_program import GaitProgram
from drakegait.program.lagrangian_hessian import LagrangianHessian
from drakegait.program.least_squares_multipliers import LeastSquaresMultipliers
from drakegait.program.local_rows import DenseRows
from drakegait.solvers.condensed.assembly import Assembly, add_square, own_blocks
from drakegait.solvers.condensed.border import Border
from drakegait.solvers.condensed.convexity import convex_excess
from drakegait.solvers.condensed.cyclic_band import CyclicBandMatrix
from drakegait.solvers.condensed.least_convexity import least_share
from drakegait.solvers.condensed.linearisation import Linearisation
from drakegait.solvers.condensed.local_elimination import LocalElimination
from drakegait.solvers.condensed.local_variables import LocalVariables, hessian_times
from drakegait.solvers.condensed.reserves import Reserves
from drakegait.solvers.condensed.sparse_structure import SparseStructure
from drakegait.walker import feet
from drakegait.walker.corners import CornerSlopes

_ELIMINATED = (EquationsOfMotion, LeastSquaresMultipliers)
_REFINEMENTS, _LAST_CORRECTION = 3, 1e-7  # at most; of the solution: the next is below 1e-14


class CondensedSystem:
    """Factors and solves the systems of one program.

    Args:
        share: of the program's cost in what is minimised.
    """

    def __init__(self, program: GaitProgram, hessian: LagrangianHessian, share: float = 1.0):
        self._program, self._hessian, self._share = program, hessian, share
        self.num_shared = program.design.offsets["multipliers"]
        self._arms = program.formulation.walker.muscles.moment_arms
        self._assembly = Assembly(program, self.num_shared)
        shape = program.num_constraints, program.num_variables
        self._jacobian = SparseStructure(program.jacobian_rows, program.jacobian_columns, shape)
        self._variables = LocalVariables(program)
        self._flattest: np.ndarray | None = None  # direction that lacks convexity most
        self._locate_local()
        self._classify_rows()

    def _locate_local(self) -> None:
        program = self._program
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
        compliance: np.ndarray | None = None,
        corners: CornerSlopes | None = None,
    ) -> None:
        """Evaluate second derivatives at `x` and build K.

        Args:
            multipliers: of all rows (num_constraints,).
            stiffness, diagonal, jacobian: see `Linearisation`.
            compliance: D, how far equations of motion and equality rows of no control point give
                way for their multipliers (num_constraints,); default not.
            corners: see `MuscleFunctions.hessian`.
        """
        state = self._program.state(x)
        curvature = self._hessian.local_curvature(
            state, multipliers, self._share, stiffness, corners
        )
        elimination = LocalElimination.at(state, curvature)
        timing = self._program.timing
        bends = timing.curvature(multipliers[self._program.first_timing_row :])
        size, blocks, by_shared = self.num_shared, curvature.blocks, elimination.by_shared
        # Without the shared unknowns' part in the local ones, then with it.
        local = self._variables.hessian(blocks, diagonal)
        mixed = self._variables.mixed_hessian(blocks, by_shared.shape[2])
        dense = own_blocks(blocks, by_shared.shape[2])
        for constraint, numbers in self._dense_rows:
            partials = constraint.partials(state)
            weight = np.append(stiffness, 0.0)[numbers] / constraint.scale**2
            if partials.multipliers is not None:
                contacts = local[:, : feet.NUM_ROWS, : feet.NUM_ROWS]
                add_square(contacts, partials.multipliers, weight)
            if partials.q is not None:
                rows = elimination.rows_by_shared(
                    partials, constraint.num_rows, blocks.tau_by_time
                )
                add_square(dense, rows, weight)
        half = np.swapaxes(by_shared, 1, 2) @ (mixed + 0.5 * local @ by_shared)
        dense += half
        dense += np.swapaxes(half, 1, 2)
        self.reserves, self.give = None, np.zeros(len(self.equality))
        if compliance is not None:
            physical = compliance[self._balance] * self._balance_scale**2
            self.reserves = Reserves(elimination, local, mixed, physical)
            self.give = compliance.copy()
            self.give[self._balance] *= self.reserves.share[:, None]
            dense -= self.reserves.reduction
        matrix = self._assembly.matrix(dense, blocks)
        matrix.add_diagonal(diagonal[:size])
        # An event may end one phase and begin another.
        matrix.add_pairs(timing.curved_rows, timing.curved_columns, bends)
        rows = jacobian[self._shared_inequalities][:, :size].toarray()
        few = np.flatnonzero(rows.any(axis=0))  # timing and placement
        rows = rows[:, few]
        square = rows.T @ (stiffness[self._shared_inequalities][:, None] * rows)
        matrix.add_corner(few, square)
        few = self._shared_equalities
        self._border = Border(jacobian[few][:, :size].toarray(), self.give[few])
        self.matrix = matrix
        self._curvature, self._convexifying = curvature, None
        self.at = Linearisation(
            jacobian, blocks, bends, stiffness, diagonal, elimination, local, mixed
        )

    def _lack(self) -> CyclicBandMatrix:
        """L, what the muscles lack to be convex, as a part of K."""
        if self._convexifying is None:
            walker, curvature = self._program.formulation.walker, self._curvature
            excess = convex_excess(curvature.physical.muscles, walker.muscles)
            blocks = self._hessian.muscle_blocks(curvature, excess)
            shared = self.at.elimination.by_shared.shape[2]
            self._convexifying = self._assembly.matrix(own_blocks(blocks, shared), blocks)
        return self._convexifying

    def factor(self, shift: float, convexity: float = 0.0) -> bool:
        """Factorise K + shift I + `convexity` of L; False if that is not positive definite."""
        self._convexity = convexity
        matrix = self.matrix.plus(self._lack(), convexity) if convexity else self.matrix.copy()
        matrix.add_diagonal(shift)
        self._border.weigh(matrix, self.matrix)
        factor = matrix.factor()
        if factor is None:
            return False
        self.shift = shift
        self._border.factored(factor)
        return True

    def least_convexity(self) -> float:
        """The share of L that K needs, after K + L was factorised."""
        convex = self.matrix.plus(self._lack(), 1.0)
        self._border.weigh(convex, self.matrix)
        share, self._flattest = least_share(
            self._lack(), convex, self._border.factor, self._flattest
        )
        return share

    # Solve -------------------------------------------------------------------------------

    def solve(self, b: np.ndarray, c: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """dx and the equalities' dy (at their rows, 0 elsewhere) for right-hand sides b and c.

        Args:
            b: (num_variables,); c: (num_constraints,), read at equality rows.
        """
        x, y = self._once(b, c)
        for _ in range(_REFINEMENTS):
            more_x, more_y = self._once(*self._residual(x, y, b, c))
            x, y = x + more_x, y + more_y
            # Each correction is that share of the one before which the first is of the solution:
            # what would follow now is rounding.
            if _small(more_x, x) and _small(more_y, y):
                break
        return x, y

    def _times(self, x: np.ndarray) -> np.ndarray:
        """(W + J_I^T S J_I) x."""
        at, timing, size = self.at, self._program.timing, self._program.num_variables
        rows = at.blocks.rows
        change = hessian_times(at.blocks, self._arms, self._variables.of(x, rows))
        out = self._variables.transposed(change, rows) + at.diagonal * x
        pairs = timing.curved_rows, timing.curved_columns
        for one, other in (pairs, pairs[::-1]):
            out += np.bincount(one, at.bends * x[other], size)
        shared = x[: self.num_shared]
        out[: self.num_shared] += self.shift * shared
        if self._convexity > 0.0:
            out[: self.num_shared] += self._convexity * (self._lack() @ shared)
        return out + at.jacobian.T @ (self._others * at.stiffness * (at.jacobian @ x))

    def _residual(
        self, x: np.ndarray, y: np.ndarray, b: np.ndarray, c: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray]:
        rest_b = b - self._times(x) - self.at.jacobian.T @ y
        return rest_b, np.where(self.equality, c + self.at.jacobian @ x - self.give * y, 0.0)

    def _once(self, b: np.ndarray, c: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        at, size, variables = self.at, self.num_shared, self._variables
        by_shared, rows = at.elimination.by_shared, at.blocks.rows[:, :3]
        local, wanted = self._follow(c), variables.local(b)  # at fixed shared unknowns
        if self.reserves is not None:
            local = local + self.reserves.follow(wanted - (at.local @ local[..., None])[..., 0])
        rest = (wanted - (at.local @ local[..., None])[..., 0])[:, None]
        shares = (rest @ by_shared - local[:, None] @ at.mixed)[:, 0]
        reduced = b[:size] + variables.by_shared(shares, rows)[:size]
        few = self._shared_equalities
        y = np.zeros(len(c))
        shared, y[few] = self._border.solve(reduced, c[few])
        x = np.zeros(len(b))
        x[:size] = shared
        along = variables.shared(x, rows)[..., None]
        followed = by_shared if self.reserves is None else self.reserves.by_shared
        local = local + (followed @ along)[..., 0]
        variables.into(x, local)
        y += self._weigh(wanted - (at.local @ local[..., None] + at.mixed @ along)[..., 0])
        return x, y

    def _follow(self, rows: np.ndarray) -> np.ndarray:
        """Local unknowns that make up for `rows` of the eliminated laws (num, 14 + n)."""
        padded = np.append(rows, 0.0)
        balance = padded[self._balance] * self._balance_scale
        least = padded[self._least] * self._least_scale
        return np.where(self._variables.used, self.at.elimination.local(balance, least), 0.0)

    def _weigh(self, local: np.ndarray) -> np.ndarray:
        """Multipliers of the eliminated laws that balance `local` (num, 14 + n)."""
        count = feet.NUM_ROWS
        balance, least = self.at.elimination.rows(local[:, :count], local[:, count:])
        out = np.zeros(len(self.equality) + 1)
        out[self._balance] = balance * self._balance_scale
        out[self._least] = least * self._least_scale
        return out[:-1]


def _small(change: np.ndarray, whole: np.ndarray) -> bool:
    return bool(np.abs(change).max() <= _LAST_CORRECTION * np.abs(whole).max())
