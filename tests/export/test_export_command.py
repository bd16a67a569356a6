"""`drakegait export` on the command line."""

from __future__ import annotations

import pytest
from gait_cases import reference_gait

from drakegait.cli import main


@pytest.fixture(scope="module")
def gait_file(tmp_path_factory):
    path = tmp_path_factory.mktemp("walk") / "gait.nc"
    reference_gait("planar").save(path)
    return path


def run(capsys, *arguments) -> tuple[int, str, str]:
    with pytest.raises(SystemExit) as ending:
        main([str(each) for each in ("export", *arguments)])
    shown = capsys.readouterr()
    return ending.value.code or 0, shown.out, shown.err


def test_all_at_once(capsys, tmp_path, gait_file):
    folder, tables, model = tmp_path / "os", tmp_path / "csv", tmp_path / "walker.sdf"
    code, out, err = run(
        capsys, gait_file.parent, "--opensim", folder, "--csv", tables, "--sdf", model,
        "--instants", 51, "--strides", 2, "--muscles", "actuators",
    )  # fmt: skip
    assert (code, err) == (0, "")
    assert "has not converged (time_limit)" in out
    assert "model.osim" in out and "coordinates.csv" in out and str(model) in out
    assert "nRows=101" in (folder / "coordinates.mot").read_text(encoding="utf-8")
    assert "PathActuator" in (folder / "model.osim").read_text(encoding="utf-8")
    assert len((tables / "coordinates.csv").read_text(encoding="utf-8").splitlines()) == 52
    assert model.read_text(encoding="utf-8").startswith("<?xml")


def test_only_what_is_asked_for(capsys, tmp_path, gait_file):
    assert run(capsys, gait_file, "--sdf", tmp_path / "sub" / "w.sdf")[0] == 0
    assert [path.name for path in tmp_path.iterdir()] == ["sub"]


REFUSED = [
    ([], ["at least one of", "--opensim", "--csv", "--sdf"]),
    (["--opensim", "{out}", "--muscles", "hill"], ["'hill'", "degroote_fregly, actuators, none"]),
    (["--opensim", "{out}", "--strides", "0"], ["strides", "0", "1 to 20"]),
    (["--opensim", "{out}", "--instants", "1"], ["num", "1", "whole number"]),
    (["--csv", "{out}", "--instants", "many"], ["--instants", "'many'", "a whole number"]),
]


@pytest.mark.parametrize(("options", "words"), REFUSED, ids=lambda x: " ".join(x)[:40])
def test_bad_input_is_refused_in_one_sentence(capsys, tmp_path, gait_file, options, words):
    options = [option.format(out=tmp_path / "out") for option in options]
    code, out, err = run(capsys, gait_file, *options)
    assert code == 2 and err.startswith("drakegait: ") and err.count("\n") == 1
    assert [word for word in words if word not in err] == []
    assert not (tmp_path / "out").exists()


def test_a_missing_gait_is_named(capsys, tmp_path):
    code, _, err = run(capsys, tmp_path / "gait.nc", "--csv", tmp_path / "out")
    assert code == 2 and "gait.nc" in err and "does not exist" in err
