"""First derivatives by forward differences, for comparison with the exact ones.

    dg_r/dx_c = (g_r(x + h e_c) - g_r(x)) / h

Variables that no row and no part of the cost share are moved together (Curtis, Powell & Reid
1974): all entries then follow from `num_colours` evaluations more instead of `num_variables`.
"""

from __future__ import annotations

import numpy as np
import scipy.sparse

from drakegait.program.formulation import Formulation
from drakegait.program.gait_program import GaitProgram

STEP = 1.5e-8
"""h for scaled variables of size 1: the root of the machine's precision."""


class DifferencedProgram(GaitProgram):
    """A `GaitProgram` whose gradient and Jacobian come from its values and its sparsity alone.

    Attributes:
        coloured: whether variables are moved together; else one by one.
        evaluations: of all rows and costs so far.
    """

    def __init__(self, formulation: Formulation, coloured: bool = True):
        super().__init__(formulation)
        self.coloured, self.evaluations = coloured, 0
        self._parts = self._parts_of_cost()
        self._colour = np.arange(self.num_variables)
        if coloured:
            self._colour = colours(self._pattern())
        self._known: tuple[np.ndarray, float, np.ndarray, np.ndarray] | None = None

    @property
    def num_colours(self) -> int:
        """Evaluations that one set of derivatives takes, besides that at x itself."""
        return int(self._colour.max()) + 1

    def gradient(self, x: np.ndarray) -> np.ndarray:
        """df/dx (num_variables,)."""
        return self._differences(x)[0]

    def jacobian(self, x: np.ndarray) -> np.ndarray:
        """Entries of the Jacobian at `jacobian_rows`, `jacobian_columns`."""
        return self._differences(x)[1]

    def _parts_of_cost(self) -> tuple[np.ndarray, np.ndarray]:
        """Control point and variable of every pair where a cost may change."""
        pairs = set()
        for cost in self.costs:
            index = self.selection.index[:, cost.columns]
            points = np.broadcast_to(np.arange(len(index))[:, None], index.shape)
            pairs |= set(zip(points[index >= 0].tolist(), index[index >= 0].tolist(), strict=True))
        point, variable = np.array(sorted(pairs)).reshape(-1, 2).T
        return point, variable

    def _pattern(self) -> scipy.sparse.csc_array:
        """Rows and, below them, the cost at each control point, by variable."""
        point, variable = self._parts
        rows = np.concatenate([self.jacobian_rows, self.num_constraints + point])
        columns = np.concatenate([self.jacobian_columns, variable])
        shape = self.num_constraints + self.points.num, self.num_variables
        return scipy.sparse.csc_array((np.ones(len(rows)), (rows, columns)), shape=shape)

    def _differences(self, x: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        known = self._known
        if known is None or known[1] != self.smoothing or not np.array_equal(known[0], x):
            self._known = known = (x.copy(), self.smoothing, *self._computed(x))
        return known[2], known[3]

    def _computed(self, x: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        step = STEP * np.maximum(1.0, np.abs(x))
        step = (x + step) - x  # what the moved number really is away
        rows, costs = self._values(x)
        gradient, jacobian = np.zeros(x.size), np.zeros(self.num_entries)
        entries = _by_colour(self._colour[self.jacobian_columns], self.num_colours)
        parts = _by_colour(self._colour[self._parts[1]], self.num_colours)
        members = _by_colour(self._colour, self.num_colours)
        for entry, part, member in zip(entries, parts, members, strict=True):
            moved = x.copy()
            moved[member] += step[member]
            more_rows, more_costs = self._values(moved)
            jacobian[entry] = (more_rows - rows)[self.jacobian_rows[entry]]
            point, variable = self._parts[0][part], self._parts[1][part]
            np.add.at(gradient, variable, (more_costs - costs)[point])
        return gradient / step, jacobian / step[self.jacobian_columns]

    def _values(self, x: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        self.evaluations += 1
        state = self.state(x)
        return self.rows(x), np.sum([cost.values(state) for cost in self.costs], axis=0)


def _by_colour(colour: np.ndarray, num: int) -> list[np.ndarray]:
    """Positions of each colour."""
    order = np.argsort(colour, kind="stable")
    return np.split(order, np.searchsorted(colour[order], np.arange(1, num)))


def colours(pattern: scipy.sparse.csc_array) -> np.ndarray:
    """A colour (num_columns,) for each column such that columns of one colour share no row.

    Greedy, the fullest columns first.
    """
    meets = pattern.T @ pattern
    neighbours = scipy.sparse.csr_array(meets)
    colour = np.full(pattern.shape[1], -1)
    for column in np.argsort(-np.diff(neighbours.indptr), kind="stable"):
        others = neighbours.indices[neighbours.indptr[column] : neighbours.indptr[column + 1]]
        taken = np.zeros(len(others) + 1, dtype=bool)
        used = colour[others]
        taken[used[(used >= 0) & (used <= len(others))]] = True
        colour[column] = np.argmin(taken)
    return colour
