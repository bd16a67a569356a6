"""Constants and variants of the muscles' equations that a study may choose."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from drakegait.errors import InvalidInput
from drakegait.settings import Settings, choice, quantity


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
