"""Several sweeps after one another: run, and shown while they run."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from rich.console import Console

from drakegait.commands.sweep import SweepDisplay, tell_interrupted
from drakegait.paper.chapter import Chapter
from drakegait.paper.results import Results
from drakegait.paper.run import run
from drakegait.sweep.progress import SweepProgress

SOLVES = "solves"
"""Folder of the sweeps in that of the answer."""


class Stages:
    """A display for each sweep, with its notes and a heading."""

    def __init__(self, screen: Console):
        self._screen = screen
        self._display: SweepDisplay | None = None

    def begin(self, sentence: str) -> None:
        """Another sweep begins."""
        self.end()
        self._screen.print(sentence, markup=False, soft_wrap=True)
        self._display = SweepDisplay(self._screen)
        self._display.__enter__()

    def report(self, progress: SweepProgress) -> None:
        """Show how far it is."""
        if self._display is not None:
            self._display.report(progress)

    def end(self) -> None:
        """The sweep has ended."""
        if self._display is not None:
            self._display.__exit__(None, None, None)
            self._display = None


def run_in_stages(
    screen: Console, chapters: Sequence[Chapter], folder: Path, workers: int | None,
    scheduler: str | None, retry_failed: bool,
) -> Results | None:  # fmt: skip
    """Run the chapters with progress on the screen; None after Ctrl-C, which is told."""
    stages = Stages(screen)
    try:
        return run(
            chapters, folder / SOLVES, workers=workers, scheduler=scheduler,
            retry_failed=retry_failed, report=stages.report, stage=stages.begin,
        )  # fmt: skip
    except KeyboardInterrupt:
        tell_interrupted(screen, folder)
        return None
    finally:
        stages.end()
