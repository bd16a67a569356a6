"""The results as the generated part of docs/fidelity.md and as one HTML page."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from pathlib import Path

from drakegait.fidelity.published import Place, Row
from drakegait.fidelity.section import Section
from drakegait.fidelity.sources import SOURCES
from drakegait.paper.document import made, markdown
from drakegait.paper.numbers import Missing, Numbers
from drakegait.paper.results import Results
from drakegait.whole_file import write_bytes

FORMAT = "drakegait fidelity results"
BEGIN, END = "<!-- fidelity:begin -->", "<!-- fidelity:end -->"
HEADS = ("quantity", "published", "source", "ours", "place", "by how much", "why")
TEMPLATE = "fidelity.html"
_CLASSES = {Place.INSIDE: "yes", Place.OUTSIDE: "no", Place.NOT_KNOWN: "missing"}


def headline(rows: Iterable[Row]) -> str:
    """How many numbers lie inside, in a sentence."""
    places = [row.place for row in rows]
    counts = [f"{place.value} {places.count(place)}" for place in Place if place in places]
    return f"{len(places)} numbers: {', '.join(counts)}."


def text(sections: Sequence[Section], results: Results, pictures: str = "pictures") -> str:
    """The part between the markers, without them.

    Args:
        pictures: folder of the figures, as seen from the file.
    """
    everything = [row for section in sections for row in section.judged(results)]
    lines = [headline(everything), "", made(results), ""]
    for section in sections:
        rows = section.judged(results)
        lines += [f"## {section.title}", "", section.about, "", headline(rows), ""]
        for name, (caption, _) in section.pictures.items():
            lines += [f"![{caption}]({pictures}/{name}.svg)", "", f"*{caption}.*", ""]
        cells = [(row.quantity, row.published, row.source, row.ours, f"**{row.place.value}**",
                  row.by, row.why) for row in rows]  # fmt: skip
        lines += [*markdown(HEADS, cells), "", f"{section.rule[0].upper()}{section.rule[1:]}.", ""]
        numbers = results.numbers.get(section.name)
        if section.tables is not None and numbers is not None:
            for table in section.tables(numbers):
                lines += [f"**{table.title}**", "", *markdown(table.heads, table.rows), ""]
                lines += [table.note, ""] if table.note else []
    lines += ["## Sources", ""]
    lines += [f"- **{name}**: {citation}" for name, citation in SOURCES.items()]
    return "\n".join(lines).rstrip() + "\n"


def drawn(sections: Sequence[Section], results: Results) -> dict[str, tuple[str, str]]:
    """Name of each figure that can be drawn -> (caption, SVG)."""
    found = {}
    for section in sections:
        numbers = results.numbers.get(section.name, Numbers())
        for name, (caption, draw) in section.pictures.items():
            try:
                found[name] = (caption, draw(numbers))
            except Missing:
                continue
    return found


def save_pictures(sections: Sequence[Section], results: Results, folder: Path) -> list[Path]:
    """Write the figures as SVG files; raises BadFile."""
    written = []
    for name, (_, svg) in drawn(sections, results).items():
        written.append(folder / f"{name}.svg")
        # Outside of a page, nothing else says how wide it is and that the ground is white.
        sized = svg.replace("<svg ", '<svg width="900" style="background:#fff" ', 1)
        write_bytes(written[-1], (sized + "\n").encode())
    return written


def page(sections: Sequence[Section], results: Results) -> str:
    """The page as HTML; it refers to no other file."""
    import jinja2
    from markupsafe import Markup

    import drakegait

    loader = jinja2.ChoiceLoader(
        [jinja2.PackageLoader("drakegait.fidelity"), jinja2.PackageLoader("drakegait.paper")]
    )
    environment = jinja2.Environment(
        loader=loader, autoescape=True, undefined=jinja2.StrictUndefined, trim_blocks=True,
        lstrip_blocks=True,
    )  # fmt: skip
    parts = [
        {
            "section": section,
            "rows": section.judged(results),
            "tables": section.tables(results.numbers.get(section.name, Numbers()))
            if section.tables else (),
            "pictures": {name: (caption, Markup(svg))
                         for name, (caption, svg) in drawn([section], results).items()},
        }
        for section in sections
    ]  # fmt: skip
    rows = [row for part in parts for row in part["rows"]]
    return environment.get_template(TEMPLATE).render(
        headline=headline(rows), parts=parts, classes=_CLASSES, heads=HEADS,
        made=made(results), sources=SOURCES, version=drakegait.__version__,
    )  # fmt: skip
