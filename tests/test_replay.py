"""The replay shows the gait: places, colours, arrows, prints, in one file without a network."""

import base64
import dataclasses
import re
import struct

import numpy as np
import pytest
from gait_cases import reference_gait
from pydrake.geometry import Meshcat

from drakegait import replay_scene as scene
from drakegait.errors import BadFile, InvalidInput
from drakegait.replay import replay
from drakegait.replay_film import LEAST_LOAD, Film, linear_light
from drakegait.replay_muscles import ACTIVE, RESTING, activation_colours, muscle_pieces
from drakegait.report.footprints import prints
from drakegait.walker import coordinates
from drakegait.walker.muscles import MuscleSet
from drakegait.walker.skeleton import Skeleton
from drakegait.walker.subject import Subject


@pytest.fixture(scope="module")
def gait():
    return reference_gait("spatial")


@pytest.fixture(scope="module")
def film(gait):
    return Film.of(gait)


@pytest.fixture(scope="module")
def page(gait, tmp_path_factory):
    path = tmp_path_factory.mktemp("replay") / "replay.html"
    replay(gait, html=path, strides=2)
    return path.read_text(encoding="utf-8")


@pytest.fixture(scope="module")
def commands(page):
    """What the page tells the viewer, as bytes in the order of sending."""
    parts = re.findall(r'"data:application/octet-binary;base64,([^"]+)"', page)
    assert len(parts) > 50
    return [base64.b64decode(part) for part in parts]


def number(value: float) -> bytes:
    return b"\xcb" + struct.pack(">d", value)  # MessagePack, 64-bit float


def test_page_needs_no_network(page):
    assert not re.findall(r"<(?:script|img|iframe|link)[^>]+(?:src|href)\s*=", page)
    assert not re.findall(r"fetch\(\s*[\"'](?!data:)", page)
    assert not re.findall(r"import\s*\(?[\"']https?:", page)
    assert not re.findall(r"url\(\s*[\"']?https?:", page)
    assert page.count("</html>") == 1 and page.rstrip().endswith("</html>")


def test_page_says_who_walks_and_has_pause(page, gait):
    assert f"{gait.speed:.2f} m/s" in page
    assert "has not converged" in page
    assert 'id="walk-pause"' in page and "viewer.animator.pause()" in page
    assert "for illustration" in page


def test_animation_moves_every_segment_and_colours_every_muscle(commands, gait, film):
    animation = commands[-1] if b"set_animation" in commands[-1] else next(
        part for part in commands if b"set_animation" in part
    )  # fmt: skip
    for segment in film.poses:
        assert scene.body_path(segment).encode() in animation
    for piece in muscle_pieces(gait.study.walker.muscles, gait.study.subject):
        if piece.belly:
            assert f"{scene.piece_path(piece)}/shape/<object>".encode() in animation
    frame = film.frames_per_stride // 3
    for muscle in ("soleus_l", "gluteus_medius_posterior_r"):
        colour = linear_light(film.colour(muscle)[frame])
        key = b"\x93" + b"".join(number(value) for value in colour)
        assert animation.count(key) >= 2  # once in each stride
    # The world goes back under the walker, who thus stays in view.
    backwards = b"\x93" + number(-float(film.viewer(frame))) + 2 * number(0.0)
    assert animation.count(backwards) == 1


def test_colour_follows_activation(gait, film):
    data = gait.sample(film.frames_per_stride + 1)
    for name in ("soleus_r", "vasti_l"):
        activation = data.activation.sel(muscle=name).values[:-1]
        colour = film.colour(name)
        share = (colour[:, 0] - RESTING[0]) / (ACTIVE[0] - RESTING[0])
        np.testing.assert_allclose(share, np.clip(activation, 0.0, 1.0), atol=1e-12)
    red, _, blue = activation_colours(np.linspace(0.0, 1.0, 11)).T
    assert np.all(np.diff(red) > 0.0) and np.all(np.diff(blue) < 0.0)
    np.testing.assert_array_equal(activation_colours(np.array([-0.1, 1.3])), [RESTING, ACTIVE])
    np.testing.assert_allclose(linear_light(np.array([0.0, 1.0])), [0.0, 1.0])


def test_film_is_the_motion_in_real_time(gait, film):
    count = film.frames_per_stride
    assert count / film.frame_rate == pytest.approx(gait.stride_time)
    q = gait.motion(np.array([5 / count])).q
    rotation, origin = gait.study.walker.skeleton.body_poses(q)["foot_l"]
    np.testing.assert_allclose(film.poses["foot_l"][0][5], rotation[0])
    np.testing.assert_allclose(film.poses["foot_l"][1][5], origin[0])
    # The viewer keeps beside the hips.
    beside = film.viewer(np.arange(count))
    assert film.viewer(count) - film.viewer(0) == pytest.approx(gait.stride_length)
    assert np.abs(film.poses["hat"][1][:, 0] - beside).max() < 0.06


def test_arrows_stand_on_the_ground_under_loaded_feet(gait, film):
    data = gait.sample(film.frames_per_stride + 1).isel(time=slice(0, -1))
    weight = gait.study.subject.mass * 9.81
    vertical = data.ground_reaction_force.sel(axis="z").values
    np.testing.assert_array_equal(film.loaded, vertical > LEAST_LOAD * weight)
    assert np.all(film.loaded.any(axis=1))  # walking, not running
    start = film.pressure[film.loaded]
    np.testing.assert_allclose(start[:, 2], 0.0, atol=1e-9)
    for foot, points in ((0, ("heel_r", "toe_r")), (1, ("heel_l", "toe_l"))):
        on = film.loaded[:, foot]
        ends = data.contact_points.sel(contact_point=list(points), axis="x").values[on]
        x = film.pressure[on, foot, 0]
        assert np.all((x > ends.min(axis=1) - 1e-6) & (x < ends.max(axis=1) + 1e-6))


def test_feet_stand_on_their_prints(gait, film):
    foot = gait.study.walker.foot
    x, y, heading = prints(gait)["right"][0]
    standing = round(0.25 * film.frames_per_stride)  # right single support
    rotation, ankle = film.poses["foot_r"][0][standing], film.poses["foot_r"][1][standing]
    assert np.hypot(ankle[0] - x, ankle[1] - y) < 0.015
    assert np.arctan2(rotation[1, 0], rotation[0, 0]) == pytest.approx(heading, abs=0.03)
    assert foot.heel < 0.0 < foot.toe


@pytest.mark.parametrize(
    "kind, planar_set", [("spatial", "table3"), ("planar", "table3"), ("planar", "gait2d")]
)
def test_every_muscle_is_drawn_mirrored_and_unbroken(kind, planar_set):
    muscles = MuscleSet.load(kind, planar_set=planar_set)
    pieces = muscle_pieces(muscles, Subject())
    assert {piece.muscle for piece in pieces} == set(muscles.names)
    for name in muscles.names:
        own = [piece for piece in pieces if piece.muscle == name]
        assert sum(piece.belly for piece in own) == 1
        for before, after in zip(own[:-1], own[1:], strict=True):
            assert before.segments[1] == after.segments[0]
            np.testing.assert_array_equal(before.points[1], after.points[0])
    half = len(pieces) // 2
    for right, left in zip(pieces[:half], pieces[half:], strict=True):
        assert right.muscle[:-2] == left.muscle[:-2]
        np.testing.assert_allclose(right.points * [1, -1, 1], left.points)


def test_bellies_are_as_thick_as_muscles_are_strong():
    """Areas go with f_max, at a size that fits a thigh: the vasti's radius is 1 to 4 cm."""
    muscles = MuscleSet.load("spatial")
    radius = {x.muscle: x.radius for x in muscle_pieces(muscles, Subject()) if x.belly}
    area = np.array([radius[name] ** 2 for name in muscles.names])
    np.testing.assert_allclose(area / area[0], muscles.f_max / muscles.f_max[0])
    assert 0.01 < radius["vasti_r"] < 0.04


def test_drawn_muscles_shorten_in_the_sense_of_their_moment_arms():
    muscles, skeleton = MuscleSet.load("spatial"), Skeleton.load("spatial")
    pieces = muscle_pieces(muscles, Subject())
    posture = np.zeros(skeleton.num_coordinates)
    for name in ("hip_flexion_r", "knee_flexion_r", "ankle_dorsiflexion_r"):
        column = coordinates.position("spatial", name)
        moved = posture.copy()
        moved[column] = 0.15
        change = drawn_lengths(skeleton, pieces, muscles.names, moved) - drawn_lengths(
            skeleton, pieces, muscles.names, -moved
        )
        arms = muscles.moment_arms[:, column]
        wrong = [muscles.names[i] for i in np.flatnonzero(np.abs(arms) > 0.015)
                 if change[i] * arms[i] >= 0.0]  # fmt: skip
        assert wrong == []


def drawn_lengths(skeleton, pieces, names, q) -> np.ndarray:
    poses = skeleton.body_poses(q)
    lengths = dict.fromkeys(names, 0.0)
    for piece in pieces:
        ends = [
            poses[segment][0] @ point + poses[segment][1]
            for segment, point in zip(piece.segments, piece.points, strict=True)
        ]
        lengths[piece.muscle] += np.linalg.norm(ends[1] - ends[0])
    return np.array(list(lengths.values()))


def test_rotation_takes_z_along_a_direction():
    for direction in np.random.default_rng(4).normal(size=(20, 3)) + [0.0, 0.0, 0.5]:
        matrix = scene.along_z(direction).matrix()
        unit = direction / np.linalg.norm(direction)
        np.testing.assert_allclose(matrix @ [0.0, 0.0, 1.0], unit, atol=1e-12)
        np.testing.assert_allclose(matrix @ matrix.T, np.eye(3), atol=1e-12)
        assert np.linalg.det(matrix) > 0.0
        axis = np.cross([0.0, 0.0, 1.0], unit)  # the smallest rotation leaves its axis alone
        np.testing.assert_allclose(matrix @ axis, axis, atol=1e-12)


def test_live_view_has_prints_and_worn_weights(gait):
    heavy = dataclasses.replace(gait, study=gait.study.with_added_mass("foot_r", 2.0))
    meshcat = replay(heavy, strides=1)
    assert isinstance(meshcat, Meshcat)
    assert meshcat.HasPath("gait/walker/foot_r/weight_0")
    for path in ("gait/ground/print_left_1", "gait/forces/right", "gait/walker/thigh_l/bone"):
        assert meshcat.HasPath(path)


def test_planar_walker_is_shown_too(tmp_path):
    replay(reference_gait("planar-symmetric"), html=tmp_path / "a.html", strides=1)
    assert [path.name for path in tmp_path.iterdir()] == ["a.html"]


def test_bad_input_is_refused_in_a_sentence(gait, tmp_path):
    for strides in (0, 21, 2.5, True):
        with pytest.raises(InvalidInput, match="strides is .* 1 to 20"):
            replay(gait, strides=strides)
    for port in (80, 70000, "web"):
        with pytest.raises(InvalidInput, match="port is .* 1024 to 65535"):
            replay(gait, port=port)
    with pytest.raises(BadFile, match="cannot be written"):
        replay(gait, html=tmp_path / "missing" / "replay.html", strides=1)
    assert list(tmp_path.iterdir()) == []
