"""From a laboratory's files to a compared report, in two commands."""

from __future__ import annotations

import pytest
from measured_cases import SUBJECT, Lab

from drakegait import cli
from drakegait.gait import Gait


def run(*arguments) -> int:
    with pytest.raises(SystemExit) as ending:
        cli.main([str(argument) for argument in arguments])
    return int(ending.value.code or 0)


@pytest.mark.solve
def test_files_become_a_compared_report(tmp_path, capsys):
    motion, forces = Lab().write(tmp_path)
    size = ("--height", SUBJECT.height, "--mass", SUBJECT.mass)
    assert run("import", motion, forces, *size, "-o", tmp_path / "me.nc") == 0
    out = tmp_path / "weak"
    assert run(
        "walk", "--reference", tmp_path / "me.nc", "--weakness", "soleus=0.5", "--compare",
        "--model", "planar-symmetric", "--nodes", "15", "--no-refine", "--no-pictures",
        "--set", "optimality=0.01", "--out", out,
    ) == 0  # fmt: skip
    for folder in (out / "unchanged", out):
        gait = Gait.load(folder / "gait.nc")
        assert gait.study.subject == SUBJECT
        assert gait.speed == pytest.approx(Lab().reference.speed, rel=0.01)
    page = (out / "report.html").read_text()
    assert "ik.mot, stride from" in page  # whose walk it is
    assert "50 % of its strength" in page
    assert "Report in" in capsys.readouterr().out
