"""IPOPT with MUMPS through ipyopt, as drakegait calls it, and through CasADi: the same iterations?

    python benchmarks/casadi_ipopt.py

Both wheels bring IPOPT and MUMPS. Here both get the planar walk of 18 nodes with its own functions,
Jacobian and Hessian, the same start and the same options, for a fixed number of iterations. CasADi
takes functions that are not its own as callbacks; values go through its matrices.
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Callable

import casadi
import numpy as np

from drakegait.program.gait_program import GaitProgram
from drakegait.program.guess import guess_from_reference
from drakegait.program.lagrangian_hessian import LagrangianHessian
from drakegait.study import GaitStudy

OPTIONS = {
    "tol": 1e-9, "mu_strategy": "monotone", "mu_init": 0.01, "linear_solver": "mumps",
    "mumps_pivot_order": 0, "print_level": 0, "sb": "yes",
}  # fmt: skip
NAMES = {
    "nlp": (("x", "p"), ("f", "g")),
    "grad_f": (("x", "p"), ("f", "grad_f_x")),
    "jac_g": (("x", "p"), ("g", "jac_g_x")),
    "hess_lag": (("x", "p", "lam_f", "lam_g"), ("hess_gamma_x_x",)),
}


class Wrapped(casadi.Callback):
    """A function of numpy arrays as a function of CasADi's."""

    def __init__(
        self, kind: str, taken: list[casadi.Sparsity], given: list[casadi.Sparsity],
        function: Callable,
    ):  # fmt: skip
        casadi.Callback.__init__(self)
        self._names, self._taken, self._given = NAMES[kind], taken, given
        self._function = function
        self.construct(kind, {})

    def get_n_in(self) -> int:
        return len(self._taken)

    def get_n_out(self) -> int:
        return len(self._given)

    def get_name_in(self, k: int) -> str:
        return self._names[0][k]

    def get_name_out(self, k: int) -> str:
        return self._names[1][k]

    def get_sparsity_in(self, k: int) -> casadi.Sparsity:
        return self._taken[k]

    def get_sparsity_out(self, k: int) -> casadi.Sparsity:
        return self._given[k]

    def eval(self, arguments: list[casadi.DM]) -> list[casadi.DM]:
        arrays = [np.array(argument.nonzeros()) for argument in arguments]
        return [
            casadi.DM(pattern, value)
            for pattern, value in zip(self._given, self._function(*arrays), strict=True)
        ]


def _pattern(rows: np.ndarray, columns: np.ndarray, shape: tuple[int, int]):
    """A sparsity of CasADi, which goes column by column, and the order of its entries."""
    order = np.lexsort((rows, columns))
    place = (rows[order].tolist(), columns[order].tolist())
    return casadi.Sparsity.triplet(*shape, *place), order


def by_casadi(program: GaitProgram, x: np.ndarray, iterations: int) -> float:
    """Seconds in the solver."""
    size, count = program.num_variables, program.num_constraints
    hessian = LagrangianHessian(program)
    of_x, of_p = casadi.Sparsity.dense(size, 1), casadi.Sparsity(0, 0)
    of_f, of_g = casadi.Sparsity.dense(1, 1), casadi.Sparsity.dense(count, 1)
    jacobian, by_entry = _pattern(
        np.asarray(program.jacobian_rows), np.asarray(program.jacobian_columns), (count, size)
    )
    ends = np.asarray(hessian.rows), np.asarray(hessian.columns)
    curvature, by_pair = _pattern(np.minimum(*ends), np.maximum(*ends), (size, size))
    nlp = Wrapped(
        "nlp", [of_x, of_p], [of_f, of_g], lambda x, _: (program.cost(x), program.rows(x))
    )
    parts = {
        "grad_f": Wrapped(
            "grad_f", [of_x, of_p], [of_f, of_x],
            lambda x, _: (program.cost(x), program.gradient(x)),
        ),
        "jac_g": Wrapped(
            "jac_g", [of_x, of_p], [of_g, jacobian],
            lambda x, _: (program.rows(x), program.jacobian(x)[by_entry]),
        ),
        "hess_lag": Wrapped(
            "hess_lag", [of_x, of_p, of_f, of_g], [curvature],
            lambda x, _, share, rows: (hessian.values(x, rows, float(share[0]))[by_pair],),
        ),
    }  # fmt: skip
    limited = {"ipopt": {**OPTIONS, "max_iter": iterations}, "print_time": False}
    solver = casadi.nlpsol("solver", "ipopt", nlp, {**parts, **limited, "no_nlp_grad": True})
    began = time.perf_counter()
    solver(
        x0=x, lbx=program.design.lower, ubx=program.design.upper, lbg=program.lower,
        ubg=program.upper,
    )  # fmt: skip
    seconds = time.perf_counter() - began
    assert solver.stats()["iter_count"] == iterations
    return seconds


def by_ipyopt(program: GaitProgram, x: np.ndarray, iterations: int) -> float:
    """Seconds in the solver, with the BLAS that drakegait gives to it."""
    from drakegait.solvers.ipopt_mumps import ipyopt

    hessian = LagrangianHessian(program)

    def gradient(x: np.ndarray, out: np.ndarray) -> np.ndarray:
        out[:] = program.gradient(x)
        return out

    def rows(x: np.ndarray, out: np.ndarray) -> np.ndarray:
        out[:] = program.rows(x)
        return out

    def jacobian(x: np.ndarray, out: np.ndarray) -> np.ndarray:
        out[:] = program.jacobian(x)
        return out

    def curvature(
        x: np.ndarray, multipliers: np.ndarray, share: float, out: np.ndarray
    ) -> np.ndarray:
        out[:] = hessian.values(x, multipliers, share)
        return out

    problem = ipyopt.Problem(
        program.num_variables, program.design.lower, program.design.upper,
        program.num_constraints, program.lower, program.upper,
        (np.asarray(program.jacobian_rows), np.asarray(program.jacobian_columns)),
        (np.asarray(hessian.rows), np.asarray(hessian.columns)),
        program.cost, gradient, rows, jacobian, curvature,
        ipopt_options={**OPTIONS, "max_iter": iterations},
    )  # fmt: skip
    began = time.perf_counter()
    problem.solve(x.copy())
    return time.perf_counter() - began


def main() -> None:
    """Run both in turn and print seconds per iteration."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--iterations", type=int, default=40)
    parser.add_argument("--repeats", type=int, default=3)
    given = parser.parse_args()
    program = GaitProgram(GaitStudy.planar(18).formulation())
    x = guess_from_reference(program)
    for name, solve in (("ipyopt", by_ipyopt), ("casadi", by_casadi)):
        times = [solve(program, x, given.iterations) for _ in range(given.repeats)]
        print(f"{name}: {1e3 * np.median(times) / given.iterations:.0f} ms per iteration")


if __name__ == "__main__":
    main()
