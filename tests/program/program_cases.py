"""Small programs that have every kind of row, and design vectors that are no special case."""

from __future__ import annotations

import functools

import numpy as np
import scipy.sparse

from drakegait.program.formulation import JointLimit
from drakegait.program.gait_program import GaitProgram
from drakegait.program.guess import guess_from_reference
from drakegait.study import GaitStudy

MODELS = ("spatial", "planar", "spatial-symmetric", "planar-symmetric")
FORMS = ("lifted", "projected")
CASES = [(model, form) for model in MODELS for form in FORMS]
LIMITS = (JointLimit("hip_flexion_r", -0.4, 0.9), JointLimit("knee_flexion_l", -0.1, np.inf))
MIRRORED_LIMITS = (
    *LIMITS, JointLimit("hip_flexion_l", -0.4, 0.9), JointLimit("knee_flexion_r", -0.1, np.inf)
)  # fmt: skip


def study(model: str, form: str = "lifted", **statements) -> GaitStudy:
    """Few nodes, few control points, but points on every event and in every kind of phase."""
    symmetric = model.endswith("symmetric")
    chosen = dict(
        nodes=11 if symmetric else 10,
        interior_points=(1, 0, 1, 1) if symmetric else (1, 0, 1, 0, 0, 1, 0, 1),
        limits=MIRRORED_LIMITS if symmetric else LIMITS,
        multipliers=form,
    )
    return GaitStudy(model=model, **(chosen | statements))


@functools.cache
def program(model: str, form: str = "lifted", **statements) -> GaitProgram:
    return GaitProgram(study(model, form, **statements).formulation())


@functools.cache
def guess(model: str, form: str = "lifted", **statements) -> np.ndarray:
    """Design vector of the reference walk."""
    return guess_from_reference(program(model, form, **statements))


def jiggled(
    model: str, form: str = "lifted", seed: int = 1, size: float = 0.1, **statements
) -> np.ndarray:
    """A walk off the reference: nothing in it is zero, symmetric or at a bound by chance."""
    design = program(model, form, **statements).design
    x = guess(model, form, **statements)
    moved = x + size * np.random.default_rng(seed).uniform(-1.0, 1.0, x.size)
    return np.clip(moved, design.lower, design.upper)


def dense_jacobian(program: GaitProgram, x: np.ndarray) -> np.ndarray:
    shape = program.num_constraints, program.num_variables
    entries = (program.jacobian_rows, program.jacobian_columns)
    return scipy.sparse.coo_array((program.jacobian(x), entries), shape=shape).toarray()


def declared(program: GaitProgram) -> np.ndarray:
    """Mask of the entries that may differ from zero."""
    mask = np.zeros((program.num_constraints, program.num_variables), dtype=bool)
    mask[program.jacobian_rows, program.jacobian_columns] = True
    return mask


def differences(function, x: np.ndarray, step: float = 1e-5) -> np.ndarray:
    """Derivatives of `function` by every entry of x, by central differences of fourth order."""
    columns = []
    for i in range(x.size):
        def at(shift, i=i):
            moved = x.copy()
            moved[i] += shift
            return np.atleast_1d(function(moved))

        near, far = at(step) - at(-step), at(2.0 * step) - at(-2.0 * step)
        columns.append((8.0 * near - far) / (12.0 * step))
    return np.stack(columns, axis=-1)


def directional_difference(function, x: np.ndarray, way: np.ndarray, step: float = 1e-5):
    """Derivative of `function` along `way`, by central differences of fourth order."""
    near = function(x + step * way) - function(x - step * way)
    far = function(x + 2.0 * step * way) - function(x - 2.0 * step * way)
    return (8.0 * near - far) / (12.0 * step)


def numbers_of(program: GaitProgram, *words: str) -> np.ndarray:
    """Rows whose name has all these words."""
    return np.array(
        [i for i, name in enumerate(program.row_names) if all(word in name for word in words)],
        dtype=int,
    )
