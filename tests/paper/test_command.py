"""`drakegait paper`: bad input is refused before anything runs; without solves it is quick."""

from __future__ import annotations

import json

import pytest

from drakegait.cli import main

pytest.importorskip("distributed")
pytest.importorskip("jinja2")


def run(*arguments: str) -> int:
    with pytest.raises(SystemExit) as ending:
        main(["paper", *arguments])
    return ending.value.code


def test_one_chapter_makes_a_page_and_numbers(tmp_path, capsys):
    assert run("--only", "muscle-table", "--out", str(tmp_path)) == 0
    page = (tmp_path / "paper.html").read_text()
    assert "GRA (10.28 %)" in page and "Which muscles count" in page
    numbers = json.loads((tmp_path / "paper_results.json").read_text())
    assert set(numbers["chapters"]) == {"muscle-table"}
    assert "3 claims: yes: 1, no: 2" in capsys.readouterr().out


def test_an_unknown_chapter_is_refused(tmp_path, capsys):
    assert run("--only", "table-7", "--out", str(tmp_path / "out")) == 2
    assert "convergence" in capsys.readouterr().err
    assert not (tmp_path / "out").exists()


def test_docs_need_all_chapters_and_a_file_to_write_into(tmp_path, capsys):
    assert run("--only", "muscle-table", "--docs", str(tmp_path)) == 2
    assert "--only" in capsys.readouterr().err
    assert run("--docs", str(tmp_path), "--out", str(tmp_path / "out")) == 2
    assert "paper.md" in capsys.readouterr().err
    assert not (tmp_path / "out").exists()
