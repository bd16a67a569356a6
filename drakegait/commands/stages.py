"""What is shown while several sweeps run after one another."""

from __future__ import annotations

from rich.console import Console

from drakegait.commands.sweep import SweepDisplay
from drakegait.sweep.progress import SweepProgress


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
