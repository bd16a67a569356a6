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

from dataclasses import astuple, dataclass, fields
from functools import cached_property

import casadi
import numpy as np

from drakegait.errors import InvalidInput
from drakegait.settings import Settings, choice, quantity
from drakegait.walker.columnwise import ColumnwiseFunction
from drakegait.walker.contraction import (
    MuscleConstants,
    contract,
    excitation,
    excitation_bounds,
)
from drakegait.walker.metabolics import EnergySettings, energy_rate
from drakegait.walker.muscles import MuscleSet

NUM_INPUTS = 6
NUM_OUTPUTS = 3

# One triangle of second derivatives is computed; each place of the matrix in it.
_LOW = np.tril_indices(NUM_INPUTS)
_FROM_LOW = np.zeros((NUM_INPUTS, NUM_INPUTS), dtype=int)
_FROM_LOW[_LOW] = _FROM_LOW.T[_LOW] = np.arange(len(_LOW[0]))

# Length / l_opt beyond which a parallel element pulls (Ackermann & van den Bogert 2010).
PARALLEL_START = 1.2
PARALLEL_START_THIGH = 1.4


@dataclass(frozen=True, kw_only=True)
class MuscleSettings(Settings):
    """Constants and variants of contraction and activation dynamics."""

    tendon_strain: float = quantity(0.04, "-", 0.01, 0.12, "tendon strain at maximal force")
    tendon_rounding: float = quantity(
        0.03, "-", 0.002, 0.2, "d: rounds the tendon's infinite compliance at zero force"
    )
    pennation_model: str = choice(
        "fixed_thickness",
        ("fixed_thickness", "constant_angle"),
        "whether the belly's thickness or the pennation angle is constant",
    )
    parallel_element: str = choice(
        "none",
        ("none", "quadratic"),
        "passive force of the fibres; counts twice unless passive joint moments are reduced",
    )
    width: str = choice(
        "half", ("half", "full"), "how to read the table's width of the force-length parabola"
    )
    force_length: str = choice(
        "corrected",
        ("corrected", "printed"),
        "eq. (B.2) with l_ce / l_opt, or with the inverse ratio as printed",
    )
    force_velocity: str = choice(
        "constant",
        ("constant", "ft_dependent"),
        "Hill constants: a_rel and b_rel, or 0.1 + 0.4 FT and 12 times that (Umberger)",
    )
    a_rel: float = quantity(0.41, "-", 0.1, 1.0, "Hill's A_rel")
    b_rel: float = quantity(5.2, "1/s", 1.0, 15.0, "Hill's B_rel")
    f_asympt: float = quantity(1.5, "-", 1.05, 2.0, "largest force in lengthening / isometric")
    slope_factor: float = quantity(
        1.0, "-", 1.0, 3.0, "eccentric over concentric slope of force-velocity at rest"
    )
    force_velocity_floor: float = quantity(
        0.02, "-", 0.005, 0.1, "least force-velocity factor, so that activation stays finite"
    )
    activation_dynamics: str = choice(
        "corrected",
        ("corrected", "printed"),
        "eq. (C.1): (u - a)(t1 u + t2) with t1 = 1/t_a - 1/t_d, or with the signs and the t1 as "
        "printed, under which activation runs away from excitation",
    )
    time_constants: str = choice(
        "ft_formula",
        ("ft_formula", "fixed"),
        "80 - 0.47 %FT and 90 - 0.56 %FT ms (Umberger 2003, eq. 4), or the two values below",
    )
    time_activation: float = quantity(0.050, "s", 0.005, 0.2, "t_a if fixed")
    time_deactivation: float = quantity(0.065, "s", 0.005, 0.4, "t_d if fixed")
    min_force: float = quantity(
        0.0005, "f_max", 0.0, 0.05, "lower bound on muscle force in a gait program"
    )

    def __post_init__(self) -> None:
        super().__post_init__()
        t_a, t_d = self.time_activation, self.time_deactivation
        if not t_a <= t_d <= 2 * t_a:
            # Else one activation rate belongs to two excitations, or to none.
            allowed = f"between time_activation and twice that, {t_a:g} to {2 * t_a:g} [s]"
            raise InvalidInput("time_deactivation", t_d, allowed)

    def activation_times(self, fast_twitch: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Time constants (t_a, t_d) [s] of muscles by their fast-twitch fraction."""
        if self.time_constants == "fixed":
            one = np.ones_like(fast_twitch)
            return self.time_activation * one, self.time_deactivation * one
        return 0.080 - 0.047 * fast_twitch, 0.090 - 0.056 * fast_twitch


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

    def hessian(self, z: np.ndarray, weights: np.ndarray, smoothing: float = 1.0) -> np.ndarray:
        """Second derivatives of the weighted sum of the three outputs of each muscle.

        Args:
            weights: (..., num_muscles, 3).

        Returns:
            (..., num_muscles, 6, 6), symmetric.
        """
        z = self._checked(z)
        weights = np.ascontiguousarray(
            np.broadcast_to(weights, z.shape[:-1] + (NUM_OUTPUTS,)), float
        )
        (low,) = self._curvatures(smoothing, z, weights)
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

    def _symbols(self) -> tuple[casadi.SX, casadi.SX, casadi.SX]:
        """Symbols of a muscle's constants (smoothing last) and inputs, and its outputs."""
        names = [field.name for field in fields(MuscleConstants)]
        c = casadi.SX.sym("c", len(names) + 1)
        z = casadi.SX.sym("z", NUM_INPUTS)
        muscle = MuscleConstants(*(c[i] for i in range(len(names))))
        smoothing = c[len(names)]
        fibres = contract(casadi, muscle, self.settings, casadi.vertsplit(z), smoothing)
        a, a1 = fibres.activation, fibres.activation_rate
        u = excitation(casadi, muscle, a, a1, smoothing, self.settings.activation_dynamics)
        rate = energy_rate(casadi, muscle, self.energy, fibres, u, smoothing)
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
        low = casadi.vertcat(*(hessian[i, j] for i, j in zip(*_LOW, strict=True)))
        return self._compile([c, z, weights], [low])

    def _compile(self, inputs: list, outputs: list) -> ColumnwiseFunction:
        outputs = casadi.cse([casadi.densify(output) for output in outputs])
        table = np.column_stack(astuple(self.constants))
        return ColumnwiseFunction(casadi.Function("muscle", inputs, outputs), table)


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
