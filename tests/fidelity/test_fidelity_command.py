"""`drakegait fidelity`: bad input is refused before anything runs; a run goes on and writes all."""

from __future__ import annotations

from pathlib import Path

import pytest

from drakegait.cli import main
from drakegait.commands import stages
from drakegait.fidelity import document
from drakegait.fidelity.contents import SECTIONS
from drakegait.paper.results import Results

pytest.importorskip("distributed")
pytest.importorskip("jinja2")
DOCS = Path(__file__).resolve().parents[2] / "docs"


def run(*arguments: str) -> int:
    with pytest.raises(SystemExit) as ending:
        main(["fidelity", *arguments])
    return ending.value.code


def test_a_folder_without_the_page_is_refused(tmp_path, capsys):
    assert run("--docs", str(tmp_path), "--out", str(tmp_path / "out")) == 2
    assert "fidelity.md" in capsys.readouterr().err
    assert not (tmp_path / "out").exists()


def test_page_numbers_and_document_are_written(tmp_path, capsys, monkeypatch):
    recorded = Results.load(DOCS / "fidelity_results.json", document.FORMAT)
    monkeypatch.setattr(stages, "run", lambda *_, **__: recorded)  # the solves alone
    docs = tmp_path / "docs"
    docs.mkdir()
    (docs / "fidelity.md").write_text(f"before\n{document.BEGIN}\n{document.END}\nafter\n")
    assert run("--docs", str(docs), "--out", str(tmp_path / "out")) == 0
    text = (docs / "fidelity.md").read_text()
    assert text.startswith("before\n") and text.endswith("\nafter\n")
    assert document.text(SECTIONS, recorded) in text
    assert Results.load(docs / "fidelity_results.json", document.FORMAT).numbers == recorded.numbers
    assert (tmp_path / "out" / "fidelity.html").is_file()
    assert {path.stem for path in (docs / "pictures").iterdir()} == {
        name for section in SECTIONS for name in section.pictures
    }
    assert "numbers: inside" in capsys.readouterr().out


def test_numbers_of_the_paper_are_refused(tmp_path):
    from drakegait.errors import BadFile

    with pytest.raises(BadFile, match="drakegait fidelity results"):
        Results.load(DOCS / "paper_results.json", document.FORMAT)
