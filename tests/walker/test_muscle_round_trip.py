"""Integrated forward in time, what the inversion found gives back what it started from."""

import numpy as np
import pytest
from muscle_cases import VARIANTS, fibre_inputs, variant
from scipy.integrate import solve_ivp

from drakegait.walker.contraction import contract
from drakegait.walker.muscle_dynamics import MuscleFunctions
from drakegait.walker.muscle_settings import MuscleSettings
from drakegait.walker.muscles import MuscleSet

SPATIAL = MuscleSet.load("spatial")
FUNCTIONS = MuscleFunctions(SPATIAL)


class Motion:
    """Smooth periodic force and path of every muscle, with exact derivatives."""

    def __init__(self, muscles: MuscleSet, length: float = 0.85):
        rng = np.random.default_rng(9)
        n = muscles.num_muscles
        self.muscles, self.phase = muscles, rng.uniform(0, 2 * np.pi, (2, n))
        middle = fibre_inputs(muscles, length, 0.0, 0.2)
        self.force, self.length = middle[:, 0], middle[:, 3]

    def inputs(self, t: float) -> np.ndarray:
        w = 2 * np.pi
        z = np.zeros((self.muscles.num_muscles, 6))
        for k in range(3):
            turn = np.pi / 2 * k
            z[:, k] = 0.6 * self.force * w**k * np.sin(w * t + self.phase[0] + turn)
            z[:, 3 + k] = 0.1 * self.muscles.l_opt * w**k * np.sin(w * t + self.phase[1] + turn)
        z[:, 0] += self.force
        z[:, 3] += self.length
        return z


@pytest.mark.parametrize("length", [0.85, 1.45])
@pytest.mark.parametrize("name", VARIANTS)
def test_activation_rate_is_the_derivative_of_activation(name, length):
    functions, motion = variant(name, SPATIAL), Motion(SPATIAL, length)
    h = 1e-5
    for t in (0.1, 0.37, 0.81):
        up, down = (functions.states(motion.inputs(t + s * h))["activation"] for s in (1, -1))
        rate = functions.states(motion.inputs(t))["activation_rate"]
        scale = np.abs(rate).max()
        assert np.abs((up - down) / (2 * h) - rate).max() < 1e-4 * scale


@pytest.mark.parametrize("name", VARIANTS)
@pytest.mark.parametrize("projection", [0.02, 0.3, 1.3])
def test_rates_of_rounded_corners_are_derivatives_too(name, projection):
    """Of what the program sees; 0.02 is the floor on the fibres' projection, at 1.3 they are too
    long to pull."""
    functions = variant(name, SPATIAL)
    motion = Motion(SPATIAL, np.hypot(projection, np.sin(SPATIAL.pennation)))

    def fibres(t: float):
        z = np.moveaxis(motion.inputs(t), -1, 0)
        return contract(np, functions.constants, functions.settings, z, 1.0)

    h = 1e-6
    for t in np.linspace(0.0, 1.0, 40, endpoint=False):
        up, down, here = fibres(t + h), fibres(t - h), fibres(t)
        for value, rate in (("length", "velocity"), ("activation", "activation_rate")):
            found = (getattr(up, value) - getattr(down, value)) / (2 * h)
            wanted = getattr(here, rate)
            assert np.abs(found - wanted).max() < 1e-4 * np.abs(wanted).max()


def test_excitations_found_reproduce_activation_forward_in_time():
    motion = Motion(SPATIAL)
    t_a, t_d = MuscleSettings().activation_times(SPATIAL.fast_twitch)

    def rate(t, a):
        u = FUNCTIONS.states(motion.inputs(t))["excitation"]
        return (u - a) * (u / t_a + (1 - u) / t_d)

    start, end = (FUNCTIONS.states(motion.inputs(t))["activation"] for t in (0.0, 0.4))
    found = solve_ivp(rate, (0.0, 0.4), start, rtol=1e-7, atol=1e-9).y[:, -1]
    assert found == pytest.approx(end, abs=2e-6)


def test_activations_found_reproduce_force_forward_in_time():
    """Hill's equations (B.1), (B.3), (B.4) as printed, integrated for the fibre length."""
    motion, s = Motion(SPATIAL), MuscleSettings()
    thickness = SPATIAL.l_opt * np.sin(SPATIAL.pennation)
    d = s.tendon_rounding

    def tendon_force(fibre, path):
        stretch = (path - np.sqrt(fibre**2 - thickness**2)) / SPATIAL.l_slack - 1
        root = stretch / s.tendon_strain * (np.sqrt(1 + d**2) - d) + d
        return root**2 - d**2  # / f_max

    def velocity(t, fibre):
        z = motion.inputs(t)
        a = FUNCTIONS.states(z)["activation"]
        cosine = np.sqrt(fibre**2 - thickness**2) / fibre
        phi = tendon_force(fibre, z[:, 3]) / cosine / a
        F = 1 - ((fibre / SPATIAL.l_opt - 1) / SPATIAL.width) ** 2
        c2 = -F * s.f_asympt
        c1 = s.b_rel * (F + c2) ** 2 / ((F + s.a_rel) * s.slope_factor)
        concentric = -((F + s.a_rel) * s.b_rel / (phi + s.a_rel) - s.b_rel)
        eccentric = -(c1 / (np.minimum(phi, -c2 - 1e-6) + c2) - c1 / (F + c2))
        return SPATIAL.l_opt * np.where(phi <= F, concentric, eccentric)

    start, end = (FUNCTIONS.states(motion.inputs(t))["fiber_length"] for t in (0.0, 0.2))
    found = solve_ivp(velocity, (0.0, 0.2), start, method="LSODA", rtol=1e-8, atol=1e-11).y[:, -1]
    assert found == pytest.approx(end, abs=1e-7)
    force = tendon_force(found, motion.inputs(0.2)[:, 3]) * SPATIAL.f_max
    assert force == pytest.approx(motion.inputs(0.2)[:, 0], rel=1e-3)
