"""Metabolic power of a muscle (Umberger, Gerritsen & Martin 2003, eqs. 1-18).

    E' = h_AM + h_SL + w_CE      [W per kg of muscle]

heat of activation and maintenance, heat of shortening or lengthening, and work
of the contractile element. Written once for `math` = `casadi` or `numpy`, like
`contraction`; fibres that shorten have negative velocity.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from drakegait.settings import Settings, choice, flag, quantity
from drakegait.walker.contraction import Contraction, MuscleConstants
from drakegait.walker.corners import corner
from drakegait.walker.muscles import DENSITY, SPECIFIC_TENSION

# Umberger et al. 2003: heat of activation and maintenance, and its dependence on length.
ACTIVATION_HEAT_SLOW = 25.0
"""Heat of activation and maintenance of slow-twitch muscle [W/kg]."""
ACTIVATION_HEAT_FAST = 128.0
"""What a fully fast-twitch muscle adds to it [W/kg]."""
ACTIVATION_EXPONENT = 0.6
LENGTH_INDEPENDENT_SHARE = 0.4
"""Share of activation (not maintenance), which does not fall with filament overlap."""
SHORTENING_HEAT_SLOW = 100.0
"""Shortening heat of slow-twitch fibres at their largest speed, also its cap [W/kg]."""
SHORTENING_HEAT_FAST = 153.0
"""Shortening heat of fast-twitch fibres at their largest speed [W/kg]."""
LENGTHENING_FACTOR = {"umberger2003": 4.0, "umberger2010": 0.3}
"""Lengthening heat coefficient relative to that of slow-twitch shortening."""

# Widths that round the corners; wider ones change the optimum (A^0.6 is singular at 0, and the
# many nearly silent muscles make it count).
EXCITATION_WIDTH = 1e-3
ACTIVATION_WIDTH = 2e-4
ACTIVATION_SHIFT = 1e-4
VELOCITY_WIDTH = 0.02  # [1/s]
CAP_WIDTH = 0.1  # [1/s]
HEAT_WIDTH = 0.1  # [W/kg]


@dataclass(frozen=True, kw_only=True)
class EnergySettings(Settings):
    """Constants and variants of the metabolic energy rate."""

    model: str = choice(
        "umberger2003",
        ("umberger2003", "umberger2010"),
        "umberger2010: less heat when lengthening (0.3 for 4) and no negative work",
    )
    aerobic_scaling: float = quantity(
        1.5, "-", 1.0, 1.5, "factor S on all heat: 1.5 aerobic, 1 anaerobic"
    )
    specific_tension: float = quantity(
        SPECIFIC_TENSION, "N/m^2", 1e5, 1e6, "maximal force per area, for the muscle's mass"
    )
    density: float = quantity(DENSITY, "kg/m^3", 900.0, 1200.0, "density of muscle")
    fast_speed: str = choice(
        "fixed",
        ("fixed", "hill"),
        "largest shortening speed of fast-twitch fibres: fixed_fast_speed, or B_rel / A_rel",
    )
    fixed_fast_speed: float = quantity(
        12.0, "l_opt/s", 5.0, 25.0, "largest shortening speed of fast-twitch fibres"
    )
    speed_ratio: float = quantity(
        2.5, "-", 1.5, 4.0, "largest speed of fast- over slow-twitch fibres (2.456 = 0.05^-0.3)"
    )
    heat_floor: str = choice(
        "total",
        ("total", "activation"),
        "least heat applies to all heat after S, or to activation and maintenance before S",
    )
    least_heat: float = quantity(1.0, "W/kg", 0.0, 5.0, "floor on the heat rate")
    recruitment: str = choice(
        "uniform",
        ("uniform", "orderly"),
        "orderly: slow-twitch fibres first, as excitation grows (Bhargava et al. 2004)",
    )
    forbid_negative_power: bool = flag(False, "whether a muscle's power is kept from below 0")
    basal: bool = flag(False, "whether the whole body adds basal_rate to the muscles' power")
    basal_rate: float = quantity(1.2, "W/kg", 0.0, 3.0, "basal power per kg of body mass")

    def basal_power(self, body_mass: float) -> float:
        """Power of the body besides its muscles [W]: 0 unless `basal` is on."""
        return self.basal_rate * body_mass if self.basal else 0.0


@dataclass(frozen=True)
class EnergyRate:
    """Rates per kg of muscle [W/kg]; `total` is bounded as the settings say."""

    activation_maintenance: Any
    shortening_lengthening: Any
    work: Any
    total: Any


def energy_rate(
    math: Any,
    muscle: MuscleConstants,
    settings: EnergySettings,
    fibres: Contraction,
    excitation: Any,
    smoothing: Any,
) -> EnergyRate:
    """Metabolic rate of one muscle (or all) from the state of its fibres.

    The two heats are those of the law itself; the floor on heat enters `total`.

    Args:
        smoothing: factor on the widths that round the corners; 0 for the exact law.
    """
    a, u, nu = fibres.activation, excitation, fibres.velocity
    scaling = settings.aerobic_scaling

    # A: u where it exceeds a, else their mean.
    drive = 0.5 * (u + a + corner(math, u - a, EXCITATION_WIDTH * smoothing))
    drive = corner(math, drive, ACTIVATION_WIDTH * smoothing)
    shift = ACTIVATION_SHIFT * smoothing
    drive_heat = (drive + shift) ** ACTIVATION_EXPONENT - shift**ACTIVATION_EXPONENT

    # Longer than optimal, fewer filaments overlap; C1 since F has its top at the optimum.
    overlap = 1.0 + (fibres.length > 1.0) * (fibres.force_length - fibres.force_length_top)

    fast = _fast_fraction(math, muscle, settings, u, smoothing)
    raw_activation = (ACTIVATION_HEAT_FAST * fast + ACTIVATION_HEAT_SLOW) * drive_heat
    raw_activation = raw_activation * (
        LENGTH_INDEPENDENT_SHARE + (1.0 - LENGTH_INDEPENDENT_SHARE) * overlap
    )
    if settings.heat_floor == "activation":
        raw_activation = _at_least(math, raw_activation, settings.least_heat, smoothing)
    activation_heat = scaling * raw_activation

    slow_speed = muscle.fast_speed / settings.speed_ratio
    alpha_slow = SHORTENING_HEAT_SLOW / slow_speed
    alpha_fast = SHORTENING_HEAT_FAST / muscle.fast_speed
    shortening = corner(math, -nu, VELOCITY_WIDTH * smoothing)
    lengthening = nu + shortening
    capped = slow_speed - corner(math, slow_speed - shortening, CAP_WIDTH * smoothing)
    shortening_heat = alpha_slow * capped * (1.0 - fast) + alpha_fast * shortening * fast
    lengthening_heat = LENGTHENING_FACTOR[settings.model] * alpha_slow * lengthening
    motion_heat = scaling * overlap * drive * (shortening_heat * drive + lengthening_heat)

    work = -(settings.specific_tension / settings.density) * fibres.force * nu
    if settings.model == "umberger2010":
        work = corner(math, work, HEAT_WIDTH * smoothing)
    heat = activation_heat + motion_heat
    if settings.heat_floor == "total":
        heat = _at_least(math, heat, settings.least_heat, smoothing)
    total = heat + work
    if settings.forbid_negative_power:
        total = corner(math, total, HEAT_WIDTH * smoothing)
    return EnergyRate(activation_heat, motion_heat, work, total)


def _at_least(math: Any, heat: Any, least: float, smoothing: Any) -> Any:
    return least + corner(math, heat - least, HEAT_WIDTH * smoothing)


def _fast_fraction(
    math: Any, muscle: MuscleConstants, settings: EnergySettings, u: Any, smoothing: Any
) -> Any:
    """Fraction of fast-twitch fibres among the active ones.

    Orderly recruitment activates slow fibres as sin(pi u / 2), fast ones as 1 - cos(pi u / 2);
    their ratio is tan(pi u / 4), which needs no special case at u = 0.
    """
    if settings.recruitment == "uniform":
        return muscle.fast_twitch
    excited = math.fmin(corner(math, u, EXCITATION_WIDTH * smoothing), 1.0)
    fast = muscle.fast_twitch * math.tan(0.25 * 3.141592653589793 * excited)
    return fast / (1.0 - muscle.fast_twitch + fast)
