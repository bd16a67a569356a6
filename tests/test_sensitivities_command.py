"""`drakegait sensitivities`: what it prints and writes, what it refuses."""

from __future__ import annotations

import pytest
from gait_cases import reference_gait

from drakegait.cli import main
from drakegait.gait import Gait
from drakegait.sensitivities import Sensitivities, Sensitivity


def run(*arguments: str) -> int:
    with pytest.raises(SystemExit) as ending:
        main(["sensitivities", *arguments])
    return ending.value.code or 0


@pytest.fixture
def folder(tmp_path):
    reference_gait("planar-symmetric").save(tmp_path / "gait.nc")
    return tmp_path


def test_a_gait_without_multipliers_is_refused_in_one_sentence(folder, capsys):
    assert run(str(folder)) == 2
    captured = capsys.readouterr()
    assert captured.err.count("\n") == 1
    assert "solve again" in captured.err


@pytest.mark.parametrize("count", ["0", "61"])
def test_how_many_to_print_is_bounded(folder, capsys, count):
    assert run(str(folder), "--count", count) == 2
    assert "--count" in capsys.readouterr().err


def test_the_largest_are_printed_and_all_are_written(folder, capsys, monkeypatch):
    entries = tuple(
        Sensitivity(f"thing {k}", "walk", "m", 2.0, -0.5 * k, 3.0, 0.1, -0.05 * k, 0.3)
        for k in (3, 2, 1)
    )
    answers = Sensitivities(entries, 4.0, 350.0, 1e-5, True, "somebody")
    monkeypatch.setattr(Gait, "sensitivities", lambda gait: answers)
    assert run(str(folder), "--count", "2", "-o", str(folder / "new")) == 0
    printed = capsys.readouterr().out
    assert "thing 3" in printed
    assert "-3.75" in printed  # per cent of f for a step
    assert "thing 1" not in printed
    names = {path.name for path in (folder / "new").iterdir()}
    assert names == {"sensitivities.csv", "sensitivities.svg", "sensitivities.png"}
    assert "thing 1" in (folder / "new" / "sensitivities.csv").read_text()
