"""docs/fidelity.md and its figures say what `docs/fidelity_results.json` says, by today's rules."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from drakegait.fidelity import document
from drakegait.fidelity.contents import SECTIONS
from drakegait.fidelity.published import Place
from drakegait.fidelity.walking import WALK, studies
from drakegait.paper.results import Results
from drakegait.solve import solve

DOCS = Path(__file__).resolve().parents[2] / "docs"
SCATTER = 0.05
"""Share by which the energy of a local optimum may differ on another machine."""


@pytest.fixture(scope="module")
def recorded() -> Results:
    return Results.load(DOCS / "fidelity_results.json", document.FORMAT)


def written() -> str:
    text = (DOCS / "fidelity.md").read_text(encoding="utf-8")
    return text.split(document.BEGIN)[1].split(document.END)[0]


def test_the_document_is_made_of_the_recorded_numbers(recorded):
    assert written() == "\n" + document.text(SECTIONS, recorded)


def test_everything_was_run_and_converged(recorded):
    assert set(recorded.numbers) == {section.name for section in SECTIONS}
    for section in SECTIONS:
        assert all(row.place is not Place.NOT_KNOWN for row in section.judged(recorded))
        for name in section.own_names:
            row = recorded.numbers[section.name].rows[name]
            assert row["status"] == "done" and row["check_passed"], name


def test_what_is_outside_says_by_how_much_and_why(recorded):
    for section in SECTIONS:
        for row in section.judged(recorded):
            if row.place is Place.OUTSIDE:
                assert row.by and row.why, row.quantity


def test_the_figures_are_those_of_the_recorded_numbers(recorded, tmp_path):
    names = set(re.findall(r"\(pictures/(\w+)\.svg\)", written()))
    assert names == {name for section in SECTIONS for name in section.pictures}

    def shapes(path: Path) -> list[float]:
        # Bars and marks, in points; letters differ between machines.
        paths = re.findall(r'd="([^"]+)"', path.read_text(encoding="utf-8"))
        return [float(number) for number in re.findall(r"-?[0-9.]+", " ".join(paths))]

    for path in document.save_pictures(SECTIONS, recorded, tmp_path):
        assert shapes(path) == pytest.approx(shapes(DOCS / "pictures" / path.name), abs=1e-6)
        assert path.stat().st_size < 150_000


def test_the_page_stands_alone(recorded):
    page = document.page(SECTIONS, recorded)
    assert all(section.title in page for section in SECTIONS)
    assert "src=" not in page and 'href="http' not in page


@pytest.mark.slow
@pytest.mark.solve
def test_the_default_walk_costs_what_was_recorded(recorded):
    gait = solve(studies()[WALK])
    assert gait.converged
    expected = recorded.numbers["cost"].energy(WALK)
    assert gait.metabolic.cost_of_transport == pytest.approx(expected, rel=SCATTER)
