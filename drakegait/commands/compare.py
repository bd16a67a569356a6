"""`drakegait compare`: load the gaits, write the page and the tables, say what was found."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from rich.console import Console

from drakegait.commands.gait_files import gait_path, load_gait, output_file, output_folder
from drakegait.commands.screen import console, quiet_drake
from drakegait.report.compare import LONGEST_LABEL, Comparison, compare
from drakegait.report.comparison_words import headline, troubles

NOT_TRUSTED = 3


def write_comparison(
    names: Sequence[str], out: str, labels: str | None, csv: str | None, reference: bool
) -> int:
    """Write the report of the gaits called `names`; returns the exit code."""
    page = output_file("--out", out, ".html")
    tables = None if csv is None else output_folder("--csv", csv)
    gaits = [load_gait(name) for name in names]
    given = file_labels(names) if labels is None else [part.strip() for part in labels.split(",")]
    comparison = compare(*gaits, labels=given, reference=reference)
    screen = console()
    quiet_drake()
    with screen.status("drawing ..."):
        comparison.save(page)
        if tables is not None:
            comparison.save_csv(tables)
    print_findings(screen, comparison)
    also = "" if csv is None else f", tables in {csv}"
    screen.print(f"Report in {out}{also}.", markup=False, soft_wrap=True)
    return 0 if comparison.trusted else NOT_TRUSTED


def print_findings(screen: Console, comparison: Comparison) -> None:
    """What the top of the page says: what not to trust, what differs, what happened."""
    for finding in troubles(comparison.numbers):
        style = "bold red" if finding.severe else "yellow"
        screen.print(finding.text, markup=False, style=style, soft_wrap=True)
    for summary in headline(comparison.numbers):
        screen.print(f"{summary.title}:", markup=False, soft_wrap=True)
        for sentence in summary.sentences:
            screen.print(f"  {sentence}", markup=False, soft_wrap=True)


def file_labels(names: Sequence[str]) -> list[str]:
    """Names of gaits by their files: `heavy` for `out/heavy`, `out/heavy/gait.nc`, `heavy.nc`."""
    found: list[str] = []
    for number, name in enumerate(names):
        path = gait_path(name).resolve()
        label = path.parent.name if path.stem == "gait" and path.parent.name else path.stem
        label = label[: LONGEST_LABEL - 5]
        found.append(label if label not in found else f"{label} ({number + 1})")
    return [label or Path(name).name for label, name in zip(found, names, strict=True)]
