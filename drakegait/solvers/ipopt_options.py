"""Options of IPOPT that do not depend on how it is called."""

from __future__ import annotations

from typing import Any

from drakegait.solvers.options import SolverOptions


def ipopt_options(options: SolverOptions, warm: bool) -> dict[str, Any]:
    """Options that both ways to IPOPT share."""
    chosen: dict[str, Any] = {
        "hessian_approximation": "limited-memory",
        "limited_memory_max_history": 30,
        "tol": options.optimality,
        "dual_inf_tol": 10.0 * options.optimality,
        "compl_inf_tol": options.optimality,
        "constr_viol_tol": options.feasibility,
        "acceptable_iter": 0,
        "bound_relax_factor": 0.0,  # forces must not go below their bound
        "max_iter": int(options.max_iterations),
    }
    if options.barrier_start > 0.0 or warm:
        chosen["mu_init"] = options.barrier_start or 1e-4
    if warm:
        chosen["warm_start_init_point"] = "yes"
        for name in ("bound_push", "bound_frac", "slack_bound_push", "slack_bound_frac",
                     "mult_bound_push"):  # fmt: skip
            chosen[f"warm_start_{name}"] = 1e-6
    return chosen
