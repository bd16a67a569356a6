"""The generated part of docs/paper.md: claims and tables, from the same findings as the page."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from drakegait.errors import BadFile
from drakegait.paper.chapter import Chapter
from drakegait.paper.claim import Finding
from drakegait.paper.results import Results
from drakegait.paper.verdict import Verdict
from drakegait.whole_file import write_bytes

BEGIN, END = "<!-- paper:begin -->", "<!-- paper:end -->"
GROUPS = {
    Verdict.YES: "Hold",
    Verdict.PARTLY: "Hold in part",
    Verdict.UNCLEAR: "Ours hardly changes",
    Verdict.NO: "Do not hold",
    Verdict.NOT_RUN: "Not known",
}
"""Verdicts in the order of the overview, with their headings there."""
OPEN = "Questions that the paper leaves open"


def headline(findings: Sequence[Finding]) -> str:
    """How many of the paper's claims hold, in a sentence."""
    judged = [item for item in findings if item.claim.of_the_paper and item.claim.judge]
    counts = {verdict: sum(item.verdict is verdict for item in judged) for verdict in GROUPS}
    parts = [f"{verdict.value}: {count}" for verdict, count in counts.items() if count]
    return f"Same direction as the paper in {len(judged)} claims: {', '.join(parts)}."


def overview(
    chapters: Sequence[Chapter], results: Results
) -> dict[str, list[tuple[Chapter, Finding]]]:
    """Which claims hold: all findings with their chapters, under the headings of `GROUPS`, and what
    the paper leaves open under `OPEN`; headings without claims are left out."""
    found: dict[str, list[tuple[Chapter, Finding]]] = {
        heading: [] for heading in (*GROUPS.values(), OPEN)
    }
    for chapter in chapters:
        for item in results.findings(chapter):
            judged = item.claim.of_the_paper and item.claim.judge
            found[GROUPS[item.verdict] if judged else OPEN].append((chapter, item))
    return {heading: items for heading, items in found.items() if items}


def text(chapters: Sequence[Chapter], results: Results) -> str:
    """The section between the markers, without them."""
    everything = [item for chapter in chapters for item in results.findings(chapter)]
    lines = [headline(everything), "", made(results), ""]
    for heading, items in overview(chapters, results).items():
        lines += [f"**{heading}** ({len(items)}):", ""]
        lines += [f"- {item.claim.what} ({chapter.title.lower()})" + _in_brief(heading, item)
                  for chapter, item in items]  # fmt: skip
        lines.append("")
    for chapter in chapters:
        numbers = results.numbers.get(chapter.name)
        lines += [f"## {chapter.title}", ""]
        place = f"Paper: {chapter.place}. " if chapter.place != "-" else ""
        lines += [f"{place}{chapter.about} Program: `examples/paper/{chapter.program}`.", ""]
        lines += markdown(
            ("claim", "where", "paper", "ours", "same direction", "why they differ"),
            [
                (item.claim.what, item.claim.where, item.claim.paper or "no number", item.ours,
                 f"**{item.verdict.value}**", item.claim.why)
                for item in results.findings(chapter)
            ],
        )  # fmt: skip
        rules = [item.claim for item in results.findings(chapter) if item.claim.rule]
        lines += ["", "Judged by:", ""] if rules else []
        lines += [f"- {claim.what}: {claim.rule}." for claim in rules]
        if chapter.tables is not None and numbers is not None:
            for table in chapter.tables(numbers):
                lines += ["", f"**{table.title}**", "", *markdown(table.heads, table.rows)]
                lines += ["", table.note] if table.note else []
        lines.append("")
    return "\n".join(lines).rstrip() + "\n"


def update(path: Path, content: str, begin: str = BEGIN, end: str = END) -> None:
    """Put the section between the markers of a file that has them; raises BadFile."""
    try:
        whole = path.read_text(encoding="utf-8")
    except OSError as error:
        raise BadFile(path, f"cannot be read ({error.strerror or error}).") from None
    if whole.count(begin) != 1 or whole.count(end) != 1 or whole.index(end) < whole.index(begin):
        raise BadFile(path, f"lacks the lines {begin} and {end}, in this order.")
    before, rest = whole.split(begin)
    after = rest.split(end)[1]
    write_bytes(path, f"{before}{begin}\n{content}{end}{after}".encode())


def _in_brief(heading: str, item: Finding) -> str:
    """Our numbers, where they do not simply say yes."""
    if heading == OPEN:
        return f": **{item.verdict.value}**; {item.ours}"
    return "" if item.verdict is Verdict.YES else f": {item.ours}"


def made(results: Results) -> str:
    """When, where and with what the run was made, in a sentence; empty if not known."""
    facts = results.made
    if not facts:
        return ""
    versions = facts.get("versions", {})
    named = ", ".join(f"{name} {versions[name]}" for name in ("drakegait", "drake", "casadi")
                      if name in versions)  # fmt: skip
    place = f"{facts.get('cores')} cores ({facts.get('system')})"
    return f"Run of {facts.get('date')} on {place}: {named}."


def markdown(heads: Sequence[str], rows: Sequence[Sequence[str]]) -> list[str]:
    """The lines of a table."""

    def line(cells: Sequence[str]) -> str:
        return "| " + " | ".join(cell.replace("|", "\\|") or " " for cell in cells) + " |"

    return [line(heads), "|" + "---|" * len(heads), *(line(row) for row in rows)]
