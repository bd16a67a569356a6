"""The nonlinear program of walking: variables, rows, costs, names.

`GaitProgram` numbers the rows of all constraints at all control points,
evaluates them together as arrays (what a solver that takes sparse matrices
wants), and `mathematical_program` writes the same rows as bindings of a Drake
`MathematicalProgram`. Both ways run the same local code.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from drakegait.program.asymmetry import AsymmetryRows
from drakegait.program.control_points import ControlPoints
from drakegait.program.design import PHASE_DURATIONS, design_vector
from drakegait.program.equations_of_motion import EquationsOfMotion
from drakegait.program.excitation import Excitation
from drakegait.program.foot_contact import Clearance, FootContact
from drakegait.program.formulation import Formulation
from drakegait.program.ground_forces import FreeMoment, Friction, NormalForce, ToeTorque
from drakegait.program.joint_limits import JointLimits
from drakegait.program.largest_residuals import LargestResiduals
from drakegait.program.least_squares_multipliers import LeastSquaresMultipliers
from drakegait.program.load_penalty import load_penalties
from drakegait.program.local_costs import Deviation, LocalCost, MetabolicCost
from drakegait.program.local_rows import LocalRows
from drakegait.program.local_state import LocalState
from drakegait.program.selection import local_variables
from drakegait.program.stride_rows import PeriodicEnds, StrideRows
from drakegait.program.timing import TimingRows
from drakegait.transcription.design_vector import DesignValues
from drakegait.walker import feet


@dataclass(frozen=True)
class Violation:
    """One row of the program that does not hold."""

    name: str
    kind: str
    amount: float  # in units of the row's scale
    size: float  # physical
    unit: str

    def __str__(self) -> str:
        return f"{self.name}: off by {self.size:.3g} {self.unit}"


class GaitProgram:
    """One walking problem as a nonlinear program in a scaled design vector.

    Attributes:
        formulation: what is stated.
        points: the control points.
        design: the unknowns.
        constraints, costs: what holds and what is minimised at each control point.
        timing: the few rows that belong to no control point.
        stride_rows: rows of the stride as a whole that variants of the formulation add.
        smoothing: width of the rounded corners of the energy model, 1 = docs/formulation.md 1.6.
    """

    def __init__(self, formulation: Formulation):
        self.formulation = formulation
        self.points = ControlPoints.of(formulation)
        self.design = design_vector(formulation, self.points)
        self.smoothing = 1.0
        kinds = self._laws()
        self.constraints = [kind(formulation, self.points) for kind in kinds]
        self.costs: list[LocalCost] = []
        if formulation.energy_weight > 0.0:
            self.costs.append(MetabolicCost(formulation, self.points))
        if formulation.deviation_weight > 0.0:
            self.costs.append(Deviation(formulation, self.points))
        self.costs += load_penalties(formulation, self.points)
        self.timing = TimingRows(formulation, self.design, PHASE_DURATIONS)
        self.selection = local_variables(formulation, self.points, self.design)
        self.stride_rows = self._stride_rows()
        self._number_rows()
        self._number_entries()
        self._cached: tuple[np.ndarray, float, LocalState] | None = None

    # Sizes and names ---------------------------------------------------------------------

    @property
    def num_variables(self) -> int:
        """Number of unknowns."""
        return self.design.num_variables

    @property
    def num_constraints(self) -> int:
        """Number of rows."""
        return len(self.lower)

    @property
    def num_entries(self) -> int:
        """Number of entries of the Jacobian that may differ from zero."""
        return len(self.jacobian_rows)

    def place_name(self, point: int) -> str:
        """A control point in gait terms: phase and share of it."""
        phase, share = self.points.phases[point], self.points.shares[point]
        if share == 0.0:
            return f"{feet.EVENT_NAMES[phase]}"
        return f"{feet.PHASE_NAMES[phase]} {share:.2f}"

    @cached_property
    def row_names(self) -> list[str]:
        """`"law | phase and share | joint, foot or muscle"` of every row."""
        names = []
        for constraint in self.constraints:
            for point, applies in enumerate(constraint.applies):
                place = self.place_name(point)
                names += [
                    f"{constraint.kind} | {place} | {name}"
                    for name, holds in zip(constraint.row_names, applies, strict=True)
                    if holds
                ]
        return names + self.timing.names + [n for rows in self.stride_rows for n in rows.names]

    # Assembly ----------------------------------------------------------------------------

    def _laws(self) -> list[type[LocalRows]]:
        """What holds at each control point, in the order of the rows."""
        formulation = self.formulation
        kinds: list[type[LocalRows]] = [
            EquationsOfMotion, FootContact, Clearance, Friction, Excitation,
        ]  # fmt: skip
        if formulation.lifted:
            kinds.insert(1, LeastSquaresMultipliers)
        elif formulation.variants.eom_form == "maximum":
            kinds.remove(EquationsOfMotion)
        if not formulation.planar:
            kinds.append(FreeMoment)
        if not formulation.lifted:
            kinds.append(NormalForce)
            if formulation.contact.toe_torque:
                kinds.append(ToeTorque)
        if formulation.limits:
            kinds.append(JointLimits)
        return kinds

    def _stride_rows(self) -> list[StrideRows]:
        """Rows of variants of the formulation and of unequal steps; none by default."""
        rows: list[StrideRows] = []
        if self.formulation.asymmetries:
            rows.append(AsymmetryRows(self.formulation, self.design))
        variants = self.formulation.variants
        if variants.periodicity == "eq14":
            rows.append(PeriodicEnds(self.formulation, self.design))
        if variants.eom_form == "maximum":
            rows.append(
                LargestResiduals(self.formulation, self.points, self.design, self.selection)
            )
        return rows

    def _number_rows(self) -> None:
        self.row_numbers, lower, upper, scale, units = [], [], [], [], []
        total = 0
        for constraint in self.constraints:
            numbers = np.full(constraint.applies.shape, -1)
            count = int(constraint.applies.sum())
            numbers[constraint.applies] = total + np.arange(count)
            self.row_numbers.append(numbers)
            columns = np.nonzero(constraint.applies)[1]
            lower.append(constraint.lower[columns])
            upper.append(constraint.upper[columns])
            scale.append(constraint.scale[columns])
            units += [constraint.units[column] for column in columns]
            total += count
        self.first_timing_row, self.first_stride_rows = total, []
        total += len(self.timing.names)
        for rows in self.stride_rows:
            self.first_stride_rows.append(total)
            total += len(rows.names)
        whole = [self.timing, *self.stride_rows]
        self.lower = np.concatenate(lower + [rows.lower for rows in whole])
        self.upper = np.concatenate(upper + [rows.upper for rows in whole])
        self.row_scale = np.concatenate(scale + [rows.scale for rows in whole])
        self.row_units = units + [unit for rows in whole for unit in rows.units]

    def _number_entries(self) -> None:
        """Positions of the Jacobian's entries, and where each local derivative goes."""
        rows, columns, self._kept, factors = [], [], [], []
        for constraint, numbers in zip(self.constraints, self.row_numbers, strict=True):
            row = numbers[:, constraint.rows]
            column = self.selection.index[:, constraint.columns]
            kept = (row >= 0) & (column >= 0)
            rows.append(row[kept])
            columns.append(column[kept])
            factors.append(self.selection.factor[:, constraint.columns][kept])
            self._kept.append(np.flatnonzero(kept))
        firsts = [self.first_timing_row, *self.first_stride_rows]
        for first, more in zip(firsts, [self.timing, *self.stride_rows], strict=True):
            rows.append(first + more.rows)
            columns.append(more.columns)
            factors.append(np.ones(len(more.rows)))
        self._factors = np.concatenate(factors)
        keys = np.concatenate(rows) * self.num_variables + np.concatenate(columns)
        unique, self._entry = np.unique(keys, return_inverse=True)
        self._distinct = len(unique) == len(keys)
        if self._distinct:
            # Entries need not be sorted; keeping them as computed saves a pass.
            self.jacobian_rows = np.concatenate(rows)
            self.jacobian_columns = np.concatenate(columns)
        else:
            self.jacobian_rows = unique // self.num_variables
            self.jacobian_columns = unique % self.num_variables

    # Evaluation --------------------------------------------------------------------------

    def state(self, x: np.ndarray) -> LocalState:
        """The physics at all control points for the design vector `x` (kept for one x)."""
        cached = self._cached
        if cached is None or cached[1] != self.smoothing or not np.array_equal(cached[0], x):
            z = self.selection.values(x)
            state = LocalState(self.formulation, self.points, z, self.smoothing)
            self._cached = cached = x.copy(), self.smoothing, state
        return cached[2]

    def last_state(self) -> tuple[np.ndarray, LocalState] | None:
        """Design vector and physics of the last evaluation of all control points."""
        return None if self._cached is None else (self._cached[0], self._cached[2])

    def cost(self, x: np.ndarray) -> float:
        """f of eq. (13)."""
        return float(sum(self.cost_parts(x).values()))

    def cost_parts(self, x: np.ndarray) -> dict[str, float]:
        """Weighted parts of f by kind."""
        state = self.state(x)
        return {cost.kind: float(cost.values(state).sum()) for cost in self.costs}

    def gradient(self, x: np.ndarray) -> np.ndarray:
        """df/dx (num_variables,)."""
        return np.sum([self.cost_gradient(cost, x) for cost in self.costs], axis=0)

    def cost_gradient(self, cost: LocalCost, x: np.ndarray) -> np.ndarray:
        """Gradient of one kind of cost (num_variables,)."""
        local = cost.gradient(self.state(x)) * self.selection.factor[:, cost.columns]
        index = self.selection.index[:, cost.columns]
        index = np.where(index >= 0, index, self.num_variables).ravel()
        return np.bincount(index, local.ravel(), self.num_variables + 1)[:-1]

    def rows(self, x: np.ndarray) -> np.ndarray:
        """Scaled values of all rows (num_constraints,)."""
        state = self.state(x)
        parts = [constraint.values(state)[constraint.applies] for constraint in self.constraints]
        parts += [self.timing.values(x), *(r.values(x, self.state) for r in self.stride_rows)]
        return np.concatenate(parts)

    def jacobian(self, x: np.ndarray) -> np.ndarray:
        """Entries of the Jacobian at `jacobian_rows`, `jacobian_columns`."""
        state = self.state(x)
        parts = [
            constraint.jacobian(state).ravel().take(kept)
            for constraint, kept in zip(self.constraints, self._kept, strict=True)
        ]
        parts += [self.timing.jacobian(x), *(r.jacobian(x, self.state) for r in self.stride_rows)]
        values = np.concatenate(parts)
        values *= self._factors
        if self._distinct:
            return values
        return np.bincount(self._entry, values, self.num_entries)

    # Reading -----------------------------------------------------------------------------

    def values(self, x: np.ndarray) -> DesignValues:
        """The unknowns in full and in physical units; multipliers also if projected."""
        values = self.design.unpack(x)
        if self.formulation.lifted:
            return values
        state = self.state(x)
        return replace(values, multipliers=state.multipliers, residuals=state.residual)

    def violations(self, x: np.ndarray) -> np.ndarray:
        """How far each row is outside its bounds, in units of its scale (num_constraints,)."""
        rows = self.rows(x)
        return np.maximum(np.maximum(self.lower - rows, rows - self.upper), 0.0)

    def as_walk(self, x: np.ndarray) -> tuple[GaitProgram, np.ndarray]:
        """The program and its unknowns in which `x` is a walk: this one."""
        return self, x

    def worst(self, x: np.ndarray, count: int = 3) -> list[Violation]:
        """The `count` rows that are violated most, in gait terms."""
        amounts = np.nan_to_num(self.violations(x), nan=np.inf)
        order = np.argsort(-amounts)[:count]
        names, physical = self.row_names, amounts * self.row_scale
        return [
            Violation(
                names[i], names[i].split(" | ")[0], float(amounts[i]), float(physical[i]),
                self.row_units[i],
            )
            for i in order
            if amounts[i] > 0.0
        ]  # fmt: skip
