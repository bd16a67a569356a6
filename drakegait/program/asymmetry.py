"""Constraint: right and left steps or stances in a given ratio.

    L_R - ratio L_L = 0                                        step length
    (theta_7 - theta_1) - ratio (1 + theta_3 - theta_5) = 0    stance time

with theta_p the start of phase p as fraction of the stride: stance lasts from
heel strike (phases 1 and 5 begin) to toe off (phases 7 and, of the next
stride, 3). Both are linear in the unknowns.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from drakegait.program.formulation import Formulation
from drakegait.program.local_state import LocalState
from drakegait.program.stride_rows import StrideRows
from drakegait.transcription.design_vector import DesignVector
from drakegait.walker.disorders import Asymmetry

_LENGTH, _SHARE = 0.1, 0.05  # typical sizes [m], [share of the stride]
_TERMS = {  # block of the unknowns, (position in it, weight, whether the ratio multiplies it)
    "step_length": ("placement", ((0, 1.0, False), (1, -1.0, True))),
    "stance_time": ("timing", ((7, 1.0, False), (1, -1.0, False), (3, -1.0, True), (5, 1.0, True))),
}


class AsymmetryRows(StrideRows):
    """One row per ratio."""

    kind = "asymmetry"

    def __init__(self, formulation: Formulation, design: DesignVector):
        stated = formulation.asymmetries
        self.names = [f"{self.kind} | stride | {_words(item)}" for item in stated]
        self.scale = np.array([_size(item) for item in stated])
        self.units = ["m" if item.quantity == "step_length" else "of the stride" for item in stated]
        self.lower = self.upper = np.zeros(len(stated))
        matrix = np.zeros((len(stated), design.num_variables))
        self._constant = np.zeros(len(stated))
        for row, item in enumerate(stated):
            block, terms = _TERMS[item.quantity]
            unknowns = design.selection(block)
            for position, weight, multiplied in terms:
                factor = weight * (item.ratio if multiplied else 1.0) / self.scale[row]
                self._constant[row] += factor * unknowns.constant[position]
                if unknowns.index[position] >= 0:
                    matrix[row, unknowns.index[position]] += factor * unknowns.factor[position]
            if item.quantity == "stance_time":
                self._constant[row] -= item.ratio / self.scale[row]
        self.rows, self.columns = np.nonzero(matrix)
        self._entries = matrix[self.rows, self.columns]

    def values(self, x: np.ndarray, state: Callable[[np.ndarray], LocalState]) -> np.ndarray:
        linear = np.bincount(self.rows, self._entries * x[self.columns], len(self.names))
        return linear + self._constant

    def jacobian(self, x: np.ndarray, state: Callable[[np.ndarray], LocalState]) -> np.ndarray:
        return self._entries


def _words(item: Asymmetry) -> str:
    return f"{item.quantity.replace('_', ' ')} right over left"


def _size(item: Asymmetry) -> float:
    return _LENGTH if item.quantity == "step_length" else _SHARE
