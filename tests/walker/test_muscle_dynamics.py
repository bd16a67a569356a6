"""Contraction and activation: inverted, differentiated, and integrated forward again."""

import pickle

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from drakegait.errors import InvalidInput
from drakegait.walker.metabolics import EnergySettings
from drakegait.walker.muscle_dynamics import MuscleFunctions, MuscleSettings
from drakegait.walker.muscles import MuscleSet
from muscle_cases import fibre_inputs, random_inputs

SPATIAL = MuscleSet.load("spatial")
PLANAR = MuscleSet.load("planar", planar_set="gait2d")
FUNCTIONS = MuscleFunctions(SPATIAL)
STEP = 1e-6

VARIANTS = {
    "default": ({}, {}),
    "constant_angle": ({"pennation_model": "constant_angle"}, {}),
    "parallel_element": ({"parallel_element": "quadratic"}, {"model": "umberger2010"}),
    "full_width": ({"width": "full"}, {"heat_floor": "activation"}),
    "printed": ({"force_length": "printed"}, {"forbid_negative_power": True}),
    "ft_dependent": ({"force_velocity": "ft_dependent"}, {"fast_speed": "hill"}),
    "slope_factor": ({"slope_factor": 2.0}, {"recruitment": "orderly"}),
    "fixed_times": ({"time_constants": "fixed"}, {"aerobic_scaling": 1.0}),
}


def variant(name: str, muscles: MuscleSet = SPATIAL) -> MuscleFunctions:
    settings, energy = VARIANTS[name]
    return MuscleFunctions(muscles, MuscleSettings(**settings), EnergySettings(**energy))


def steps(muscles: MuscleSet) -> np.ndarray:
    """Sizes (num_muscles, 6) for finite differences in the six inputs."""
    f, length = muscles.f_max[:, None], muscles.l_opt[:, None]
    return np.hstack([f * [1, 10, 100], length * [1, 10, 100]])


def away_from_rest(functions: MuscleFunctions, z: np.ndarray) -> np.ndarray:
    """Mask (num_instants, num_muscles) of states whose second derivatives do not jump nearby."""
    states = functions.states(z)
    velocity = states["fiber_velocity"] / functions.muscles.l_opt
    return (abs(velocity) > 0.01) & (abs(states["normalized_fiber_length"] - 1.0) > 1e-3)


@pytest.mark.parametrize("name", VARIANTS)
@pytest.mark.parametrize("smoothing", [1.0, 20.0])
def test_derivatives_agree_with_differences(name, smoothing):
    functions = variant(name)
    z = random_inputs(SPATIAL, 12)
    usable = away_from_rest(functions, z)
    assert usable.mean() > 0.9
    values, jacobian = functions.evaluate_with_jacobian(z, smoothing)
    assert values == pytest.approx(functions.evaluate(z, smoothing), rel=1e-12)
    weights = np.random.default_rng(3).normal(size=values.shape)
    hessian = functions.hessian(z, weights, smoothing)
    assert hessian == pytest.approx(np.swapaxes(hessian, -1, -2), rel=1e-8, abs=1e-300)
    size = steps(SPATIAL)
    for k in range(6):
        h = np.zeros((28, 6))
        h[:, k] = STEP * size[:, k]
        (up, up_jac), (down, down_jac) = (
            functions.evaluate_with_jacobian(z + sign * h, smoothing) for sign in (1, -1)
        )
        slope = (up - down) / (2 * STEP * size[:, k, None])
        scale = np.abs(jacobian * size[:, None]).max(axis=-1) + np.abs(values)
        error = np.abs(slope - jacobian[..., k]) * size[:, k, None] / scale
        assert error[usable].max() < 1e-4
        bend = np.einsum("nmij,nmi->nmj", (up_jac - down_jac) / (2 * STEP * size[:, None, k, None]), weights)
        scaled = np.abs(hessian * size[..., None] * size[:, None, :])
        error = np.abs(bend - hessian[..., k]) * size * size[:, k, None]
        assert (error.max(axis=-1) / scaled.max(axis=(-1, -2)))[usable].max() < 2e-4


def test_one_instant_and_many_agree():
    """Small and large batches take different roads."""
    z = random_inputs(SPATIAL, 80)
    weights = np.random.default_rng(4).normal(size=(80, 28, 3))
    values, jacobian = FUNCTIONS.evaluate_with_jacobian(z)
    hessian = FUNCTIONS.hessian(z, weights)
    for i in (0, 41, 79):
        one, one_jacobian = FUNCTIONS.evaluate_with_jacobian(z[i])
        assert one == pytest.approx(values[i], rel=1e-11)
        assert one_jacobian == pytest.approx(jacobian[i], rel=1e-9, abs=1e-12)
        scale = np.abs(hessian[i]).max(axis=(-1, -2), keepdims=True)
        error = np.abs(FUNCTIONS.hessian(z[i], weights[i]) - hessian[i]) / scale
        assert error.max() < 1e-10
    folded = FUNCTIONS.evaluate(z.reshape(8, 10, 28, 6))
    assert folded.shape == (8, 10, 28, 3)
    assert folded.reshape(80, 28, 3) == pytest.approx(values, rel=1e-11)


def test_results_are_not_overwritten_by_the_next_call():
    z = random_inputs(SPATIAL, 3)
    first = FUNCTIONS.evaluate(z)
    kept = first.copy()
    FUNCTIONS.evaluate(2 * z)
    assert (first == kept).all()


def test_inputs_may_be_views_and_single_instants():
    z = random_inputs(SPATIAL, 4)
    turned = np.asfortranarray(z)
    assert FUNCTIONS.evaluate(turned[::2]) == pytest.approx(FUNCTIONS.evaluate(z[::2].copy()))
    assert FUNCTIONS.evaluate(z[0]).shape == (28, 3)
    assert FUNCTIONS.evaluate(z[:0]).shape == (0, 28, 3)
    with pytest.raises(InvalidInput, match="28, 6"):
        FUNCTIONS.evaluate(z[:, :5])


@pytest.mark.parametrize(
    ("velocity", "g"),
    [(-10, 0.072), (-5, 0.309), (-2, 0.608), (-1, 0.773), (0, 1), (1, 1.176), (2, 1.260), (5, 1.365)],
)
def test_tabulated_force_velocity(velocity, g):
    states = FUNCTIONS.states(fibre_inputs(SPATIAL, 1.0, velocity, 0.3))
    assert states["force_velocity"] == pytest.approx(g, abs=6e-4)
    assert states["activation"] == pytest.approx(0.3 / states["force_velocity"])
    assert states["normalized_fiber_length"] == pytest.approx(1.0)
    assert states["fiber_velocity"] == pytest.approx(velocity * SPATIAL.l_opt)


def test_slope_factor_is_the_ratio_of_slopes_at_rest():
    for factor in (1.0, 2.0):
        functions = MuscleFunctions(SPATIAL, MuscleSettings(slope_factor=factor))
        g = [
            functions.states(fibre_inputs(SPATIAL, 1.1, v, 0.3))["force_velocity"]
            for v in (-1e-5, 0.0, 1e-5)
        ]
        assert (g[2] - g[1]) / (g[1] - g[0]) == pytest.approx(factor, rel=1e-4)


def test_quiet_standing_needs_5_percent_of_soleus():
    """5 degrees of dorsiflexion, 155 N: l~ = 0.72, F = 0.92, a = 0.05."""
    q = np.zeros(16)
    q[10] = -np.deg2rad(5.0)
    z = np.zeros((28, 6))
    z[:, 0], z[:, 3] = 155.0, SPATIAL.lengths(q)
    states = FUNCTIONS.states(z)
    assert states["normalized_fiber_length"][0] == pytest.approx(0.72, abs=0.01)
    assert states["force_length"][0] == pytest.approx(0.92, abs=0.01)
    assert states["activation"][0] == pytest.approx(0.05, abs=0.01)


def test_half_width_and_corrected_ratio_of_the_force_length_curve():
    def top(length, **settings):
        functions = MuscleFunctions(SPATIAL, MuscleSettings(**settings))
        return functions.states(fibre_inputs(SPATIAL, length, 0.0, 0.1))["force_length"][6]

    half_width = 0.56  # tensor fasciae latae
    assert top(0.7) == pytest.approx(1 - (0.3 / half_width) ** 2)
    assert top(0.8, width="full") == pytest.approx(1 - (0.4 / half_width) ** 2)
    assert top(0.8, force_length="printed") == pytest.approx(1 - (0.25 / half_width) ** 2)
    assert top(0.42) == pytest.approx(0.02)


def test_time_constants():
    fast = np.array([0.20, 0.25, 0.45, 0.53, 0.55, 0.30, 0.50, 0.35])
    t_a, t_d = MuscleSettings().activation_times(fast)
    assert 1e3 * t_a == pytest.approx([70.6, 68.25, 58.85, 55.09, 54.15, 65.9, 56.5, 63.55])
    assert 1e3 * t_d == pytest.approx([78.8, 76.0, 64.8, 60.32, 59.2, 73.2, 62.0, 70.4])
    t_a, t_d = MuscleSettings(time_constants="fixed").activation_times(fast)
    assert (t_a == 0.050).all()
    assert (t_d == 0.065).all()
    for t_d in (0.090, 0.045):
        with pytest.raises(InvalidInput, match="time_deactivation"):
            MuscleSettings(time_constants="fixed", time_activation=0.045 + 1e-4, time_deactivation=t_d * 1.01 if t_d > 0.05 else t_d)


def test_constant_force_at_rest_needs_excitation_equal_to_activation():
    states = FUNCTIONS.states(fibre_inputs(SPATIAL, 0.9, 0.0, 0.25))
    assert states["activation_rate"] == pytest.approx(0.0, abs=1e-12)
    assert states["excitation"] == pytest.approx(states["activation"])


@pytest.mark.parametrize("settings", [{}, {"time_constants": "fixed"}, dict(
    time_constants="fixed", time_activation=0.05, time_deactivation=0.05)])
def test_bounds_say_that_excitation_is_between_0_and_1(settings):
    functions = MuscleFunctions(SPATIAL, MuscleSettings(**settings))
    z = random_inputs(SPATIAL, 200, seed=5)
    z[..., [1, 2, 4, 5]] *= 0.2
    states = functions.states(z)
    a, a1, u = (states[k] for k in ("activation", "activation_rate", "excitation"))
    t_a, t_d = functions.settings.activation_times(SPATIAL.fast_twitch)
    t2 = 1 / t_d
    t1 = 1 / t_a - t2
    possible = a <= 1
    assert 0.2 < possible.mean()
    low, high, _ = np.moveaxis(functions.evaluate(z), -1, 0)
    clear = possible & (abs(low) > 0.02) & (abs(high) > 0.02)
    assert ((u > 0) == (low > 0))[clear].all()
    assert ((u < 1) == (high < 0))[clear].all()
    assert ((u > 0) & (u < 1))[clear].any()
    real = (u > -1) & possible
    assert ((u - a) * (t1 * u + t2))[real] == pytest.approx(a1[real], rel=1e-5, abs=1e-5)


def test_smooth_functions_tend_to_the_exact_states():
    z = random_inputs(SPATIAL, 50, seed=6)
    power = FUNCTIONS.states(z)["power"]
    error = [np.abs(FUNCTIONS.evaluate(z, s)[..., 2] - power).max() for s in (1.0, 0.1, 1e-3)]
    assert error[0] > 3 * error[1] > 9 * error[2]
    assert error[2] < 1e-3 * np.abs(power).max()


@pytest.mark.parametrize("muscles", [SPATIAL, PLANAR], ids=["spatial", "gait2d"])
@pytest.mark.parametrize("name", VARIANTS)
def test_wild_iterates_stay_finite(muscles, name):
    functions = variant(name, muscles)
    rng = np.random.default_rng(7)
    z = random_inputs(muscles, 60, seed=8)
    z *= 10.0 ** rng.uniform(-3, 3, z.shape) * rng.choice([1, 1, -1], z.shape)
    z[:5] = 0.0
    z[5:10, :, 3] = 0.0
    z[10:15, :, 0] = -muscles.f_max
    for smoothing in (1.0, 30.0):
        values, jacobian = functions.evaluate_with_jacobian(z, smoothing)
        hessian = functions.hessian(z, np.ones_like(values), smoothing)
        assert all(np.isfinite(x).all() for x in (values, jacobian, hessian))
    with np.errstate(all="raise", under="ignore"):
        assert all(np.isfinite(x).all() for x in functions.states(z).values())


def test_survives_pickling():
    z = random_inputs(SPATIAL, 2)
    FUNCTIONS.evaluate(z)
    again = pickle.loads(pickle.dumps(FUNCTIONS))
    assert (again.evaluate(z) == FUNCTIONS.evaluate(z)).all()


class Motion:
    """Smooth periodic force and path of every muscle, with exact derivatives."""

    def __init__(self, muscles: MuscleSet):
        rng = np.random.default_rng(9)
        n = muscles.num_muscles
        self.muscles, self.phase = muscles, rng.uniform(0, 2 * np.pi, (2, n))
        middle = fibre_inputs(muscles, 0.85, 0.0, 0.2)
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


@pytest.mark.parametrize("name", VARIANTS)
def test_activation_rate_is_the_derivative_of_activation(name):
    functions, motion = variant(name), Motion(SPATIAL)
    h = 1e-5
    for t in (0.1, 0.37, 0.81):
        up, down = (functions.states(motion.inputs(t + s * h))["activation"] for s in (1, -1))
        rate = functions.states(motion.inputs(t))["activation_rate"]
        scale = np.abs(rate).max()
        assert np.abs((up - down) / (2 * h) - rate).max() < 1e-4 * scale


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


def test_largest_force_of_a_posture_is_where_activation_is_1():
    z = fibre_inputs(SPATIAL, 0.8, 0.0, 0.1)

    def surplus(x):
        state = z.copy()
        state[:, 0] = x * SPATIAL.f_max
        return FUNCTIONS.states(state)["activation"][3] - 1

    x = brentq(surplus, 0.01, 1.2)
    state = z.copy()
    state[:, 0] = x * SPATIAL.f_max
    states = FUNCTIONS.states(state)
    cosine = np.sqrt(1 - (np.sin(SPATIAL.pennation) / states["normalized_fiber_length"]) ** 2)
    assert x / cosine[3] == pytest.approx(states["force_length"][3])
