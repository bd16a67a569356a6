"""Markers of C3D files become the joint angles that put them there."""

from __future__ import annotations

import numpy as np
import pytest
from c3d_cases import markers_of, write_c3d
from measured_cases import SUBJECT, Lab

from drakegait.errors import BadFile, InvalidInput, UnknownName
from drakegait.measured import import_walk
from drakegait.measured.c3d_markers import read_c3d_motion
from drakegait.measured.column_map import ColumnMap
from drakegait.measured.markers import MEDIAL, NEEDED, TRUNK, marker_angles
from drakegait.measured.notes import Notes

pytest.importorskip("ezc3d")
LAB = Lab()
SIZE = {"height": SUBJECT.height, "mass": SUBJECT.mass}


@pytest.fixture(scope="module")
def markers():
    return markers_of(LAB)


def truth(count: int) -> dict[str, np.ndarray]:
    """The angles of the laboratory's motion file [deg], our names."""
    columns = {name: values[:count] for name, values in LAB.motion().items()}
    found = {"hat_tilt": -columns["pelvis_tilt"], "hat_list": columns["pelvis_list"],
             "hat_rotation": columns["pelvis_rotation"]}  # fmt: skip
    for side in "rl":
        for name in ("hip_flexion", "hip_adduction", "hip_rotation"):
            found[f"{name}_{side}"] = columns[f"{name}_{side}"]
        found[f"knee_flexion_{side}"] = columns[f"knee_angle_{side}"]
        found[f"ankle_dorsiflexion_{side}"] = columns[f"ankle_angle_{side}"]
    return found


def test_angles_are_those_of_the_body(markers):
    angles, without = marker_angles(markers, SUBJECT.height)
    assert without == ()
    for name, values in truth(len(markers["RASI"])).items():
        np.testing.assert_allclose(angles[name], values, atol=1e-6, err_msg=name)
    for name in ("lumbar_extension", "lumbar_bending", "lumbar_rotation"):
        assert np.abs(angles[name]).max() < 1e-6  # the model's trunk is one piece with the pelvis


def test_without_medial_markers_angles_are_a_few_degrees_off(markers):
    few = {name: place for name, place in markers.items() if name not in (*MEDIAL, *TRUNK)}
    angles, without = marker_angles(few, SUBJECT.height)
    assert without == ("medial", "trunk")
    assert "hip_rotation_r" not in angles and "lumbar_bending" not in angles
    for name, values in truth(len(markers["RASI"])).items():
        if not name.startswith("hip_rotation"):
            assert np.abs(angles[name] - values).max() < 5.0, name


def test_a_sacrum_serves_for_two_psis(markers):
    one = {name: x for name, x in markers.items() if name not in ("RPSI", "LPSI")}
    one["SACR"] = 0.5 * (markers["RPSI"] + markers["LPSI"])
    angles, _ = marker_angles(one, SUBJECT.height)
    both, _ = marker_angles(markers, SUBJECT.height)
    for name, values in both.items():
        np.testing.assert_allclose(angles[name], values, atol=1e-9)


def test_one_c3d_file_is_motion_and_forces(tmp_path, markers):
    """Also with a subject's prefix, a gap, and axes of the laboratory's own."""
    motion, forces = LAB.write(tmp_path)
    given = import_walk(motion, forces, **SIZE)
    hidden = {f"Anna:{name}": place.copy() for name, place in markers.items()}
    hidden["Anna:RKNE"][100:106] = np.nan
    write_c3d(tmp_path / "walk.c3d", LAB, hidden)
    walk = import_walk(tmp_path / "walk.c3d", tmp_path / "walk.c3d", **SIZE)
    said = " ".join(walk.warnings)
    assert "z is up, and the feet point along -y" in said and "Harrington" in said
    tau = np.arange(100) / 100
    ours, theirs = (x.reference.coordinate_values(tau) for x in (walk, given))
    assert np.degrees(np.abs(ours - theirs)[:, 3:]).max() < 0.5
    assert np.abs(ours - theirs)[:, :3].max() < 0.005
    assert walk.reference.speed == pytest.approx(given.reference.speed, rel=0.005)


def test_a_map_names_the_markers(tmp_path, markers):
    theirs = {f"m.{name.lower()}": place for name, place in markers.items()}
    write_c3d(tmp_path / "walk.c3d", LAB, theirs)
    with pytest.raises(BadFile, match=r"no marker RASI, RKNE.*\[markers\].*m\.rasi"):
        import_walk(tmp_path / "walk.c3d", tmp_path / "walk.c3d", **SIZE)
    table = tmp_path / "map.toml"
    names = "\n".join(f'{name} = "m.{name.lower()}"' for name in markers)
    table.write_text(f"[markers]\n{names}\n")
    walk = import_walk(tmp_path / "walk.c3d", tmp_path / "walk.c3d", columns=table, **SIZE)
    assert walk.reference.speed == pytest.approx(LAB.reference.speed, rel=0.01)
    for text, error, words in (
        ('RASIS = "m.rasi"', UnknownName, "'RASIS', .* RASI"),
        ("RASI = 3", InvalidInput, "label of a marker"),
        ('RASI = "nowhere"', BadFile, "no marker 'nowhere', which the map gives for RASI"),
        (names.replace('"m.lasi"', '"m.rasi"'), InvalidInput, "different markers"),
    ):
        table.write_text(f"[markers]\n{text}\n")
        with pytest.raises(error, match=words):
            import_walk(tmp_path / "walk.c3d", tmp_path / "walk.c3d", columns=table, **SIZE)


def test_markers_in_another_unit_than_the_file_says_are_refused(tmp_path, markers):
    write_c3d(tmp_path / "walk.c3d", LAB, {name: place / 1000.0 for name, place in markers.items()})
    with pytest.raises(BadFile, match=r"0.000\d* m from the heel, in its unit 'mm'.*unit wrong"):
        import_walk(tmp_path / "walk.c3d", tmp_path / "walk.c3d", **SIZE)


@pytest.mark.parametrize("unit", ["", "furlong"])
def test_an_unknown_unit_is_told_from_the_leg(tmp_path, markers, unit):
    for metre in (1000.0, 1.0):  # of the file's unit
        places = {name: 0.001 * metre * place for name, place in markers.items()}
        write_c3d(tmp_path / "walk.c3d", LAB, places, unit)
        table = read_c3d_motion(
            tmp_path / "walk.c3d", ColumnMap(), height=SUBJECT.height, notes=Notes()
        )
        half = 0.5 * (markers["RASI"] + markers["LASI"])
        moved = np.ptp(table.columns["hat_x"])
        assert moved == pytest.approx(np.ptp(half[:, 0]), rel=0.05)


@pytest.mark.parametrize("name", [NEEDED[0], "LTOE", "LPSI"])
def test_a_missing_marker_is_named(tmp_path, markers, name):
    some = {label: place for label, place in markers.items() if label != name}
    write_c3d(tmp_path / "walk.c3d", LAB, some)
    with pytest.raises(BadFile, match=f"no marker {name};"):
        import_walk(tmp_path / "walk.c3d", tmp_path / "walk.c3d", **SIZE)
