"""From tendon force and path to activation: one muscle's equations, inverted.

Written once for two backends: `math` is `casadi` or `Corners` (symbols, for derivatives) or
`numpy` (arrays, for the exact states of a finished gait). Lengths are in units of the
optimal fibre length, forces in units of the maximal force, times in s; fibres
that shorten have negative velocity.

Every positive part or floor has a width, so that the equations have two
derivatives and stay finite for the wildest iterate of an optimiser; width 0 is
the exact law.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from drakegait.walker.corners import TINY, noted, positive_part

if TYPE_CHECKING:
    from drakegait.walker.muscle_settings import MuscleSettings

FORCE_LENGTH_FLOOR = 0.02
FORCE_LENGTH_FLOOR_WIDTH = 0.02
FORCE_VELOCITY_FLOOR_WIDTH = 0.005
# Shortest projection of the fibres on the tendon, far below any length in walking.
PROJECTION_FLOOR = 0.02
PROJECTION_FLOOR_WIDTH = 0.005
EXCITATION_ROOT_WIDTH = 1e-3
# Velocity [1/s] over which shortening turns into lengthening. There the curvature of force-velocity
# jumps, hence the slope of the excitation; an optimum in that corner is one at which no Newton
# step ends. With this width the muscle's force changes by less than 3e-4 of the isometric one.
TURNING_WIDTH = 0.1


@dataclass(frozen=True)
class MuscleConstants:
    """Constants of one muscle (symbols or numbers) or of all (arrays), in scaled form."""

    inverse_f_max: Any  # [1/N]
    inverse_l_opt: Any  # [1/m]
    slack: Any  # tendon slack length / l_opt
    thickness: Any  # sin of the pennation angle: height of the muscle belly / l_opt
    cosine: Any  # cos of the pennation angle
    curvature: Any  # c = -1 / (half width)^2 of the force-length parabola
    a_rel: Any
    b_rel: Any  # [1/s]
    parallel_start: Any  # length / l_opt at which a parallel element starts to pull
    time_deactivation: Any  # [s]
    time_activation: Any  # [s]
    fast_twitch: Any
    fast_speed: Any  # largest shortening speed of fast-twitch fibres [l_opt/s]
    mass: Any  # [kg]


@dataclass(frozen=True)
class Contraction:
    """What the fibres do: lengths / l_opt, forces / f_max."""

    length: Any
    velocity: Any  # [1/s]
    force: Any  # of the contractile element
    force_length: Any  # F, with its floor
    force_length_top: float | Any  # the value that F (with its floor) has at optimal length
    force_velocity: Any  # g, with its floor
    activation: Any
    activation_rate: Any  # [1/s]


def _positive_part_and_slope(math: Any, x: Any, width: Any) -> tuple[Any, Any, Any]:
    """Positive part, its slope and its root sqrt(x^2 + width^2)."""
    root = math.sqrt(x * x + (width * width + TINY))
    return 0.5 * (x + root), 0.5 + 0.5 * x / root, root


def tendon_stretch(
    math: Any, settings: MuscleSettings, x: Any, x1: Any, x2: Any
) -> tuple[Any, Any, Any]:
    """Tendon strain and its two time derivatives from x = f / f_max, x', x''.

    The parabola f = f_max (strain / eps0)^2 with its singular inverse rounded at x = 0:
    strain = eps0 S(x), S = (sqrt(x + d^2) - d) / (sqrt(1 + d^2) - d). Below x = 0, where no
    tendon can be, S goes on with its second derivative for d^2 and then as a straight line.
    """
    d = settings.tendon_rounding
    scale = settings.tendon_strain / ((1.0 + d * d) ** 0.5 - d)
    pulled = math.fmax(x, 0.0)
    below = x - pulled
    parabola = math.fmax(below, -d * d)
    root = math.sqrt(pulled + d * d)
    slope0 = 0.5 * scale / root
    bend0 = -0.5 * slope0 / (root * root)
    strain = scale * (root - d) + slope0 * below + bend0 * parabola * (below - 0.5 * parabola)
    slope = slope0 + bend0 * parabola
    bend = bend0 * (x > -d * d)
    return strain, slope * x1, bend * x1 * x1 + slope * x2


def contract(
    math: Any, muscle: MuscleConstants, settings: MuscleSettings, z: Any, smoothing: Any
) -> Contraction:
    """Activation and its rate from z = (f, f', f'', l, l', l'') of one muscle.

    f is the tendon force [N], l the path length [m]. Source: Garcia-Vallejo & Schiehlen 2012,
    appendix B, solved for the activation; tendon and pennation as in Nagano & Gerritsen 2001.

    Args:
        z: six symbols or six arrays that broadcast with the constants.
        smoothing: factor on widths of floors, counted up to 1; 0 for the exact law.
    """
    guard = math.fmin(smoothing, 1.0)
    x, x1, x2 = (muscle.inverse_f_max * z[k] for k in range(3))
    strain, strain1, strain2 = tendon_stretch(math, settings, x, x1, x2)
    p = muscle.inverse_l_opt * z[3] - muscle.slack * (1.0 + strain)
    p1 = muscle.inverse_l_opt * z[4] - muscle.slack * strain1
    p2 = muscle.inverse_l_opt * z[5] - muscle.slack * strain2

    width = PROJECTION_FLOOR_WIDTH * guard
    above, slope, root = _positive_part_and_slope(math, p - PROJECTION_FLOOR, width)
    p2 = slope * p2 + 0.5 * (width * width) / (root * root * root) * p1 * p1
    p, p1 = PROJECTION_FLOOR + above, slope * p1

    if settings.pennation_model == "fixed_thickness":
        length = math.sqrt(p * p + muscle.thickness * muscle.thickness)
        cosine = p / length
        sine = muscle.thickness / length
        turn = sine * sine * p1  # sin^2 p'
        velocity = cosine * p1
        acceleration = cosine * p2 + turn * p1 / length
        force = x / cosine
        force1 = (x1 - x * turn / p) / cosine
    else:
        length, velocity, acceleration = p / muscle.cosine, p1 / muscle.cosine, p2 / muscle.cosine
        force, force1 = x / muscle.cosine, x1 / muscle.cosine

    if settings.parallel_element == "quadratic":
        # f_pe = (f_max / l_opt^2) (l_ce - s l_opt)^2 beyond s l_opt (Ackermann & van den Bogert).
        beyond = math.fmax(length - muscle.parallel_start, 0.0)
        force, force1 = force - beyond * beyond, force1 - 2.0 * beyond * velocity

    isometric, isometric1, top = _force_length(math, muscle, settings, length, velocity, guard)
    g, g1 = _force_velocity(
        math, muscle, settings, isometric, isometric1, velocity, acceleration, guard
    )
    activation = force / g
    return Contraction(
        length=length,
        velocity=velocity,
        force=force,
        force_length=isometric,
        force_length_top=top,
        force_velocity=g,
        activation=activation,
        activation_rate=(force1 - activation * g1) / g,
    )


def _force_length(
    math: Any, muscle: MuscleConstants, settings: MuscleSettings, length: Any, velocity: Any,
    guard: Any,
) -> tuple[Any, Any, Any]:  # fmt: skip
    """F = 1 + c (ratio - 1)^2 with a floor, its time derivative, and its value at the optimum.

    The ratio is l_ce / l_opt, or l_opt / l_ce as eq. (B.2) was printed.
    """
    if settings.force_length == "corrected":
        offset, offset1 = length - 1.0, velocity
    else:
        offset, offset1 = 1.0 / length - 1.0, -velocity / (length * length)
    parabola = 1.0 + muscle.curvature * offset * offset
    parabola1 = 2.0 * muscle.curvature * offset * offset1
    width = FORCE_LENGTH_FLOOR_WIDTH * guard
    above, slope, _ = _positive_part_and_slope(math, parabola - FORCE_LENGTH_FLOOR, width)
    top = FORCE_LENGTH_FLOOR + positive_part(math, 1.0 - FORCE_LENGTH_FLOOR, width)
    return FORCE_LENGTH_FLOOR + above, slope * parabola1, top


def _force_velocity(
    math: Any, muscle: MuscleConstants, settings: MuscleSettings, F: Any, F1: Any, nu: Any,
    nu1: Any, guard: Any,
) -> tuple[Any, Any]:  # fmt: skip
    """g = f_ce / (a f_max) from Hill's hyperbola and its eccentric branch, and g' [1/s].

    nu <= 0: g = (F B + A nu) / (B - nu);  nu > 0: g = F (K + f_as nu) / (K + nu) with
    K = B F (f_as - 1) / (S_f (F + A)); both written as F plus what velocity adds.
    """
    A, B = muscle.a_rel, muscle.b_rel
    gain = settings.f_asympt - 1.0
    width = TURNING_WIDTH * guard
    root = math.sqrt(nu * nu + (width * width + TINY))
    shift = noted(math, nu, width)
    shortening, lengthening = 0.5 * (nu - root) - shift, 0.5 * (nu + root) + shift
    shortening1 = 0.5 * nu1 * (1.0 - nu / root)
    lengthening1 = nu1 - shortening1

    hill = 1.0 / (B - shortening)
    K = B * gain / settings.slope_factor * F / (F + A)
    K_F = K * A / (F * (F + A))
    pull = 1.0 / (K + lengthening)
    eccentric = gain * lengthening * pull
    g = F + (F + A) * shortening * hill + F * eccentric
    g_F = 1.0 + shortening * hill + eccentric * (1.0 - F * pull * K_F)
    g1 = (
        g_F * F1
        + (F + A) * B * hill * hill * shortening1
        + F * K * gain * pull * pull * lengthening1
    )
    floor = settings.force_velocity_floor
    above, slope, _ = _positive_part_and_slope(math, g - floor, FORCE_VELOCITY_FLOOR_WIDTH * guard)
    return floor + above, slope * g1


def excitation_bounds(
    muscle: MuscleConstants, settings: MuscleSettings, a: Any, a1: Any
) -> tuple[Any, Any]:
    """Two rates [1/s]: u >= 0 where the first is >= 0, u <= 1 where the second is <= 0.

    As u is monotone in a', its bounds are those of a' at u = 0 and at u = 1.
    """
    if settings.activation_dynamics == "printed":
        t1, t2 = _printed_rates(muscle)
        return a * t2 - a1, -a1 - (1.0 - a) * (t2 - t1)
    return a1 + a / muscle.time_deactivation, a1 - (1.0 - a) / muscle.time_activation


def _printed_rates(muscle: MuscleConstants) -> tuple[Any, Any]:
    """t1 and t2 of eq. (C.1) as printed, numbers of s and 1/s taken alike; t1 < 0 < t2 - t1."""
    t2 = 1.0 / muscle.time_deactivation
    return 1.0 / (muscle.time_activation - t2), t2


def excitation(
    math: Any,
    muscle: MuscleConstants,
    activation: Any,
    activation_rate: Any,
    smoothing: Any,
    law: str = "corrected",
) -> Any:
    """Excitation u that makes the activation a change at the rate a'.

    The plus root of a' = (u - a)(t1 u + t2), t2 = 1/t_d, t1 = 1/t_a - 1/t_d (He et al. 1991, as
    in Nagano & Gerritsen 2001, eq. A2), single-valued on 0..1 because t_d <= 2 t_a. The `law`
    `"printed"` is a' = (u - a)(t1 u - t2) with t1 = 1/(t_a - t2), eq. (C.1) to the letter.
    """
    if law == "printed":
        t1, t2 = _printed_rates(muscle)
        sum_, product = t2 + t1 * activation, activation * t2 - activation_rate
        # The root near a; the radicand is that of a' = 0, (t2 - t1 a)^2, plus 4 t1 a'.
        radicand = sum_ * sum_ - 4.0 * t1 * product
        floor = EXCITATION_ROOT_WIDTH * t2 * t2
        return 2.0 * product / (sum_ + math.sqrt(positive_part(math, radicand, floor)))
    # Equal time constants make the law linear; a small quadratic part stands in for none.
    t = math.fmax(muscle.time_deactivation / muscle.time_activation - 1.0, 1e-6)
    width = EXCITATION_ROOT_WIDTH * math.fmin(smoothing, 1.0)
    rise = t * activation + 1.0
    radicand = rise * rise + 4.0 * t * muscle.time_deactivation * activation_rate
    root = math.sqrt(positive_part(math, radicand, width) + 1e-6 * width * width)
    return (t * activation - 1.0 + root) / (2.0 * t)
