"""Disorders change what they say and nothing else; impossible ones are refused in a sentence."""

from __future__ import annotations

import dataclasses
import json
import math

import numpy as np
import pytest

from drakegait.errors import DrakegaitError
from drakegait.study import GaitStudy
from drakegait.walker import coordinates
from drakegait.walker import disorders as dis
from drakegait.walker.joint_springs import ROUNDING, JointSpring, JointSprings
from drakegait.walker.subject import AddedMass

ALL = (
    dis.Weakness("soleus", "l", 0.5),
    dis.Contracture("hamstrings", "l", 0.9),
    dis.Spasticity("rectus_femoris", "both", 0.1),
    dis.JointStiffness("ankle", "l", 40.0, -5.0, 0.5),
    dis.LimitedRange("knee", "l", 0.0, 50.0),
    dis.LegLength("thigh", "r", 0.01),
    dis.Prosthesis("r", category=3),
    dis.Orthosis("l", 60.0, 5.0, mass=0.4),
    dis.Asymmetry("step_length", 1.1),
    dis.Pain("foot", "r", 2.0),
)


def planar(*disorders) -> GaitStudy:
    return GaitStudy.planar().with_disorder(*disorders)


def walker(*disorders, model: str = "planar"):
    return GaitStudy(model=model, disorders=disorders).walker


def posture(kind: str, **degrees: float) -> np.ndarray:
    """Plant coordinates of a posture given by anatomical names with side and degrees."""
    q = np.zeros(len(coordinates.names(kind)))
    for name, value in degrees.items():
        q[coordinates.position(kind, name)] = np.radians(value)
    return coordinates.to_plant(kind, q)


def moments(someone, **degrees: float) -> dict[str, float]:
    """Passive moments at rest by name, anatomical sense."""
    kind = someone.skeleton.kind
    q = posture(kind, **degrees)
    forces = coordinates.to_anatomical(kind, someone.passive.forces(q, np.zeros_like(q)))
    return dict(zip(coordinates.names(kind), forces, strict=True))


# Study and file ----------------------------------------------------------------------------


def test_one_of_each_class_is_tried_here():
    assert {item.kind for item in ALL} == set(dis.KINDS)


def test_they_compose_and_survive_json():
    study = planar(*ALL)
    assert study.disorders == ALL
    again = GaitStudy.from_dict(json.loads(json.dumps(study.to_dict())))
    assert again == study and again.disorders == ALL
    np.testing.assert_array_equal(again.walker.muscles.f_max, study.walker.muscles.f_max)
    assert GaitStudy.planar().disorders == ()
    old = {k: v for k, v in GaitStudy.planar().to_dict().items() if k != "disorders"}
    assert GaitStudy.from_dict(old) == GaitStudy.planar()


@pytest.mark.parametrize("item", ALL, ids=lambda item: item.kind)
def test_each_survives_json_and_has_words(item):
    assert dis.from_plain(json.loads(json.dumps(dis.to_plain(item)))) == item
    assert item.describe()
    if not isinstance(item, dis.Asymmetry):
        assert item.mirrored().mirrored() == item
    with pytest.raises(dataclasses.FrozenInstanceError):
        item.kind_ = 1


def test_an_open_range_survives_json():
    item = dis.LimitedRange("knee", "l", high=40.0)
    assert dis.from_plain(json.loads(json.dumps(dis.to_plain(item)))) == item


def test_added_mass_is_a_disorder_like_others():
    study = planar(AddedMass("foot_r", 2.0), dis.Weakness("soleus", "l"))
    assert study.added_masses == (AddedMass("foot_r", 2.0),) and len(study.disorders) == 1


# Refusals ----------------------------------------------------------------------------------

REFUSED = [
    (lambda: dis.Weakness("soleus", "left", 0.5), "side is 'left'"),
    (lambda: dis.Weakness("soleus", "l", 1.5), "strength left .* is 1.5, .* 0.01 to 1"),
    (lambda: dis.Weakness("soleus", "l", math.nan), "is nan"),
    (lambda: dis.Contracture("soleus", "l", 1.2), "fibre length .* is 1.2, .* 0.5 to 1"),
    (lambda: dis.Spasticity("soleus", "l", 1.0), "smallest excitation .* is 1.0, .* 0 to 0.5"),
    (lambda: dis.JointStiffness("elbow", "l", 1.0), "joint is 'elbow'"),
    (lambda: dis.JointStiffness("knee", "l", -1.0), "stiffness of knee_flexion is -1.0"),
    (lambda: dis.LimitedRange("knee", "l", 50.0, 5.0), "low < high"),
    (lambda: dis.LimitedRange("knee", "l"), "closed at one end"),
    (lambda: dis.LegLength("foot", "l", 0.01), "is 'foot', .* thigh, shank"),
    (lambda: dis.LegLength("shank", "l", 0.2), r"0.2, .* -0.08 to 0.08 \[m\]"),
    (lambda: dis.Prosthesis("r", category=10), "category .* is 10, .* 1 .* to 9"),
    (lambda: dis.Prosthesis("r", category=2.5), "category .* is 2.5"),
    (lambda: dis.Prosthesis("r", shank_mass=0.0), "shank mass with a prosthesis is 0.0"),
    (lambda: dis.Orthosis("r", 2000.0), "stiffness of the orthosis is 2000.0"),
    (lambda: dis.Asymmetry("cadence", 1.1), "is 'cadence', .* step_length, stance_time"),
    (lambda: dis.Asymmetry("stance_time", 2.0), "is 2.0, .* 0.8 to 1.25"),
    (lambda: dis.Pain("head", "r"), "where it hurts is 'head'"),
    (lambda: dis.Pain("foot", "r", -1.0), "weight of pain in foot is -1.0"),
    (lambda: planar("weakness"), "disorder is 'weakness'"),
    (lambda: planar(dis.Weakness("SOL", "l"), dis.Weakness("SOL", "both")), "stated once"),
    (lambda: planar(dis.Prosthesis("r"), dis.Prosthesis("both")), "stated once"),
    (lambda: planar(dis.Prosthesis("r"), dis.Orthosis("r", 50.0)), "no prosthesis replaces"),
    (lambda: planar(dis.Prosthesis("r"), dis.Pain("ankle", "both")), "no prosthesis replaces"),
    (lambda: planar(dis.JointStiffness("hip_adduction", "r", 9.0)), "joint of a planar walker"),
    (lambda: planar(dis.Prosthesis("r"), dis.Contracture("GAS", "r")).walker, "no gastrocnemius_r"),
    (lambda: planar(dis.Prosthesis("r"), dis.Spasticity("TA", "both")).walker, "no tibialis"),
    (lambda: planar(dis.Prosthesis("r")).replace(strength={"soleus_r": 0.5}).walker,
     "'soleus_r', .* no soleus_r"),
    (lambda: planar(dis.Prosthesis("both")).replace(muscle_changes={"SOL": {"l0": 0.3}}).walker,
     "'SOL', .* no soleus_r"),
    (lambda: planar(dis.Weakness("solus", "l")).walker, "'solus'.*mean 'soleus'"),
    (lambda: planar(dis.LimitedRange("knee", "l", 0, 20), dis.LimitedRange("knee", "both", 30, 60)),
     "stated once"),
    (lambda: planar(dis.LimitedRange("knee", "l", 0, 20)).with_limit("knee_flexion_l", 0.5),
     "limit of knee_flexion_l .* leaves angles"),
    (lambda: planar(dis.LimitedRange("knee", "l", 150.0)), "150 to inf degrees.*-9 to 115 degrees"),
    (lambda: dis.from_plain({"kind": "limp"}), "kind of disorder is 'limp'"),
    (lambda: dis.from_plain({"kind": "weakness", "force": 1}), "value of weakness is 'force'"),
]  # fmt: skip


@pytest.mark.parametrize(("make", "words"), REFUSED)
def test_what_cannot_be_is_refused_in_a_sentence(make, words):
    with pytest.raises(DrakegaitError, match=words) as error:
        make()
    assert "\n" not in str(error.value)


ONE_SIDED = [item for item in ALL if item.kind != "spasticity"]


@pytest.mark.parametrize("item", ONE_SIDED, ids=lambda item: item.kind)
def test_a_symmetric_model_has_no_one_sided_disorder(item):
    with pytest.raises(DrakegaitError, match="both sides of a symmetric model"):
        GaitStudy.planar_symmetric().with_disorder(item)


def test_a_symmetric_model_has_disorders_of_both_sides():
    study = GaitStudy.planar_symmetric()
    assert study.with_disorder(dis.Prosthesis("both"), dis.Spasticity("VAS", "both", 0.1)).walker
    # With one prosthesis the other leg still has the muscle.
    assert planar(dis.Prosthesis("r")).replace(strength={"SOL": 0.5}).walker
    apart = study.with_disorder(dis.Weakness("SOL", "r", 0.5), dis.Weakness("SOL", "l", 0.5))
    assert len(apart.disorders) == 2
    with pytest.raises(DrakegaitError, match="both sides"):
        study.with_disorder(dis.Weakness("SOL", "r", 0.5), dis.Weakness("SOL", "l", 0.6))


@pytest.mark.parametrize(
    "statement",
    [
        {"added_masses": (AddedMass("foot_r", 2.0),)},
        {"added_masses": (AddedMass("hat", 2.0, (0.0, 0.1, 0.2)),)},
        {"strength": {"soleus_l": 0.5}},
        {"strength": {"soleus_l": 0.5, "soleus_r": 0.6}},
    ],
)
def test_a_symmetric_model_has_no_one_sided_weight_or_strength(statement):
    with pytest.raises(DrakegaitError, match="both sides of a symmetric model"):
        GaitStudy.planar_symmetric(**statement).formulation()
    with pytest.raises(DrakegaitError, match="both sides of a symmetric model"):
        GaitStudy.planar_symmetric().with_limit("knee_flexion_r", high=1.0).formulation()


def test_a_symmetric_model_wears_equal_weights():
    worn = (AddedMass("foot_r", 2.0, (0.1, 0.02, 0.0)), AddedMass("foot_l", 2.0, (0.1, -0.02, 0.0)))
    study = GaitStudy.spatial_symmetric(
        added_masses=(*worn, AddedMass("hat", 3.0)), strength={"SOL": 0.5, "vasti_r": 2.0,
                                                               "vasti_l": 2.0},
    )  # fmt: skip
    limited = study.with_limit("knee_flexion_r", 0.0, 1.2).with_limit("knee_flexion_l", 0.0, 1.2)
    assert limited.formulation().walker.skeleton.total_mass == pytest.approx(82.0)


# Muscles -----------------------------------------------------------------------------------


def test_weakness_scales_one_force_and_what_hangs_on_it():
    normal, weak = walker().muscles, walker(dis.Weakness("soleus", "l", 0.4)).muscles
    i = normal.names.index("soleus_l")
    expected = normal.f_max.copy()
    expected[i] *= 0.4
    np.testing.assert_array_equal(weak.f_max, expected)
    assert weak.mass[i] == pytest.approx(0.4 * normal.mass[i])
    np.testing.assert_array_equal(weak.l_opt, normal.l_opt)
    same = GaitStudy.planar(strength={"soleus_l": 0.4}).walker.muscles
    np.testing.assert_allclose(weak.f_max, same.f_max, rtol=1e-15)


def test_contracture_shortens_fibres_and_tightens_the_path():
    normal, short = walker(), walker(dis.Contracture("gastrocnemius", "l", 0.8))
    i = normal.muscles.names.index("gastrocnemius_l")
    assert short.muscles.l_opt[i] == pytest.approx(0.8 * normal.muscles.l_opt[i])
    assert short.muscles.f_max[i] == normal.muscles.f_max[i]

    def excess(**angles):
        a, b = moments(short, **angles), moments(normal, **angles)
        return {name: a[name] - b[name] for name in a}

    stretched = excess(ankle_dorsiflexion_l=14.0, knee_flexion_l=5.0)
    assert stretched["ankle_dorsiflexion_l"] < -10.0  # into plantarflexion
    ratio = normal.muscles.moment_arms[i]
    where = coordinates.index("planar")
    assert stretched["knee_flexion_l"] / -stretched["ankle_dorsiflexion_l"] == pytest.approx(
        ratio[where["knee_flexion_l"]] / ratio[where["ankle_dorsiflexion_l"]]
    )
    assert stretched["ankle_dorsiflexion_r"] == stretched["hip_flexion_l"] == 0.0
    bent = excess(ankle_dorsiflexion_l=14.0, knee_flexion_l=60.0)
    assert abs(bent["ankle_dorsiflexion_l"]) < 0.6 * abs(stretched["ankle_dorsiflexion_l"])
    slack = excess(ankle_dorsiflexion_l=-25.0, knee_flexion_l=20.0)
    assert abs(slack["ankle_dorsiflexion_l"]) < 1.5


@pytest.mark.parametrize("muscle", ["soleus", "hamstrings", "adductor_magnus", "vasti"])
def test_the_tension_of_a_contracture_is_thelens(muscle):
    """At the normal stretch of 1.2 onsets, and at 1.2 / 0.85 of those that have shortened."""
    item = dis.Contracture(muscle, "r", 0.85)
    muscles = walker(model="spatial").muscles
    i = muscles.names.index(f"{muscle}_r")
    bands = item.bands(muscles)
    # The path at which a healthy muscle is stretched by 1.2: where its own (negative) band has
    # the tension of Thelen's curve plus the constant that cancels in the difference.
    path = (5.0 / 0.6 * 0.2 - bands[1].offset) / bands[1].rate
    tension = sum(band.tension * math.exp(band.offset + band.rate * path) for band in bands)

    def thelen(x):
        return muscles.f_max[i] * math.expm1(5.0 / 0.6 * (x - 1.0)) / math.expm1(5.0)

    assert tension == pytest.approx(thelen(1.2 / 0.85) - thelen(1.2), rel=1e-9)


def test_spasticity_lifts_the_lowest_excitation_only():
    someone = walker(dis.Spasticity("hamstrings", "l", 0.2), dis.Weakness("soleus", "r", 0.5))
    lowest = dict(zip(someone.muscles.names, someone.lowest_excitation, strict=True))
    assert lowest.pop("hamstrings_l") == 0.2
    assert set(lowest.values()) == {0.0}


# Joints ------------------------------------------------------------------------------------


def test_a_stiff_joint_pulls_towards_its_neutral_angle():
    normal, stiff = walker(), walker(dis.JointStiffness("knee", "l", 40.0, 10.0, 2.0))
    for angle in (-5.0, 10.0, 30.0):
        a, b = (moments(w, knee_flexion_l=angle)["knee_flexion_l"] for w in (stiff, normal))
        assert a - b == pytest.approx(-40.0 * math.radians(angle - 10.0), abs=1e-9)
    q, v = np.zeros(9), np.zeros(9)
    row = coordinates.position("planar", "knee_flexion_l")
    v[row] = 1.5
    moving = stiff.passive.forces(q, v) - stiff.passive.forces(q, 0 * v)
    healthy = normal.passive.forces(q, v) - normal.passive.forces(q, 0 * v)
    assert (moving - healthy)[row] == pytest.approx(-3.0)


@pytest.mark.parametrize("joint", ["ankle_dorsiflexion_r", "knee_flexion_l", "hip_adduction_l"])
def test_springs_are_restoring_and_their_derivatives_exact(joint):
    springs = JointSprings("spatial", [JointSpring(joint, 30.0, 90.0, 0.1, 0.7)])
    row = coordinates.position("spatial", joint)
    sign = coordinates.anatomical_signs("spatial")[row]
    q = np.zeros((41, 16))
    angles = np.linspace(-0.4, 0.6, 41)
    q[:, row] = sign * angles
    moment = sign * springs.forces(q)[:, row]
    far = np.abs(angles - 0.1) > 0.2
    expected = np.where(angles > 0.1, -90.0, -30.0) * (angles - 0.1)
    # Far from the neutral angle the rounding leaves a constant of half its width.
    np.testing.assert_allclose(moment[far], expected[far], atol=0.5 * 60.0 * ROUNDING)
    assert np.all(moment * (angles - 0.1) <= 1e-12)
    np.testing.assert_allclose(springs.forces(np.where(np.arange(16) == row, sign * 0.1, 0)), 0.0,
                               atol=1e-12)  # fmt: skip
    h = 1e-5
    step = np.where(np.arange(16) == row, h, 0.0)
    by_q = (springs.forces(q + step) - springs.forces(q - step))[:, row] / (2 * h)
    np.testing.assert_allclose(springs.slopes(q)[:, row], by_q, rtol=1e-7)
    bend = (springs.slopes(q + step) - springs.slopes(q - step))[:, row] / (2 * h)
    np.testing.assert_allclose(springs.bends(q)[:, row], bend, rtol=1e-5, atol=1e-4)
    others = np.delete(springs.forces(q), row, axis=1)
    assert not others.any() and springs.damping[row] == 0.7 and springs.damping.sum() == 0.7


def test_passive_derivatives_with_springs_and_bands():
    someone = walker(*ALL, model="spatial").passive
    random = np.random.default_rng(0)
    q, v = random.uniform(-0.4, 0.4, (5, 16)), random.normal(size=(5, 16))
    weights, h = random.normal(size=(5, 16)), 1e-5
    by_q, by_v = someone.derivatives(q)
    curved = someone.curvature(q, weights)
    for i, way in enumerate(h * np.eye(16)):
        slope = (someone.forces(q + way, v) - someone.forces(q - way, v)) / (2 * h)
        np.testing.assert_allclose(by_q[:, :, i], slope, rtol=1e-6, atol=1e-5)
        slope = (someone.forces(q, v + way) - someone.forces(q, v - way)) / (2 * h)
        np.testing.assert_allclose(by_v[:, i], slope[0], atol=1e-7)
        a, b = (np.einsum("pi,pij->pj", weights, someone.derivatives(q + s * way)[0])
                for s in (1, -1))  # fmt: skip
        np.testing.assert_allclose(curved[:, :, i], (a - b) / (2 * h), rtol=1e-5, atol=1e-3)


def test_an_orthosis_may_be_one_sided_and_weighs_what_it_weighs():
    normal, braced = walker(), walker(dis.Orthosis("l", 100.0, 0.0, 0.0, mass=0.6))

    def extra(angle):
        return (
            moments(braced, ankle_dorsiflexion_l=angle)["ankle_dorsiflexion_l"]
            - moments(normal, ankle_dorsiflexion_l=angle)["ankle_dorsiflexion_l"]
        )

    assert extra(15.0) == pytest.approx(-100.0 * math.radians(15.0), abs=100.0 * 0.5 * ROUNDING)
    assert abs(extra(-20.0)) < 100.0 * 0.6 * ROUNDING
    added = braced.skeleton.total_mass - normal.skeleton.total_mass
    assert added == pytest.approx(0.6)


# Limbs -------------------------------------------------------------------------------------


@pytest.mark.parametrize("model", ["planar", "spatial"])
def test_a_short_shank_lifts_the_foot_and_keeps_the_mass(model):
    normal, short = walker(model=model), walker(dis.LegLength("shank", "l", -0.03), model=model)
    zero = np.zeros(normal.skeleton.num_coordinates)
    lift = short.skeleton.contact_points(zero) - normal.skeleton.contact_points(zero)
    np.testing.assert_allclose(lift[:2], 0.0, atol=1e-15)
    np.testing.assert_allclose(lift[2:], [[0.0, 0.0, 0.03]] * 2, atol=1e-12)
    assert short.skeleton.total_mass == pytest.approx(normal.skeleton.total_mass, rel=1e-15)
    np.testing.assert_array_equal(short.muscles.l0, normal.muscles.l0)
    np.testing.assert_array_equal(short.muscles.moment_arms, normal.muscles.moment_arms)
    # A lighter pendulum: less inertia about the knee.
    row = coordinates.position(model, "knee_flexion_l")
    inertia = [w.skeleton.mass_matrix(zero)[row, row] for w in (normal, short)]
    assert inertia[1] < inertia[0]


def test_a_leg_grown_and_shrunk_again_is_as_before():
    from drakegait.walker.model_file import model_sdf, read_segments
    from drakegait.walker.segment_edits import LengthEdit
    from drakegait.walker.subject import Subject

    there = LengthEdit("thigh_r", 0.05)
    back = LengthEdit("thigh_r", -0.05)
    before = read_segments(model_sdf("spatial", Subject()))
    long = read_segments(model_sdf("spatial", Subject(), edits=[there]))
    after = read_segments(model_sdf("spatial", Subject(), edits=[there, back]))
    assert long["thigh_r"].length == pytest.approx(before["thigh_r"].length + 0.05)
    for name, segment in before.items():
        assert after[name].length == pytest.approx(segment.length, rel=1e-14)
        np.testing.assert_allclose(after[name].inertia, segment.inertia, rtol=1e-12)
        np.testing.assert_allclose(after[name].com, segment.com, rtol=1e-12, atol=1e-15)
    # Radius of gyration: its share of the length stays.
    ratio = long["thigh_r"].inertia[1, 1] / before["thigh_r"].inertia[1, 1]
    assert ratio == pytest.approx((long["thigh_r"].length / before["thigh_r"].length) ** 2)
    assert long["thigh_r"].inertia[2, 2] == pytest.approx(before["thigh_r"].inertia[2, 2])


@pytest.mark.parametrize(("model", "gone"), [("planar", 3), ("spatial", 3)])
def test_a_prosthesis_has_no_muscle_at_the_ankle(model, gone):
    normal, someone = walker(model=model), walker(dis.Prosthesis("r"), model=model)
    lost = set(normal.muscles.names) - set(someone.muscles.names)
    assert lost == {"soleus_r", "gastrocnemius_r", "tibialis_anterior_r"} and len(lost) == gone
    ankle = coordinates.position(model, "ankle_dorsiflexion_r")
    assert not someone.muscles.moment_arms[:, ankle].any()
    # Those that are left are those of the healthy subject.
    for name in someone.muscles.names:
        i, k = normal.muscles.names.index(name), someone.muscles.names.index(name)
        np.testing.assert_array_equal(someone.muscles.moment_arms[k], normal.muscles.moment_arms[i])
        assert someone.muscles.f_max[k] == normal.muscles.f_max[i]
    lighter = normal.skeleton.total_mass - someone.skeleton.total_mass
    assert lighter == pytest.approx(0.35 * 3.4875 + 0.4 * 1.0875)


def test_a_prosthetic_ankle_is_a_spring_and_nothing_else():
    someone = walker(dis.Prosthesis("r", category=4, alignment=2.0))
    for knee in (0.0, 60.0):
        found = moments(someone, ankle_dorsiflexion_r=12.0, knee_flexion_r=knee)
        expected = -290.0 * math.radians(10.0)
        assert found["ankle_dorsiflexion_r"] == pytest.approx(expected, abs=145 * 0.5 * ROUNDING)
    bent = [moments(someone, ankle_dorsiflexion_r=angle)["knee_flexion_r"] for angle in (-20, 20)]
    assert bent[0] == bent[1]  # no gastrocnemius that would couple them
    other = [moments(w, ankle_dorsiflexion_l=12.0, knee_flexion_l=5.0) for w in (walker(), someone)]
    assert other[0]["ankle_dorsiflexion_l"] == other[1]["ankle_dorsiflexion_l"]


def test_categories_rise_and_a_stiffness_of_ones_own_wins():
    stiffness = [dis.Prosthesis("r", category=n).forefoot_stiffness for n in range(1, 10)]
    assert all(np.diff(stiffness) > 0.0) and stiffness[3] == 290.0
    np.testing.assert_allclose(np.array(stiffness[1:]) / stiffness[:-1], 1.12)
    assert dis.Prosthesis("r", category=1, stiffness=500.0).forefoot_stiffness == 500.0


# Mirror ------------------------------------------------------------------------------------


@pytest.mark.parametrize("model", ["planar", "spatial"])
def test_the_mirrored_disorders_make_the_mirrored_walker(model):
    items = [x for x in ALL if not isinstance(x, dis.Asymmetry)]
    one, other = walker(*items, model=model), walker(*(x.mirrored() for x in items), model=model)
    random = np.random.default_rng(2)
    q, v, a = (random.uniform(-0.4, 0.4, (4, one.skeleton.num_coordinates)) for _ in range(3))
    image = [coordinates.mirror(model, x) for x in (q, v, a)]
    for found, expected in (
        (other.skeleton.inverse_dynamics(*image), one.skeleton.inverse_dynamics(q, v, a)),
        (other.passive.forces(*image[:2]), one.passive.forces(q, v)),
    ):
        np.testing.assert_allclose(found, coordinates.mirror(model, expected), atol=1e-9)
    swap = {"r": "l", "l": "r"}
    names = [name[:-1] + swap[name[-1]] for name in one.muscles.names]
    which = [other.muscles.names.index(name) for name in names]
    assert set(names) == set(other.muscles.names)
    np.testing.assert_array_equal(other.muscles.f_max[which], one.muscles.f_max)
    np.testing.assert_array_equal(other.muscles.l_opt[which], one.muscles.l_opt)
    np.testing.assert_array_equal(other.lowest_excitation[which], one.lowest_excitation)
    np.testing.assert_allclose(
        other.muscles.lengths(image[0])[:, which], one.muscles.lengths(q), atol=1e-12
    )


def test_every_number_of_a_disorder_has_a_unit():
    for kind in dis.KINDS.values():
        numbers = {f.name for f in dataclasses.fields(kind) if f.type in ("float", "float | None")}
        assert set(kind.units) == numbers, kind
