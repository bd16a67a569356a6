"""`walk --compare`: from one command to two walkers on one page."""

from __future__ import annotations

import dataclasses
import json
import re
import signal
from pathlib import Path

import pytest
from gait_cases import reference_gait, restated
from test_cli import TINY, process, refused, request, run

from drakegait.commands import walk as walk_command
from drakegait.commands.unchanged import known_gait, unchanged
from drakegait.errors import InvalidInput
from drakegait.gait import Gait
from drakegait.reference.reference import Reference
from drakegait.study import GaitStudy
from drakegait.walker.disorders import Weakness

QUICK = (*TINY, "--no-pictures", "--no-refine", "--set", "optimality=0.01")


def test_only_what_makes_the_walker_differ_is_left_out():
    base = GaitStudy.planar(nodes=20, speed=1.0, energy_weight=2.0).with_settings(friction=0.5)
    for changed in (
        base.with_added_mass("foot_r", 2.0),
        base.with_disorder(Weakness("soleus", "l", 0.5)),
        base.with_limit("knee_flexion_r", high=0.8),
        base.replace(strength={"soleus_l": 0.5}),
        base.replace(muscle_changes={"SOL": {"l_slack": 0.24}}),
    ):
        assert unchanged(changed) == base
    with pytest.raises(InvalidInput, match="--added-mass"):
        unchanged(base)


def test_an_interrupted_second_walk_is_compared_all_the_same(capsys, tmp_path, monkeypatch):
    """Ctrl-C ends it with the best gait so far, which the report calls unfinished."""
    endings = iter(("converged", "interrupted"))
    starts = []

    def solve(study, *, guess, **_):
        starts.append(guess)
        gait = restated(reference_gait("planar-symmetric"), study)
        outcome = dataclasses.replace(gait.outcome, status=next(endings))
        return dataclasses.replace(gait, outcome=outcome)

    monkeypatch.setattr(walk_command, "solve", solve)
    code, printed, _ = run(
        capsys, "walk", "--model", "planar-symmetric", "--nodes", "19", "--no-pictures",
        "--weakness", "soleus=0.5", "--compare", "--out", tmp_path,
    )  # fmt: skip
    assert code == 3 and "NOT CONVERGED (interrupted)" in printed
    assert starts[0] is None and starts[1].study.disorders == ()
    assert Gait.load(tmp_path / "gait.nc").outcome.status == "interrupted"
    assert "NOT CONVERGED (interrupted)" in (tmp_path / "report.html").read_text()


def test_a_guess_is_taken_only_if_it_has_solved_the_unchanged_walk():
    unfinished = reference_gait("planar-symmetric")
    outcome = dataclasses.replace(unfinished.outcome, status="converged")
    gait = dataclasses.replace(unfinished, outcome=outcome)
    study = gait.study.replace(interior_points=None)
    assert known_gait(study, gait) is gait
    assert known_gait(study, None) is None
    assert known_gait(study, unfinished) is None
    assert known_gait(study.replace(speed=1.1), gait) is None
    other = Reference.embedded("planar", study.subject, "asymmetric")
    assert known_gait(study.replace(reference=other), gait) is None


def test_nothing_to_compare_is_refused_before_any_solve(capsys, tmp_path, monkeypatch):
    monkeypatch.setattr(walk_command, "solve", None)
    sentence = refused(capsys, "walk", *TINY, "--compare", "--speed", "1", "--out", tmp_path / "x")
    assert "--compare" in sentence and "--added-mass" in sentence
    assert list(tmp_path.iterdir()) == []
    study, *_ = request(model="planar", added_mass=["foot_r=2"], compare=True).prepare()
    assert study.added_masses


@pytest.fixture(scope="module")
def compared(tmp_path_factory):
    """Exit code, output and folder of one command that walks twice."""
    out = tmp_path_factory.mktemp("compared")
    running = process("walk", *QUICK, "--weakness", "soleus=0.5", "--compare", "--out", out)
    printed, err = running.communicate(timeout=300)
    return running.returncode, printed, err, out


@pytest.mark.solve
def test_one_command_walks_twice_and_compares(compared):
    code, printed, err, out = compared
    assert (code, err) == (0, "")
    names = sorted(str(path.relative_to(out)) for path in out.rglob("*") if path.is_file())
    assert names == [
        "gait.nc", "report.html", "summary.json", "unchanged/gait.nc", "unchanged/summary.json",
    ]  # fmt: skip
    before, after = Gait.load(out / "unchanged" / "gait.nc"), Gait.load(out / "gait.nc")
    assert before.study.disorders == ()
    assert after.study.disorders == (Weakness("soleus", "both", 0.5),)
    assert before.study.replace(disorders=after.study.disorders) == after.study
    # The second starts where the first ended, not where the first started.
    starts = [float(x) for x in re.findall(r"iteration 0 +cost ([\d.]+)", printed)]
    end = before.cost["total"]
    assert len(starts) == 2 and abs(starts[1] - end) < 0.5 * abs(starts[0] - end)
    page = (out / "report.html").read_text()
    assert "unchanged walker" in page and "soleus on both sides with 50 % of its strength" in page
    assert "What differs: soleus on both sides" in printed
    cost = before.metabolic.cost_of_transport
    assert f"than {cost:.0f} J/m" in printed and f"than {cost:.0f} J/m" in page
    assert f"Report in {out / 'report.html'}" in printed


@pytest.mark.solve
def test_a_second_question_about_the_same_person_solves_once(compared, capsys, tmp_path):
    *_, first = compared
    code, printed, _ = run(
        capsys, "walk", *QUICK, "--weakness", "soleus=0.8", "--compare",
        "--guess", first / "unchanged", "--out", tmp_path,
    )  # fmt: skip
    assert code == 0 and "not solved again" in printed
    assert printed.count("Converged after") == 1
    # What is compared with lies beside the answer, as ever.
    texts = [json.loads((x / "unchanged/summary.json").read_text()) for x in (first, tmp_path)]
    assert texts[0]["cost"] == texts[1]["cost"]
    assert (tmp_path / "report.html").exists()


@pytest.mark.solve
def test_ctrl_c_in_the_first_walk_ends_both(tmp_path: Path):
    running = process(
        "walk", "--nodes", "18", "--no-pictures", "--added-mass", "foot_r=2", "--compare",
        "--out", tmp_path,
    )  # fmt: skip
    for line in running.stdout:
        if line.startswith("iteration 0"):
            break
    running.send_signal(signal.SIGINT)
    printed, err = running.communicate(timeout=60)
    assert (running.returncode, err) == (3, "")
    assert "the second was not solved" in printed and "Second walk" not in printed
    assert Gait.load(tmp_path / "unchanged" / "gait.nc").outcome.status == "interrupted"
    assert [path.name for path in tmp_path.iterdir()] == ["unchanged"]


@pytest.mark.solve
def test_a_walk_alone_says_that_an_old_report_is_old(compared, capsys, tmp_path):
    (tmp_path / "report.html").write_text("old")
    _, printed, _ = run(
        capsys, "walk", *QUICK, "--out", tmp_path, "--guess", compared[3] / "unchanged"
    )
    assert f"report.html in {tmp_path} is of an earlier walk" in printed
