"""Cost: pain, a penalty on the load of a foot or a joint.

    foot:   weight sum_k s_k |F_k|^2 / W^2        F the force of the ground, W body weight
    joint:  weight sum_k s_k M_k^2 / (m M_1)^2    M = sum_m r_m f_m, M_1 = 1 N m/kg

with s_k the control point's share of the stride: the mean over the stride.
"""

from __future__ import annotations

import numpy as np

from drakegait.program.chain import Partials, Pattern, chain, no_dependence
from drakegait.program.control_points import ControlPoints
from drakegait.program.formulation import Formulation
from drakegait.program.local_costs import LocalCost
from drakegait.program.local_state import LocalState
from drakegait.walker import feet
from drakegait.walker.disorders import Pain

_MOMENT = 1.0  # [N m/kg]


def load_penalties(formulation: Formulation, points: ControlPoints) -> list[LoadPenalty]:
    """The costs of all that hurts, one for each side."""
    found: list[LoadPenalty] = []
    for pain in formulation.pains:
        kind = FootLoad if pain.where == "foot" else JointLoad
        if pain.weight > 0.0:
            found += [kind(formulation, points, pain, side) for side in pain.sides]
    return found


class LoadPenalty(LocalCost):
    """weight s l^2 with a load l of one or three components, relative to what is usual.

    Attributes:
        pairs: local rows and columns of the second derivatives, one triangle.
    """

    pairs: tuple[np.ndarray, np.ndarray]

    def __init__(self, formulation: Formulation, points: ControlPoints, pain: Pain, side: str):
        super().__init__(formulation, points)
        self.kind = f"pain in {pain.where}_{side}"
        self._weight = pain.weight
        self._points = points

    def _declare(self, masks: dict[str, np.ndarray]) -> None:
        masks["time"][:, 1:] = True
        pattern, layout = Pattern(**masks), self._points.layout
        if not self.formulation.lifted:
            pattern = pattern.with_projected_multipliers()
        self.columns = np.nonzero(pattern.local(layout)[0])[0]

    def load(self, state: LocalState) -> np.ndarray:
        """The relative load (num, components) [-]."""
        raise NotImplementedError

    def _partials(self, state: LocalState, factor: np.ndarray) -> Partials:
        """Derivatives of sum_a factor_a load_a, without those of the share."""
        raise NotImplementedError

    def curvature(self, state: LocalState, objective: float) -> np.ndarray:
        """Second derivatives (num, len(pairs[0])), for lifted multipliers."""
        raise NotImplementedError

    def values(self, state: LocalState) -> np.ndarray:
        return self._weight * state.share_of_cycle * (self.load(state) ** 2).sum(axis=1)

    def _share_slopes(self, state: LocalState) -> np.ndarray:
        """Derivatives of the share by the three local events (num, 3)."""
        return self.formulation.repeats * state.points.weights

    def gradient(self, state: LocalState) -> np.ndarray:
        load = self.load(state)
        factor = 2.0 * self._weight * state.share_of_cycle[:, None] * load
        partials = self._partials(state, factor)
        square = self._weight * (load**2).sum(axis=1)
        partials.events = (square[:, None] * self._share_slopes(state))[:, None]
        return chain(state, partials, 1)[:, 0, self.columns]


class FootLoad(LoadPenalty):
    """The force of the ground on a foot, in body weights."""

    def __init__(self, formulation: Formulation, points: ControlPoints, pain: Pain, side: str):
        super().__init__(formulation, points, pain, side)
        first = feet.ROWS_PER_FOOT * "rl".index(side)
        self._foot, self._rows = "rl".index(side), first + np.arange(6)  # heel xyz, toe xyz
        masks = no_dependence(1, points.layout)
        masks["multipliers"][:, self._rows] = True
        self._declare(masks)
        layout = points.layout
        forces = layout.multipliers + self._rows
        events = layout.time + 1 + np.arange(3)
        left = np.concatenate([forces, forces[3:], np.repeat(forces, 3)])
        right = np.concatenate([forces, forces[:3], np.tile(events, 6)])
        self.pairs = left, right

    def load(self, state: LocalState) -> np.ndarray:
        return state.ground_reactions[:, self._foot] / self.formulation.body_weight

    def _loaded(self, state: LocalState) -> np.ndarray:
        return state.points.loaded[:, self._rows].astype(float)

    def _partials(self, state: LocalState, factor: np.ndarray) -> Partials:
        out = np.zeros((len(factor), 1, state.points.layout.num_rows))
        both = np.tile(factor, 2) * self._loaded(state)
        out[:, 0, self._rows] = both / self.formulation.body_weight
        return Partials(multipliers=out)

    def curvature(self, state: LocalState, objective: float) -> np.ndarray:
        loaded = self._loaded(state)
        bend = 2.0 * objective * self._weight / self.formulation.body_weight**2
        square = bend * state.share_of_cycle[:, None] * loaded
        across = square[:, :3] * loaded[:, 3:]
        slope = bend * self.formulation.body_weight * np.tile(self.load(state), 2) * loaded
        mixed = slope[:, :, None] * self._share_slopes(state)[:, None]
        return np.concatenate([square, across, mixed.reshape(len(slope), -1)], axis=1)


class JointLoad(LoadPenalty):
    """The moment of all muscles about a joint, in N m per kg of body mass."""

    def __init__(self, formulation: Formulation, points: ControlPoints, pain: Pain, side: str):
        super().__init__(formulation, points, pain, side)
        walker, layout = formulation.walker, points.layout
        row = walker.coordinate_names.index(f"{pain.where}_{side}")
        arms = walker.muscles.moment_arms[:, row] / (_MOMENT * walker.subject.mass)
        self._muscles = np.flatnonzero(arms)
        self._arms = arms[self._muscles]
        masks = no_dependence(1, layout)
        masks["forces"][:, self._muscles] = True
        self._declare(masks)
        window = np.arange(layout.width)
        coefficients = (layout.forces + self._muscles[:, None] * layout.width + window).ravel()
        variables = np.concatenate([coefficients, layout.time + 1 + np.arange(3)])
        self._low = np.tril_indices(len(variables))
        self.pairs = variables[self._low[0]], variables[self._low[1]]

    def load(self, state: LocalState) -> np.ndarray:
        return state.forces.value[:, self._muscles] @ self._arms[:, None]

    def _partials(self, state: LocalState, factor: np.ndarray) -> Partials:
        out = np.zeros((len(factor), 1, state.points.layout.num_muscles))
        out[:, 0, self._muscles] = factor * self._arms
        return Partials(f=out)

    def curvature(self, state: LocalState, objective: float) -> np.ndarray:
        num, count = state.points.num, len(self._muscles) * state.points.layout.width
        basis, load = state.basis, self.load(state)[:, 0]
        by_tau = np.zeros((num, 3))  # of the events before, at the start and at the end
        by_tau[:, 1], by_tau[:, 2] = 1.0 - state.points.shares, state.points.shares
        first = np.zeros((num, count + 3))
        first[:, :count] = (self._arms[:, None] * basis[0][:, None]).reshape(num, -1)
        speed = state.forces.by_tau[0][:, self._muscles] @ self._arms
        first[:, count:] = speed[:, None] * by_tau
        second = np.zeros((num, count + 3, count + 3))
        along = (self._arms[:, None] * basis[1][:, None]).reshape(num, -1)
        second[:, count:, :count] = by_tau[:, :, None] * along[:, None]
        second[:, :count, count:] = np.swapaxes(second[:, count:, :count], 1, 2)
        bend = state.bending(np.broadcast_to(basis[2][:, None], (num, 3, basis.shape[2])))[1]
        bend = bend[:, self._muscles, 0] @ self._arms
        second[:, count:, count:] = bend[:, None, None] * by_tau[:, :, None] * by_tau[:, None]
        share = np.zeros((num, count + 3))
        share[:, count:] = self._share_slopes(state)
        weight = state.share_of_cycle[:, None, None]
        total = weight * (first[:, :, None] * first[:, None] + load[:, None, None] * second)
        mixed = load[:, None, None] * share[:, :, None] * first[:, None]
        total += mixed + np.swapaxes(mixed, 1, 2)
        return 2.0 * objective * self._weight * total[:, self._low[0], self._low[1]]
