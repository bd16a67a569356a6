"""The OpenSim model is the walker: masses, paths and passive moments to the last digits."""

from __future__ import annotations

import dataclasses
import math
from xml.etree import ElementTree

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from drakegait.errors import UnknownName
from drakegait.export.bodies import read_parts
from drakegait.export.muscles import active_force, width_scale
from drakegait.export.osim_model import osim_model
from drakegait.program.variants import Variants
from drakegait.study import GaitStudy
from drakegait.walker import coordinates
from drakegait.walker import disorders as dis
from drakegait.walker.coordinates import TO_OPENSIM
from drakegait.walker.joint_springs import JointSpring
from drakegait.walker.passive_joints import PassiveJoints, PassiveSettings

POINT = (0.1, 0.03, -0.05)
STATES = 4


def study(model: str, **statements) -> GaitStudy:
    return GaitStudy(model=model, **statements).with_added_mass("foot_r", 2.0, POINT)


def random_states(walker) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """q, v, a in plant signs and the factor to anatomical signs."""
    rng = np.random.default_rng(3)
    shape = (STATES, len(walker.coordinate_names))
    q, v, a = rng.uniform(-0.6, 0.6, shape), rng.normal(size=shape), rng.normal(size=shape)
    return q, v, a, coordinates.anatomical_signs(walker.skeleton.kind)


def write(folder, walker, **options) -> str:
    (folder / "model.osim").write_text(osim_model(walker, **options), encoding="utf-8")
    return "model.osim"


@pytest.mark.parametrize("model", ["planar", "spatial"])
def test_opensim_moves_as_we_do(model, tmp_path, ask_opensim):
    walker = study(model).walker
    q, v, a, signs = random_states(walker)
    answer = ask_opensim(
        what="postures", model=write(tmp_path, walker), names=walker.coordinate_names,
        q=q * signs, v=v * signs, a=a * signs, muscles=walker.muscles.names,
        ask=["mass_matrix", "paths", "points"],
    )  # fmt: skip
    assert answer["mass"] == pytest.approx(walker.skeleton.total_mass, rel=1e-12)
    mass = walker.skeleton.mass_matrix(q) * signs[:, None] * signs
    np.testing.assert_allclose(answer["mass_matrix"], mass, atol=1e-10)
    lengths = [[length for length, _ in posture] for posture in answer["paths"]]
    np.testing.assert_allclose(lengths, walker.muscles.lengths(q), atol=1e-12)
    arms = np.array([[arms for _, arms in posture] for posture in answer["paths"]])
    wanted = np.broadcast_to(walker.muscles.moment_arms * signs, arms.shape)
    np.testing.assert_allclose(arms, wanted, atol=1e-12)
    points = walker.skeleton.contact_points(q) @ TO_OPENSIM.T
    np.testing.assert_allclose(answer["points"], points, atol=1e-12)


@pytest.mark.parametrize("model", ["planar", "spatial"])
@pytest.mark.parametrize("passive", ["riener_edrich", "double_exponential"])
def test_weight_and_passive_moments_are_ours(model, passive, tmp_path, ask_opensim):
    settings = PassiveSettings(model=passive, damping_ankle=0.3)
    walker = study(model, passive=settings).walker
    q, v, a, signs = random_states(walker)
    q[0] *= 2.5  # far enough for exponentials to go on as their tangents
    answer = ask_opensim(
        what="postures", model=write(tmp_path, walker, muscles="none"), ask=["forces"],
        names=walker.coordinate_names, q=q * signs, v=v * signs, a=a * signs,
    )  # fmt: skip
    wanted = walker.skeleton.inverse_dynamics(q, v, a) - walker.passive.forces(q, v)
    np.testing.assert_allclose(answer["forces"], signs * wanted, rtol=1e-9, atol=1e-8)


@pytest.mark.parametrize(
    ("model", "statements"),
    [
        ("planar", {"disorders": (dis.Prosthesis("r", category=6),
                                  dis.LegLength("thigh", "l", 0.02))}),
        ("spatial", {"disorders": (dis.Contracture("hamstrings", "l", 0.85),
                                   dis.Orthosis("r", 200.0, mass=0.5),
                                   dis.JointStiffness("hip_rotation", "l", 20.0, 5.0, 0.2))}),
        ("spatial", {"variants": Variants(sequence="123")}),
    ],
)  # fmt: skip
def test_other_walkers_are_themselves(model, statements, tmp_path, ask_opensim):
    """Disorders and the other sequence of rotations reach OpenSim through the walker alone."""
    walker = GaitStudy(model=model, **statements).walker
    q, v, a, signs = random_states(walker)
    answer = ask_opensim(
        what="postures", model=write(tmp_path, walker, muscles="actuators"),
        names=walker.coordinate_names, q=q * signs, v=v * signs, a=a * signs,
        muscles=walker.muscles.names, ask=["forces", "paths", "points"],
    )  # fmt: skip
    wanted = walker.skeleton.inverse_dynamics(q, v, a) - walker.passive.forces(q, v)
    np.testing.assert_allclose(answer["forces"], signs * wanted, rtol=1e-9, atol=1e-8)
    lengths = [[length for length, _ in posture] for posture in answer["paths"]]
    np.testing.assert_allclose(lengths, walker.muscles.lengths(q), atol=1e-12)
    points = walker.skeleton.contact_points(q) @ TO_OPENSIM.T
    np.testing.assert_allclose(answer["points"], points, atol=1e-12)


def test_springs_at_joints_are_ours(tmp_path, ask_opensim):
    springs = (JointSpring("ankle_dorsiflexion_r", 120.0, 400.0, -0.1, 1.5),
               JointSpring("knee_flexion_l", 30.0, 0.0, 0.2, 0.0))  # fmt: skip
    walker = GaitStudy.planar().walker
    walker = dataclasses.replace(walker, passive=PassiveJoints("planar", springs=springs))
    q, v, a, signs = random_states(walker)
    answer = ask_opensim(
        what="postures", model=write(tmp_path, walker, muscles="none"), ask=["forces"],
        names=walker.coordinate_names, q=q * signs, v=v * signs, a=a * signs,
    )  # fmt: skip
    wanted = walker.skeleton.inverse_dynamics(q, v, a) - walker.passive.forces(q, v)
    np.testing.assert_allclose(answer["forces"], signs * wanted, rtol=1e-9, atol=1e-8)


@pytest.mark.parametrize("model", ["planar", "spatial"])
def test_ideal_muscles_accelerate_the_body_as_ours(model, tmp_path, ask_opensim):
    """Forward dynamics: M a = passive + muscles + gravity - bias, with control = force / f_max."""
    walker = study(model).walker
    q, v, _, signs = random_states(walker)
    share = np.random.default_rng(4).uniform(0.0, 1.2, (STATES, walker.muscles.num_muscles))
    answer = ask_opensim(
        what="postures", model=write(tmp_path, walker, muscles="actuators"),
        ask=["accelerations"], names=walker.coordinate_names, q=q * signs, v=v * signs,
        muscles=walker.muscles.names, controls=share,
    )  # fmt: skip
    skeleton = walker.skeleton
    force = (
        skeleton.gravity_forces(q) - skeleton.bias(q, v) + walker.passive.forces(q, v)
        + walker.muscles.joint_torques(share * walker.muscles.f_max)
    )  # fmt: skip
    wanted = signs * np.linalg.solve(skeleton.mass_matrix(q), force[..., None])[..., 0]
    np.testing.assert_allclose(answer["accelerations"], wanted, rtol=1e-8, atol=1e-7)


def test_pictures_are_where_drake_has_them(tmp_path, ask_opensim):
    walker = study("spatial").walker
    q, v, _, signs = random_states(walker)
    answer = ask_opensim(
        what="postures", model=write(tmp_path, walker), names=walker.coordinate_names,
        q=q * signs, v=v * signs, ask=["shapes"],
        shapes=["/bodyset/hat/forearm_l_frame", "/bodyset/shank_r/shank_frame"],
    )  # fmt: skip
    poses = walker.skeleton.body_poses(q)
    turned = Rotation.from_euler("y", -0.12).as_matrix()  # of the forearm in the SDF file
    for k, (name, place, turn) in enumerate(
        [("hat", (0.02, 0.21, 0.09), turned), ("shank_r", (0.0, 0.0, -0.2214), np.eye(3))]
    ):
        rotation, origin = poses[name]
        centre = (origin + rotation @ np.array(place)) @ TO_OPENSIM.T
        up = (rotation @ turn)[..., 2] @ TO_OPENSIM.T  # SDF's z is OpenSim's y
        found = np.array(answer["shapes"])[:, k]
        np.testing.assert_allclose(found, np.hstack([centre, up]), atol=1e-9)


def half_extents(shape: ElementTree.Element) -> np.ndarray:
    """Of an SDF or OpenSim shape along its own axes, SDF's y and z as z and y."""

    def sizes(*names: str) -> np.ndarray:
        return np.concatenate([np.array(shape.findtext(name).split(), float) for name in names])

    match shape.tag:
        case "box":
            return 0.5 * sizes("size")[[0, 2, 1]]
        case "ellipsoid":
            return sizes("radii")[[0, 2, 1]]
        case "capsule":  # its ends are round
            radius, half = sizes("radius", "length") * (1.0, 0.5)
            return np.array([radius, half + radius, radius])
        case "cylinder":
            return sizes("radius", "length", "radius") * (1.0, 0.5, 1.0)
        case "sphere" | "Sphere":
            return sizes("radius", "radius", "radius")
        case "Brick":
            return sizes("half_lengths")
        case "Ellipsoid":
            return sizes("radii")
        case "Cylinder":
            return sizes("radius", "half_height", "radius")
    raise AssertionError(shape.tag)


@pytest.mark.parametrize("model", ["planar", "spatial"])
def test_every_picture_of_the_model_file_is_there_in_its_size(model):
    walker = study(model).walker
    found = {
        (body.get("name"), shape[0].get("name")): shape[0]
        for body in ElementTree.fromstring(osim_model(walker)).iter("Body")
        for shape in body.iter("attached_geometry")
    }
    for link in ElementTree.fromstring(walker.skeleton.sdf).iter("link"):
        for visual in link.iter("visual"):
            shape = found.pop((link.get("name"), visual.get("name")))
            wanted = half_extents(visual.find("geometry")[0])
            np.testing.assert_allclose(half_extents(shape), wanted, rtol=1e-9)
    assert not found


@pytest.mark.parametrize("model", ["planar", "spatial"])
def test_parts_are_a_tree_with_all_coordinates_and_the_whole_mass(model):
    walker = study(model).walker
    parts = read_parts(walker.skeleton)
    named = [freedom.coordinate for part in parts for freedom in part.freedoms]
    assert sorted(named) == sorted(walker.coordinate_names)
    seen = {"ground"}
    for part in parts:
        assert part.parent in seen
        seen.add(part.name)
    assert sum(part.mass for part in parts) == pytest.approx(walker.skeleton.total_mass)
    assert [len(part.points) for part in parts if part.name.startswith("foot")] == [2, 2]


def test_hips_turn_in_the_sequence_213():
    parts = {part.name: part for part in read_parts(study("spatial").walker.skeleton)}
    named = [freedom.coordinate for freedom in parts["thigh_l"].freedoms]
    assert named == ["hip_flexion_l", "hip_adduction_l", "hip_rotation_l"]


def test_limits_of_the_study_narrow_the_range():
    limited = GaitStudy.planar().with_limit("knee_flexion_r", 0.1, 1.0)
    text = osim_model(limited.walker, limits=limited.limits)
    ranges = {
        item.get("name"): [float(x) for x in item.find("range").text.split()]
        for item in ElementTree.fromstring(text).iter("Coordinate")
    }
    assert ranges["knee_flexion_r"] == [0.1, 1.0]
    assert ranges["knee_flexion_l"] == pytest.approx([-0.15, 2.0])
    assert ranges["ankle_dorsiflexion_l"][0] == pytest.approx(-0.9)  # plantarflexion


def test_muscles_carry_our_constants():
    walker = GaitStudy.planar(strength={"soleus_l": 0.5}).walker
    root = ElementTree.fromstring(osim_model(walker))
    muscles = {item.get("name"): item for item in root.iter("DeGrooteFregly2016Muscle")}
    assert tuple(muscles) == walker.muscles.names
    index = walker.muscles.names.index("soleus_l")
    for tag, value in (
        ("max_isometric_force", walker.muscles.f_max[index]),
        ("optimal_fiber_length", walker.muscles.l_opt[index]),
        ("tendon_slack_length", walker.muscles.l_slack[index]),
        ("pennation_angle_at_optimal", math.radians(23.6)),
        ("max_contraction_velocity", 5.2 / 0.41),
        ("activation_time_constant", 0.0706),
        ("deactivation_time_constant", 0.0788),
    ):
        assert float(muscles["soleus_l"].find(tag).text) == pytest.approx(value)
    assert muscles["soleus_l"].find("ignore_passive_fiber_force").text == "true"


def test_a_spastic_muscle_cannot_rest():
    walker = GaitStudy.planar(disorders=(dis.Spasticity("soleus", "l", 0.2),)).walker
    muscles = ElementTree.fromstring(osim_model(walker)).iter("DeGrooteFregly2016Muscle")
    least = {item.get("name"): float(item.find("min_control").text) for item in muscles}
    assert least["soleus_l"] == 0.2 and least["soleus_r"] == 0.0


def test_width_scale_follows_the_parabola():
    assert active_force(np.array([1.0]), 2.0) == pytest.approx(1.0, abs=0.02)
    scales = [width_scale(width) for width in (0.2, 0.44, 0.89, 1.44)]
    assert scales[0] == 1.0 and scales[1] < scales[2] < scales[3]
    length = np.linspace(0.5, 1.5, 21)
    ours = 1.0 - ((length - 1.0) / 0.889) ** 2
    assert np.max(np.abs(active_force(length, width_scale(0.889)) - ours)) < 0.15


def test_other_kinds_of_muscles_are_refused():
    with pytest.raises(UnknownName, match="actuators"):
        osim_model(GaitStudy.planar().walker, muscles="hill")
