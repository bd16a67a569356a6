"""Contraction and activation inverted: tabulated values, derivatives, limits."""

import pickle

import numpy as np
import pytest
from muscle_cases import VARIANTS, fibre_inputs, random_inputs, variant
from scipy.optimize import brentq

from drakegait.errors import InvalidInput
from drakegait.walker.contraction import excitation, excitation_bounds, tendon_stretch
from drakegait.walker.metabolics import EnergySettings
from drakegait.walker.muscle_dynamics import MuscleFunctions, muscle_constants
from drakegait.walker.muscle_settings import MuscleSettings
from drakegait.walker.muscles import MuscleSet

SPATIAL = MuscleSet.load("spatial")
PLANAR = MuscleSet.load("planar", planar_set="gait2d")
FUNCTIONS = MuscleFunctions(SPATIAL)
STEP = 1e-6


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
    functions = variant(name, SPATIAL)
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
        bend = np.einsum(
            "nmij,nmi->nmj", (up_jac - down_jac) / (2 * STEP * size[:, None, k, None]), weights
        )
        scaled = np.abs(hessian * size[..., None] * size[:, None, :])
        error = np.abs(bend - hessian[..., k]) * size * size[:, k, None]
        assert (error.max(axis=-1) / scaled.max(axis=(-1, -2)))[usable].max() < 2e-4


@pytest.mark.parametrize("name", VARIANTS)
def test_one_instant_and_many_agree(name):
    """Few and many columns take different roads; 230 instants make blocks of unequal use."""
    functions, many = variant(name, SPATIAL), 230
    z = random_inputs(SPATIAL, many)
    weights = np.random.default_rng(4).normal(size=(many, 28, 3))
    values, jacobian = functions.evaluate_with_jacobian(z, 2.0)
    hessian = functions.hessian(z, weights, 2.0)
    for i in (0, 41, 77, 229):
        one, one_jacobian = functions.evaluate_with_jacobian(z[i], 2.0)
        assert one == pytest.approx(values[i], rel=1e-9, abs=1e-9)
        scale = np.abs(jacobian[i]).max(axis=-1, keepdims=True)
        assert (np.abs(one_jacobian - jacobian[i]) / scale).max() < 1e-8
        scale = np.abs(hessian[i]).max(axis=(-1, -2), keepdims=True)
        assert (np.abs(functions.hessian(z[i], weights[i], 2.0) - hessian[i]) / scale).max() < 1e-7


def test_smoothing_never_moves_the_bounds_on_excitation():
    """Wider corners make the energy easier, not the muscles weaker or stronger."""
    z = random_inputs(SPATIAL, 80)
    normal, wide = (FUNCTIONS.evaluate(z, s)[..., :2] for s in (1.0, 30.0))
    assert wide == pytest.approx(normal, rel=1e-12)


def test_tendon_goes_on_gently_below_zero_force():
    settings = MuscleSettings()
    x = np.array([-1.0, -2e-3, -5e-4, 0.0, 1.0])
    strain, slope, _ = tendon_stretch(np, settings, x, np.ones(5), np.zeros(5))
    assert strain[3:] == pytest.approx([0.0, settings.tendon_strain])
    assert (np.diff(strain) > 0).all()
    assert slope[0] < 2 * slope[3]
    h = 1e-9
    up, down = (tendon_stretch(np, settings, x + s * h, 1.0, 0.0)[0] for s in (1, -1))
    assert (up - down) / (2 * h) == pytest.approx(slope, rel=1e-5)


def test_any_leading_axes_and_changing_smoothing():
    z = random_inputs(SPATIAL, 80)
    values = FUNCTIONS.evaluate(z)
    wide = FUNCTIONS.evaluate(z, 30.0)
    assert np.abs(wide - values)[..., 2].min() > 0
    assert (FUNCTIONS.evaluate(z) == values).all()
    folded = FUNCTIONS.evaluate(z.reshape(8, 10, 28, 6))
    assert folded.shape == (8, 10, 28, 3)
    assert (folded.reshape(80, 28, 3) == values).all()


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
    [
        (-10, 0.072),
        (-5, 0.309),
        (-2, 0.608),
        (-1, 0.773),
        (0, 1),
        (1, 1.176),
        (2, 1.260),
        (5, 1.365),
    ],
)
def test_tabulated_force_velocity(velocity, g):
    states = FUNCTIONS.states(fibre_inputs(SPATIAL, 1.0, velocity, 0.3))
    assert states["force_velocity"] == pytest.approx(g, abs=6e-4)
    assert states["activation"] == pytest.approx(0.3 / states["force_velocity"])
    assert states["normalized_fiber_length"] == pytest.approx(1.0)
    assert states["fiber_velocity"] == pytest.approx(velocity * SPATIAL.l_opt)


def test_hill_constants_by_fibre_type():
    functions = MuscleFunctions(SPATIAL, MuscleSettings(force_velocity="ft_dependent"))
    g = functions.states(fibre_inputs(SPATIAL, 1.0, -2.0, 0.3))["force_velocity"]
    a_rel = 0.1 + 0.4 * SPATIAL.fast_twitch
    assert g == pytest.approx((12 * a_rel - 2 * a_rel) / (12 * a_rel + 2))


def test_parallel_element_takes_over_part_of_the_force():
    functions = MuscleFunctions(SPATIAL, MuscleSettings(parallel_element="quadratic"))
    states = functions.states(fibre_inputs(SPATIAL, 1.5, 0.0, 0.3))
    active = dict(
        zip(SPATIAL.abbreviations, states["activation"] * states["force_velocity"], strict=True)
    )
    assert active["ILPSO"] == pytest.approx(0.3 - (1.5 - 1.2) ** 2)
    for thigh in ("RF", "VAS"):
        assert active[thigh] == pytest.approx(0.3 - (1.5 - 1.4) ** 2)


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


# Fibre lengths / l_opt over measured level walking, tendon load 0..0.36 (another subject).
WALKING_LENGTHS = {
    "SOL": (0.42, 0.88), "TA": (0.89, 1.24), "GAS": (0.43, 1.40), "VAS": (0.56, 1.05),
    "RF": (0.63, 1.13), "HAMS": (0.53, 1.09), "TFL": (0.75, 1.31), "GMAXL": (0.61, 0.83),
    "GMAXM": (0.69, 0.98), "GMEDA": (0.73, 0.92), "GMEDP": (0.91, 1.23), "ADM": (1.51, 1.81),
    "ADLB": (1.16, 1.36), "ILPSO": (0.72, 1.01),
}  # fmt: skip


def test_fibres_work_in_their_range_while_walking():
    # hip flexion, knee flexion, dorsiflexion [degrees] through the cycle
    postures = [(28, 5, 0), (5, 10, 8), (-15, 8, 12), (-10, 40, -15), (20, 62, 0)]
    for load in (0.0, 0.36):
        for hip, knee, ankle in postures:
            q = np.zeros(16)
            q[[7, 9, 10]] = np.deg2rad([-hip, knee, -ankle])
            z = np.zeros((28, 6))
            z[:, 0], z[:, 3] = load * SPATIAL.f_max, SPATIAL.lengths(q)
            length = FUNCTIONS.states(z)["normalized_fiber_length"][:14]
            for group, value in zip(SPATIAL.abbreviations, length, strict=False):
                low, high = WALKING_LENGTHS[group]
                assert low - 0.1 < value < high + 0.1, (group, hip, knee, ankle, load)


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
    for t_d in (0.091, 0.044):  # more than twice t_a; less than t_a
        with pytest.raises(InvalidInput, match="time_deactivation"):
            MuscleSettings(time_activation=0.045, time_deactivation=t_d)


def test_constant_force_at_rest_needs_excitation_equal_to_activation():
    states = FUNCTIONS.states(fibre_inputs(SPATIAL, 0.9, 0.0, 0.25))
    assert states["activation_rate"] == pytest.approx(0.0, abs=1e-12)
    assert states["excitation"] == pytest.approx(states["activation"])


@pytest.mark.parametrize(
    "settings",
    [
        {},
        {"time_constants": "fixed"},
        dict(time_constants="fixed", time_activation=0.05, time_deactivation=0.05),
    ],
)
def test_bounds_say_that_excitation_is_between_0_and_1(settings):
    functions = MuscleFunctions(SPATIAL, MuscleSettings(**settings))
    z = random_inputs(SPATIAL, 200, seed=5)
    z[..., [1, 2, 4, 5]] *= 0.2
    states = functions.states(z)
    a, a1, u = (states[k] for k in ("activation", "activation_rate", "excitation"))
    t_a, t_d = functions.settings.activation_times(SPATIAL.fast_twitch)
    t2 = 1 / t_d
    t1 = 1 / t_a - t2
    low, high, _ = np.moveaxis(functions.evaluate(z, 1e-4), -1, 0)
    scale = np.abs(a1) + a / t_a + 1
    assert (np.abs(low - (a1 + a / t_d)) / scale).max() < 1e-5
    assert (np.abs(high - (a1 - (1 - a) / t_a)) / scale).max() < 1e-5
    possible = a <= 1
    assert possible.mean() > 0.2
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


# Eq. (C.1) to the letter --------------------------------------------------------------------------


def test_printed_activation_dynamics_are_inverted_as_printed():
    """a' = (u - a)(t1 u - t2), t2 = 1/t_d, t1 = 1/(t_a - t2): s minus 1/s, docs 2.8."""
    muscles = MuscleSet.load("planar")
    settings = MuscleSettings(activation_dynamics="printed")
    constants = muscle_constants(muscles, settings, EnergySettings())
    t2 = 1.0 / constants.time_deactivation
    t1 = 1.0 / (constants.time_activation - t2)
    random = np.random.default_rng(0)
    a, u = random.uniform(0.0, 1.0, (2, 40, muscles.num_muscles))
    rate = (u - a) * (t1 * u - t2)
    np.testing.assert_allclose(excitation(np, constants, a, rate, 0.0, "printed"), u, atol=1e-6)
    inside = excitation_bounds(constants, settings, a, rate)
    assert inside[0].min() > 0.0 > inside[1].max()
    for beyond in (-0.1, 1.1):  # exactly one of the two bounds is broken
        off, full = excitation_bounds(
            constants, settings, a, (beyond - a) * (t1 * beyond - t2)
        )
        assert ((off < 0.0) == (beyond < 0.0)).all()
        assert ((full > 0.0) == (beyond > 1.0)).all()


def test_printed_activation_runs_away_from_excitation():
    """With no excitation it grows: why (C.1) cannot be meant as printed."""
    muscles = MuscleSet.load("planar")
    for law, way in (("corrected", -1.0), ("printed", 1.0)):
        settings = MuscleSettings(activation_dynamics=law)
        constants = muscle_constants(muscles, settings, EnergySettings())
        for rate in (-5.0, 5.0):
            u = excitation(np, constants, np.full(16, 0.5), np.full(16, rate), 0.0, law)
            assert (np.sign(u - 0.5) == -way * np.sign(rate)).all()
