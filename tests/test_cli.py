"""The command line as a user meets it: refusals, help, files, exit codes."""

from __future__ import annotations

import dataclasses
import inspect
import json
import os
import re
import signal
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from gait_cases import reference_gait

from drakegait import cli
from drakegait.commands import constants
from drakegait.commands import walk as walk_command
from drakegait.commands.request import WalkRequest
from drakegait.errors import BadFile
from drakegait.gait import Gait
from drakegait.reference.reference import Reference
from drakegait.study import MODELS, GaitStudy
from drakegait.summary import CHECKED
from drakegait.whole_file import write_json

ROOT = Path(__file__).resolve().parents[1]
TINY = ("--model", "planar-symmetric", "--nodes", "11")


def run(capsys, *arguments) -> tuple[int, str, str]:
    """Exit code, standard output and standard error of `drakegait ARGUMENTS`."""
    capsys.readouterr()
    with pytest.raises(SystemExit) as ending:
        cli.main([str(argument) for argument in arguments])
    return int(ending.value.code or 0), *capsys.readouterr()


def process(*arguments, **options) -> subprocess.Popen:
    environment = os.environ | {"PYTHONPATH": str(ROOT), "OMP_NUM_THREADS": "1"}
    command = [sys.executable, "-m", "drakegait.cli", *map(str, arguments)]
    return subprocess.Popen(
        command, env=environment, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
        **options,
    )  # fmt: skip


@pytest.fixture(scope="module")
def gait_file(tmp_path_factory) -> Path:
    path = tmp_path_factory.mktemp("gait") / "gait.nc"
    reference_gait("planar-symmetric").save(path)
    return path


# Bad input ---------------------------------------------------------------------------------

REFUSED = [
    (["--added-mass", "foot=2"], ["segment", "'foot'", "thigh_r", "mean 'foot_r'"]),
    (["--added-mass", "foot_r"], ["--added-mass", "'foot_r'", "SEGMENT=KG"]),
    (["--added-mass", "foot_r=two"], ["--added-mass", "'foot_r=two'", "[kg, m]"]),
    (["--added-mass", "foot_r=-1"], ["added mass", "-1.0", "at most 30 [kg]"]),
    (["--added-mass", "foot_r=2@1,2"], ["point", "(1.0, 2.0)", "three numbers"]),
    (["--strength", "solus_l=0.5"], ["muscle", "'solus_l'", "vasti_r", "mean 'soleus_l'"]),
    (["--strength", "soleus_l=50"], ["strength of soleus_l", "50.0", "0.01 to 10"]),
    (["--strength", "soleus_l"], ["--strength", "'soleus_l'", "MUSCLE=FACTOR"]),
    (["--muscle", "SOL=0.2"], ["--muscle", "'SOL=0.2'", "MUSCLE.ENTRY=VALUE"]),
    (["--muscle", "SOL.l_slack=long"], ["--muscle", "SOL.l_slack=long"]),
    (["--muscle", "SOL.slack=0.2"], ["muscle entry", "'slack'", "l_slack"]),
    (["--muscle", "SOLE.l_slack=0.2"], ["muscle", "'SOLE'", "soleus_r"]),
    (["--muscle", "SOL.l_slack=-1"], ["l_slack of SOL", "-1.0", "0.0508 to 1.27"]),
    (["--set", "sequence=321"], ["sequence", "'321'", "213, 123"]),
    (["--set", "frction=0.4"], ["setting", "'frction'", "tendon_strain", "mean 'friction'"]),
    (["--set", "friction=-1"], ["friction", "-1.0", "0.02 to 2"]),
    (["--set", "friction=nan"], ["friction", "nan", "0.02 to 2"]),
    (["--set", "friction=low"], ["friction", "'low'", "0.02 to 2"]),
    (["--set", "friction"], ["--set", "'friction'", "NAME=VALUE"]),
    (["--set", "basal=perhaps"], ["basal", "'perhaps'", "on or off"]),
    (["--set", "energy.model=hill"], ["model", "'hill'", "umberger2003, umberger2010"]),
    (["--set", "height=1.7"], ["--set", "'height=1.7'", "--height"]),
    (["--set", "solver.time_limit=5"], ["--set", "--time-limit"]),
    (["--set", "max_iterations=0"], ["max_iterations", "0.0", "from 1"]),
    (["--model", "spatiall"], ["model", "'spatiall'", "planar-symmetric", "mean 'spatial'"]),
    (["--nodes", "5"], ["nodes", "5", "10 to 141"]),
    (["--nodes", "12.5"], ["--nodes", "'12.5'", "a whole number"]),
    (["--model", "spatial-symmetric", "--nodes", "18"], ["nodes", "18", "odd"]),
    (["--speed", "fast"], ["--speed", "'fast'", "a number"]),
    (["--speed", "nan"], ["speed", "nan", "0.3 to 2.5 [m/s]"]),
    (["--speed", "12"], ["speed", "12.0", "0.3 to 2.5 [m/s]"]),
    (["--height", "180"], ["height", "180.0", "1.2 to 2.2 [m]"]),
    (["--mass", "inf"], ["mass", "inf", "30 to 200 [kg]"]),
    (["--weights", "0", "0"], ["weights", "(0.0, 0.0)", "positive"]),
    (["--weights", "-1", "1"], ["energy weight", "-1.0", "0 to 1000"]),
    (["--weights", "1", "x"], ["--weights", "'1 x'", "two numbers"]),
    (["--weights", "1"], ["--weights", "2 arguments"]),
    (["--weights", "1", "--nodes", "20"], ["--weights", "'1 --nodes'", "two numbers"]),
    (["--solver", "knitro"], ["solver", "'knitro'", "condensed, ipopt-mumps, ipopt, snopt"]),
    (["--multipliers", "penalty"], ["multipliers", "'penalty'", "lifted, projected"]),
    (["--time-limit", "-3"], ["time_limit", "-3.0", "[s]"]),
    (["--limit", "knee=0:60"], ["coordinate of a limit", "'knee'", "knee_flexion_r"]),
    (["--limit", "hat_x=0:1"], ["coordinate of a limit", "'hat_x'"]),
    (["--limit", "knee_flexion_r=60:0"], ["--limit", "low end"]),
    (["--limit", "knee_flexion_r=nan:60"], ["--limit", "low end"]),
    (["--limit", "knee_flexion_r=:"], ["--limit", "LOW:HIGH"]),
    (["--set", "friction=0.4", "--set", "contact.friction=0.5"], ["contact.friction=0.5", "once"]),
    (["--strength", "SOL=0.5", "--strength", "SOL=0.9"], ["'SOL=0.9'", "stated once for SOL"]),
    (["--muscle", "SOL.l0=0.3", "--muscle", "SOL.l0=0.31"], ["'SOL.l0=0.31'", "once for SOL.l0"]),
    (["--muscle", "SOL.l_slack=240"], ["l_slack of SOL", "240.0", "0.0508 to 1.27"]),
    (["--muscle", "SOL.color=-1"], ["muscle entry", "'color'", "l_opt"]),
    (["--set", "max_iterations=1.5"], ["max_iterations", "1.5", "a whole number"]),
    (["--model", "planar-symmetric", "--nodes", "19", "--limit", "knee_flexion_r=0:60"],
     ["limit", "0 to 60 degrees of knee_flexion_r", "both sides"]),
    (["--planar-muscles", "many", "--model", "planar"], ["'many'", "table3, gait2d"]),
    (["--reference", "nomal"],
     ["--reference", "'nomal'", "measured", "path of a file", "mean 'normal'"]),
    (["--reference", "missing.csv"], ["missing.csv", "cannot be read"]),
    (["--guess", "missing.nc"], ["missing.nc", "does not exist"]),
    (["--starts", "0"], ["starts", "whole number from 1"]),
    (["--starts", "3", "--seed", "-2"], ["seed", "whole number from 0"]),
    (["--bogus", "3"], ["--bogus", "drakegait walk --help"]),
    (["surplus"], ["surplus", "drakegait walk --help"]),
]


@pytest.fixture
def no_solve(monkeypatch):
    def solve(*_, **__):
        raise AssertionError("a solve was started")

    monkeypatch.setattr(walk_command, "solve", solve)


def refused(capsys, *arguments) -> str:
    """The one sentence with which a command is refused."""
    code, out, err = run(capsys, *arguments)
    assert (code, out) == (2, "")
    assert err.startswith("drakegait: ") and err.count("\n") == 1 and len(err) > 30
    assert "Traceback" not in err
    return err


@pytest.mark.parametrize(("options", "words"), REFUSED, ids=lambda x: " ".join(x)[:40])
def test_bad_input_is_refused_in_one_sentence(capsys, tmp_path, no_solve, options, words):
    sentence = refused(capsys, "walk", "--out", tmp_path / "deep" / "out", *options)
    assert [word for word in words if word not in sentence] == []
    assert list(tmp_path.iterdir()) == []


def _edit_row(text: str, row: int, column: str, cell: str) -> str:
    lines = text.splitlines()
    heading = next(k for k, line in enumerate(lines) if line.startswith("percent"))
    place = [name.split(" ")[0] for name in lines[heading].split(",")].index(column)
    cells = lines[heading + row].split(",")
    cells[place] = cell
    lines[heading + row] = ",".join(cells)
    return "\n".join(lines)


def _head(text: str, lines: int) -> str:
    return "\n".join(text.splitlines()[:lines])


DAMAGES = {
    "gap": (lambda t: _edit_row(t, 7, "knee_flexion_r", ""), ["knee_flexion_r", "empty"]),
    "nan": (lambda t: _edit_row(t, 7, "knee_flexion_r", "nan"), ["knee_flexion_r", "nan"]),
    "wrong column": (lambda t: t.replace("hip_flexion_l", "hip_flexxion_l"), ["hip_flexxion_l"]),
    "degrees": (lambda t: t.replace("[deg]", "[rad]"), ["degrees stated as radians"]),
    "radians": (
        lambda t: re.sub(r"(hat_tilt|\w+_[rl]) \[deg\]", r"\1 [deg]", t)
        .replace("[m]", "[mm]"),
        ["1000 times"],
    ),
    "no phases": (lambda t: t.replace("# phase_fractions", "# no"), ["no", "phase_fractions"]),
    "half a stride": (lambda t: _head(t, 25), ["percent"]),
    "no table": (lambda t: "hello", ["no heading"]),
}  # fmt: skip


@pytest.mark.parametrize("name", DAMAGES)
def test_a_damaged_reference_is_refused(capsys, tmp_path, no_solve, name):
    damage, words = DAMAGES[name]
    table = tmp_path / "table.csv"
    Reference.embedded("planar").save(table, rows=41)
    table.write_text(damage(table.read_text()))
    out = tmp_path / "out"
    sentence = refused(capsys, "walk", "--model", "planar", "--reference", table, "--out", out)
    assert [word for word in words if word not in sentence] == []
    assert not out.exists()


def test_a_sound_reference_and_guess_are_taken(tmp_path, gait_file):
    table = tmp_path / "table.csv"
    Reference.embedded("planar").save(table)
    study, options, guess = request(
        model="planar", reference=str(table), guess=str(gait_file), set_=["optimality=0.01"]
    ).prepare()
    assert study.reference.name == "table.csv"
    assert guess.study.model == "planar-symmetric"
    assert options.optimality == 0.01


@pytest.mark.parametrize("command", ["check", "plot", "replay", "walk"])
@pytest.mark.parametrize("fault", ["foreign", "cut", "netcdf", "missing", "folder"])
def test_a_file_that_is_no_gait_is_refused(capsys, tmp_path, no_solve, gait_file, command, fault):
    import xarray

    path = tmp_path / "gait.nc"
    if fault == "foreign":
        path.write_text("hello")
    elif fault == "cut":
        path.write_bytes(gait_file.read_bytes()[:50_000])
    elif fault == "netcdf":
        xarray.Dataset({"a": ("x", [1.0])}).to_netcdf(path, engine="h5netcdf")
    elif fault == "folder":
        path = tmp_path
    before = sorted(tmp_path.iterdir())
    extra = ["walk", "--out", tmp_path / "out", "--guess"] if command == "walk" else [command]
    assert str(path) in refused(capsys, *extra, path)
    assert sorted(tmp_path.iterdir()) == before


def test_a_guess_of_another_skeleton_is_refused(capsys, tmp_path, no_solve, gait_file):
    sentence = refused(capsys, "walk", "--out", tmp_path / "out", "--guess", gait_file)
    assert "'planar-symmetric'" in sentence and "spatial-symmetric" in sentence
    assert list(tmp_path.iterdir()) == []


def test_folders_that_cannot_take_the_results_are_refused(capsys, tmp_path, no_solve):
    file = tmp_path / "file"
    file.write_text("mine")
    assert "is a file" in refused(capsys, "walk", *TINY, "--out", file)
    assert "Not a directory" in refused(capsys, "walk", *TINY, "--out", file / "deeper")
    (tmp_path / "out" / "gait.nc").mkdir(parents=True)
    assert "is a folder" in refused(capsys, "walk", *TINY, "--out", tmp_path / "out")
    assert file.read_text() == "mine"


@pytest.mark.skipif(os.geteuid() == 0, reason="root may write anywhere")
def test_a_folder_without_permission_is_refused(capsys, tmp_path, no_solve):
    tmp_path.chmod(0o500)
    assert "Permission denied" in refused(capsys, "walk", *TINY, "--out", tmp_path / "out")


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["check", "GAIT", "--instants", "5"], ["instants", "5", "100"]),
        (["check", "GAIT", "--instants", "many"], ["--instants", "'many'"]),
        (["replay", "GAIT", "--strides", "0", "--html", "x.html"], ["strides", "1 to 20"]),
        (["replay", "GAIT", "--port", "80"], ["port", "80", "1024 to 65535"]),
        (["plot", "GAIT", "--out", "GAIT"], ["is a file", "folder"]),
        (["plot", "GAIT", "--with", "other.nc"], ["other.nc", "does not exist"]),
        (["wlk"], ["'wlk'", "drakegait --help"]),
        (["check"], ["GAIT"]),
    ],
)
def test_other_commands_refuse_likewise(capsys, monkeypatch, tmp_path, gait_file, arguments, words):
    monkeypatch.chdir(tmp_path)
    arguments = [gait_file if word == "GAIT" else word for word in arguments]
    sentence = refused(capsys, *arguments)
    assert [word for word in words if word not in sentence] == []
    assert list(tmp_path.iterdir()) == []


# Options -----------------------------------------------------------------------------------


def request(**options) -> WalkRequest:
    """A request with the defaults of the command line."""
    parameters = inspect.signature(cli.walk.walk).parameters.values()
    defaults = {p.name: p.default for p in parameters if p.name != "context"}
    return WalkRequest(**(defaults | options))


@pytest.mark.parametrize("model", MODELS)
def test_defaults_are_those_of_the_study(model):
    study, options, guess = request(model=model).prepare()
    assert study == getattr(GaitStudy, model.replace("-", "_"))()
    assert options == type(options)()
    assert guess is None


def test_options_reach_the_study():
    study, options, _ = request(
        model="planar", nodes=20, speed=1.0, weights=(0.5, 2.0), height=1.7, mass=60.0,
        added_mass=["foot_r=2.0", "hat=5@0.1,0,0.3"], strength=["SOL=0.5", "vasti_l=2"],
        limit=["knee_flexion_r=:45", "hat_z=0.8:1.1", "hip_flexion_l=-10:"],
        set_=["friction=0.5", "energy.model=umberger2010", "basal=on", "anthropometry=deleva",
              "muscles.a_rel=0.3", "optimality=1e-4"],
        planar_muscles="gait2d", multipliers="projected", solver="snopt", time_limit=7.0,
        reference="asymmetric",
    ).prepare()  # fmt: skip
    assert (study.nodes, study.speed) == (20, 1.0)
    assert (study.energy_weight, study.deviation_weight) == (0.5, 2.0)
    assert study.subject.to_dict() == {"height": 1.7, "mass": 60.0, "anthropometry": "deleva"}
    assert [(m.segment, m.mass, m.point) for m in study.added_masses] == [
        ("foot_r", 2.0, None),
        ("hat", 5.0, (0.1, 0.0, 0.3)),
    ]
    assert study.strength == {"SOL": 0.5, "vasti_l": 2.0}
    knee, height, hip = study.limits
    assert knee.high == pytest.approx(0.785398) and knee.low == -float("inf")
    assert (height.low, height.high) == (0.8, 1.1)
    assert hip.low == pytest.approx(-0.174533) and hip.high == float("inf")
    assert study.contact.friction == 0.5
    assert (study.energy.model, study.energy.basal) == ("umberger2010", True)
    assert study.muscles.a_rel == 0.3
    assert (options.solver, options.time_limit, options.optimality) == ("snopt", 7.0, 1e-4)
    assert study.reference.name == "asymmetric" and study.planar_muscles == "gait2d"


def test_a_named_reference_follows_subject_and_settings():
    study, *_ = request(height=1.6, reference="normal", set_=["sigma_rule=printed"]).prepare()
    assert study.reference_walk.deviation.sigma_rule == "printed"
    normal = Reference.embedded("spatial")
    ratio = study.reference.foot_placement.stride_length / normal.foot_placement.stride_length
    assert ratio == pytest.approx(1.6 / 1.8)


# Help --------------------------------------------------------------------------------------

LOUD = {"COLUMNS": "200", "TERMINAL_WIDTH": "200", "NO_COLOR": "1"}


def test_help_explains_every_option_and_constant(capsys, monkeypatch):
    for name, value in LOUD.items():
        monkeypatch.setenv(name, value)
    code, out, _ = run(capsys, "walk", "--help")
    assert code == 0
    for name in ("--model", "--nodes", "--speed", "--height", "--mass", "--added-mass",
                 "--strength", "--limit", "--weights", "--solver", "--multipliers", "--guess",
                 "--time-limit", "--refine", "--no-refine", "--no-pictures", "--out", "--set",
                 "--reference", "m/s", "kg", "degrees"):  # fmt: skip
        assert name in out
    for name in constants.catalogue():
        assert name in out
    for model in MODELS:
        assert model in out and str(getattr(GaitStudy, model.replace("-", "_"))().nodes) in out
    friction = next(line for line in out.splitlines() if line.strip().startswith("moment_tol"))
    assert "2 N m" in friction and "0.01 to 50 N m" in friction and "rotations" in friction


@pytest.mark.parametrize("command", ["check", "plot", "replay"])
def test_help_of_the_other_commands(capsys, command):
    code, out, _ = run(capsys, command, "--help")
    assert code == 0 and "GAIT" in out


def test_help_needs_nothing_heavy():
    """`drakegait --help` answers at once because it imports no numerics and no Drake."""
    code = (
        "import sys\n"
        "from drakegait.cli import main\n"
        "try:\n    main(['--help'])\nexcept SystemExit:\n    pass\n"
        "heavy = {'numpy', 'scipy', 'pydrake', 'casadi', 'matplotlib', 'xarray'}\n"
        "sys.exit(str(heavy & set(sys.modules)) if heavy & set(sys.modules) else 0)\n"
    )
    done = subprocess.run([sys.executable, "-c", code], cwd=ROOT, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert "replay" in done.stdout


def test_a_walk_loads_no_library_that_it_can_do_without(tmp_path):
    """From the prompt to `gait.nc`: what is slow to import is for pictures, tables and clusters."""
    code = (
        "import sys\n"
        "from drakegait.cli import main\n"
        "try:\n    main(sys.argv[1:])\nexcept SystemExit as end:\n    code = end.code\n"
        "slow = {'xarray', 'pandas', 'dask', 'distributed', 'matplotlib', 'scipy.interpolate',\n"
        "        'scipy.optimize', 'scipy.special', 'pydrake.all', 'jinja2', 'ezc3d'}\n"
        "print(code, sorted(slow & set(sys.modules)), 'casadi' in sys.modules)\n"
    )
    # Ended by the time limit at once: what is loaded does not hang on the number of iterations.
    walk = ["walk", "--model", "planar-symmetric", "--nodes", "13", "--time-limit", "0.1"]
    walk += ["--no-pictures", "--out", str(tmp_path)]
    command = [sys.executable, "-c", code, *walk]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True)
    assert done.stdout.splitlines()[-1] == "3 [] True", done.stdout + done.stderr
    assert {path.name for path in tmp_path.iterdir()} == {"gait.nc", "summary.json"}


def test_version(capsys):
    code, out, _ = run(capsys, "--version")
    assert code == 0 and out.startswith("drakegait ")


# Looking at a saved gait -------------------------------------------------------------------


def test_check_judges_and_tells_by_its_exit_code(capsys, gait_file):
    code, out, _ = run(capsys, "check", gait_file, "--instants", "200")
    assert code == 3  # the reference walk with fitted forces is no solution
    assert "NOT passed" in out and "has not converged (time_limit)" in out
    assert "equations of motion, moments" in out


def test_plot_and_replay_write_files(capsys, gait_file, tmp_path):
    code, out, _ = run(capsys, "plot", gait_file.parent, "--out", tmp_path / "pictures")
    assert code == 0 and "joint_angles" in out
    assert len(list((tmp_path / "pictures").glob("*.svg"))) >= 5
    page = tmp_path / "walk.html"
    code, out, err = run(capsys, "replay", gait_file, "--html", page, "--strides", "1")
    assert (code, err) == (0, "") and str(page) in out
    assert page.stat().st_size > 1e5


def test_the_summary_is_valid_json_and_replaced_at_once(tmp_path, monkeypatch):
    path = tmp_path / "summary.json"
    write_json(path, {"a": float("nan"), "b": [1.0, float("inf")], "c": {"d": "x"}})
    assert json.loads(path.read_text()) == {"a": None, "b": [1.0, None], "c": {"d": "x"}}

    def full(*_, **__):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(Path, "replace", full)
    with pytest.raises(BadFile, match="No space left"):
        write_json(path, {"a": 2.0})
    assert [item.name for item in tmp_path.iterdir()] == ["summary.json"]
    assert json.loads(path.read_text())["a"] is None


# Walking -----------------------------------------------------------------------------------


HASTY = ("--no-pictures", "--no-refine", "--set", "optimality=0.01")


@pytest.fixture(scope="module")
def walked(tmp_path_factory) -> tuple[subprocess.CompletedProcess, Path]:
    out = tmp_path_factory.mktemp("walk") / "new" / "folder"
    running = process("walk", *TINY, "--out", out, *HASTY)
    printed, err = running.communicate(timeout=300)
    return subprocess.CompletedProcess([], running.returncode, printed, err), out


@pytest.mark.solve
def test_another_process_finds_the_same_bits(walked, tmp_path):
    _, out = walked
    process("walk", *TINY, "--out", tmp_path, *HASTY).communicate(timeout=300)
    one, other = (Gait.load(folder / "gait.nc") for folder in (out, tmp_path))
    assert one.outcome.iterations == other.outcome.iterations and one.cost == other.cost
    for item in dataclasses.fields(one.values):
        np.testing.assert_array_equal(
            getattr(one.values, item.name), getattr(other.values, item.name), err_msg=item.name
        )
    np.testing.assert_array_equal(one.kkt.rows, other.kkt.rows)


@pytest.mark.solve
def test_walk_from_start_to_files(walked):
    done, out = walked
    assert (done.returncode, done.stderr) == (0, "")
    assert sorted(path.name for path in out.iterdir()) == ["gait.nc", "summary.json"]
    assert re.search(r"iteration 0 +cost [\d.]+ +\S+ left  [\d.]+ x tolerance: \w+", done.stdout)
    assert "Converged after" in done.stdout and "equations of motion, forces" in done.stdout
    assert f"Files in {out}: gait.nc, summary.json." in done.stdout
    gait = Gait.load(out / "gait.nc")
    summary = json.loads((out / "summary.json").read_text())
    assert gait.converged and summary["solver"]["status"] == "converged"
    assert (summary["model"], summary["nodes"]) == ("planar-symmetric", 11)
    assert set(summary["check"]) == set(CHECKED)
    assert summary["gait"]["speed_m_per_s"] == pytest.approx(1.2, abs=2e-3)
    if not summary["check"]["passed"]:
        assert "did NOT pass" in done.stdout


@pytest.mark.solve
def test_walk_continues_from_a_gait_and_draws(walked, tmp_path, capsys):
    _, guess = walked
    code, out, err = run(
        capsys, "walk", *TINY, "--out", tmp_path, "--guess", guess, "--no-refine",
        "--set", "optimality=0.01",
    )  # fmt: skip
    assert (code, err) == (0, "")
    names = sorted(path.name for path in tmp_path.iterdir())
    assert names == ["figures", "gait.nc", "replay.html", "summary.json"]
    assert "figures/, replay.html" in out
    again = Gait.load(tmp_path / "gait.nc")
    # Warm, it starts beside its end: within a small part of the cost of the first solve.
    first = Gait.load(guess / "gait.nc")
    assert again.cost["total"] == pytest.approx(first.cost["total"], rel=0.01)


@pytest.mark.solve
def test_the_time_limit_saves_the_best_gait(capsys, tmp_path):
    code, out, _ = run(
        capsys, "walk", "--model", "planar", "--out", tmp_path, "--no-pictures",
        "--time-limit", "1",
    )  # fmt: skip
    assert code == 3
    assert "NOT CONVERGED (time_limit)" in out and "Holds least: " in out
    assert "What to try: " in out
    assert json.loads((tmp_path / "summary.json").read_text())["solver"]["status"] == "time_limit"
    assert not Gait.load(tmp_path / "gait.nc").converged


@pytest.mark.solve
def test_ctrl_c_saves_the_best_gait(tmp_path):
    running = process("walk", "--out", tmp_path, "--no-pictures", "--nodes", "18")
    first = [running.stdout.readline() for _ in range(2)]
    assert "Ctrl-C" in first[0] and "iteration 0" in first[1]
    running.send_signal(signal.SIGINT)
    out, err = running.communicate(timeout=60)
    assert (running.returncode, err) == (3, "")
    assert "NOT CONVERGED (interrupted)" in out
    assert Gait.load(tmp_path / "gait.nc").outcome.status == "interrupted"
    assert sorted(p.name for p in tmp_path.iterdir()) == ["gait.nc", "summary.json"]


@pytest.mark.parametrize("wrapped", [False, True])
def test_ctrl_c_before_the_solve_leaves_nothing(capsys, monkeypatch, tmp_path, wrapped):
    def prepare(_):
        if wrapped:  # what happens while Drake's libraries are loaded
            cause = ImportError("initialization failed")
            cause.__cause__ = KeyboardInterrupt()
            raise ImportError("of the module that imports it") from cause
        raise KeyboardInterrupt

    monkeypatch.setattr(WalkRequest, "prepare", prepare)
    code, out, err = run(capsys, "walk", "--out", tmp_path / "out")
    assert (code, out, err.strip()) == (130, "", "drakegait: interrupted.")
    assert not list(tmp_path.iterdir())
