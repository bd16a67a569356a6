"""Where commands write: never over what they read, never into a folder that nobody named."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest
from gait_cases import reference_gait

from drakegait import cli

ROOT = Path(__file__).resolve().parents[1]


def run(capsys, *arguments) -> tuple[int, str]:
    """Exit code and standard error."""
    capsys.readouterr()
    with pytest.raises(SystemExit) as ending:
        cli.main([str(argument) for argument in arguments])
    return int(ending.value.code or 0), " ".join(capsys.readouterr().err.split())


@pytest.fixture
def gait_file(tmp_path) -> Path:
    path = tmp_path / "gait.nc"
    reference_gait("planar-symmetric").save(path)
    return path


@pytest.mark.parametrize(
    ("command", "suffix"),
    [
        (("compare", "-o", "GAIT", "GAIT", "GAIT"), ".html"),
        (("replay", "GAIT", "--html", "GAIT"), ".html"),
        (("export", "GAIT", "--sdf", "GAIT"), ".sdf"),
        (("replay", "GAIT", "--html", ""), ".html"),
    ],
)
def test_a_gait_named_as_the_output_stays(capsys, gait_file, command, suffix):
    before = gait_file.read_bytes()
    code, error = run(capsys, *(gait_file if word == "GAIT" else word for word in command))
    assert code == 2 and f"ends in {suffix}" in error
    assert gait_file.read_bytes() == before


def test_an_import_does_not_replace_a_gait(capsys, gait_file, tmp_path):
    before = gait_file.read_bytes()
    for name in ("ik.mot", "grf.mot"):
        (tmp_path / name).write_text("unread")
    code, error = run(
        capsys, "import", tmp_path / "ik.mot", tmp_path / "grf.mot", "--height", "1.8", "--mass",
        "70", "-o", gait_file,
    )  # fmt: skip
    assert code == 2 and "holds no imported walk" in error
    assert gait_file.read_bytes() == before


@pytest.mark.parametrize(
    "command",
    [
        ("export", "GAIT", "--csv", ""),
        ("export", "GAIT", "--opensim", " "),
        ("plot", "GAIT", "--out", ""),
        ("walk", "--out", ""),
        ("sweep", "SWEEP", "--out", ""),
        ("paper", "--out", ""),
        ("fidelity", "--out", " "),
    ],
)
def test_a_folder_without_a_name_is_refused(capsys, gait_file, monkeypatch, command):
    monkeypatch.chdir(gait_file.parent)
    sweep = ROOT / "examples" / "sweep_foot_mass.py"
    files = {"GAIT": gait_file, "SWEEP": sweep}
    code, error = run(capsys, *(files.get(word, word) for word in command))
    assert code == 2 and "this one is called ." in error
    assert [path.name for path in gait_file.parent.iterdir()] == ["gait.nc"]


@pytest.mark.parametrize(
    "command",
    [
        ("check", "GAIT", "--instants", "100000000"),
        ("export", "GAIT", "--csv", "d", "--instants", "1"),
    ],
)
def test_instants_that_no_machine_can_hold_or_that_are_no_curve(capsys, gait_file, command):
    code, error = run(capsys, *(gait_file if word == "GAIT" else word for word in command))
    assert code == 2 and "instants is" in error and "100001" in error


@pytest.mark.skipif(sys.platform == "win32", reason="has no limits on the size of files")
def test_a_full_disk_is_one_sentence_and_leaves_the_old_file(gait_file):
    old = gait_file.read_bytes()
    program = (
        "import resource, signal, sys\n"
        "from drakegait.errors import BadFile\n"
        "from drakegait.gait import Gait\n"
        "gait = Gait.load(sys.argv[1])\n"
        "signal.signal(signal.SIGXFSZ, signal.SIG_IGN)\n"
        "resource.setrlimit(resource.RLIMIT_FSIZE, (20_000, resource.RLIM_INFINITY))\n"
        "try:\n    gait.save(sys.argv[1])\n"
        "except BadFile as error:\n    print(error)\n"
    )
    done = subprocess.run(
        [sys.executable, "-c", program, str(gait_file)], capture_output=True, text=True
    )
    assert done.returncode == 0, done.stderr
    assert done.stdout.count("\n") == 1 and "cannot be written (File too large)" in done.stdout
    assert gait_file.read_bytes() == old
    assert [path.name for path in gait_file.parent.iterdir()] == ["gait.nc"]
