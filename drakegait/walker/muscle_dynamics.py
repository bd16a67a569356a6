"""Muscles as functions: bounds on excitation and metabolic power from force and path.

Per muscle and instant there are six inputs z = (f, f', f'', l, l', l''), tendon force
[N] and path length [m] with their time derivatives, and three outputs

    a' + a / t_d         >= 0   [1/s]     is u >= 0,
    a' - (1 - a) / t_a   <= 0   [1/s]     is u <= 1,
    E'                          [W]       is what the muscle costs,

with activation a, excitation u and time constants t_a, t_d (a' = (u - a)(t1 u + t2) is
monotone in u, so the two bounds need no root). `contraction` and `metabolics` hold
the equations; here they become compiled functions over all muscles and instants.
"""

from __future__ import annotations

from dataclasses import astuple, fields
from functools import cached_property
from typing import Any

import casadi
import numpy as np

from drakegait.errors import InvalidInput
from drakegait.walker.columnwise import ColumnwiseFunction
from drakegait.walker.contraction import (
    MuscleConstants,
    contract,
    excitation,
    excitation_bounds,
)
from drakegait.walker.corners import Corners, CornerSlopes
from drakegait.walker.metabolics import EnergySettings, energy_rate
from drakegait.walker.muscle_settings import MuscleSettings
from drakegait.walker.muscles import MuscleSet

NUM_INPUTS = 6
NUM_OUTPUTS = 3

# Length / l_opt beyond which a parallel element pulls (Ackermann & van den Bogert 2010).
PARALLEL_START = 1.2
PARALLEL_START_THIGH = 1.4

# One triangle of second derivatives is computed; each place of the matrix in it.
_LOW = np.tril_indices(NUM_INPUTS)
_FROM_LOW = np.zeros((NUM_INPUTS, NUM_INPUTS), dtype=int)
_FROM_LOW[_LOW] = _FROM_LOW.T[_LOW] = np.arange(len(_LOW[0]))


class MuscleFunctions:
    """Excitation bounds and metabolic power of all muscles, with exact derivatives.

    Arrays are (..., num_muscles, ...) with any leading axes (instants). Second derivatives jump
    where fibres pass from shortening to lengthening; all else is smooth. Results are finite for
    any finite input.

    Args:
        muscles: constants of the muscles.
        settings: contraction and activation dynamics.
        energy: metabolic energy rate.
    """

    def __init__(
        self,
        muscles: MuscleSet,
        settings: MuscleSettings | None = None,
        energy: EnergySettings | None = None,
    ):
        self.muscles = muscles
        self.settings = MuscleSettings() if settings is None else settings
        self.energy = EnergySettings() if energy is None else energy
        self.constants = muscle_constants(muscles, self.settings, self.energy)

    def __reduce__(self):
        # Compiled functions cannot be sent to another process; they are quick to make anew.
        return type(self), (self.muscles, self.settings, self.energy)

    def evaluate(self, z: np.ndarray, smoothing: float = 1.0) -> np.ndarray:
        """The three outputs.

        Args:
            z: (..., num_muscles, 6) = f, f', f'', l, l', l''  [N, N/s, N/s^2, m, m/s, m/s^2].
            smoothing: factor on the widths that round the corners of the energy rate.

        Returns:
            (..., num_muscles, 3) = a' + a/t_d [1/s], a' - (1-a)/t_a [1/s], E' [W].
        """
        return self._values(smoothing, self._checked(z))[0]

    def evaluate_with_jacobian(
        self, z: np.ndarray, smoothing: float = 1.0
    ) -> tuple[np.ndarray, np.ndarray]:
        """The three outputs and their derivatives with respect to the six inputs.

        Returns:
            values (..., num_muscles, 3) and derivatives (..., num_muscles, 3, 6).
        """
        values, jacobian = self._derivatives(smoothing, self._checked(z))
        return values, jacobian.reshape(values.shape + (NUM_INPUTS,))

    def hessian(
        self,
        z: np.ndarray,
        weights: np.ndarray,
        smoothing: float = 1.0,
        corners: CornerSlopes | None = None,
    ) -> np.ndarray:
        """Second derivatives of the weighted sum of the three outputs of each muscle.

        Args:
            weights: (..., num_muscles, 3).
            corners: with them, corners curve as it takes to get across them (`walker.corners`),
                and the slopes they have now are noted.

        Returns:
            (..., num_muscles, 6, 6), symmetric.
        """
        z = self._checked(z)
        weights = np.ascontiguousarray(
            np.broadcast_to(weights, z.shape[:-1] + (NUM_OUTPUTS,)), float
        )
        if corners is None:
            (low,) = self._curvatures(smoothing, z, weights)
        elif corners.held is not None:
            low, corners.held = self._crossing(smoothing, z, weights, corners.held)
        else:
            # Whatever is held, the first call finds the arguments; the slopes where they stay are
            # those of the rounded corners.
            held = np.zeros(z.shape[:-1] + (self._crossing.size_in(3),))
            _, held = self._crossing(smoothing, z, weights, held)
            low, corners.held = self._crossing(smoothing, z, weights, held)
        return low.take(_FROM_LOW, axis=-1)

    def states(self, z: np.ndarray) -> dict[str, np.ndarray]:
        """Everything about the muscles by the exact, unsmoothed laws.

        Returns:
            arrays (..., num_muscles): fiber_length [m], fiber_velocity [m/s] (shortening < 0),
            normalized_fiber_length, force_length, force_velocity, activation,
            activation_rate [1/s], excitation, power, heat_activation_maintenance,
            heat_shortening_lengthening and work_rate [W]. Power is the sum of the other three
            except where the floor on heat (or another bound of the energy settings) acts.
        """
        z = self._checked(z)
        constants = self.constants
        fibres = contract(np, constants, self.settings, np.moveaxis(z, -1, 0), 0.0)
        law = self.settings.activation_dynamics
        u = excitation(np, constants, fibres.activation, fibres.activation_rate, 0.0, law)
        rate = energy_rate(np, constants, self.energy, fibres, u, 0.0)
        return {
            "fiber_length": fibres.length * self.muscles.l_opt,
            "fiber_velocity": fibres.velocity * self.muscles.l_opt,
            "normalized_fiber_length": fibres.length,
            "force_length": fibres.force_length,
            "force_velocity": fibres.force_velocity,
            "activation": fibres.activation,
            "activation_rate": fibres.activation_rate,
            "excitation": u,
            "power": constants.mass * rate.total,
            "heat_activation_maintenance": constants.mass * rate.activation_maintenance,
            "heat_shortening_lengthening": constants.mass * rate.shortening_lengthening,
            "work_rate": constants.mass * rate.work,
        }

    def _checked(self, z: np.ndarray) -> np.ndarray:
        z = np.ascontiguousarray(z, dtype=float)
        if z.shape[-2:] != (self.muscles.num_muscles, NUM_INPUTS):
            allowed = f"(..., {self.muscles.num_muscles}, {NUM_INPUTS})"
            raise InvalidInput("shape of the muscle inputs", z.shape, allowed)
        return z

    def _symbols(self, math: Any = casadi) -> tuple[casadi.SX, casadi.SX, casadi.SX]:
        """Symbols of a muscle's constants (smoothing last) and inputs, and its outputs."""
        names = [field.name for field in fields(MuscleConstants)]
        c = casadi.SX.sym("c", len(names) + 1)
        z = casadi.SX.sym("z", NUM_INPUTS)
        muscle = MuscleConstants(*(c[i] for i in range(len(names))))
        smoothing = c[len(names)]
        fibres = contract(math, muscle, self.settings, casadi.vertsplit(z), smoothing)
        a, a1 = fibres.activation, fibres.activation_rate
        u = excitation(math, muscle, a, a1, smoothing, self.settings.activation_dynamics)
        rate = energy_rate(math, muscle, self.energy, fibres, u, smoothing)
        off, full = excitation_bounds(muscle, self.settings, a, a1)
        return c, z, casadi.vertcat(off, full, muscle.mass * rate.total)

    @cached_property
    def _values(self) -> ColumnwiseFunction:
        c, z, outputs = self._symbols()
        return self._compile([c, z], [outputs])

    @cached_property
    def _derivatives(self) -> ColumnwiseFunction:
        c, z, outputs = self._symbols()
        return self._compile([c, z], [outputs, casadi.jacobian(outputs, z).T])

    @cached_property
    def _curvatures(self) -> ColumnwiseFunction:
        c, z, outputs = self._symbols()
        weights = casadi.SX.sym("w", NUM_OUTPUTS)
        hessian, _ = casadi.hessian(casadi.dot(weights, outputs), z)
        return self._compile([c, z, weights], [_low(hessian)])

    @cached_property
    def _crossing(self) -> ColumnwiseFunction:
        corners = Corners()
        c, z, outputs = self._symbols(corners)
        weights = casadi.SX.sym("w", NUM_OUTPUTS)
        hessian, held, holds = corners.hessian(casadi.dot(weights, outputs), z)
        return self._compile([c, z, weights, held], [_low(hessian), holds])

    def _compile(self, inputs: list, outputs: list) -> ColumnwiseFunction:
        outputs = casadi.cse([casadi.densify(output) for output in outputs])
        table = np.column_stack(astuple(self.constants))
        return ColumnwiseFunction(casadi.Function("muscle", inputs, outputs), table)


def _low(matrix: casadi.SX) -> casadi.SX:
    return casadi.vertcat(*(matrix[i, j] for i, j in zip(*_LOW, strict=True)))


def muscle_constants(
    muscles: MuscleSet, settings: MuscleSettings, energy: EnergySettings
) -> MuscleConstants:
    """The muscles' constants (num_muscles,) in the scaled form of the equations."""
    one = np.ones(muscles.num_muscles)
    half_width = muscles.width if settings.width == "half" else 0.5 * muscles.width
    if settings.force_velocity == "constant":
        a_rel, b_rel = settings.a_rel * one, settings.b_rel * one
    else:
        a_rel = 0.1 + 0.4 * muscles.fast_twitch
        b_rel = 12.0 * a_rel
    thigh = np.isin(muscles.abbreviations, ("RF", "VAS"))
    time_activation, time_deactivation = settings.activation_times(muscles.fast_twitch)
    return MuscleConstants(
        inverse_f_max=1.0 / muscles.f_max,
        inverse_l_opt=1.0 / muscles.l_opt,
        slack=muscles.l_slack / muscles.l_opt,
        thickness=np.sin(muscles.pennation),
        cosine=np.cos(muscles.pennation),
        curvature=-1.0 / half_width**2,
        a_rel=a_rel,
        b_rel=b_rel,
        parallel_start=np.where(thigh, PARALLEL_START_THIGH, PARALLEL_START),
        time_deactivation=time_deactivation,
        time_activation=time_activation,
        fast_twitch=muscles.fast_twitch,
        fast_speed=b_rel / a_rel if energy.fast_speed == "hill" else energy.fixed_fast_speed * one,
        mass=muscles.masses(energy.specific_tension, energy.density),
    )
