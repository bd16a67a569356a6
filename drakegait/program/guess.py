"""Where a solve starts: the reference motion with the muscle forces that fit it best.

Static optimisation along the reference: with the motion fixed to the
reference, the residual of the equations of motion is affine in the muscle
forces and contact forces. One convex quadratic program finds those that
minimise the residual, plus a little of (f / f_max)^2 and of the distance from
the reference's ground reactions, within their bounds.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import scipy.sparse
from pydrake.solvers import ClarabelSolver, MathematicalProgram

from drakegait.program.equations_of_motion import EquationsOfMotion
from drakegait.program.gait_program import GaitProgram
from drakegait.transcription.design_vector import DesignValues
from drakegait.walker import feet

_EFFORT = 0.03  # weight of (f / 0.3 f_max)^2 per coefficient against (e / eps)^2 per row
_PRIOR = 0.3  # weight of the ground reactions' distance, in units of 0.3 body weight


def guess_from_reference(program: GaitProgram) -> np.ndarray:
    """Design vector of the reference walk at the wanted speed, with fitted forces."""
    x = program.design.pack(reference_values(program))
    return fit_forces(program, np.clip(x, program.design.lower, program.design.upper))


def guess_from_values(program: GaitProgram, values: DesignValues) -> np.ndarray:
    """Design vector of an earlier gait; contact forces are fitted if their number differs."""
    design = program.design
    if values.multipliers.shape == program.points.loaded.shape:
        return np.clip(design.pack(values), design.lower, design.upper)
    blank = np.zeros(program.points.loaded.shape)
    no_residuals = np.zeros((program.points.num, program.points.layout.num_coordinates))
    x = design.pack(
        DesignValues(
            values.coordinate_coefficients, values.force_coefficients, values.stride_time,
            values.events, values.placement, blank, no_residuals,
        )
    )  # fmt: skip
    return fit_forces(program, np.clip(x, design.lower, design.upper), keep_muscles=True)


def reference_values(program: GaitProgram) -> DesignValues:
    """The reference walk at the wanted speed with its own ground reactions and silent muscles."""
    formulation = program.formulation
    reference, splines = formulation.reference, formulation.splines
    placement = reference.foot_placement
    samples = np.arange(8 * splines.num_intervals) / (8 * splines.num_intervals)
    coefficients = splines.fit(samples, reference.coordinate_values(samples).T)
    least = formulation.walker.muscle_functions.settings.min_force
    forces = np.repeat(
        least * formulation.walker.muscles.f_max[:, None], splines.num_intervals, axis=1
    )
    instants = program.formulation.schedule.instants(
        np.append(np.array(formulation.event_centres), 1.0)[: formulation.schedule.num_phases + 1]
    )
    multipliers = _reference_multipliers(program, reference.ground_reactions(instants))
    return DesignValues(
        coefficients,
        forces,
        placement.stride_length / formulation.speed,
        np.array(formulation.event_centres),
        np.array([
            placement.step_length_right, placement.step_length_left,
            placement.toe_angle_right, placement.toe_angle_left, placement.step_width,
        ]),
        multipliers,
        np.zeros((program.points.num, program.points.layout.num_coordinates)),
    )  # fmt: skip


def _reference_multipliers(program: GaitProgram, reactions: np.ndarray) -> np.ndarray:
    """Contact forces with the reference's ground reactions, heel and toe sharing alike."""
    multipliers = np.zeros((program.points.num, 2, feet.ROWS_PER_FOOT))
    loaded = program.points.loaded[:, : feet.NUM_ROWS].reshape(multipliers.shape)
    for axis in range(3):
        both = loaded[:, :, axis] & loaded[:, :, axis + 3]
        for offset in (axis, axis + 3):
            multipliers[:, :, offset] = np.where(
                loaded[:, :, offset], reactions[:, :, axis] * np.where(both, 0.5, 1.0), 0.0
            )
    found = np.zeros(program.points.loaded.shape)
    found[:, : feet.NUM_ROWS] = multipliers.reshape(program.points.num, feet.NUM_ROWS)
    return found


def fit_forces(program: GaitProgram, x: np.ndarray, keep_muscles: bool = False) -> np.ndarray:
    """Improve muscle and contact forces in `x` by one quadratic program."""
    if not isinstance(program.constraints[0], EquationsOfMotion):
        # The same unknowns under eq. (28) have the rows that are fitted here.
        variants = program.formulation.variants.replace(eom_form="components")
        program = GaitProgram(replace(program.formulation, variants=variants))
    design = program.design
    forces = np.zeros(design.num_variables, dtype=bool)
    forces[design.offsets["forces"] : design.offsets["timing"]] = not keep_muscles
    forces[design.offsets["multipliers"] : design.offsets["residuals"]] = True
    if not forces.any():  # projected multipliers follow from motion and muscles
        return x
    rows = _motion_rows(program)
    entries = program.jacobian(x)
    matrix = scipy.sparse.csr_array(
        (entries, (program.jacobian_rows, program.jacobian_columns)),
        shape=(program.num_constraints, program.num_variables),
    )[:rows][:, np.flatnonzero(forces)]
    x = x.copy()
    x[design.offsets["residuals"] :] = 0.0
    offset = program.rows(x)[:rows] - matrix @ x[forces]
    is_muscle = np.flatnonzero(forces) < design.offsets["timing"]
    weight = np.where(is_muscle, _EFFORT, _PRIOR)
    prior = np.where(is_muscle, 0.0, x[forces])
    quadratic = (matrix.T @ matrix).toarray() + np.diag(weight)
    linear = matrix.T @ offset - weight * prior
    problem = MathematicalProgram()
    y = problem.NewContinuousVariables(int(forces.sum()))
    problem.AddQuadraticCost(quadratic, linear, y, is_convex=True)
    problem.AddBoundingBoxConstraint(design.lower[forces], design.upper[forces], y)
    result = ClarabelSolver().Solve(problem)
    if result.is_success():
        x[forces] = np.clip(result.GetSolution(y), design.lower[forces], design.upper[forces])
    return _with_residuals(program, x)


def _with_residuals(program: GaitProgram, x: np.ndarray) -> np.ndarray:
    """Set the residual variables, if any, to the residuals of `x` within their bounds."""
    design, start = program.design, program.design.offsets["residuals"]
    if start == design.num_variables:
        return x
    full = program.design.unpack(x)
    x = design.pack(replace(full, residuals=program.state(x).residual))
    return np.clip(x, design.lower, design.upper)


def _motion_rows(program: GaitProgram) -> int:
    """Number of rows of the equations of motion, which come first."""
    first = program.constraints[0]
    assert isinstance(first, EquationsOfMotion)
    return int(first.applies.sum())
