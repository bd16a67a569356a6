"""All chapters solved, through `drakegait.sweep`, and measured."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

from drakegait.errors import DrakegaitError, UnknownName
from drakegait.gait import Gait
from drakegait.paper.chapter import Chapter
from drakegait.paper.results import Results, number_rows
from drakegait.solvers.options import SolverOptions
from drakegait.study import GaitStudy
from drakegait.sweep.progress import SweepProgress
from drakegait.sweep.result import SweepResult
from drakegait.sweep.run import sweep

STAGES = {
    "first": lambda chapter: chapter.refine and not chapter.after,
    "after": lambda chapter: chapter.refine and bool(chapter.after),
    "unrefined": lambda chapter: not chapter.refine,
}
"""Sweeps, each in a folder of its own: what waits for nothing, what builds on gaits of the first,
and what is solved without added control points."""


def run(
    chapters: Sequence[Chapter],
    folder: str | Path,
    *,
    workers: int | None = None,
    scheduler: str | None = None,
    retry_failed: bool = False,
    report: Callable[[SweepProgress], None] | None = None,
    stage: Callable[[str], None] | None = None,
    _solve: Callable[..., Gait] | None = None,
) -> Results:
    """Solve what is not solved yet, one solve a core, and measure.

    Chapters that others build on are solved along. Workers are processes that import the calling
    program: put the call below `if __name__ == "__main__":`.

    Args:
        chapters: of `drakegait.paper.contents.CHAPTERS`.
        folder: for the gaits; the same call goes on where an earlier one was ended.
        workers, scheduler, retry_failed, report: as `sweep` takes them.
        stage: called with a sentence when a sweep begins.

    Returns:
        The numbers and gaits of these chapters.

    Raises:
        what `sweep` raises.
    """
    from drakegait.paper.contents import CHAPTERS

    involved = with_needed(chapters, CHAPTERS)
    solved: dict[str, SweepResult] = {}
    for number, (name, belongs) in enumerate(STAGES.items(), 1):
        mine = [chapter for chapter in involved if belongs(chapter)]
        studies = _studies(mine, solved)
        if not studies:
            continue
        if stage is not None:
            stage(f"Sweep {number} of {len(STAGES)}: {', '.join(c.title for c in mine)}")
        warm = {key: guess for c in mine for key, guess in c.warm.items() if key in studies}
        options = dict.fromkeys(studies, SolverOptions())
        options |= {key: way for c in mine for key, way in c.options.items() if key in studies}
        result = sweep(
            studies, Path(folder) / name, warm=warm, options=options, refine=mine[0].refine,
            workers=workers, scheduler=scheduler, retry_failed=retry_failed, report=report,
            axes=_axes(mine, studies), _solve=_solve,
        )  # fmt: skip
        solved |= dict.fromkeys(studies, result)
    return _measured(chapters, solved)


def with_needed(chapters: Sequence[Chapter], known: Sequence[Chapter]) -> list[Chapter]:
    """The chapters and those whose studies they need, in the order of `known`."""
    everything = {chapter.name: chapter for chapter in (*known, *chapters)}
    owner = {study: c.name for c in reversed(everything.values()) for study in c.own_names}
    wanted: dict[str, Chapter] = {}
    open_names = [chapter.name for chapter in chapters]
    while open_names:
        name = open_names.pop()
        if name in wanted:
            continue
        wanted[name] = everything[name]
        open_names += [owner[study] for study in (*wanted[name].after, *wanted[name].compares)]
    return [chapter for name, chapter in everything.items() if name in wanted]


def chapter_named(name: str, chapters: Iterable[Chapter]) -> Chapter:
    """A chapter by its name; raises UnknownName."""
    names = {chapter.name: chapter for chapter in chapters}
    if name not in names:
        raise UnknownName("chapter", name, names)
    return names[name]


def _studies(
    chapters: Sequence[Chapter], solved: Mapping[str, SweepResult]
) -> dict[str, GaitStudy]:
    """What the chapters of a stage ask for; those whose gaits are missing are left out."""
    found: dict[str, GaitStudy] = {}
    for chapter in chapters:
        if any(name not in solved or name in solved[name].failures for name in chapter.after):
            continue
        for name, study in chapter.studies(*(solved[n].gait(n) for n in chapter.after)).items():
            if name in found and found[name] != study:
                raise DrakegaitError(f"Two chapters mean different studies by {name!r}.")
            found[name] = study
    return found


def _axes(chapters: Sequence[Chapter], studies: Iterable[str]) -> dict[str, dict[str, str]]:
    """Chapters are no grid: the table of a sweep says in which chapter a study comes first."""
    owner = {name: c.name for c in reversed(chapters) for name in c.own_names}
    return {name: {"chapter": owner[name]} for name in studies}


def _measured(chapters: Sequence[Chapter], solved: Mapping[str, SweepResult]) -> Results:
    rows: dict[str, dict[str, Any]] = {}
    for result in dict.fromkeys(solved.values()):
        rows |= number_rows(result)
    gaits = {name: result.gait(name) for name, result in solved.items()
             if name not in result.failures}  # fmt: skip
    return Results.measure(chapters, rows, gaits)
