"""The same program as bindings of Drake's `MathematicalProgram`.

One constraint binding per law and control point, over that point's own
variables only, with its sparsity declared; one cost binding per kind of cost.
Everything between the AutoDiffXd vectors of a binding is plain floats
(`ExtractValue` in, `InitializeAutoDiff` out).

Drake calls the bindings one by one, while our arrays are cheapest for all
control points together. A cost binding sees the whole design vector and
evaluates all points at once; a constraint binding that finds its variables
unchanged since then reads from that evaluation, and otherwise evaluates its
own point.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from pydrake.autodiffutils import ExtractGradient, ExtractValue, InitializeAutoDiff
from pydrake.solvers import Binding, Constraint, Cost, MathematicalProgram
from pydrake.symbolic import Variable

from drakegait.program.gait_program import GaitProgram
from drakegait.program.local_costs import LocalCost
from drakegait.program.local_rows import LocalRows
from drakegait.program.local_state import LocalState


@dataclass(frozen=True)
class DrakeProgram:
    """A `MathematicalProgram` and what its parts are called.

    Attributes:
        program: to be handed to any of Drake's solvers.
        variables: the scaled design vector.
        constraints: bindings in the order of the rows of `GaitProgram`.
        costs: one binding per kind.
    """

    program: MathematicalProgram
    variables: np.ndarray
    constraints: tuple[Binding[Constraint], ...]
    costs: tuple[Binding[Cost], ...]


def mathematical_program(gait_program: GaitProgram) -> DrakeProgram:
    """Write `gait_program` as a `MathematicalProgram` over named, scaled variables."""
    program = MathematicalProgram()
    variables = np.array([Variable(name) for name in gait_program.design.names])
    program.AddDecisionVariables(variables)
    bounds = program.AddBoundingBoxConstraint(
        gait_program.design.lower, gait_program.design.upper, variables
    )
    bounds.evaluator().set_description("bounds of the design variables")
    costs = tuple(
        _add_cost(program, _CostEvaluator(gait_program, cost), variables)
        for cost in gait_program.costs
    )
    constraints = []
    for constraint in gait_program.constraints:
        for point in range(gait_program.points.num):
            if constraint.applies[point].any():
                evaluator = _PointEvaluator(gait_program, constraint, point)
                constraints.append(_add_constraint(program, evaluator, variables))
    constraints.append(_add_constraint(program, _TimingEvaluator(gait_program), variables))
    return DrakeProgram(program, variables, tuple(constraints), costs)


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
    if not _is_identity(x):
        jacobian = jacobian @ ExtractGradient(x)
    return InitializeAutoDiff(value, jacobian)[:, 0]


def _is_identity(x: np.ndarray) -> bool:
    """Whether x carries the identity as derivatives, as Drake's solvers seed it.

    Reading all derivatives costs more than the physics; first, middle and last entry tell the
    solvers' seed from any other.
    """
    num = len(x)
    for i in {0, num // 2, num - 1}:
        derivatives = x[i].derivatives()
        if len(derivatives) != num or derivatives[i] != 1.0 or np.count_nonzero(derivatives) != 1:
            return False
    return True


class _PointEvaluator:
    """The rows of one law at one control point, as a function of that point's variables."""

    def __init__(self, program: GaitProgram, constraint: LocalRows, point: int):
        self._program, self._constraint, self._point = program, constraint, point
        self._points = program.points.only(point)
        holds = constraint.applies[point]
        self._holds = holds
        self.lower, self.upper = constraint.lower[holds], constraint.upper[holds]
        self.name = f"{constraint.kind} | {program.place_name(point)}"
        number = np.cumsum(holds) - 1
        local = program.selection.index[point]
        # The variables that determine the physics at this point, in the solver's order.
        self.index, place = np.unique(local, return_inverse=True)
        if self.index[0] == -1:
            self.index, place = self.index[1:], place - 1
        self._place, self._is_variable = place, local >= 0
        self._factor = program.selection.factor[point]
        self._constant = program.selection.constant[point]
        kept = holds[constraint.rows] & self._is_variable[constraint.columns]
        self._kept = np.flatnonzero(kept)
        self.rows = number[constraint.rows[kept]]
        self.columns = place[constraint.columns[kept]]
        self._entry_factor = self._factor[constraint.columns[kept]]
        self._flat = self.rows * len(self.index) + self.columns

    def __call__(self, x: np.ndarray) -> np.ndarray:
        if x.dtype != object:
            return self._values(*self._state(x))
        value = ExtractValue(x)[:, 0]
        state, at = self._state(value)
        entries = self._jacobian_entries(state, at) * self._entry_factor
        shape = (len(self.lower), len(self.index))
        jacobian = np.bincount(self._flat, entries, shape[0] * shape[1]).reshape(shape)
        return _with_derivatives(x, self._values(state, at), jacobian)

    def _values(self, state: LocalState, at: int) -> np.ndarray:
        return _once(state, self._constraint, "values")[at][self._holds]

    def _jacobian_entries(self, state: LocalState, at: int) -> np.ndarray:
        return _once(state, self._constraint, "jacobian")[at][self._kept]

    def _state(self, value: np.ndarray) -> tuple[LocalState, int]:
        """The physics for these variables and this point's position in it."""
        program = self._program
        shared = program.last_state()
        if shared is not None and np.array_equal(shared[0][self.index], value):
            return shared[1], self._point
        own = program.last_point_state.get(self._point)
        if own is None or not np.array_equal(own[0], value):
            padded = np.where(self._is_variable, value[self._place], 0.0)
            z = self._constant + self._factor * padded
            state = LocalState(program.formulation, self._points, z[None], program.smoothing)
            own = value.copy(), state
            program.last_point_state[self._point] = own
        return own[1], 0


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
        value = self._program.timing.values(full)
        if x.dtype != object:
            return value
        jacobian = np.zeros((len(value), len(x)))
        jacobian[self.rows, self.columns] = self._program.timing.jacobian(full)
        return _with_derivatives(x, value, jacobian)


class _CostEvaluator:
    """One kind of cost as a function of the whole design vector."""

    def __init__(self, program: GaitProgram, cost: LocalCost):
        self._program, self._cost = program, cost
        self.name = cost.kind
        self.index = np.arange(program.num_variables)

    def __call__(self, x: np.ndarray) -> np.ndarray | float:
        if x.dtype != object:
            return float(self._cost.values(self._program.state(x)).sum())
        value = ExtractValue(x)[:, 0]
        total = self._cost.values(self._program.state(value)).sum()
        gradient = self._program.cost_gradient(self._cost, value)
        return _with_derivatives(x, np.array([total]), gradient[None])[0]
