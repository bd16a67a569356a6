"""Muscle inputs for tests (random as in walking, or built from a fibre state) and options."""

import numpy as np

from drakegait.walker.metabolics import EnergySettings
from drakegait.walker.muscle_dynamics import MuscleFunctions
from drakegait.walker.muscle_settings import MuscleSettings
from drakegait.walker.muscles import MuscleSet

# Each option of the settings at least once.
VARIANTS = {
    "default": ({}, {}),
    "constant_angle": ({"pennation_model": "constant_angle"}, {}),
    "parallel_element": ({"parallel_element": "quadratic"}, {"model": "umberger2010"}),
    "full_width": ({"width": "full"}, {"heat_floor": "activation"}),
    "printed": ({"force_length": "printed"}, {"forbid_negative_power": True}),
    "printed_activation": ({"activation_dynamics": "printed"}, {}),
    "ft_dependent": ({"force_velocity": "ft_dependent"}, {"fast_speed": "hill"}),
    "slope_factor": ({"slope_factor": 2.0}, {"recruitment": "orderly"}),
    "fixed_times": ({"time_constants": "fixed"}, {"aerobic_scaling": 1.0}),
}


def variant(name: str, muscles: MuscleSet) -> MuscleFunctions:
    """Functions with one of the groups of options."""
    settings, energy = VARIANTS[name]
    return MuscleFunctions(muscles, MuscleSettings(**settings), EnergySettings(**energy))


def random_inputs(muscles: MuscleSet, num_instants: int, seed: int = 0) -> np.ndarray:
    """Inputs (num_instants, num_muscles, 6) with forces, lengths and rates as in walking."""
    rng = np.random.default_rng(seed)
    shape = (num_instants, muscles.num_muscles)
    x = rng.uniform(0.002, 0.5, shape)
    thickness = np.sin(muscles.pennation)
    length = np.maximum(rng.uniform(0.6, 1.35, shape), thickness + 0.15)
    z = np.empty(shape + (6,))
    z[..., 0] = x * muscles.f_max
    z[..., 1] = rng.normal(0, 1.0, shape) * muscles.f_max
    z[..., 2] = rng.normal(0, 20.0, shape) * muscles.f_max
    z[..., 3] = tendon_length(muscles, x) + np.sqrt(length**2 - thickness**2) * muscles.l_opt
    z[..., 4] = rng.normal(0, 1.0, shape) * muscles.l_opt
    z[..., 5] = rng.normal(0, 15.0, shape) * muscles.l_opt
    return z


def tendon_length(muscles: MuscleSet, x: np.ndarray) -> np.ndarray:
    """Tendon length at x = f / f_max with the default constants."""
    s = MuscleSettings()
    d = s.tendon_rounding
    stretch = (np.sqrt(x + d**2) - d) / (np.sqrt(1 + d**2) - d)
    return muscles.l_slack * (1 + s.tendon_strain * stretch)


def fibre_inputs(muscles: MuscleSet, length, velocity, force) -> np.ndarray:
    """Steady-force inputs (num_muscles, 6) that give all muscles this normalised fibre state.

    Args:
        length: fibre length / l_opt.
        velocity: [l_opt/s].
        force: along the fibres / f_max.
    """
    thickness = np.sin(muscles.pennation)
    p = np.sqrt(length**2 - thickness**2)
    x = force * p / length
    z = np.zeros((muscles.num_muscles, 6))
    z[:, 0] = x * muscles.f_max
    z[:, 3] = tendon_length(muscles, x) + p * muscles.l_opt
    z[:, 4] = velocity * length / p * muscles.l_opt
    return z
