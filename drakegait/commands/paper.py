"""`drakegait paper`: solve what is open, judge the claims, write the page."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from rich.console import Console
from rich.table import Table
from rich.text import Text

from drakegait.commands.gait_files import output_folder
from drakegait.commands.screen import console
from drakegait.commands.stages import run_in_stages
from drakegait.commands.sweep import INTERRUPTED
from drakegait.errors import BadFile, InvalidInput
from drakegait.paper import document, page
from drakegait.paper.chapter import Chapter
from drakegait.paper.contents import CHAPTERS
from drakegait.paper.results import Results
from drakegait.paper.run import chapter_named
from drakegait.paper.verdict import Verdict
from drakegait.whole_file import new_folder, write_bytes

PAGE, NUMBERS = "paper.html", "paper_results.json"
_COLOURS = {Verdict.YES: "green", Verdict.NO: "red"}


def paper(
    out: str,
    only: Sequence[str],
    workers: int | None,
    scheduler: str | None,
    retry_failed: bool,
    docs: str | None,
) -> int:
    """Run the chapters and write the page; returns the exit code."""
    chapters = [chapter_named(name, CHAPTERS) for name in only] or list(CHAPTERS)
    if docs is not None:
        _check_docs(Path(docs), only)
    folder, screen = new_folder(output_folder("--out", out)), console()
    results = run_in_stages(screen, chapters, folder, workers, scheduler, retry_failed)
    if results is None:
        return INTERRUPTED
    results.save(folder / NUMBERS)
    write_bytes(folder / PAGE, page.render(chapters, results).encode())
    _print(screen, chapters, results)
    screen.print(f"{folder / PAGE}", markup=False, soft_wrap=True)
    if docs is not None:
        results.save(Path(docs) / NUMBERS)
        recorded = Results.load(Path(docs) / NUMBERS)  # rounded: text and numbers have to agree
        document.update(Path(docs) / "paper.md", document.text(chapters, recorded))
        screen.print(f"{Path(docs) / 'paper.md'}", markup=False, soft_wrap=True)
    return 0


def _check_docs(folder: Path, only: Sequence[str]) -> None:
    """Refuse what would be refused after an hour."""
    if only:
        raise InvalidInput("--docs", str(folder), "given without --only, as it holds all chapters")
    if not (folder / "paper.md").is_file():
        raise BadFile(folder / "paper.md", "is not there; --docs is the folder that has it.")


def _print(screen: Console, chapters: Sequence[Chapter], results: Results) -> None:
    table = Table(box=None, pad_edge=False)
    for head in ("same direction", "claim", "ours"):
        table.add_column(head, overflow="fold")
    everything = []
    for chapter in chapters:
        for item in results.findings(chapter):
            everything.append(item)
            colour = _COLOURS.get(item.verdict, "")
            table.add_row(Text(item.verdict.value, colour), Text(item.claim.what), Text(item.ours))
    screen.print(table)
    screen.print(document.headline(everything), markup=False, soft_wrap=True)
