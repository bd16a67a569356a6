"""The two costs of eq. (13), summed over the control points.

    f = w_E E^t / 100 + w_J J_dev

Metabolic cost of transport (7), (8): E^t = (1 / (L_R + L_L)) sum_k w_k T P_k with P_k the
metabolic power [W] of all muscles (Umberger, Gerritsen & Martin 2003) and w_k
trapezoidal shares of the cycle. Deviation (11): J_dev = sum_k w_k T D_k with

    D = sum_i omega_i (x_i - x_i^m)^2 / sigma_i^2

over coordinates and the ground reactions of each foot, compared at the same
percentage of the cycle; omega_i from eq. (12). hat_x is compared without its
steady advance, so a different speed or stride length is not a deviation.
"""

from __future__ import annotations

from abc import ABC, abstractmethod

import numpy as np

from drakegait.program.chain import Partials, Pattern, chain, no_dependence
from drakegait.program.control_points import ControlPoints
from drakegait.program.excitation import MuscleChain
from drakegait.program.formulation import Formulation
from drakegait.program.local_state import LocalState
from drakegait.walker import feet


class LocalCost(ABC):
    """A cost that is a sum over control points.

    Attributes:
        kind: its name.
        columns: local variables that it depends on, constant.
    """

    kind: str
    columns: np.ndarray

    def __init__(self, formulation: Formulation, points: ControlPoints):
        self.formulation = formulation

    @abstractmethod
    def values(self, state: LocalState) -> np.ndarray:
        """Weighted contributions to f of eq. (13), (num,)."""

    @abstractmethod
    def gradient(self, state: LocalState) -> np.ndarray:
        """Derivatives by the local variables in `columns`, (num, len(columns))."""


class MetabolicCost(LocalCost):
    """w_E E^t / 100."""

    kind = "metabolic cost of transport"

    def __init__(self, formulation: Formulation, points: ControlPoints):
        super().__init__(formulation, points)
        self._chain = MuscleChain(formulation)
        layout, width = points.layout, points.layout.width
        spanned = np.unique(self._chain.coordinate_of_span)
        window = np.arange(width)
        self._by_span = np.zeros((len(spanned), layout.num_muscles))
        for muscle, coordinate, arm in zip(
            self._chain.muscle_of_span,
            self._chain.coordinate_of_span,
            self._chain.arm_of_span,
            strict=True,
        ):
            self._by_span[np.searchsorted(spanned, coordinate), muscle] = -arm
        self.columns = np.concatenate(
            [
                (spanned[:, None] * width + window).ravel(),
                layout.forces + np.arange(layout.num_muscles * width),
                layout.time + np.arange(4),
                layout.placement + np.arange(2),
            ]
        )
        walker = formulation.walker
        self._basal = walker.energy_settings.basal_power(walker.subject.mass)

    def power(self, state: LocalState) -> np.ndarray:
        """Metabolic power of the walker at each control point (num,) [W]."""
        return state.muscle_values[..., 2].sum(axis=1) + self._basal

    def values(self, state: LocalState) -> np.ndarray:
        weight = 0.01 * self.formulation.energy_weight
        energy = state.share_of_cycle * state.stride_time[:, 0] * self.power(state)
        return weight * energy / state.stride_length

    def gradient(self, state: LocalState) -> np.ndarray:
        num = state.points.num
        weight = 0.01 * self.formulation.energy_weight / state.stride_length
        period, share = state.stride_time[:, 0], state.share_of_cycle
        slopes = state.muscles[1][:, :, 2, :]
        force, length = self._chain.windows(state, slopes)
        tau, stride_time = (part.sum(axis=1) for part in self._chain.timing(state, slopes))
        factor = weight * share * period
        power = self.power(state)
        by_coordinate = self._by_span @ length
        time = np.empty((num, 4))
        time[:, 0] = factor * stride_time + weight * share * power
        time[:, 1:] = (
            (weight * period * power)[:, None] * self.formulation.repeats * state.points.weights
        )
        time[:, 2] += factor * tau * (1.0 - state.points.shares)
        time[:, 3] += factor * tau * state.points.shares
        step = np.repeat((-factor * power / state.stride_length)[:, None], 2, axis=1)
        windows = np.concatenate([by_coordinate.reshape(num, -1), force.reshape(num, -1)], axis=1)
        return np.concatenate([factor[:, None] * windows, time, step], axis=1)


class Deviation(LocalCost):
    """w_J J_dev."""

    kind = "deviation"

    def __init__(self, formulation: Formulation, points: ControlPoints):
        super().__init__(formulation, points)
        reference = formulation.reference
        self.coordinate_weight = reference.coordinate_weight / reference.coordinate_sigma**2
        sigma = np.where(reference.force_weight > 0.0, reference.force_sigma, 1.0)
        self.force_weight = reference.force_weight / sigma**2
        masks = no_dependence(1, points.layout)
        masks["coordinates"][:] = True
        for foot in range(2):
            for axis in range(3):
                if self.force_weight[foot, axis] > 0.0:
                    rows = foot * feet.ROWS_PER_FOOT + np.array([axis, axis + 3])
                    masks["multipliers"][0, rows] = True
        masks["time"][:] = True
        pattern = Pattern(**masks)
        if not formulation.lifted:
            pattern = pattern.with_projected_multipliers()
        self.columns = np.nonzero(pattern.local(points.layout)[0])[0]

    def rate(self, state: LocalState) -> np.ndarray:
        """D, the integrand of (11), at each control point (num,)."""
        motion, force = state.deviation
        return (motion**2 @ self.coordinate_weight) + np.einsum(
            "pfa,fa->p", force**2, self.force_weight
        )

    def values(self, state: LocalState) -> np.ndarray:
        weight = self.formulation.deviation_weight
        return weight * state.share_of_cycle * state.stride_time[:, 0] * self.rate(state)

    def gradient(self, state: LocalState) -> np.ndarray:
        weight, num = self.formulation.deviation_weight, state.points.num
        motion, force = state.deviation
        motion_slope, force_slope = state.deviation_slope
        by_motion = 2.0 * motion * self.coordinate_weight
        by_force = 2.0 * force * self.force_weight
        tau = (by_motion * motion_slope).sum(axis=1) + (by_force * force_slope).sum(axis=(1, 2))
        both_points = np.zeros((num, 2, feet.ROWS_PER_FOOT))
        both_points[:, :, 0:3] = both_points[:, :, 3:6] = by_force
        multipliers = both_points.reshape(num, -1) * state.points.loaded[:, : feet.NUM_ROWS]
        share, period = state.share_of_cycle, state.stride_time[:, 0]
        factor = weight * share * period
        rate = self.rate(state)
        partials = Partials(
            q=(factor[:, None] * by_motion)[:, None],
            multipliers=(factor[:, None] * multipliers)[:, None],
            tau=(factor * tau)[:, None],
            stride_time=(weight * share * rate)[:, None],
            events=(
                (weight * period * rate)[:, None]
                * self.formulation.repeats
                * state.points.weights
            )[:, None],
        )
        return chain(state, partials, 1, advance=False)[:, 0, self.columns]
