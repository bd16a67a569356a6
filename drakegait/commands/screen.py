"""What the commands print: a live line while solving, tables, the end in plain words."""

from __future__ import annotations

import logging
import math
import time
from types import TracebackType

from rich.console import Console
from rich.live import Live
from rich.table import Table
from rich.text import Text

from drakegait.check import CheckReport
from drakegait.solvers.monitor import Progress
from drakegait.solvers.outcome import Outcome

PLAIN_WIDTH = 150  # columns where the output is no terminal
PLAIN_INTERVAL = 5.0  # [s] between lines where the output is no terminal


def console() -> Console:
    """Standard output; wide where it is a file or a pipe."""
    screen = Console(highlight=False)
    if not screen.is_terminal:
        screen.width = PLAIN_WIDTH
    return screen


def quiet_drake() -> None:
    """Keep Drake's own notes ("Meshcat listening ...") off the screen, but not its warnings."""
    logging.getLogger("drake").setLevel(logging.WARNING)


def progress_line(progress: Progress) -> str:
    """One iterate in one line; the name of the worst row is last, where it may be cut off."""
    worst = "every law holds"
    if progress.worst:
        law = progress.worst.replace(" | ", ", ")
        worst = f"{progress.violation:.2g} x tolerance: {law}"
    around = "" if progress.round == 1 else f"round {progress.round}  "
    return (
        f"{around}iteration {progress.iteration:<3d}  cost {progress.cost:<7.5g}  "
        f"{clock(progress.remaining)} left  {worst}"
    )


def clock(seconds: float) -> str:
    """Minutes and seconds, with hours if there are any."""
    whole = max(0, round(seconds))
    minutes, rest = divmod(whole, 60)
    hours, minutes = divmod(minutes, 60)
    return f"{hours}:{minutes:02d}:{rest:02d}" if hours else f"{minutes}:{rest:02d}"


class ProgressDisplay:
    """Follows a solve: one live line on a terminal, else a line every few seconds.

    Use as a context manager and hand `report` to `solve`.
    """

    def __init__(self, screen: Console):
        self._screen = screen
        self._live: Live | None = None
        self._last = -PLAIN_INTERVAL

    def __enter__(self) -> ProgressDisplay:
        if self._screen.is_terminal:
            # No refreshing thread: it would wait for the solver anyway.
            self._live = Live(
                self._text("preparing ..."), console=self._screen, auto_refresh=False,
                transient=True,
            )  # fmt: skip
            self._live.start(refresh=True)
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        if self._live is not None:
            self._live.stop()

    def report(self, progress: Progress) -> None:
        """Show an iterate."""
        self._show(progress_line(progress))

    def task(self, task: str, progress: Progress | None) -> None:
        """Show what is being tried, and how far it is."""
        if progress is None:
            self._last = -PLAIN_INTERVAL  # a new task is always worth a line
            self._show(f"explaining: {task}")
        else:
            left = clock(progress.remaining)
            self._show(f"explaining: {task}, iteration {progress.iteration}, {left} left")

    def _show(self, line: str) -> None:
        if self._live is not None:
            self._live.update(self._text(line), refresh=True)
        elif time.monotonic() - self._last >= PLAIN_INTERVAL:
            self._last = time.monotonic()
            print(line, flush=True)

    @staticmethod
    def _text(line: str) -> Text:
        return Text(line, no_wrap=True, overflow="ellipsis")


def print_report(screen: Console, report: CheckReport) -> None:
    """The table of a check."""
    screen.print(report.table())


def print_starts(screen: Console, outcome: Outcome) -> None:
    """How the solves from several starts ended; nothing if there was one."""
    if not outcome.starts:
        return
    table = Table(title="Starts", box=None)
    table.add_column("from")
    table.add_column("ended")
    for heading in ("f", "E [J/m]", "iterations", "s"):
        table.add_column(heading, justify="right")
    for record in outcome.starts:
        table.add_row(
            record.start, record.status, f"{record.cost:.4f}", f"{record.energy:.1f}",
            str(record.iterations), f"{record.wall_time:.1f}",
        )  # fmt: skip
    screen.print(table)
    if not math.isnan(outcome.spread):
        screen.print(
            f"Costs of those that converged lie within {100.0 * outcome.spread:.2f} %.",
            markup=False,
        )
