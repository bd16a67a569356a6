"""One HTML page with everything: claims first, then each chapter with tables and figures."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from drakegait.paper.chapter import Chapter
from drakegait.paper.document import OPEN, headline, overview
from drakegait.paper.numbers import Missing, Numbers
from drakegait.paper.results import Results
from drakegait.paper.verdict import Verdict

TEMPLATE = "paper.html"
CLASSES = {
    Verdict.YES: "yes", Verdict.PARTLY: "partly", Verdict.UNCLEAR: "unclear", Verdict.NO: "no",
    Verdict.NOT_RUN: "missing", Verdict.SILENT: "silent",
}  # fmt: skip


def render(chapters: Sequence[Chapter], results: Results) -> str:
    """The page as HTML; it refers to no other file."""
    import jinja2

    import drakegait

    environment = jinja2.Environment(
        loader=jinja2.PackageLoader("drakegait.paper"), autoescape=True,
        undefined=jinja2.StrictUndefined, trim_blocks=True, lstrip_blocks=True,
    )  # fmt: skip
    parts = [_part(chapter, results) for chapter in chapters]
    findings = [item for part in parts for item in part["findings"]]
    return environment.get_template(TEMPLATE).render(
        headline=headline(findings),
        overview=overview(chapters, results),
        open=OPEN,
        parts=parts,
        classes=CLASSES,
        made=results.made,
        version=drakegait.__version__,
    )


def _part(chapter: Chapter, results: Results) -> dict[str, Any]:
    from markupsafe import Markup

    from drakegait.paper.numbers import Gaits

    numbers = results.numbers.get(chapter.name, Numbers())
    figures = {}
    for title, draw in chapter.figures.items():
        try:
            figures[title] = Markup(draw(Gaits(results.gaits), numbers))
        except Missing as missing:
            figures[title] = f"Not drawn: {missing}"
    return {
        "chapter": chapter,
        "findings": results.findings(chapter),
        "tables": chapter.tables(numbers) if chapter.tables else (),
        "figures": figures,
    }
