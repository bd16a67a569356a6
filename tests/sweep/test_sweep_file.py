"""Files with sweeps: what they mean, and how they are refused."""

from __future__ import annotations

import json
import math
from pathlib import Path

import pytest

from drakegait import cli
from drakegait.reference.netcdf_file import write_subject
from drakegait.reference.reference import Reference
from drakegait.study import GaitStudy
from drakegait.sweep import axes, sweep_file
from drakegait.walker import disorders as dis
from drakegait.walker.subject import AddedMass, Subject

EXAMPLES = Path(__file__).resolve().parents[2] / "examples"


def read(tmp_path, text: str, name: str = "some.toml") -> sweep_file.SweepFile:
    path = tmp_path / name
    path.write_text(text)
    return sweep_file.read(path)


def test_a_grid_is_the_product_of_its_axes(tmp_path):
    found = read(tmp_path, """
        [sweep]
        warm = ["speed", "added_mass.foot_r"]
        refine = false
        [base]
        model = "planar"
        nodes = 20
        speed = 1.5
        [grid]
        speed = [0.8, 1.0]
        "added_mass.foot_r" = [0, 1.5]
        """)  # fmt: skip
    bare = GaitStudy.planar(nodes=20)
    assert dict(found.studies) == {
        "speed=0.8,added_mass.foot_r=0": bare.replace(speed=0.8),
        "speed=0.8,added_mass.foot_r=1.5": bare.replace(speed=0.8).with_added_mass("foot_r", 1.5),
        "speed=1,added_mass.foot_r=0": bare.replace(speed=1.0),
        "speed=1,added_mass.foot_r=1.5": bare.replace(speed=1.0).with_added_mass("foot_r", 1.5),
    }
    assert found.warm == {
        "speed=0.8,added_mass.foot_r=1.5": "speed=0.8,added_mass.foot_r=0",
        "speed=1,added_mass.foot_r=0": "speed=0.8,added_mass.foot_r=0",
        "speed=1,added_mass.foot_r=1.5": "speed=0.8,added_mass.foot_r=1.5",
    }
    assert found.refine is False
    grid = axes.grid(found.axes)
    assert grid == {"speed": [0.8, 1.0], "added_mass.foot_r": [0, 1.5]}
    # The axes are found as well where nobody names them.
    assert axes.grid(axes.differences(found.studies)) == grid


def test_every_kind_of_statement_means_what_the_command_line_means(tmp_path):
    Reference.embedded("planar").save(tmp_path / "walk.csv")
    found = read(tmp_path, """
        [base]
        model = "planar"
        height = 1.7
        mass = 60
        weights = [2.0, 0.5]
        strength.SOL = 0.5
        limit.knee_flexion_r = [-inf, 60]
        set.friction = 0.4
        set.optimality = 0.01
        energy.model = "umberger2010"
        muscle.SOL.l_slack = 0.25
        time_limit = 5.0
        interior_points = [1, 1, 3, 2, 1, 1, 3, 2]
        reference = "walk.csv"
        added_mass.hat = { mass = 5.0, point = [0.0, 0.0, 0.3] }
        [[study]]
        name = "plain"
        [[study]]
        name = "strong"
        warm = "plain"
        strength.SOL = 1.5
        solver = "snopt"
        """)  # fmt: skip
    plain, strong = found.studies.values()
    expected = GaitStudy(
        model="planar", subject=Subject(height=1.7, mass=60.0), energy_weight=2.0,
        deviation_weight=0.5, strength={"SOL": 0.5}, interior_points=(1, 1, 3, 2, 1, 1, 3, 2),
        added_masses=(AddedMass("hat", 5.0, (0.0, 0.0, 0.3)),),
        muscle_changes={"SOL": {"l_slack": 0.25}},
    ).with_limit("knee_flexion_r", high=math.radians(60.0))  # fmt: skip
    expected = expected.with_settings(**{"friction": 0.4, "energy.model": "umberger2010"})
    assert plain == expected and plain.reference.name
    assert strong == expected.replace(strength={"SOL": 1.5})
    assert strong.reference is plain.reference  # read once
    assert found.warm == {"strong": "plain"} and found.axes is None
    options = found.options
    assert (options["plain"].time_limit, options["plain"].optimality) == (5.0, 0.01)
    assert options["strong"].solver == "snopt"
    assert axes.differences(found.studies)["strong"] == {"strength.SOL": 1.5}


def test_disorders_are_stated_as_on_the_command_line(tmp_path):
    found = read(tmp_path, """
        [base]
        model = "planar"
        prosthesis.transtibial_r = 4
        range.knee_l = [5, 45]
        [grid]
        weakness.SOL_l = [0.5, 0.8]
        """)  # fmt: skip
    study = GaitStudy.planar().with_disorder(
        dis.Prosthesis("r", 4), dis.LimitedRange("knee", "l", 5.0, 45.0)
    )
    assert found.studies["weakness.SOL_l=0.8"] == study.with_disorder(dis.Weakness("SOL", "l", 0.8))
    assert axes.grid(found.axes) == {"weakness.SOL_l": [0.5, 0.8]}
    # The form of GaitStudy.to_dict is taken as well; TOML has no null.
    plain = [
        {name: value for name, value in disorder.items() if value is not None}
        for disorder in found.studies["weakness.SOL_l=0.5"].to_dict()["disorders"]
    ]
    toml = json.dumps(plain).replace(": ", " = ")
    again = read(
        tmp_path, f"[base]\nmodel = 'planar'\n[[study]]\nname = 'a'\ndisorders = {toml}\n"
    )
    assert again.studies["a"] == found.studies["weakness.SOL_l=0.5"]


def test_an_imported_walk_brings_its_person_and_speed(tmp_path):
    reference = Reference.embedded("planar", Subject(height=1.6, mass=55.0))
    write_subject(tmp_path / "me.nc", (reference,), Subject(height=1.6, mass=55.0))
    found = read(tmp_path, """
        [base]
        model = "planar"
        reference = "me.nc"
        [[study]]
        name = "as measured"
        [[study]]
        name = "heavier"
        mass = 60
        speed = 1.0
        """)  # fmt: skip
    measured, heavier = found.studies.values()
    assert measured.subject == Subject(height=1.6, mass=55.0)
    assert measured.speed == pytest.approx(reference.speed, abs=1e-3)
    assert measured.reference.name == reference.name
    assert (heavier.subject, heavier.speed) == (Subject(height=1.6, mass=60.0), 1.0)


def test_symmetric_models_have_the_nodes_of_their_command(tmp_path):
    found = read(tmp_path, '[base]\nmodel = "planar-symmetric"\n[grid]\nspeed = [1.0]\n')
    assert found.studies["speed=1"] == GaitStudy.planar_symmetric(speed=1.0)


def test_a_python_file_gives_what_it_names(tmp_path):
    (tmp_path / "beside.py").write_text("NODES = 20\n")
    found = read(tmp_path, (
        "from beside import NODES\n"
        "from drakegait import GaitStudy, SolverOptions\n"
        "studies = {'a': GaitStudy.planar(nodes=NODES), 'b': GaitStudy.planar(speed=1.0)}\n"
        "warm = {'b': 'a'}\n"
        "options = SolverOptions(optimality=0.01)\n"
    ), "some.py")  # fmt: skip
    assert found.studies["a"] == GaitStudy.planar(nodes=20)
    assert found.warm == {"b": "a"} and found.options.optimality == 0.01 and found.refine


@pytest.mark.parametrize("name", ["sweep_speed.toml", "sweep_foot_mass.py"])
def test_the_examples_can_be_read(name):
    found = sweep_file.read(EXAMPLES / name)
    assert len(found.studies) >= 4 and set(found.warm) < set(found.studies)


GRID = "[grid]\nspeed = [1.0]\n"
REFUSED = [
    ("", ["[grid]", "[[study]]"]),
    ("x = \n", ["cannot be read", "line 1"]),
    (GRID + "[[study]]\nname = 'a'\n", ["not both"]),
    ("[gird]\nspeed = [1.0]\n", ["section", "'gird'", "mean 'grid'"]),
    ("grid = 3\n", ["grid", "a section [grid]"]),
    ("[grid]\n", ["[grid]", "at least one axis"]),
    ("[grid]\nspeed = 1.0\n", ["speed in [grid]", "1.0", "a list"]),
    ("[grid]\nspeed = []\n", ["speed in [grid]", "at least one"]),
    ("[grid]\nspeed = [1.0, 1.0]\n", ["speed in [grid]", "without repeated"]),
    ("[grid]\nspeed = [1.0, 9.0]\n", ["[grid] speed=9", "9.0", "0.3 to 2.5 [m/s]"]),
    ("[grid]\nspeed = [1.0, 'fast']\n", ["[grid] speed=fast", "'fast'", "0.3 to 2.5"]),
    ("[grid]\nsped = [1.0]\n", ["[grid]", "statement", "'sped'", "mean 'speed'"]),
    ("[grid]\n'added_mass.foot' = [1.0]\n", ["segment", "'foot'", "mean 'foot_r'"]),
    ("[grid]\nadded_mass.foot_r = ['x']\n", ["added mass", "'x'", "[kg]"]),
    ("[base]\nadded_mass = 2.0\n" + GRID, ["[base]", "added_mass", "2.0", "a table"]),
    ("[base]\nadded_mass.foot_r = { mass = 1, at = 2 }\n" + GRID, ["added_mass.foot_r", "point"]),
    ("[base]\nset.frction = 1\n" + GRID, ["setting", "'frction'", "mean 'friction'"]),
    ("[base]\nset.friction = 9.0\n" + GRID, ["friction", "9.0", "0.02 to 2"]),
    ("[base]\nset.friction = 'low'\n" + GRID, ["friction", "'low'", "0.02 to 2"]),
    ("[base]\nlimit.knee = [0, 1]\n" + GRID, ["coordinate of a limit", "'knee'"]),
    ("[base]\nlimit.knee_flexion_r = [9, 1]\n" + GRID, ["limit.knee_flexion_r", "low below"]),
    ("[base]\nweights = 1.0\n" + GRID, ["weights", "1.0", "[energy, deviation]"]),
    ("[base]\nmodel = 'planr'\n" + GRID, ["model", "'planr'", "planar-symmetric"]),
    ("[base]\ndisorders = 3\n" + GRID, ["disorders", "3", "a list"]),
    ("[[study]]\nname = 3\n", ["[[study]] 1: name", "3", "text in quotes"]),
    ("[base]\nnodes = 12.5\n" + GRID, ["nodes", "12.5", "whole number"]),
    ("[base]\nheight = 180\n" + GRID, ["height", "180", "[m]"]),
    ("[base]\nreference = 'nomal'\n" + GRID, ["reference", "'nomal'", "mean 'normal'"]),
    ("[base]\nreference = 'no.csv'\n" + GRID, ["no.csv", "cannot be read"]),
    ("[base]\nsdf = 'no.sdf'\n" + GRID, ["no.sdf", "cannot be read"]),
    ("[base]\nsolver = 'magic'\n" + GRID, ["solver", "'magic'", "snopt"]),
    ("[base]\nmuscle.SOL = 3\n" + GRID, ["muscle.SOL", "3", "l_slack"]),
    ("[base]\nweakness.SOL_l = 'x'\n" + GRID, ["weakness", "'SOL_l=x'", "soleus_l=0.5"]),
    ("[base]\nweakness = 0.5\n" + GRID, ["weakness", "0.5", "a table", "weakness.soleus_l = 0.5"]),
    ("[base]\nreference = 'no.nc'\n" + GRID, ["no.nc", "does not exist"]),
    ("[base]\ninterior_points = 3\n" + GRID, ["[grid] speed=1", "interior_points", "3", "a list"]),
    ("[sweep]\nwarm = 'nodes'\n" + GRID, ["warm in [sweep]", "'nodes'", "speed"]),
    ("[sweep]\nwarm = 3\n" + GRID, ["warm in [sweep]", "3", "an axis"]),
    ("[sweep]\nrefine = 1\n" + GRID, ["refine in [sweep]", "1", "true or false"]),
    ("[sweep]\nwram = 'speed'\n" + GRID, ["key of [sweep]", "'wram'", "mean 'warm'"]),
    ("[[study]]\nspeed = 1.0\n", ["[[study]] 1", "name"]),
    ("[[study]]\nname = 'a'\n[[study]]\nname = 'a'\n", ["[[study]] 2", "'a'", "another"]),
    ("[[study]]\nname = 'a'\nnods = 1\n", ["[[study]] 1, a", "'nods'", "mean 'nodes'"]),
    ("[[study]]\nname = 'a'\nwarm = 'b'\n", ["guess in warm", "'b'"]),
    ("[[study]]\nname = 'a'\n[sweep]\nwarm = 'speed'\n", ["warm in [sweep]", "left out"]),
    ("[[study]]\nname = 'a/b'\n", ["name of a study", "'a/b'"]),
]
REFUSED_PYTHON = [
    ("x = 3\n", ["does not define studies"]),
    ("studies = {}\n", ["studies", "at least one"]),
    ("studies = [1]\n", ["studies", "mapping"]),
    ("studies = {'a': 1}\n", ["study 'a'", "GaitStudy"]),
    ("x = 1\n\n1 / 0\n", ["line 3", "ZeroDivisionError"]),
    ("x = 1\nx ==\n", ["line 2", "SyntaxError"]),
    ("from drakegait import GaitStudy\nGaitStudy(speed=9.0)\n", ["line 2", "speed", "[m/s]"]),
]
FILES = [("some.toml", *case) for case in REFUSED]
FILES += [("some.py", *case) for case in REFUSED_PYTHON]


@pytest.mark.parametrize(("name", "text", "words"), FILES, ids=lambda x: str(x)[:40])
def test_a_bad_file_is_refused_in_one_sentence(capsys, tmp_path, name, text, words):
    pytest.importorskip("distributed")
    file = tmp_path / name
    file.write_text(text)
    sentence = refused(capsys, "sweep", file, "--out", tmp_path / "out")
    assert [word for word in words if word not in sentence] == []
    assert [path for path in tmp_path.iterdir() if path.name != "__pycache__"] == [file]


@pytest.mark.parametrize(("arguments", "words"), [
    (["no.toml"], ["no.toml", "does not exist"]),
    (["no.txt"], ["no.txt", ".toml nor a .py"]),
    ([str(EXAMPLES / "sweep_speed.toml"), "--workers", "two"], ["--workers", "'two'"]),
    ([str(EXAMPLES / "sweep_speed.toml"), "--workers", "0"], ["workers", "0", "from 1"]),
    ([str(EXAMPLES / "sweep_speed.toml"), "--scheduler", "here"], ["scheduler", "'here'"]),
], ids=lambda x: str(x)[-30:])  # fmt: skip
def test_bad_arguments_are_refused(capsys, tmp_path, arguments, words):
    pytest.importorskip("distributed")
    sentence = refused(capsys, "sweep", *arguments, "--out", tmp_path / "out")
    assert [word for word in words if word not in sentence] == []
    assert list(tmp_path.iterdir()) == []


def refused(capsys, *arguments) -> str:
    with pytest.raises(SystemExit) as ending:
        cli.main([str(argument) for argument in arguments])
    out, err = capsys.readouterr()
    assert (ending.value.code, out) == (2, "")
    assert err.startswith("drakegait: ") and err.count("\n") == 1 and "Traceback" not in err
    return err


def test_many_unlike_studies_are_no_grid_and_cost_no_time():
    """Their combinations would be 40^40."""
    unlike = {str(k): {f"axis {axis}": k for axis in range(40)} for k in range(40)}
    assert axes.grid(unlike) is None
    whole = {f"{a}{b}": {"a": a, "b": b} for a in (2, 1) for b in ("x", "y")}
    assert axes.grid(whole) == {"a": [1, 2], "b": ["x", "y"]}
    del whole["1y"]
    assert axes.grid(whole) is None
