"""Gaits for tests: the reference walk with fitted forces, not a solution."""

from __future__ import annotations

import dataclasses
import functools

import numpy as np

from drakegait.gait import Gait
from drakegait.program.gait_program import GaitProgram
from drakegait.program.guess import guess_from_reference
from drakegait.solvers.outcome import Outcome
from drakegait.study import GaitStudy


@functools.cache
def program_and_guess(model: str, **statements) -> tuple[GaitStudy, GaitProgram, np.ndarray]:
    nodes = 19 if model.endswith("symmetric") else 18
    study = GaitStudy(model=model, nodes=nodes, **statements)
    program = GaitProgram(study.formulation())
    return study, program, guess_from_reference(program)


@functools.cache
def reference_gait(model: str, **statements) -> Gait:
    study, program, x = program_and_guess(model, **statements)
    outcome = Outcome(
        solver="ipopt", status="time_limit", message="out of time", iterations=7, wall_time=1.5,
        setup_time=0.25, num_variables=program.num_variables,
        num_constraints=program.num_constraints, jacobian_nonzeros=program.num_entries,
        worst=("equations of motion | right loading 0.33 | knee_flexion_r",), advice="wait",
    )  # fmt: skip
    parts = program.cost_parts(x)
    return Gait(study, program.values(x), outcome, {"total": sum(parts.values()), **parts})


def changed(gait: Gait, **values) -> Gait:
    """The gait with other unknowns."""
    return dataclasses.replace(gait, values=dataclasses.replace(gait.values, **values))


def restated(gait: Gait, study: GaitStudy) -> Gait:
    """The same motion as the answer to another study."""
    return dataclasses.replace(gait, study=study)
