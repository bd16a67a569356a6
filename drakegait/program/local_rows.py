"""What every constraint at a control point has in common."""

from __future__ import annotations

from abc import ABC, abstractmethod

import numpy as np

from drakegait.program.chain import Partials, Pattern, chain
from drakegait.program.control_points import ControlPoints
from drakegait.program.formulation import Formulation
from drakegait.program.local_state import LocalState


class LocalRows(ABC):
    """A kind of constraint that holds at every control point: lower <= g(z) <= upper.

    Rows are divided by their tolerance or typical size, so that 1 means "one
    tolerance" (or one typical size) to a solver.

    Attributes:
        kind: name of the law in gait terms.
        row_names: what each row is about.
        scale: physical size of one unit of each row (num_rows,).
        units: unit of `scale`.
        lower, upper: bounds in units of `scale` (num_rows,).
        applies: at which control points each row holds (num_points, num_rows).
        rows, columns: sparsity, local variables by row, constant.
    """

    kind: str
    row_names: tuple[str, ...]
    scale: np.ndarray
    units: tuple[str, ...]
    lower: np.ndarray
    upper: np.ndarray
    applies: np.ndarray
    rows: np.ndarray
    columns: np.ndarray

    def __init__(self, formulation: Formulation, points: ControlPoints):
        self.formulation = formulation
        self.points = points

    @property
    def num_rows(self) -> int:
        """Rows at a control point where all of them hold."""
        return len(self.row_names)

    @abstractmethod
    def values(self, state: LocalState) -> np.ndarray:
        """Scaled values (num, num_rows)."""

    @abstractmethod
    def jacobian(self, state: LocalState) -> np.ndarray:
        """Scaled derivatives by local variables in the order of `rows`, `columns`."""


class DenseRows(LocalRows):
    """Rows whose derivatives go through the general chain rule.

    Derived classes set `pattern` and implement `values` and `partials` (unscaled).
    """

    pattern: Pattern

    def _declare(self, pattern: Pattern) -> None:
        if not self.formulation.lifted:
            pattern = pattern.with_projected_multipliers()
        self._mask = pattern.local(self.points.layout)
        self.rows, self.columns = np.nonzero(self._mask)
        self._places = np.flatnonzero(self._mask)

    @abstractmethod
    def partials(self, state: LocalState) -> Partials:
        """Derivatives of the unscaled rows by physical quantities."""

    def jacobian(self, state: LocalState) -> np.ndarray:
        dense = chain(state, self.partials(state), self.num_rows)
        entries = dense.reshape(len(dense), -1).take(self._places, axis=1)
        return entries / self.scale[self.rows]
