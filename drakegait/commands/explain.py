"""`drakegait explain` and the end of a `drakegait walk` that found no walk."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from rich.console import Console

from drakegait.commands.gait_files import SUMMARY_FILE, gait_path, load_gait
from drakegait.commands.screen import ProgressDisplay, console
from drakegait.errors import BadFile
from drakegait.gait import Gait
from drakegait.infeasibility.explain import MOST_REMEDIES, explain
from drakegait.infeasibility.explanation import UNKNOWN, WALKS, Explanation
from drakegait.whole_file import write_json

EXPLANATION = "explanation"  # key in summary.json
FEASIBLE_FILE, REMEDY_FILE = "feasible.nc", "remedy_{}.nc"
NOTHING_KNOWN = 3
# How a solve ends that looked everywhere it could; the others ran out of time.
EXPLAINED_STATUSES = ("infeasible", "failed", "iteration_limit", "acceptable")


def explain_file(name: str, time_limit: float, remedies: int) -> int:
    """Explain a saved gait, print it and add it to the summary beside; returns the exit code."""
    gait, folder = load_gait(name), gait_path(name).parent
    screen = console()
    found = explain_gait(screen, gait, folder, time_limit, remedies)
    summary = folder / SUMMARY_FILE
    if summary.is_file():
        write_json(summary, {**_read(summary), EXPLANATION: found.to_dict()})
    return NOTHING_KNOWN if found.verdict == UNKNOWN else 0


def explain_gait(
    screen: Console, gait: Gait, folder: Path, time_limit: float, remedies: int = MOST_REMEDIES
) -> Explanation:
    """Explain `gait`, print what was found and save the walks in `folder`."""
    with ProgressDisplay(screen) as display:
        found = explain(gait, time_limit=time_limit, remedies=remedies, report=display.task)
    title = "There is a walk:" if found.verdict == WALKS else "Why no walk was found:"
    screen.print(title, style="bold")
    for sentence in found.sentences:
        screen.print(sentence, markup=False, soft_wrap=True)
    saved = _save(found, folder)
    if saved:
        screen.print(
            f"Walks that were found: {', '.join(saved)} in {folder}; start from one with --guess.",
            markup=False, soft_wrap=True,
        )  # fmt: skip
    return found


def walks_in(folder: Path) -> list[str]:
    """Names of walks that an explanation left in a folder."""
    names = [path.name for path in folder.glob(REMEDY_FILE.format("*"))]
    return [*([FEASIBLE_FILE] if (folder / FEASIBLE_FILE).exists() else []), *sorted(names)]


def _save(found: Explanation, folder: Path) -> list[str]:
    """Write the walks that an explanation found; returns the names of the files."""
    walks = {FEASIBLE_FILE: found.gait} if found.gait is not None else {}
    walks |= {
        REMEDY_FILE.format(number): remedy.gait
        for number, remedy in enumerate(found.remedies, 1)
    }
    for name in set(walks_in(folder)) - set(walks):  # answers to another question
        (folder / name).unlink(missing_ok=True)
    for name, gait in walks.items():
        gait.save(folder / name)
    return list(walks)


def _read(path: Path) -> dict[str, Any]:
    try:
        return dict(json.loads(path.read_text(encoding="utf-8")))
    except (OSError, ValueError, TypeError):
        raise BadFile(path, "cannot be read: damaged, or not a summary.") from None
