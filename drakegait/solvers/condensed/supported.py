"""Which programs the condensed solver takes."""

from __future__ import annotations

import numpy as np

from drakegait.program.differences import DifferencedProgram
from drakegait.program.gait_program import GaitProgram
from drakegait.program.load_penalty import LoadPenalty
from drakegait.solvers.options import SolverOptions
from drakegait.walker import feet


def why_not(program: GaitProgram, options: SolverOptions) -> str:
    """What the elimination of contact forces and residuals does not cover; empty if nothing."""
    formulation = program.formulation
    if not formulation.lifted:
        return "projected multipliers"
    if isinstance(program, DifferencedProgram) or options.second_derivatives != "exact":
        return "no exact derivatives"
    if program.points.loaded.shape[1] != feet.NUM_ROWS:
        return "torques at the toes"
    if formulation.variants.eom_form != "components":
        return "one bound on the largest residual"
    if any(isinstance(cost, LoadPenalty) for cost in program.costs):
        return "penalties on loads"
    if np.any(program.design.lower == program.design.upper):
        return "variables without freedom"
    return ""
