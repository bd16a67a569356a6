"""The exact Hessian of the Lagrangian of a `GaitProgram`.

    H = sigma f_xx + sum_r lambda_r (g_r)_xx

made of small dense blocks at each control point (`hessian_blocks`), added up
over the control points that share coefficients. With it a solve mostly takes
fewer iterations than with quasi-Newton updates, which may also end at worse optima.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from drakegait.errors import InvalidInput
from drakegait.program.cost_hessian import (
    add_deviation,
    add_energy_weights,
    add_footprints,
    add_friction,
    power_weight,
)
from drakegait.program.excitation import Excitation, MuscleChain
from drakegait.program.gait_program import GaitProgram
from drakegait.program.hessian_blocks import HessianBlocks, places
from drakegait.program.hessian_chain import Directions, carry
from drakegait.program.load_penalty import LoadPenalty
from drakegait.program.local_costs import Deviation, MetabolicCost
from drakegait.program.local_rows import LocalRows
from drakegait.program.local_state import LocalState
from drakegait.program.physical_hessian import (
    LawWeights,
    PhysicalHessian,
    hessian_of_muscles,
    physical_hessian,
)
from drakegait.walker.corners import CornerSlopes
from drakegait.walker.dynamics_curvature import DynamicsCurvature


@dataclass(frozen=True)
class LocalCurvature:
    """Second derivatives at the control points, how their motion changes with time, and what the
    former are made of."""

    blocks: HessianBlocks
    directions: Directions
    physical: PhysicalHessian


@dataclass(frozen=True)
class _Sparsity:
    """Where local second derivatives go in the sparse matrix.

    Attributes:
        kept: those that count, of all (num * entries) of them.
        factor: of each of those.
        entry: the place of each of those, and then of the timing rows' ones.
        rows, columns: of each place.
    """

    kept: np.ndarray
    factor: np.ndarray
    entry: np.ndarray
    rows: np.ndarray
    columns: np.ndarray


class LagrangianHessian:
    """Second derivatives of a program with lifted multipliers.

    Raises:
        InvalidInput: for projected multipliers, whose elimination has no second derivatives here.
    """

    def __init__(self, program: GaitProgram):
        if not program.formulation.lifted:
            raise InvalidInput("multipliers", "projected", "lifted for exact second derivatives")
        self._program = program
        self._dynamics = DynamicsCurvature(program.formulation.walker.skeleton)
        self._spans = MuscleChain(program.formulation)
        self._penalties = [cost for cost in program.costs if isinstance(cost, LoadPenalty)]
        self._numbers = {type(item): k for k, item in enumerate(program.constraints)}

    @property
    def rows(self) -> np.ndarray:
        """Rows of the entries of the lower triangle that may differ from zero, each once."""
        return self._sparsity.rows

    @property
    def columns(self) -> np.ndarray:
        """Their columns."""
        return self._sparsity.columns

    @property
    def num_entries(self) -> int:
        """Their number."""
        return len(self.rows)

    def values(
        self,
        x: np.ndarray,
        multipliers: np.ndarray,
        objective: float,
        stiffness: np.ndarray | None = None,
    ) -> np.ndarray:
        """Entries at (`rows`, `columns`).

        Args:
            x: design vector.
            multipliers: lambda of the rows (num_constraints,).
            objective: factor sigma of the cost.
            stiffness: weights w of the rows (num_constraints,) in an interior-point method; for
                the excitation rows g, w g_x^T g_x is added at no cost. Others are not read.
        """
        program, state, sparsity = self._program, self._program.state(x), self._sparsity
        curvature = self.local_curvature(state, multipliers, objective, stiffness)
        local = self._local(curvature, objective).ravel()[sparsity.kept]
        timing = program.timing.curvature(multipliers[program.first_timing_row :])
        entries = np.concatenate([local * sparsity.factor, timing])
        return np.bincount(sparsity.entry, entries, self.num_entries)

    def _local(self, curvature: LocalCurvature, objective: float) -> np.ndarray:
        """Second derivatives by local variables (num, entries)."""
        state, entries = curvature.blocks.state, curvature.blocks.values(self._spans)
        if not self._penalties:
            return entries
        penalties = [penalty.curvature(state, objective) for penalty in self._penalties]
        return np.concatenate([entries, *penalties], axis=1)

    def local_curvature(
        self,
        state: LocalState,
        multipliers: np.ndarray,
        objective: float,
        stiffness: np.ndarray | None = None,
        corners: CornerSlopes | None = None,
    ) -> LocalCurvature:
        """Second derivatives at the control points; see `values`, `physical_hessian`."""
        weights = self._weights(multipliers)
        springs = None if stiffness is None else self._weights(stiffness, power=2)(Excitation)
        costs = {type(cost): cost for cost in self._program.costs}
        blocks = HessianBlocks(state)
        directions = Directions.of(state, blocks)
        power = np.zeros(len(state.q))
        if MetabolicCost in costs:
            power = power_weight(state, objective)
            add_energy_weights(
                blocks, costs[MetabolicCost], directions, self._spans, objective
            )
        physical = physical_hessian(state, self._dynamics, weights, power, springs, corners)
        carry(blocks, physical, directions, self._spans.arms)
        if Deviation in costs:
            add_deviation(blocks, costs[Deviation], objective)
        add_friction(blocks, weights)
        add_footprints(blocks, weights)
        return LocalCurvature(blocks, directions, physical)

    def muscle_blocks(self, curvature: LocalCurvature, muscles: np.ndarray) -> HessianBlocks:
        """Second derivatives (num, m, 6, 6) by the muscles' inputs, carried to the control points'
        variables at the state of `curvature`."""
        blocks, arms = HessianBlocks(curvature.blocks.state), self._spans.arms
        physical = hessian_of_muscles(curvature.physical, muscles, arms)
        carry(blocks, physical, curvature.directions, arms)
        return blocks

    def _weights(self, multipliers: np.ndarray, power: int = 1) -> LawWeights:
        program, padded = self._program, np.append(multipliers, 0.0)

        def of(kind: type[LocalRows]) -> np.ndarray | None:
            number = self._numbers.get(kind)
            if number is None:
                return None
            # A row that does not hold somewhere has the number -1: the zero at the end.
            return padded[program.row_numbers[number]] / program.constraints[number].scale**power

        return of

    # Sparsity ----------------------------------------------------------------------------

    @cached_property
    def _sparsity(self) -> _Sparsity:
        """Takes a while; who works with `local_curvature` does without it."""
        program = self._program
        left, right = places(self._probe_state(), self._spans)
        left = np.concatenate([left, *(penalty.pairs[0] for penalty in self._penalties)])
        right = np.concatenate([right, *(penalty.pairs[1] for penalty in self._penalties)])
        index, factor = program.selection.index, program.selection.factor
        row, column = index[:, left], index[:, right]
        kept = (row >= 0) & (column >= 0) & self._possible()
        scale = (factor[:, left] * factor[:, right])[kept]
        row, column = row[kept], column[kept]
        # One local entry off the diagonal stands for two; where a mirror makes both ends the
        # same variable they fall on one place of the diagonal.
        doubled = (row == column) & np.broadcast_to(left != right, kept.shape)[kept]
        row = np.concatenate([row, program.timing.curved_rows])
        column = np.concatenate([column, program.timing.curved_columns])
        keys = np.maximum(row, column) * program.num_variables + np.minimum(row, column)
        keys, entry = np.unique(keys, return_inverse=True)
        return _Sparsity(
            kept=np.flatnonzero(kept),
            factor=np.where(doubled, 2.0 * scale, scale),
            entry=entry,
            rows=keys // program.num_variables,
            columns=keys % program.num_variables,
        )

    def _probe_state(self) -> LocalState:
        """A state without accidental zeros; its basis rows reach all of their windows."""
        program, generator = self._program, np.random.default_rng(0)
        design, points = program.design, program.points
        low, high = np.maximum(design.lower, -1e3), np.minimum(design.upper, 1e3)
        x = generator.uniform(0.4, 0.6, design.num_variables) * (high - low) + low
        state = LocalState(program.formulation, points, program.selection.values(x))
        state.basis = generator.uniform(0.5, 1.5, (4, points.num, points.layout.width))
        return state

    def _possible(self) -> np.ndarray:
        """Entries that can differ from zero, found with random weights."""
        weights = np.random.default_rng(1).uniform(0.5, 1.5, self._program.num_constraints)
        curvature = self.local_curvature(self._probe_state(), weights, 1.0)
        return self._local(curvature, 1.0) != 0.0
