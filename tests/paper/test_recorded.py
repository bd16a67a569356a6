"""The directions that the recorded run has found hold, and docs/paper.md says nothing else.

`docs/paper_results.json` holds numbers only; verdicts are computed from them anew, by the rules and
tolerances of each claim.
"""

from __future__ import annotations

from pathlib import Path

import pytest

from drakegait.paper import convergence, document
from drakegait.paper.bases import SMALL, small
from drakegait.paper.contents import CHAPTERS
from drakegait.paper.heavy_foot import SHARED, SILENT, measured
from drakegait.paper.results import Results
from drakegait.paper.verdict import Verdict
from drakegait.paper.worn_masses import BASE, CHAPTER, HEAVY, studies
from drakegait.solve import solve

DOCS = Path(__file__).resolve().parents[2] / "docs"
SAME, SCATTER = 0.02, 0.05
"""Shares by which energy and cost may differ from the recorded run on another machine: where one
optimum is found by all, and where optima scatter."""

EXPECTED: dict[str, tuple[str, ...]] = {
    "muscle-table": (
        "yes",
        "no",
        "no",
    ),
    "convergence": (
        "yes",
        "yes",
        "yes",
        "no",
    ),
    "heavy-foot-planar": (
        "yes",
        "yes",
        "yes",
        "yes",
        "partly",
        "no clear change",
        "no clear change",
        "yes",
        "yes",
        "yes",
        "partly",
        "yes",
        "yes",
        "yes",
    ),
    "heavy-foot-spatial": (
        "yes",
        "yes",
        "yes",
        "no clear change",
        "yes",
        "partly",
        "no",
        "no",
        "no",
        "yes",
        "no clear change",
        "yes",
    ),
    "spatial-symmetric": ("no",),
    "formulation": (
        "yes",
        "yes",
        "yes",
        "yes",
        "yes",
        "paper is silent",
        "yes",
    ),
    "rulings": ("paper is silent",),
    "cost-front": (
        "yes",
        "paper is silent",
    ),
    "speeds": ("partly",),
    "worn-masses": (
        "yes",
        "yes",
        "no",
    ),
}
"""Chapter -> verdicts in the order of its claims."""


@pytest.fixture(scope="module")
def recorded() -> Results:
    return Results.load(DOCS / "paper_results.json")


def test_every_chapter_was_run(recorded):
    assert set(recorded.numbers) == {chapter.name for chapter in CHAPTERS} == set(EXPECTED)


@pytest.mark.parametrize("chapter", CHAPTERS, ids=lambda chapter: chapter.name)
def test_directions_hold(chapter, recorded):
    findings = recorded.findings(chapter)
    assert tuple(item.verdict.value for item in findings) == EXPECTED[chapter.name]
    assert all(item.verdict is not Verdict.NOT_RUN for item in findings)


@pytest.mark.parametrize("chapter", CHAPTERS, ids=lambda chapter: chapter.name)
def test_what_differs_is_explained(chapter, recorded):
    for item in recorded.findings(chapter):
        if item.verdict in (Verdict.NO, Verdict.UNCLEAR, Verdict.PARTLY):
            assert item.claim.why, item.claim.what


def test_the_document_is_made_of_the_recorded_numbers(recorded):
    text = (DOCS / "paper.md").read_text(encoding="utf-8")
    written = text.split(document.BEGIN)[1].split(document.END)[0]
    assert written == "\n" + document.text(CHAPTERS, recorded)


@pytest.mark.solve
def test_the_smallest_walk_is_as_recorded(recorded):
    gait = solve(small())
    numbers = recorded.numbers[convergence.CHAPTER.name]
    assert gait.converged
    assert gait.cost["total"] == pytest.approx(numbers.cost(SMALL), rel=SAME)
    assert gait.metabolic.cost_of_transport == pytest.approx(numbers.energy(SMALL), rel=SAME)


@pytest.mark.solve
def test_a_heavy_foot_still_does_what_was_recorded(recorded):
    """2 kg in the plane, against the embedded stride: both gaits anew."""
    pair = studies()
    normal = solve(pair[BASE])
    burdened = solve(pair[HEAVY], guess=normal)
    numbers = recorded.numbers[CHAPTER.name]
    for gait, name in ((normal, BASE), (burdened, HEAVY)):
        found = gait.metabolic.cost_of_transport
        assert found == pytest.approx(numbers.energy(name), rel=SCATTER)
    energies = [gait.metabolic.cost_of_transport for gait in (normal, burdened)]
    assert energies[1] > 1.01 * energies[0]
    assert burdened.report.deviation > 1.01 * normal.report.deviation
    found = measured(normal, burdened)
    for what in ("right excitation height", "right excitation width", "right late stance force",
                 "tibialis anterior 60-70"):  # fmt: skip
        assert found[f"{what} heavy"] > found[f"{what} normal"], what
    for when in ("normal", "heavy"):
        assert found[f"shared by tibialis anterior and calf {when}"] > SHARED
        assert found[f"calf at the peak of tibialis anterior {when}"] < SILENT
