"""C3D files, OpenSim's state files, tables in other axes, and what an import writes."""

from __future__ import annotations

import re

import numpy as np
import pytest
from c3d_cases import write_c3d
from measured_cases import SUBJECT, Lab, write_csv, write_mot

from drakegait import cli
from drakegait.commands.request import WalkRequest
from drakegait.errors import BadFile, InvalidInput, UnknownName
from drakegait.measured import ImportedWalk, import_walk
from drakegait.reference.netcdf_file import read_subject
from drakegait.reference.reference import Reference
from drakegait.study import GaitStudy

LAB = Lab()
TAU = np.arange(100) / 100
DATA = "opensim_subject01"


def take(files, **options) -> ImportedWalk:
    return import_walk(*files, height=SUBJECT.height, mass=SUBJECT.mass, **options)


def same_forces(walk: ImportedWalk, other: ImportedWalk, most: float) -> bool:
    difference = walk.reference.ground_reactions(TAU) - other.reference.ground_reactions(TAU)
    return float(np.sqrt((difference**2).mean())) < most


@pytest.fixture(scope="module")
def files(tmp_path_factory):
    return LAB.write(tmp_path_factory.mktemp("files"))


@pytest.fixture(scope="module")
def walk(files):
    return take(files)


def test_force_plates_of_a_c3d_file(tmp_path, files, walk):
    write_c3d(tmp_path / "trial.c3d", LAB)
    ours = take((files[0], tmp_path / "trial.c3d"))
    assert any("vertical" in sentence and "along" in sentence for sentence in ours.warnings)
    assert same_forces(ours, walk, 10.0)


@pytest.mark.parametrize(
    ("text", "error", "words"),
    [
        ('angle_unit = "rad"\n', InvalidInput, "angle_unit.*headings and units of an OpenSim"),
        ('[columns]\npelvis_tilt = "lean"\n', InvalidInput, "columns.pelvis_tilt.*OpenSim file"),
        ('[sides]\nnosuchplate = "left"\n', UnknownName, "nosuchplate"),
        ("columns = 3\n", InvalidInput, "columns is 3.*a table of names"),
        ('sides = "left"\n', InvalidInput, "sides is 'left'.*a table of names"),
        ("markers = [1]\n", InvalidInput, "markers is .*a table of names"),
    ],
)
def test_a_map_that_says_nothing_of_these_files_is_refused(tmp_path, files, text, error, words):
    (tmp_path / "map.toml").write_text(text)
    with pytest.raises(error, match=words):
        take(files, columns=tmp_path / "map.toml")


def test_a_broken_c3d_file_is_refused(tmp_path, files):
    with pytest.raises(BadFile, match="does not exist"):
        take((tmp_path / "trial.c3d", files[1]))
    pytest.importorskip("ezc3d")
    (tmp_path / "broken.c3d").write_bytes(b"nothing")
    with pytest.raises(BadFile, match="broken.c3d"):
        take((files[0], tmp_path / "broken.c3d"))
    with pytest.raises(BadFile, match="broken.c3d"):
        take((tmp_path / "broken.c3d", files[1]))


def test_state_files_name_coordinates_by_path(tmp_path, files, walk):
    columns = {"time" if n == "time" else f"/jointset/any/{n}/value": v
               for n, v in Lab(unit="rad").motion().items()}  # fmt: skip
    columns |= {  # speeds, and what ends in "value" without being a coordinate's
        name.replace("/value", "/speed"): np.ones_like(v)
        for name, v in columns.items() if name != "time"
    } | {"value": np.zeros_like(columns["time"])}  # fmt: skip
    write_mot(tmp_path / "states.sto", columns, unit="rad")
    ours = take((tmp_path / "states.sto", files[1]))
    difference = ours.reference.coordinate_values(TAU) - walk.reference.coordinate_values(TAU)
    assert np.abs(difference).max() < 1e-3


def test_axes_of_another_laboratory(tmp_path, files, walk):
    """x to the left, y backward, z up."""
    columns = {}
    for name, values in LAB.forces().items():
        stem, axis = name[:-1], name[-1]
        if name != "time":
            target, sign = {"x": ("y", -1.0), "y": ("z", 1.0), "z": ("x", -1.0)}[axis]
            columns[f"{stem}{target}"] = sign * values
        else:
            columns[name] = values
    write_csv(tmp_path / "forces.csv", columns)
    (tmp_path / "map.json").write_text('{"axes": {"forward": "-y", "up": "z"}}')
    motion = tmp_path / "ik.mot"
    motion.write_bytes(files[0].read_bytes())  # of a .mot file the axes are known
    ours = take((motion, tmp_path / "forces.csv"), columns=tmp_path / "map.json")
    assert same_forces(ours, walk, 1.0)


def test_an_import_comes_back_from_its_file(tmp_path, walk):
    pytest.importorskip("jinja2")
    path = tmp_path / "subject.nc"
    walk.save(path)
    for reference in (walk.reference, walk.planar_reference):
        loaded = Reference.load(path, reference.kind)
        assert loaded.coordinate_values(TAU) == pytest.approx(reference.coordinate_values(TAU))
        forces = reference.ground_reactions(TAU)
        assert loaded.ground_reactions(TAU) == pytest.approx(forces, abs=0.5)
        assert loaded.phase_fractions == pytest.approx(reference.phase_fractions)
        assert loaded.foot_placement == reference.foot_placement
    assert Reference.load(path).kind == "spatial"
    assert read_subject(path) == SUBJECT
    page = (tmp_path / "subject_quality.html").read_text()
    for words in ("What was read", "before [mm]", "right hip flexion", "left heel",
                  "% of the stride", "<svg", "lumbar"):
        assert words in page
    assert not re.search(r"(src|href)\s*=\s*['\"]https?:", page)


def test_a_reference_alone_comes_back_and_foreign_files_do_not(tmp_path):
    path = tmp_path / "planar.nc"
    Reference.embedded("planar").save(path)
    assert Reference.load(path).kind == "planar"
    assert read_subject(path) is None
    with pytest.raises(UnknownName, match="spatial"):
        Reference.load(path, "spatial")
    path.write_bytes(b"no netCDF")
    with pytest.raises(BadFile, match="damaged"):
        Reference.load(path)
    with pytest.raises(BadFile, match="does not exist"):
        Reference.load(tmp_path / "none.nc")


def _request(**options) -> WalkRequest:
    import inspect

    from drakegait.cli.walk import walk

    signature = inspect.signature(walk).parameters
    defaults = {n: p.default for n, p in signature.items() if n != "context"}
    return WalkRequest(**(defaults | options))


def test_walk_takes_height_mass_and_speed_of_the_person(tmp_path, walk):
    path = tmp_path / "subject.nc"
    walk.save(path, page=False)
    study, _, _ = _request(reference=str(path)).prepare()
    assert (study.subject.height, study.subject.mass) == (SUBJECT.height, SUBJECT.mass)
    assert study.speed == pytest.approx(walk.reference.speed, abs=1e-3)
    study, _, _ = _request(reference=str(path), model="planar", mass=90.0, speed=1.0).prepare()
    assert (study.subject.height, study.subject.mass, study.speed) == (SUBJECT.height, 90.0, 1.0)
    assert study.reference.kind == "planar"
    plain, _, _ = _request().prepare()
    assert (plain.subject.height, plain.subject.mass, plain.speed) == (1.8, 75.0, 1.2)


def test_a_study_takes_the_walk(walk):
    study = GaitStudy.spatial(reference=walk.reference, subject=walk.subject)
    assert study.formulation().reference is walk.reference


def run(capsys, *arguments) -> tuple[int, str, str]:
    with pytest.raises(SystemExit) as ending:
        cli.main([str(argument) for argument in arguments])
    return int(ending.value.code or 0), *capsys.readouterr()


def test_command_line(tmp_path, files, capsys):
    pytest.importorskip("jinja2")
    out = tmp_path / "me.nc"
    size = ("--height", SUBJECT.height, "--mass", SUBJECT.mass)
    code, text, _ = run(capsys, "import", *files, *size, "-o", out)
    assert code == 0 and out.is_file() and (tmp_path / "me_quality.html").is_file()
    assert "stride" in text and "drakegait walk --reference" in text
    for more, word in (
        (("-o", tmp_path / "me.txt"), ".nc"),
        (("-o", tmp_path / "none" / "me.nc"), "does not exist"),
        (("-o", out, "--side", "1"), "PLATE=SIDE"),
        (("-o", out, "--stride", "one"), "whole number"),
    ):
        code, _, error = run(capsys, "import", *files, *size, *more)
        assert code == 2 and word in error and error.count("\n") == 1
    code, _, error = run(capsys, "import", *files, "--mass", "70")
    assert code == 2 and "--height" in error


def test_sides_of_plates_can_be_said(tmp_path, files, capsys):
    motion, _ = files
    lab = Lab(heads=("plate1_", "plate2_"))
    columns = {k: v for k, v in lab.forces().items() if not k[:-1].endswith("_p")}
    write_mot(tmp_path / "grf.mot", columns)
    walk = take((motion, tmp_path / "grf.mot"), sides={"plate1": "r", "plate2": "l"})
    assert not any("swapped" in sentence for sentence in walk.warnings)
    with pytest.raises(UnknownName, match="'plate3', .* plate1, plate2"):
        take((motion, tmp_path / "grf.mot"), sides={"plate3": "r"})


def test_a_real_person(request):
    """OpenSim's subject01 on a treadmill of 1.13 m/s; events by 20 N as its SOURCE.md lists."""
    folder = request.config.rootpath.parent / "shared" / "data" / DATA
    if not folder.is_dir():
        pytest.skip("the data are not part of this checkout")
    paths = [folder / f"subject01_walk1_{kind}.mot" for kind in ("ik", "grf")]
    walk = import_walk(*paths, height=1.8034, mass=72.6, treadmill_speed=1.13, stride=1)
    chosen = walk.quality.strides[0]
    assert chosen["start_s"] == pytest.approx(0.618, abs=0.004)
    assert chosen["end_s"] == pytest.approx(1.852, abs=0.004)
    events = np.cumsum(walk.reference.phase_fractions)
    assert events[[1, 3, 5]] == pytest.approx([0.138, 0.508, 0.640], abs=0.006)
    assert walk.reference.foot_placement.stride_length == pytest.approx(1.40, abs=0.02)
    names = walk.reference.coordinates
    degrees = np.degrees(walk.reference.coordinate_values(TAU))
    knee, hip = degrees[:, names.index("knee_flexion_r")], degrees[:, names.index("hip_flexion_r")]
    assert 55 < knee.max() < 75 and 62 < knee.argmax() < 80 and knee.min() > -5
    assert 35 < np.ptp(hip) < 55 and -hip.max() < -10
    up = walk.reference.ground_reactions(TAU)[:, 0, 2] / (72.6 * 9.81)
    assert up[5:25].max() > 1.0 and up[40:60].max() > 1.0 and up[25:40].min() < 0.9  # two humps
    assert max(row["after_mm"] for row in walk.quality.contacts) < 8.1
