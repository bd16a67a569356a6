"""Segments, SDF files, scaling, added masses, coordinates: truths and refusals."""

from __future__ import annotations

import json
from xml.etree import ElementTree

import numpy as np
import pytest

from drakegait.errors import BadFile, InvalidInput, UnknownName
from drakegait.walker import coordinates
from drakegait.walker.model_file import model_sdf, read_segments, sdf_path
from drakegait.walker.skeleton import Skeleton
from drakegait.walker.subject import SEGMENTS, AddedMass, Subject, segment_properties

SETS = ("default", "winter_planar", "deleva")


@pytest.mark.parametrize("name", SETS)
def test_segments_make_the_whole_body_and_are_possible_bodies(name):
    segments = segment_properties(Subject(anthropometry=name))
    assert tuple(segments) == SEGMENTS
    assert sum(s.mass for s in segments.values()) == pytest.approx(75.0, abs=1e-9)
    for segment in segments.values():
        moments = np.linalg.eigvalsh(segment.inertia)
        assert moments[0] > 0 and moments[0] + moments[1] >= moments[2]
    for right, left in zip(SEGMENTS[1:4], SEGMENTS[4:], strict=True):
        np.testing.assert_array_equal(segments[right].inertia, segments[left].inertia)


def test_default_set_follows_winters_fractions():
    # mass, length and centre of mass as fractions of M, H and L; radius of gyration k L
    table = {
        "hat": (0.678, 0.28, 0.626, 0.496),
        "thigh_r": (0.100, 0.245, 0.433, 0.323),
        "shank_l": (0.0465, 0.246, 0.433, 0.302),
    }
    segments = segment_properties(Subject())
    for name, (mass, length, com, radius) in table.items():
        segment = segments[name]
        assert segment.mass == pytest.approx(mass * 75.0)
        assert segment.length == pytest.approx(length * 1.80)
        assert abs(segment.com[2]) == pytest.approx(com * segment.length)
        iyy = segment.mass * (radius * segment.length) ** 2
        assert segment.inertia[1, 1] == pytest.approx(iyy, rel=3e-3)
    assert segments["foot_r"].length == pytest.approx(0.152 * 1.80)


def test_other_sets_differ_where_they_should():
    default, winter, deleva = (segment_properties(Subject(anthropometry=n)) for n in SETS)
    assert winter["foot_r"].inertia[1, 1] == pytest.approx(1.0875 * (0.475 * 0.2736) ** 2, rel=1e-3)
    np.testing.assert_array_equal(winter["thigh_l"].inertia, default["thigh_l"].inertia)
    assert deleva["thigh_l"].mass == pytest.approx(0.1416 * 75)
    assert deleva["thigh_l"].length == pytest.approx(0.4365)
    assert deleva["shank_r"].length == pytest.approx(0.4552)
    assert deleva["foot_r"].length == pytest.approx(0.2668)
    q = np.zeros(16)
    hip_height = -Skeleton.load("spatial", Subject(anthropometry="deleva")).contact_points(q)[0, 2]
    assert hip_height == pytest.approx(0.4365 + 0.4552 + 0.0702)


@pytest.mark.parametrize("name", SETS)
def test_lengths_masses_and_inertias_scale(name):
    base = segment_properties(Subject(anthropometry=name))
    other = segment_properties(Subject(height=1.5, mass=100.0, anthropometry=name))
    length, mass = 1.5 / 1.8, 100 / 75
    for segment in SEGMENTS:
        a, b = base[segment], other[segment]
        assert b.mass == pytest.approx(mass * a.mass)
        assert b.length == pytest.approx(length * a.length)
        np.testing.assert_allclose(b.com, length * a.com)
        np.testing.assert_allclose(b.inertia, mass * length**2 * a.inertia)


@pytest.mark.parametrize("kind", coordinates.SKELETONS)
def test_planar_and_spatial_files_have_the_same_segments(kind):
    spatial = read_segments(model_sdf("spatial", Subject()))
    here = read_segments(model_sdf(kind, Subject()))
    for name in SEGMENTS:
        assert here[name].mass == spatial[name].mass
        np.testing.assert_array_equal(here[name].com, spatial[name].com)
        np.testing.assert_array_equal(here[name].inertia, spatial[name].inertia)


def test_point_masses_are_combined_exactly():
    added = [AddedMass("foot_r", 2.0), AddedMass("foot_r", 1.0, (0.1, -0.02, 0.03))]
    alone = segment_properties(Subject())["foot_r"]
    both = read_segments(model_sdf("spatial", Subject(), added))["foot_r"]
    points = [alone.com, np.array([0.1, -0.02, 0.03])]
    assert both.mass == pytest.approx(alone.mass + 3.0)
    com = (alone.mass * alone.com + 2.0 * points[0] + 1.0 * points[1]) / both.mass
    np.testing.assert_allclose(both.com, com, atol=1e-15)

    def about_origin(inertia, mass, point):
        return inertia + mass * (point @ point * np.eye(3) - np.outer(point, point))

    expected = about_origin(alone.inertia, alone.mass, alone.com)
    expected = expected + sum(
        about_origin(0.0, a.mass, p) for a, p in zip(added, points, strict=True)
    )
    np.testing.assert_allclose(about_origin(both.inertia, both.mass, both.com), expected)
    reverse = read_segments(model_sdf("spatial", Subject(), added[::-1]))["foot_r"]
    np.testing.assert_allclose(reverse.inertia, both.inertia, atol=1e-15)


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("foot", 2.0), "segment is 'foot', but must be one of hat, thigh_r"),
        (("foot_r", 0.0), "added mass is 0.0, but must be a number above 0"),
        (("foot_r", 31.0), "at most 30"),
        (("foot_r", float("nan")), "added mass is nan"),
        (("foot_r", True), "added mass is True"),
        (("foot_r", 2.0, (0.0, 1.0)), "three numbers"),
        (("foot_r", 2.0, 3.0), "three numbers"),
        (("foot_r", 2.0, (0.0, 100.0, 0.0)), "three numbers from -1 to 1"),
    ],
)
def test_impossible_added_masses_are_refused(arguments, words):
    with pytest.raises(InvalidInput, match=words):
        AddedMass(*arguments)


@pytest.mark.parametrize(
    "change",
    [{"height": 0.9}, {"height": 180.0}, {"mass": 750.0}, {"anthropometry": "winter"}],
)
def test_impossible_subjects_are_refused(change):
    with pytest.raises(InvalidInput, match=next(iter(change))):
        Subject(**change)


def test_numbers_of_numpy_are_numbers():
    subject = Subject(height=np.float32(1.75), mass=np.int64(70))
    assert json.loads(json.dumps(subject.to_dict()))["mass"] == 70
    assert type(subject.mass) is int


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ('joint name="knee_flexion_r"', 'joint name="knee_r"', "no joint named 'knee_flexion_r'"),
        ('link name="foot_l"', 'link name="sole_l"', "no link named 'foot_l'"),
        ('frame name="toe_l"', 'frame name="tip_l"', "no frame named 'toe_l'"),
        ("</sdf>", "", "not a readable SDF text"),
        ("<mass>7.5</mass>", "<mass>heavy</mass>", "'heavy', not numbers"),
        ("<xyz>0 0 1</xyz>", "<xyz>0 0 -1</xyz>", "'hat_z' has the axis 0 0 -1, not 0 0 1"),
        ("<effort>0</effort></limit>",
         "<effort>0</effort></limit><dynamics><damping>1</damping></dynamics>",
         "'hat_x' has damping"),
        ('"hat_x" type="prismatic"', '"hat_x" type="revolute"', "'hat_x' is revolute"),
        ('name="heel_r" attached_to="foot_r"', 'name="heel_r" attached_to="shank_r"',
         "'heel_r' is not fixed to foot_r"),
        ('"toe_l" attached_to="foot_l"><pose>0.142', '"toe_l" attached_to="foot_l"><pose>0.172',
         "'toe_l' is at x = 172, z = -70.2 mm; it must be as on the other foot"),
        ('"toe_r" attached_to="foot_r"><pose>0.142 0 -0.0702',
         '"toe_r" attached_to="foot_r"><pose>0.142 0 -0.08',
         "'toe_(r|l)' is at .*; it must be"),
        ('"heel_r" attached_to="foot_r"><pose>-0.06 0',
         '"heel_r" attached_to="foot_r"><pose>-0.06 0.02',
         "'heel_r' is 20 mm beside its foot's sagittal plane"),
        ("</model>",
         '<link name="toes"><inertial><mass>0.1</mass></inertial></link>'
         '<joint name="toe_hinge" type="revolute"><parent>foot_r</parent><child>toes</child>'
         "<axis><xyz>0 1 0</xyz></axis></joint></model>",
         "17 degrees of freedom, not 16"),
    ],
)  # fmt: skip
def test_own_models_that_do_not_fit_are_refused_by_name(old, new, words):
    text = sdf_path("spatial").read_text(encoding="utf-8")
    assert old in text
    with pytest.raises(BadFile, match=words):
        Skeleton.load("spatial", Subject(mass=70.0), text=text.replace(old, new, 1))


def test_own_model_is_used_and_scaled():
    text = sdf_path("planar").read_text(encoding="utf-8")
    heavier = text.replace("<mass>50.85</mass>", "<mass>60.85</mass>")
    skeleton = Skeleton.load("planar", Subject(mass=150.0), text=heavier)
    assert skeleton.total_mass == pytest.approx(2 * 85.0)
    with pytest.raises(InvalidInput, match="anthropometry is 'deleva'"):
        Skeleton.load("planar", Subject(anthropometry="deleva"), text=text)
    with pytest.raises(BadFile, match="no joint named 'hat_y'"):
        Skeleton.load("spatial", text=text)
    with pytest.raises(BadFile, match="not an SDF text"):
        model_sdf("planar", Subject(), text="<urdf/>")


def test_a_taller_body_looks_taller_everywhere():
    """What is drawn grows with the segments."""
    small, tall = (
        ElementTree.fromstring(model_sdf("spatial", Subject(height=x))) for x in (1.8, 1.98)
    )
    for tag in ("radius", "length", "size", "radii"):
        one, other = (
            [float(word) for item in root.iter(tag) for word in item.text.split()]
            for root in (small, tall)
        )
        np.testing.assert_allclose(other, 1.1 * np.array(one), rtol=1e-9)


def test_unknown_skeletons_and_coordinates_list_the_known_ones():
    with pytest.raises(UnknownName, match="spatial, planar"):
        model_sdf("flat", Subject())
    with pytest.raises(UnknownName, match="did you mean 'hip_flexion_r'"):
        coordinates.position("planar", "hip_flexion_right")


def test_coordinates_have_the_order_of_the_paper_and_mirror_to_themselves():
    paper = "x_I1 y_I1 z_I1 a_I1 b_I1 g_I1 a_13 b_13 g_13 b_34 b_45 a_16 b_16 g_16 b_67 b_78"
    assert [c.paper_name for c in coordinates.SPATIAL] == paper.split()
    assert [c.paper_name for c in coordinates.PLANAR] == [p for p in paper.split() if p[0] in "xzb"]
    rng = np.random.default_rng(0)
    for kind in coordinates.SKELETONS:
        q = rng.normal(size=(3, len(coordinates.names(kind))))
        twice = coordinates.mirror(kind, coordinates.mirror(kind, q))
        np.testing.assert_array_equal(twice, q)
        back = coordinates.to_plant(kind, coordinates.to_anatomical(kind, q))
        np.testing.assert_array_equal(back, q)
        assert [
            coordinates.position(kind, c.paper_name) for c in coordinates.coordinates(kind)
        ] == [*range(q.shape[-1])]
        assert len(coordinates.joint_angles(kind)) == {"spatial": 10, "planar": 6}[kind]
    # In anatomical signs the legs of a mirrored posture simply change places.
    q = rng.normal(size=16)
    there = coordinates.to_anatomical("spatial", coordinates.mirror("spatial", q))
    here = coordinates.to_anatomical("spatial", q)
    np.testing.assert_array_equal(there[6:11], here[11:16])
