"""Constraint: neural excitations between 0 and 1 (item 1 of the paper's section 3.3).

For the activation dynamics a' = (u - a)(t_1 u + t_2) the bounds 0 <= u <= 1
are equivalent to (docs/formulation.md 2.8)

    a' + a/t_d >= 0    and    a' - (1 - a)/t_a <= 0,

which need no square root. Activations follow from the muscle forces and the
motion by inverting the contraction dynamics.

A muscle that cannot be switched off has the lower bound u >= m instead. Since
a' grows with u, it is a' >= (m - a)(t_1 m + t_2), and that is a mean of the two
left-hand sides above,

    (1 - m) [a' + a/t_d] + m [a' - (1 - a)/t_a] >= -m (1 - m) t_1,  t_1 = 1/t_a - 1/t_d.
"""

from __future__ import annotations

import numpy as np

from drakegait.errors import InvalidInput
from drakegait.program.control_points import ControlPoints
from drakegait.program.formulation import Formulation
from drakegait.program.local_rows import LocalRows
from drakegait.program.local_state import LocalState
from drakegait.walker.walker import Walker

_TYPICAL_RATE = 10.0  # [1/s] of activation, about 1/t_d


class MuscleChain:
    """Chain rule from muscle inputs (f, f', f'', l, l', l'') to local variables.

    A muscle sees its own force coefficients and those of the coordinates that
    it spans, through the same three basis rows each.
    """

    def __init__(self, formulation: Formulation):
        self.arms = formulation.walker.muscles.moment_arms
        self.muscle_of_span, self.coordinate_of_span = np.nonzero(self.arms)
        self.arm_of_span = self.arms[self.muscle_of_span, self.coordinate_of_span]

    def windows(self, state: LocalState, slopes: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Derivatives by a coefficient of force and by one of length.

        Args:
            slopes: (num, num_muscles, ..., 6).

        Returns:
            Two arrays (num, num_muscles, ..., width).
        """
        period = state.stride_time[:, :, None]
        rows = state.basis[:3].transpose(1, 0, 2).copy()  # (num, 3, width)
        rows[:, 1] /= period[:, 0]
        rows[:, 2] /= period[:, 0] ** 2
        shape = slopes.shape[:-1]
        flat = slopes.reshape(len(slopes), -1, 6)
        force, length = flat[..., :3] @ rows, flat[..., 3:] @ rows
        return force.reshape(*shape, -1), length.reshape(*shape, -1)

    def timing(self, state: LocalState, slopes: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Derivatives by tau and by the stride time, (num, num_muscles, ...)."""
        extra = (1,) * (slopes.ndim - 3)
        inputs = state.muscle_inputs
        by_tau = state.muscle_inputs_by_tau
        shape = (*inputs.shape[:2], *extra, 6)
        order = np.array([0.0, -1.0, -2.0, 0.0, -1.0, -2.0])
        tau = (slopes * by_tau.reshape(shape)).sum(axis=-1)
        period = state.stride_time.reshape(-1, 1, *extra)
        stride_time = (slopes * (order * inputs).reshape(shape)).sum(axis=-1) / period
        return tau, stride_time


class Excitation(LocalRows):
    """Two rows per muscle, lower and upper bound of its excitation [10 1/s]."""

    kind = "excitation"

    def __init__(self, formulation: Formulation, points: ControlPoints):
        super().__init__(formulation, points)
        names = formulation.walker.muscles.names
        self.row_names = tuple(f"{name} {side}" for name in names for side in ("off", "full"))
        num = len(self.row_names)
        self.scale = np.full(num, _TYPICAL_RATE)
        self.units = ("1/s",) * num
        self.lower = np.where(np.arange(num) % 2 == 0, 0.0, -np.inf)
        self._mixed = bool(formulation.walker.lowest_excitation.any())
        if self._mixed:
            law = formulation.walker.muscle_functions.settings.activation_dynamics
            if law != "corrected":
                allowed = "'corrected' where muscles cannot be switched off"
                raise InvalidInput("activation_dynamics", law, allowed)
            self.lower[::2] = -_lowest_rates(formulation.walker) / _TYPICAL_RATE
        self.upper = np.where(np.arange(num) % 2 == 0, np.inf, 0.0)
        self.applies = np.ones((points.num, num), dtype=bool)
        self._chain = MuscleChain(formulation)
        self.rows, self.columns = self._sparsity(points)

    def _sparsity(self, points: ControlPoints) -> tuple[np.ndarray, np.ndarray]:
        layout, width = points.layout, points.layout.width
        num = layout.num_muscles
        window = np.arange(width)
        two = np.arange(2)
        muscle = np.arange(num)[:, None, None]
        own_rows = 2 * muscle + two[:, None] + 0 * window
        own_columns = layout.forces + muscle * width + 0 * two[:, None] + window
        spans = self._chain.muscle_of_span, self._chain.coordinate_of_span
        span_rows = 2 * spans[0][:, None, None] + two[:, None] + 0 * window
        span_columns = spans[1][:, None, None] * width + 0 * two[:, None] + window
        time_rows = np.repeat(np.arange(2 * num)[:, None], 3, axis=1)
        time_columns = layout.time + np.array([0, 2, 3]) + 0 * time_rows
        rows = (own_rows, span_rows, time_rows)
        columns = (own_columns, span_columns, time_columns)
        return (
            np.concatenate([part.ravel() for part in rows]),
            np.concatenate([part.ravel() for part in columns]),
        )

    def values(self, state: LocalState) -> np.ndarray:
        values = state.muscle_values[..., :2]
        if self._mixed:
            values = _mix(self.formulation.walker, values)
        return values.reshape(state.points.num, -1) / _TYPICAL_RATE

    def jacobian(self, state: LocalState) -> np.ndarray:
        num = state.points.num
        slopes = state.muscles[1][:, :, :2, :] / _TYPICAL_RATE
        slopes = excitation_rows(self.formulation.walker, slopes)
        force, length = self._chain.windows(state, slopes)
        spans = -self._chain.arm_of_span[:, None, None] * length[:, self._chain.muscle_of_span]
        tau, stride_time = self._chain.timing(state, slopes)
        share = state.points.shares[:, None, None]
        time = np.stack([stride_time, tau * (1.0 - share), tau * share], axis=-1)
        return np.concatenate(
            [force.reshape(num, -1), spans.reshape(num, -1), time.reshape(num, -1)], axis=1
        )


def _mix(walker: Walker, values: np.ndarray) -> np.ndarray:
    """The rows (..., num_muscles, 2) with the lower one for u >= m."""
    share = walker.lowest_excitation
    lower = (1.0 - share) * values[..., 0] + share * values[..., 1]
    return np.stack([lower, values[..., 1]], axis=-1)


def excitation_rows(walker: Walker, slopes: np.ndarray) -> np.ndarray:
    """Slopes (num, num_muscles, 2, 6) of the rows from those of the two left-hand sides."""
    if not walker.lowest_excitation.any():
        return slopes
    return np.moveaxis(_mix(walker, np.moveaxis(slopes, 3, 1)), 1, 3)


def _lowest_rates(walker: Walker) -> np.ndarray:
    """m (1 - m) t_1 (num_muscles,) [1/s]."""
    constants, share = walker.muscle_functions.constants, walker.lowest_excitation
    return share * (1.0 - share) * (
        1.0 / constants.time_activation - 1.0 / constants.time_deactivation
    )


def excitation_weights(walker: Walker, weights: np.ndarray) -> np.ndarray:
    """Multipliers of the rows as weights of the two left-hand sides (num, 2 num_muscles)."""
    share = walker.lowest_excitation
    if not share.any():
        return weights
    lower, upper = weights[:, 0::2], weights[:, 1::2]
    mixed = np.stack([(1.0 - share) * lower, share * lower + upper], axis=-1)
    return mixed.reshape(len(weights), -1)
