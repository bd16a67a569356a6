"""Constraints that belong to the stride as a whole, not to one control point.

`TimingRows` are always there. The others exist only in variants of the
formulation and come after them.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable

import numpy as np

from drakegait.program.formulation import Formulation
from drakegait.program.local_state import LocalState
from drakegait.reference.periodicity import force_periodicity
from drakegait.transcription.design_vector import DesignVector


class StrideRows(ABC):
    """Rows lower <= g(x) <= upper in units of `scale`, linear or piecewise linear in x
    (their second derivatives count as zero) unless multipliers are projected.

    Attributes:
        kind: name of the law.
        names: `"law | where | what"` of each row.
        scale, units: size of one unit of each row.
        lower, upper: bounds in units of `scale`.
        rows, columns: positions of the Jacobian's entries, each once; columns are variables.
    """

    kind: str
    names: list[str]
    scale: np.ndarray
    units: list[str]
    lower: np.ndarray
    upper: np.ndarray
    rows: np.ndarray
    columns: np.ndarray

    @abstractmethod
    def values(self, x: np.ndarray, state: Callable[[np.ndarray], LocalState]) -> np.ndarray:
        """Scaled rows; `state` gives the physics at all control points for an x."""

    @abstractmethod
    def jacobian(self, x: np.ndarray, state: Callable[[np.ndarray], LocalState]) -> np.ndarray:
        """Scaled derivatives at `rows`, `columns`."""


class PeriodicEnds(StrideRows):
    """Eq. (14) on the unknown curves: their nodal values obey it like those of measured ones.

    For each coordinate and muscle force with nodal values f_1 .. f_N, f_N = f_1,

        f_k = (the value that eq. (14) gives it from f_3 .. f_(N-2)),    k = 1, 2, N - 1,

    three linear equations in the coefficients. What remains free are the paper's f_3 .. f_(N-2):
    the same set of curves, without the need to choose which values depend on which. Bounds stay
    with the coefficients, and so hold for the dependent nodes too. In a symmetric walker the
    curves that are mirror images of others have no rows of their own.
    """

    kind = "periodic ends"

    def __init__(self, formulation: Formulation, design: DesignVector):
        splines = formulation.splines
        weights = _end_weights(splines.num_intervals) @ splines.nodal_values(
            np.eye(splines.num_intervals)
        ).T  # of the coefficients
        walker, mirrored = formulation.walker, formulation.symmetric
        names, scale, units, matrices = [], [], [], []
        for block, curves in (
            ("coordinates", walker.coordinate_names),
            ("forces", walker.muscles.names),
        ):
            free = design.selection(block)
            size = design.blocks[block].scale[:, 0]
            for i, curve in enumerate(curves):
                if mirrored and curve.endswith("_l"):
                    continue
                full = np.zeros((3, design.num_variables))
                np.add.at(full.T, free.index[i], (weights * free.factor[i]).T / size[i])
                matrices.append(full)
                what = "" if block == "coordinates" else " force"
                names += [f"{self.kind} | node {k} | {curve}{what}" for k in ("1", "2", "N-1")]
                rotates = block == "coordinates" and walker.is_rotation[i]
                unit = "N" if block == "forces" else ("rad" if rotates else "m")
                scale += [size[i]] * 3
                units += [unit] * 3
        matrix = np.concatenate(matrices)
        self.names, self.units, self.scale = names, units, np.array(scale)
        self.lower = self.upper = np.zeros(len(names))
        self.rows, self.columns = np.nonzero(matrix)
        self._entries = matrix[self.rows, self.columns]

    def values(self, x: np.ndarray, state: Callable[[np.ndarray], LocalState]) -> np.ndarray:
        return np.bincount(self.rows, self._entries * x[self.columns], len(self.names))

    def jacobian(self, x: np.ndarray, state: Callable[[np.ndarray], LocalState]) -> np.ndarray:
        return self._entries


def _end_weights(num_values: int) -> np.ndarray:
    """Weights (3, M) of f_1 .. f_M in the three equations, f_(M+1) = f_1."""
    unit = np.eye(num_values)
    closed = np.column_stack([unit, unit[:, 0]])
    ends = [0, 1, num_values - 1]
    return (closed - force_periodicity(closed))[:, ends].T
