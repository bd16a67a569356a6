"""Chapters are solved once, in the order in which they need each other."""

from __future__ import annotations

from pathlib import Path

import paper_cases as cases
import pytest

from drakegait.errors import BadFile, UnknownName
from drakegait.paper import document, page, tables
from drakegait.paper.chapter import Chapter
from drakegait.paper.claim import Claim
from drakegait.paper.contents import CHAPTERS
from drakegait.paper.numbers import Missing, Numbers
from drakegait.paper.results import Results
from drakegait.paper.run import chapter_named, run, with_needed
from drakegait.paper.verdict import Verdict

pytest.importorskip("distributed")


@pytest.fixture
def trace(tmp_path, monkeypatch) -> Path:
    path = tmp_path / "trace"
    path.write_text("")
    monkeypatch.setenv(cases.TRACE, str(path))
    return path


def solved(trace: Path) -> list[str]:
    """Lines since the last look."""
    lines = trace.read_text().splitlines()
    trace.write_text("")
    return sorted(lines)


def test_chapters_are_solved_once_and_go_on_where_something_is_missing(tmp_path, trace):
    chapters = [cases.FIRST, cases.SECOND, cases.THIRD]
    sentences: list[str] = []

    def go() -> Results:
        return run(chapters, tmp_path / "out", workers=1, stage=sentences.append,
                   _solve=cases.solve)  # fmt: skip

    first = go()
    assert solved(trace) == [
        "1 embedded refined", "1.1 own refined", "1.2 embedded refined",
        "1.3 embedded as stated", "1.5 embedded as stated",
    ]  # fmt: skip
    assert len(sentences) == 3
    assert first.numbers["first"].energy("slow") > 0.0
    assert first.numbers["second"].solved("after slow")
    lost = first.numbers["third"].rows["lost"]
    assert (lost["solver_status"], lost["cost"]) == ("infeasible", None)
    (row,) = tables.studies(first.numbers["third"], ["lost"]).rows
    assert row[-1] == "infeasible; does not hold: excitation | soleus_l full: off by 3 1/s"
    (row,) = tables.studies(first.numbers["third"], ["stated"]).rows
    assert row[-1].startswith("converged")
    assert set(first.gaits) == {"slow", "fast", "after slow", "stated"}

    again = go()
    assert solved(trace) == []
    assert again.numbers == first.numbers

    (tmp_path / "out" / "first" / "slow" / "gait.nc").write_bytes(b"cut off")
    assert go().numbers["first"].rows == first.numbers["first"].rows
    assert solved(trace) == ["1 embedded refined"]

    path = tmp_path / "numbers.json"
    first.save(path)
    known = Results.load(path)
    assert [f.verdict for f in known.findings(cases.FIRST)] == [
        f.verdict for f in first.findings(cases.FIRST)
    ]
    listed = [item for items in document.overview(chapters, first).values() for item in items]
    assert len(listed) == len(cases.FIRST.claims) == 2  # each once
    html = page.render(chapters, first)
    assert all(chapter.title in html for chapter in chapters)
    assert "src=" not in html and 'href="http' not in html  # one file, no network


def test_a_chapter_brings_those_it_needs():
    alone = chapter_named("heavy-foot-spatial", CHAPTERS)
    names = [chapter.name for chapter in with_needed([alone], CHAPTERS)]
    needed = ["convergence", "heavy-foot-planar", "heavy-foot-spatial", "worn-masses"]
    assert names == needed
    with pytest.raises(UnknownName, match="heavy-foot-planar"):
        chapter_named("heavy", CHAPTERS)


def test_names_are_unique_and_every_guess_and_need_exists():
    owners: dict[str, object] = {}
    for chapter in (chapter for chapter in CHAPTERS if not chapter.after):
        for name, study in chapter.studies().items():
            assert owners.setdefault(name, study) == study
        assert set(chapter.warm) | set(chapter.warm.values()) <= set(chapter.own_names)
    for chapter in CHAPTERS:
        known = {*owners, *(name for c in CHAPTERS for name in c.own_names)}
        assert {*chapter.after, *chapter.compares} <= known
    assert len({chapter.name for chapter in CHAPTERS}) == len(CHAPTERS)


def test_every_chapter_has_its_program():
    folder = Path(__file__).resolve().parents[2] / "examples" / "paper"
    programs = {path.name: path.read_text().splitlines() for path in folder.glob("*.py")}
    assert set(programs) == {chapter.program for chapter in CHAPTERS}
    assert all(len(lines) < 80 for lines in programs.values())


def test_the_overview_sorts_claims_by_verdict_and_keeps_own_questions_apart():
    def chapter(**verdicts: Verdict) -> Chapter:
        claims = [Claim(what, where, "", lambda n: "7 J/m", judge and (lambda n, v=judge: v))
                  for what, (where, judge) in verdicts.items()]  # fmt: skip
        return Chapter(name="a", title="Walks", place="1", about="", claims=tuple(claims))

    walks = chapter(
        lost=("1", Verdict.NO), kept=("1", Verdict.YES), ours=("-", Verdict.NO),
        silent=("1", None), little=("1", Verdict.UNCLEAR),
    )  # fmt: skip
    found = document.overview([walks], Results({}))
    assert {head: [item.claim.what for _, item in items] for head, items in found.items()} == {
        "Hold": ["kept"], "Ours hardly changes": ["little"], "Do not hold": ["lost"],
        document.OPEN: ["ours", "silent"],
    }  # fmt: skip
    text = document.text([walks], Results({}))
    top = text.split("## Walks")[0]
    assert "- kept (walks)\n" in top and "- lost (walks): 7 J/m\n" in top
    assert "- ours (walks): **no**; 7 J/m\n" in top


def test_what_was_not_measured_is_not_judged():
    findings = cases.FIRST.findings(Numbers())
    assert [item.verdict for item in findings] == [Verdict.NOT_RUN] * 2
    assert "slow" in findings[0].ours
    with pytest.raises(Missing):
        Numbers({"lost": {"cost": None}}).cost("lost")
    assert cases.FIRST.measure({}) == {}
    for chapter in CHAPTERS:  # tables and claims can be made from nothing
        chapter.findings(Numbers())
        if chapter.tables is not None:
            chapter.tables(Numbers())


def test_the_section_between_the_markers_is_replaced_and_nothing_else(tmp_path):
    path = tmp_path / "paper.md"
    path.write_text(f"before\n{document.BEGIN}\nold\n{document.END}\nafter\n")
    document.update(path, "new\n")
    assert path.read_text() == f"before\n{document.BEGIN}\nnew\n{document.END}\nafter\n"
    path.write_text("no markers\n")
    with pytest.raises(BadFile, match="lacks the lines"):
        document.update(path, "new\n")


def test_foreign_numbers_are_refused(tmp_path):
    path = tmp_path / "numbers.json"
    for content in ("", "{}", '{"format": "another"}', "[]"):
        path.write_text(content)
        with pytest.raises(BadFile):
            Results.load(path)
