"""The guide is whole: every page in the nav, every link and picture there, nothing from the net."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit

import pytest

ROOT = Path(__file__).resolve().parents[2]
DOCS = ROOT / "docs"
PAGES = sorted(DOCS.glob("**/*.md"))
LARGEST = 150_000  # [byte] of a picture
_LINK = re.compile(r"!?\[[^\]]*\]\(([^)\s]+)\)")


def nav() -> list[str]:
    """Files of the nav, in order."""
    yaml = pytest.importorskip("yaml")

    def files(entry) -> list[str]:
        if isinstance(entry, str):
            return [entry]
        values = entry if isinstance(entry, list) else entry.values()
        return [name for value in values for name in files(value)]

    return files(yaml.safe_load((ROOT / "mkdocs.yml").read_text(encoding="utf-8"))["nav"])


def links(path: Path) -> list[str]:
    """Targets of a page's links and pictures, without those in blocks of code."""
    text = re.sub(r"```.*?```", "", path.read_text(encoding="utf-8"), flags=re.S)
    text = re.sub(r"`[^`\n]*`", "", text)
    return [target for target in _LINK.findall(text) if not urlsplit(target).scheme]


def test_the_nav_has_every_page_once():
    assert sorted(nav()) == [str(path.relative_to(DOCS)) for path in PAGES]


@pytest.mark.parametrize("path", [*PAGES, ROOT / "README.md"], ids=lambda path: path.name)
def test_links_lead_to_files(path):
    for target in links(path):
        file = target.split("#")[0]
        assert not file or (path.parent / file).is_file(), target


@pytest.mark.parametrize("path", PAGES, ids=lambda path: path.name)
def test_pages_of_the_site_do_not_lead_out_of_it(path):
    for target in links(path):
        assert (path.parent / target).resolve().is_relative_to(DOCS), target


def test_pictures_are_small_and_used():
    pictures = {p for p in (DOCS / "pictures").iterdir() if p.suffix in (".png", ".svg")}
    shown = {(path.parent / target).resolve() for path in (*PAGES, ROOT / "README.md")
             for target in links(path)}  # fmt: skip
    assert not pictures - shown
    assert all(path.stat().st_size < LARGEST for path in pictures)


@pytest.mark.parametrize("path", PAGES, ids=lambda path: path.name)
def test_generated_parts_were_generated(path):
    text = path.read_text(encoding="utf-8")
    for name in re.findall(r"<!-- output:(\w+):begin -->", text):
        inside = text.split(f"<!-- output:{name}:begin -->")[1]
        assert f"<!-- output:{name}:end -->" in inside
        printed = inside.split(f"<!-- output:{name}:end -->")[0]
        assert printed.startswith("\n```text\n$ ") and len(printed.splitlines()) > 4, name


def test_every_output_has_its_page_and_every_page_its_output(monkeypatch):
    monkeypatch.syspath_prepend(str(DOCS / "pictures"))
    import guide

    shown = {(program.name, program.page) for program in guide.RUNS if program.page is not None}
    marker = re.compile(r"<!-- output:(\w+):begin -->")
    marked = {
        (name, path.name) for path in PAGES for name in marker.findall(path.read_text("utf-8"))
    }
    assert shown == marked
    assert all((DOCS / "pictures" / f"{name}.png").is_file() for name in guide.PICTURES)


class Page(HTMLParser):
    """What a page of the site asks a browser to load, and where it leads to."""

    def __init__(self, text: str):
        super().__init__()
        self.loaded: list[str] = []
        self.led_to: list[str] = []
        self.names: set[str] = set()
        self.feed(text)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        given = {key: value or "" for key, value in attrs}
        self.names |= {given[key] for key in ("id", "name") if key in given}
        if tag == "a":
            self.led_to.append(given.get("href", ""))
        elif tag == "link" and given.get("rel") != "canonical":
            self.loaded.append(given.get("href", ""))
        elif "src" in given:
            self.loaded.append(given["src"])


@pytest.fixture(scope="module")
def site(tmp_path_factory) -> Path:
    """The site as `make docs` builds it."""
    pytest.importorskip("mkdocs")
    pytest.importorskip("material")
    folder = tmp_path_factory.mktemp("site")
    # Without --quiet, which hides warnings from --strict as well.
    built = subprocess.run(
        [sys.executable, "-m", "mkdocs", "build", "--strict", "--site-dir", str(folder)],
        cwd=ROOT, capture_output=True, text=True, env={**os.environ, "NO_MKDOCS_2_WARNING": "1"},
    )  # fmt: skip
    assert built.returncode == 0, built.stdout + built.stderr
    return folder


def test_the_site_has_every_page_and_nothing_that_only_makes_it(site):
    html = {str(path.relative_to(site)) for path in site.glob("**/*.html")} - {"404.html"}
    assert html == {name.removesuffix(".md") + ".html" for name in nav()}
    assert not [*site.glob("**/*.py"), *site.glob("*_results.json")]


def test_the_site_opens_without_a_network(site):
    for path in site.glob("**/*.html"):
        for address in Page(path.read_text(encoding="utf-8")).loaded:
            if path.name == "404.html":  # a server's; its addresses begin at the root
                address = address.lstrip("/")
            parts = urlsplit(address)
            assert not parts.scheme and not parts.netloc, f"{path.name}: {address}"
            assert (path.parent / unquote(parts.path)).is_file(), f"{path.name}: {address}"
    for path in site.glob("**/*.css"):
        assert not re.search(r"url\(\s*['\"]?https?:", path.read_text(encoding="utf-8")), path.name


def test_links_of_the_site_lead_to_places_that_are_there(site):
    pages = {path.resolve(): Page(path.read_text(encoding="utf-8"))
             for path in site.glob("*.html") if path.name != "404.html"}  # fmt: skip
    for path, page in pages.items():
        for address in page.led_to:
            parts = urlsplit(address)
            if parts.scheme or parts.netloc:
                continue
            target = (path.parent / unquote(parts.path)).resolve() if parts.path else path
            if target.is_dir():
                continue
            assert target.is_file(), f"{path.name}: {address}"
            if parts.fragment and target in pages:
                assert unquote(parts.fragment) in pages[target].names, f"{path.name}: {address}"
