"""How any function of an optimum answers to a change of its program: one adjoint solve.

Near the optimum of a primal-dual interior point the variables, their multipliers and the
barriers' terms move so that the KKT conditions go on to hold (Pirnay, Lopez-Negrete & Biegler
2012, Math. Prog. Comp. 4, 307-331). With the Hessian H of the Lagrangian L, the Jacobian J of the
rows and the curvatures S = multiplier / distance of the barriers of variables (S_L, S_U) and rows
(T_L, T_U; T = T_L + T_U, infinite for equalities)

    K = [ H + S_L + S_U   J^T ]      K (dx, dlambda) = ( -d grad L + S_L dx_L + S_U dx_U,
        [ J              -1/T ]                          -dg + (T_L db_L + T_U db_U) / T )

and with the adjoint K (a, b) = (grad E, 0) the change of E(x) is dE + (a, b) . (right-hand side).
Bounds that are active stay so: kinks where one comes or goes are beyond the first order. Where the
optimum is not known exactly, neither are the weakly active bounds, and the answers would jump with
them; a wider barrier lets them count in part.
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
    """The linearised KKT conditions of an optimum with lifted multipliers.

    Args:
        optimum: a program and its multipliers.
        barrier: move all multipliers and distances to the central path of this barrier
            parameter; default: as the solver left them.
    """

    def __init__(self, optimum: Optimum, barrier: float | None = None):
        program, kkt = optimum.program, optimum.multipliers
        design, x = program.design, kkt.x
        self._optimum = optimum
        pull_down, pull_up = np.maximum(-kkt.rows, 0.0), np.maximum(kkt.rows, 0.0)
        if barrier is None:
            self._lower = kkt.lower / np.maximum(x - design.lower, _LEAST_DISTANCE)
            self._upper = kkt.upper / np.maximum(design.upper - x, _LEAST_DISTANCE)
            # The distance of a row from its bound is known less well than its multiplier: with
            # multiplier times distance = barrier parameter, T = multiplier^2 / parameter.
            parameter = self._barrier()
            self._row_lower, self._row_upper = pull_down**2 / parameter, pull_up**2 / parameter
        else:
            rows = program.rows(x)
            self._lower = _centred(x - design.lower, kkt.lower, barrier)
            self._upper = _centred(design.upper - x, kkt.upper, barrier)
            self._row_lower = _centred(rows - program.lower, pull_down, barrier)
            self._row_upper = _centred(program.upper - rows, pull_up, barrier)
        stiffness = np.maximum(self._row_lower + self._row_upper, 1.0 / _LARGEST_COMPLIANCE)
        self._equality = program.lower == program.upper
        self._compliance = np.where(self._equality, 0.0, 1.0 / stiffness)
        self._matrix = self._assemble()
        self._factors = scipy.sparse.linalg.splu(self._matrix)

    def _barrier(self) -> float:
        """The solver's barrier parameter, from the products of multiplier and distance."""
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

    def energy_adjoint(self) -> np.ndarray | None:
        """(a, b) of the cost of transport E^t [J/m].

        None where the Lagrangian curves downwards along the answer: it is no minimum there.
        """
        program, x = self._optimum.program, self._optimum.multipliers.x
        gradient = program.cost_gradient(energy_of(program), x)
        found = self.adjoint(gradient)
        return found if gradient @ found[: len(x)] > 0.0 else None

    def right_hand_side(self, change: Functions) -> np.ndarray:
        """What a change of the program pushes on the KKT conditions."""
        variables = -change.slope + self._lower * change.lower + self._upper * change.upper
        held = self._row_lower * change.row_lower + self._row_upper * change.row_upper
        moved = np.where(self._equality, change.row_lower, self._compliance * held)
        return np.concatenate([variables, moved - change.rows])


def _centred(distance: np.ndarray, multiplier: np.ndarray, barrier: float) -> np.ndarray:
    """Curvature of a bound on the central path, where multiplier times distance = barrier.

    The point keeps the difference of the two, which tells whether the bound is active.
    """
    distance = np.maximum(distance, 0.0)
    with np.errstate(invalid="ignore"):
        apart = distance - multiplier
        moved = 0.5 * (apart + np.sqrt(apart**2 + 4.0 * barrier))
    return np.where(np.isfinite(distance), barrier / moved**2, 0.0)
