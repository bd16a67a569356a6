"""`drakegait fidelity`: solve what is open, hold it against published numbers, write the page."""

from __future__ import annotations

from pathlib import Path

from rich.console import Console
from rich.table import Table
from rich.text import Text

from drakegait.commands.gait_files import output_folder
from drakegait.commands.screen import console
from drakegait.commands.stages import run_in_stages
from drakegait.commands.sweep import INTERRUPTED
from drakegait.errors import BadFile
from drakegait.fidelity import document
from drakegait.fidelity.contents import SECTIONS
from drakegait.fidelity.published import Place
from drakegait.paper.document import update
from drakegait.paper.results import Results
from drakegait.whole_file import new_folder, write_bytes

PAGE, NUMBERS = "fidelity.html", "fidelity_results.json"
DOCUMENT, PICTURES = "fidelity.md", "pictures"
_COLOURS = {Place.INSIDE: "green", Place.OUTSIDE: "red", Place.NOT_KNOWN: "yellow"}


def fidelity(
    out: str, workers: int | None, scheduler: str | None, retry_failed: bool, docs: str | None
) -> int:
    """Run the sections and write the page; returns the exit code."""
    if docs is not None and not (Path(docs) / DOCUMENT).is_file():
        raise BadFile(Path(docs) / DOCUMENT, "is not there; --docs is the folder that has it.")
    folder, screen = new_folder(output_folder("--out", out)), console()
    results = run_in_stages(screen, SECTIONS, folder, workers, scheduler, retry_failed)
    if results is None:
        return INTERRUPTED
    results.save(folder / NUMBERS, document.FORMAT)
    write_bytes(folder / PAGE, document.page(SECTIONS, results).encode())
    _print(screen, results)
    screen.print(f"{folder / PAGE}", markup=False, soft_wrap=True)
    if docs is not None:
        _write_docs(Path(docs), results)
        screen.print(f"{Path(docs) / DOCUMENT}", markup=False, soft_wrap=True)
    return 0


def _write_docs(folder: Path, results: Results) -> None:
    results.save(folder / NUMBERS, document.FORMAT)
    results = Results.load(folder / NUMBERS, document.FORMAT)  # rounded: text and numbers agree
    document.save_pictures(SECTIONS, results, new_folder(folder / PICTURES))
    text = document.text(SECTIONS, results, PICTURES)
    update(folder / DOCUMENT, text, document.BEGIN, document.END)


def _print(screen: Console, results: Results) -> None:
    table = Table(box=None, pad_edge=False)
    for head in ("place", "quantity", "published", "ours"):
        table.add_column(head, overflow="fold")
    everything = [row for section in SECTIONS for row in section.judged(results)]
    for row in everything:
        place = Text(row.place.value, _COLOURS[row.place])
        table.add_row(place, Text(row.quantity), Text(row.published), Text(row.ours))
    screen.print(table)
    screen.print(document.headline(everything), markup=False, soft_wrap=True)
