"""`drakegait explain` and the end of `drakegait walk`: what is printed, saved and refused."""

from __future__ import annotations

import dataclasses
import json

import pytest
from gait_cases import reference_gait

from drakegait import cli
from drakegait.commands import explain as explain_command
from drakegait.commands import walk as walk_command
from drakegait.errors import InvalidInput
from drakegait.gait import Gait
from drakegait.infeasibility.explanation import Explanation, Remedy
from drakegait.infeasibility.place import Place

PLACE = Place("muscles", "left hip abduction", "right toe off", 61.6, 11.7, "N m", ("GMEDP",))


def gait_that_ended(status: str) -> Gait:
    gait = reference_gait("planar-symmetric")
    return dataclasses.replace(gait, outcome=dataclasses.replace(gait.outcome, status=status))


def conflict() -> Explanation:
    walk = gait_that_ended("converged")
    return Explanation(
        "conflict", ("muscles", "speed", "balance"), ("the strength of the muscles",
        "a speed of 1.2 m/s"), ("the balance of forces on the whole body",), smallest=True,
        unique=True, place=PLACE, remedies=(Remedy("at 1.15 m/s", walk.study, walk),),
    )  # fmt: skip


def run(capsys, *arguments) -> tuple[int, str, str]:
    capsys.readouterr()
    with pytest.raises(SystemExit) as ending:
        cli.main([str(argument) for argument in arguments])
    return int(ending.value.code or 0), *capsys.readouterr()


@pytest.fixture
def told(monkeypatch):
    """What `explain` is asked; it answers with `conflict`."""
    asked = []

    def explain(gait, **more):
        asked.append((gait, more))
        more["report"]("giving up speed", None)
        return conflict()

    monkeypatch.setattr(explain_command, "explain", explain)
    return asked


@pytest.fixture
def ended(monkeypatch):
    """Lets `walk` end with a status, without solving."""

    def with_status(status: str) -> None:
        monkeypatch.setattr(walk_command, "solve", lambda study, **more: gait_that_ended(status))

    return with_status


WALK = ("walk", "--model", "planar-symmetric", "--nodes", "19", "--no-pictures", "--out")
SENTENCES = (
    "Left hip abduction lacks 12 N m at 62 % of the stride (right toe off): GMEDP saturated.",
    "Cannot all hold: the strength of the muscles, a speed of 1.2 m/s; with them: the balance of "
    "forces on the whole body (give up any one, and the rest can hold).",
    "Feasible at 1.15 m/s (solved again, check passed).",
)


def test_further_conflicts_are_mentioned_where_there_are_some():
    one = conflict()
    several = dataclasses.replace(one, unique=False)
    further = "There are further conflicts beside this one."
    assert further not in one.sentences and further in several.sentences
    assert further not in dataclasses.replace(several, smallest=False).sentences


def test_walks_that_explained_another_question_are_named_and_then_replaced(
    capsys, tmp_path, told, ended
):
    for name in ("remedy_1.nc", "remedy_2.nc", "feasible.nc"):
        (tmp_path / name).write_bytes(b"of an earlier question")
    ended("converged")
    _, out, _ = run(capsys, *WALK, tmp_path)
    assert "feasible.nc, remedy_1.nc, remedy_2.nc" in out and "of an earlier walk" in out
    ended("infeasible")
    _, out, _ = run(capsys, *WALK, tmp_path)
    assert "of an earlier walk" not in out
    assert [path.name for path in sorted(tmp_path.glob("*.nc"))] == ["gait.nc", "remedy_1.nc"]
    assert Gait.load(tmp_path / "remedy_1.nc").converged


@pytest.mark.parametrize("status", ["infeasible", "failed", "iteration_limit"])
def test_a_walk_that_was_not_found_ends_with_the_explanation(capsys, tmp_path, told, ended, status):
    ended(status)
    code, out, _ = run(capsys, *WALK, tmp_path)
    assert code == 3
    assert all(sentence in out for sentence in SENTENCES)
    assert "explaining: giving up speed" in out
    summary = json.loads((tmp_path / "summary.json").read_text())
    assert summary["explanation"]["verdict"] == "conflict"
    assert summary["explanation"]["sentences"] == list(SENTENCES)
    assert summary["explanation"]["place"]["saturated_muscles"] == ["GMEDP"]
    assert Gait.load(tmp_path / "remedy_1.nc").converged
    assert told[0][1]["time_limit"] == pytest.approx(300.0)


@pytest.mark.parametrize("status", ["converged", "time_limit", "interrupted"])
def test_what_was_found_or_ended_early_is_not_explained(capsys, tmp_path, told, ended, status):
    ended(status)
    run(capsys, *WALK, tmp_path)
    assert not told
    assert "explanation" not in json.loads((tmp_path / "summary.json").read_text())


def test_it_can_be_left_out_and_stays_within_the_time_limit(capsys, tmp_path, told, ended):
    ended("infeasible")
    assert run(capsys, *WALK, tmp_path, "--no-explain")[0] == 3
    assert not told
    run(capsys, *WALK, tmp_path, "--time-limit", "60")
    assert 0.0 < told[0][1]["time_limit"] <= 60.0
    told.clear()
    code, out, _ = run(capsys, *WALK, tmp_path, "--time-limit", "2")
    assert not told and code == 3 and "No time is left to explain it" in out


def test_where_it_cannot_be_explained_the_walk_is_saved_nevertheless(
    capsys, tmp_path, ended, monkeypatch
):
    def refuse(gait, **more):
        raise InvalidInput("eom_form", "maximum", "'components'")

    monkeypatch.setattr(explain_command, "explain", refuse)
    ended("infeasible")
    code, out, _ = run(capsys, *WALK, tmp_path)
    assert code == 3 and (tmp_path / "gait.nc").is_file()
    assert "Not explained: eom_form is 'maximum'" in out


def test_a_saved_gait_is_explained_beside_its_summary(capsys, tmp_path, told, ended):
    ended("infeasible")
    run(capsys, *WALK, tmp_path, "--no-explain")
    before = json.loads((tmp_path / "summary.json").read_text())
    code, out, _ = run(capsys, "explain", tmp_path, "--time-limit", "30", "--remedies", "1")
    assert code == 0 and all(sentence in out for sentence in SENTENCES)
    assert told[0][1]["time_limit"] == 30.0 and told[0][1]["remedies"] == 1
    after = json.loads((tmp_path / "summary.json").read_text())
    assert after.pop("explanation")["conflict"] == ["muscles", "speed", "balance"]
    assert after == before


def test_a_gait_that_converged_is_refused(capsys, tmp_path):
    gait_that_ended("converged").save(tmp_path / "gait.nc")
    code, _, error = run(capsys, "explain", tmp_path)
    assert code == 2
    assert error.strip() == (
        "drakegait: gait to explain is 'converged', but must be one whose solve did not converge."
    )


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["--time-limit", "0"], ["time_limit", "0.0", "1 to 1e+06 [s]"]),
        (["--time-limit", "soon"], ["--time-limit", "'soon'"]),
        (["--remedies", "7"], ["remedies", "7", "0 to 5"]),
        (["--remedies", "1.5"], ["--remedies", "'1.5'", "whole"]),
    ],
)
def test_bad_options_are_refused(capsys, tmp_path, arguments, words):
    gait_that_ended("infeasible").save(tmp_path / "gait.nc")
    code, _, error = run(capsys, "explain", tmp_path, *arguments)
    assert code == 2
    assert all(word in error for word in words), error


def test_a_missing_file_is_refused(capsys, tmp_path):
    code, _, error = run(capsys, "explain", tmp_path / "none")
    assert code == 2 and "does not exist" in error
