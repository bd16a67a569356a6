"""The same program as bindings of Drake's `MathematicalProgram`.

One constraint binding per control point with all laws that hold there, over
that point's own variables only and with its sparsity declared; one cost
binding per kind of cost. Everything between the AutoDiffXd vectors of a
binding is plain floats (`ExtractValue` in, `InitializeAutoDiff` out): packing
those vectors is what costs time, so a binding per law would be four times slower.

Drake calls the bindings one by one, while our arrays are cheapest for all
control points together. A visualization callback, which Drake's solvers call
with the whole design vector at every new iterate, evaluates all points at
once; a binding that finds its variables unchanged since then reads from that
evaluation, and otherwise evaluates its own point.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from pydrake.autodiffutils import ExtractGradient, ExtractValue, InitializeAutoDiff
from pydrake.solvers import Binding, Constraint, Cost, MathematicalProgram
from pydrake.symbolic import Variable

from drakegait.program.gait_program import GaitProgram
from drakegait.program.local_costs import LocalCost
from drakegait.program.local_rows import LocalRows
from drakegait.program.local_state import LocalState
from drakegait.program.stride_rows import StrideRows


@dataclass(frozen=True)
class DrakeProgram:
    """A `MathematicalProgram` and what its parts are called.

    Attributes:
        program: to be handed to any of Drake's solvers.
        variables: the scaled design vector.
        constraints: one binding per control point, then that of the timing rows and, in variants,
            one per kind of rows of the whole stride.
        rows: number in `GaitProgram` of each row of `constraints`, binding by binding.
        costs: one binding per kind.
    """

    program: MathematicalProgram
    variables: np.ndarray
    constraints: tuple[Binding[Constraint], ...]
    rows: np.ndarray
    costs: tuple[Binding[Cost], ...]


def mathematical_program(
    gait_program: GaitProgram, guard: Callable[[], None] | None = None
) -> DrakeProgram:
    """Write `gait_program` as a `MathematicalProgram` over named, scaled variables.

    Args:
        guard: called at every evaluation of a cost; may raise to end a solve.
    """
    program = MathematicalProgram()
    variables = np.array([Variable(name) for name in gait_program.design.names])
    program.AddDecisionVariables(variables)
    bounds = program.AddBoundingBoxConstraint(
        gait_program.design.lower, gait_program.design.upper, variables
    )
    bounds.evaluator().set_description("bounds of the design variables")
    costs = tuple(
        _add_cost(program, _CostEvaluator(gait_program, cost, guard), variables)
        for cost in gait_program.costs
    )
    points = [_PointEvaluator(gait_program, k) for k in range(gait_program.points.num)]
    stride = [_TimingEvaluator(gait_program)]
    stride += [_StrideEvaluator(gait_program, rows) for rows in gait_program.stride_rows]
    constraints = tuple(
        _add_constraint(program, evaluator, variables) for evaluator in (*points, *stride)
    )
    program.AddVisualizationCallback(lambda x: gait_program.state(x), variables)
    first = gait_program.first_timing_row
    rows = [point.row_numbers for point in points]
    rows.append(np.arange(first, gait_program.num_constraints))
    return DrakeProgram(program, variables, constraints, np.concatenate(rows), costs)


def _add_cost(
    program: MathematicalProgram, evaluator: _CostEvaluator, variables: np.ndarray
) -> Binding[Cost]:
    binding = program.AddCost(evaluator, variables[evaluator.index])
    binding.evaluator().set_description(evaluator.name)
    return binding


def _add_constraint(
    program: MathematicalProgram,
    evaluator: _PointEvaluator | _TimingEvaluator,
    variables: np.ndarray,
) -> Binding[Constraint]:
    binding = program.AddConstraint(
        evaluator, evaluator.lower, evaluator.upper, variables[evaluator.index], evaluator.name
    )
    pattern = sorted(set(zip(evaluator.rows.tolist(), evaluator.columns.tolist(), strict=True)))
    binding.evaluator().SetGradientSparsityPattern(pattern)
    return binding


def _with_derivatives(x: np.ndarray, value: np.ndarray, jacobian: np.ndarray) -> np.ndarray:
    """AutoDiffXd values of a function with the given Jacobian by `x`."""
    seed, num = ExtractGradient(x), len(x)
    square = seed.shape == (num, num)
    # Drake's solvers seed the identity: then the product is the Jacobian itself.
    if not (square and np.count_nonzero(seed) == num and np.all(seed.diagonal() == 1.0)):
        jacobian = jacobian @ seed
    return InitializeAutoDiff(value, jacobian)[:, 0]


class _PointEvaluator:
    """All rows of one control point as a function of that point's variables."""

    def __init__(self, program: GaitProgram, point: int):
        self._program, self._point = program, point
        self._points = program.points.only(point)
        self.name = f"laws of walking | {program.place_name(point)}"
        selection = program.selection
        local = selection.index[point]
        self.index, place = np.unique(local, return_inverse=True)
        if self.index[0] == -1:
            self.index, place = self.index[1:], place - 1
        self._place, self._is_variable = place, local >= 0
        self._factor, self._constant = selection.factor[point], selection.constant[point]
        self._holds = [constraint.applies[point] for constraint in program.constraints]
        self.row_numbers = np.concatenate([n[point][n[point] >= 0] for n in program.row_numbers])
        self.lower = program.lower[self.row_numbers]
        self.upper = program.upper[self.row_numbers]
        rows, columns, factors, self._kept, total = [], [], [], [], 0
        for constraint, holds in zip(program.constraints, self._holds, strict=True):
            number = total + np.cumsum(holds) - 1
            total += int(holds.sum())
            kept = np.flatnonzero(holds[constraint.rows] & self._is_variable[constraint.columns])
            self._kept.append(kept)
            rows.append(number[constraint.rows[kept]])
            columns.append(place[constraint.columns[kept]])
            factors.append(self._factor[constraint.columns[kept]])
        self.rows, self.columns = np.concatenate(rows), np.concatenate(columns)
        self._entry_factor = np.concatenate(factors)
        self._flat = self.rows * len(self.index) + self.columns

    def __call__(self, x: np.ndarray) -> np.ndarray:
        if x.dtype != object:
            return self._values(*self._state(x))
        value = ExtractValue(x)[:, 0]
        state, at = self._state(value)
        entries = np.concatenate(
            [
                _once(state, constraint, "jacobian")[at][kept]
                for constraint, kept in zip(self._program.constraints, self._kept, strict=True)
            ]
        )
        shape = (len(self.lower), len(self.index))
        entries = np.bincount(self._flat, entries * self._entry_factor, shape[0] * shape[1])
        return _with_derivatives(x, self._values(state, at), entries.reshape(shape))

    def _values(self, state: LocalState, at: int) -> np.ndarray:
        return np.concatenate(
            [
                _once(state, constraint, "values")[at][holds]
                for constraint, holds in zip(self._program.constraints, self._holds, strict=True)
            ]
        )

    def _state(self, value: np.ndarray) -> tuple[LocalState, int]:
        """The physics for these variables and this point's position in it."""
        program = self._program
        shared = program.last_state()
        if shared is not None and np.array_equal(shared[0][self.index], value):
            return shared[1], self._point
        padded = np.where(self._is_variable, value[self._place], 0.0)
        z = self._constant + self._factor * padded
        return LocalState(program.formulation, self._points, z[None], program.smoothing), 0


def _once(state: LocalState, constraint: LocalRows, what: str) -> np.ndarray:
    """`constraint.values(state)` or `.jacobian(state)`, computed once for each state."""
    key = (constraint.kind, what)
    if key not in state.results:
        state.results[key] = getattr(constraint, what)(state)
    return state.results[key]


class _TimingEvaluator:
    """Average speed and phase durations."""

    name = "average speed and phase durations"

    def __init__(self, program: GaitProgram):
        self._program = program
        self.index = np.unique(program.timing.columns)
        self.lower, self.upper = program.timing.lower, program.timing.upper
        self.rows = program.timing.rows
        self.columns = np.searchsorted(self.index, program.timing.columns)

    def __call__(self, x: np.ndarray) -> np.ndarray:
        full = np.zeros(self._program.num_variables)
        full[self.index] = x if x.dtype != object else ExtractValue(x)[:, 0]
        value = self._value(full)
        if x.dtype != object:
            return value
        jacobian = np.zeros((len(value), len(x)))
        jacobian[self.rows, self.columns] = self._entries(full)
        return _with_derivatives(x, value, jacobian)

    def _value(self, x: np.ndarray) -> np.ndarray:
        return self._program.timing.values(x)

    def _entries(self, x: np.ndarray) -> np.ndarray:
        return self._program.timing.jacobian(x)


class _StrideEvaluator(_TimingEvaluator):
    """Rows of the stride as a whole, of one kind."""

    def __init__(self, program: GaitProgram, rows: StrideRows):
        self._program, self._stride, self.name = program, rows, rows.kind
        self.index = np.unique(rows.columns)
        self.lower, self.upper = rows.lower, rows.upper
        self.rows, self.columns = rows.rows, np.searchsorted(self.index, rows.columns)

    def _value(self, x: np.ndarray) -> np.ndarray:
        return self._stride.values(x, self._program.state)

    def _entries(self, x: np.ndarray) -> np.ndarray:
        return self._stride.jacobian(x, self._program.state)


class _CostEvaluator:
    """One kind of cost as a function of the variables that it depends on."""

    def __init__(
        self, program: GaitProgram, cost: LocalCost, guard: Callable[[], None] | None = None
    ):
        self._program, self._cost, self._guard = program, cost, guard
        self.name = cost.kind
        index = np.unique(program.selection.index[:, cost.columns])
        self.index = index[index >= 0]

    def __call__(self, x: np.ndarray) -> np.ndarray | float:
        if self._guard is not None:
            self._guard()
        if x.dtype != object:
            return float(self._cost.values(self._program.state(self._full(x))).sum())
        full = self._full(ExtractValue(x)[:, 0])
        total = self._cost.values(self._program.state(full)).sum()
        gradient = self._program.cost_gradient(self._cost, full)[self.index]
        return _with_derivatives(x, np.array([total]), gradient[None])[0]

    def _full(self, value: np.ndarray) -> np.ndarray:
        """A design vector with these variables; the others do not enter the cost."""
        shared = self._program.last_state()
        if shared is not None and np.array_equal(shared[0][self.index], value):
            return shared[0]
        full = np.zeros(self._program.num_variables)
        full[self.index] = value
        return full
