"""How any function of an optimum answers to a change of its program: one adjoint solve.

Near the optimum of a primal-dual interior point the variables, their multipliers and the
barriers' terms move so that the KKT conditions go on to hold (Pirnay, Lopez-Negrete & Biegler
2012, Math. Prog. Comp. 4, 307-331). With the Hessian H of the Lagrangian L, the Jacobian J of the
rows and the curvatures S = multiplier / distance of the barriers of variables (S_L, S_U) and rows
(T_L, T_U; T = T_L + T_U, infinite for equalities)

    K = [ H + S_L + S_U   J^T ]      K (dx, dlambda) = ( -d grad L + S_L dx_L + S_U dx_U,
        [ J              -1/T ]                          -dg + (T_L db_L + T_U db_U) / T )

and with the adjoint K (a, b) = (grad E, 0) the change of E(x) is dE + (a, b) . (right-hand side).
Bounds that are active stay so: kinks where one comes or goes are beyond the first order.
"""

from __future__ import annotations

import numpy as np
import scipy.sparse
import scipy.sparse.linalg

from drakegait.program.lagrangian_hessian import LagrangianHessian
from drakegait.program.optimum import Functions, Optimum, energy_of, jacobian_matrix

_LEAST_DISTANCE = 1e-10  # of a scaled variable from its bound
_LEAST_BARRIER = 1e-10
_LARGEST_COMPLIANCE = 1e10  # 1/T of a row that nothing holds
_REGULARISATION = 1e-9  # on the diagonal, so that rows which repeat each other do no harm


class KktSystem:
    """The linearised KKT conditions of an optimum with lifted multipliers."""

    def __init__(self, optimum: Optimum):
        program, kkt = optimum.program, optimum.multipliers
        design, x = program.design, kkt.x
        self._optimum = optimum
        self._lower = kkt.lower / np.maximum(x - design.lower, _LEAST_DISTANCE)
        self._upper = kkt.upper / np.maximum(design.upper - x, _LEAST_DISTANCE)
        barrier = self._barrier()
        equality = program.lower == program.upper
        # The distance of a row from its bound is known less well than its multiplier: with
        # multiplier times distance = barrier parameter, T = multiplier^2 / barrier parameter.
        self._row_upper = np.maximum(kkt.rows, 0.0) ** 2 / barrier
        self._row_lower = np.minimum(kkt.rows, 0.0) ** 2 / barrier
        stiffness = np.maximum(self._row_lower + self._row_upper, 1.0 / _LARGEST_COMPLIANCE)
        self._compliance = np.where(equality, 0.0, 1.0 / stiffness)
        self._equality = equality
        self._matrix = self._assemble()
        self._factors = scipy.sparse.linalg.splu(self._matrix)

    def _barrier(self) -> float:
        kkt, design = self._optimum.multipliers, self._optimum.program.design
        with np.errstate(invalid="ignore"):
            products = np.concatenate(
                [kkt.lower * (kkt.x - design.lower), kkt.upper * (design.upper - kkt.x)]
            )
        products = products[np.isfinite(products) & (products > 0.0)]
        return max(float(np.median(products)) if products.size else 0.0, _LEAST_BARRIER)

    def _assemble(self) -> scipy.sparse.csc_array:
        program, kkt = self._optimum.program, self._optimum.multipliers
        hessian = LagrangianHessian(program)
        values = hessian.values(kkt.x, kkt.rows, 1.0)
        size = program.num_variables
        lower = scipy.sparse.coo_array((values, (hessian.rows, hessian.columns)), (size, size))
        full = lower + scipy.sparse.tril(lower, -1).T
        diagonal = self._lower + self._upper + _REGULARISATION
        jacobian = jacobian_matrix(program, kkt.x)
        return scipy.sparse.block_array(
            [
                [full + scipy.sparse.diags_array(diagonal), jacobian.T],
                [jacobian, -scipy.sparse.diags_array(self._compliance + _REGULARISATION)],
            ],
            format="csc",
        )

    def solve(self, right: np.ndarray) -> np.ndarray:
        """K^-1 right, once refined."""
        found = self._factors.solve(right)
        return found + self._factors.solve(right - self._matrix @ found)

    def adjoint(self, gradient: np.ndarray) -> np.ndarray:
        """(a, b) of a function with this gradient by the scaled variables."""
        rows = np.zeros(self._optimum.program.num_constraints)
        return self.solve(np.concatenate([gradient, rows]))

    def energy_adjoint(self) -> np.ndarray:
        """(a, b) of the cost of transport E^t [J/m]."""
        program, x = self._optimum.program, self._optimum.multipliers.x
        return self.adjoint(program.cost_gradient(energy_of(program), x))

    def right_hand_side(self, change: Functions) -> np.ndarray:
        """What a change of the program pushes on the KKT conditions."""
        variables = -change.slope + self._lower * change.lower + self._upper * change.upper
        held = self._row_lower * change.row_lower + self._row_upper * change.row_upper
        moved = np.where(self._equality, change.row_lower, self._compliance * held)
        return np.concatenate([variables, moved - change.rows])
