"""`drakegait sweep`: read the file, solve what is open, print how far it is and how it ended."""

from __future__ import annotations

import time
from pathlib import Path
from types import TracebackType

from rich.console import Console
from rich.live import Live
from rich.table import Table
from rich.text import Text

from drakegait.commands.gait_files import output_folder
from drakegait.commands.screen import PLAIN_INTERVAL, clock, console
from drakegait.sweep import sweep_file
from drakegait.sweep.progress import SweepProgress
from drakegait.sweep.result import SweepResult
from drakegait.sweep.run import sweep as run

SOME_FAILED, INTERRUPTED = 3, 130
_ROWS_SHOWN = 40
_NAMES_SHOWN = 4


def sweep(
    file: str,
    out: str | None,
    workers: int | None,
    scheduler: str | None,
    retry_failed: bool,
    pictures: bool,
) -> int:
    """Run a sweep and show it; returns the exit code."""
    asked = sweep_file.read(file)
    folder = Path("out") / Path(file).stem if out is None else output_folder("--out", out)
    screen = console()
    display = SweepDisplay(screen)
    try:
        with display:
            result = run(
                asked.studies, folder, warm=asked.warm, options=asked.options,
                refine=asked.refine, workers=workers, scheduler=scheduler,
                retry_failed=retry_failed, axes=asked.axes, report=display.report,
            )  # fmt: skip
    except KeyboardInterrupt:
        tell_interrupted(screen, folder)
        return INTERRUPTED
    display.show_notes(result.notes)
    _print_end(screen, result)
    files = ["sweep.csv", "sweep.nc"]
    if pictures:
        files += [path.name for path in result.plot()]
    text = f"Files in {folder}: {', '.join(files)} and a folder for each study."
    screen.print(text, markup=False, soft_wrap=True)
    return SOME_FAILED if result.failures else 0


def tell_interrupted(screen: Console, folder: Path) -> None:
    """Say what Ctrl-C leaves."""
    text = f"Interrupted: finished studies are kept in {folder}. The same command goes on."
    screen.print(text, markup=False, soft_wrap=True)


class SweepDisplay:
    """Follows a sweep: one live line on a terminal, else a line every few seconds.

    Use as a context manager and hand `report` to `sweep`. Notes are printed once, above.
    """

    def __init__(self, screen: Console):
        self._screen = screen
        self._live: Live | None = None
        self._printed = 0.0
        self._told = 0
        self.last: SweepProgress | None = None

    def __enter__(self) -> SweepDisplay:
        if self._screen.is_terminal:
            self._live = Live(
                Text("preparing ..."), console=self._screen, auto_refresh=False, transient=True
            )
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

    def report(self, progress: SweepProgress) -> None:
        """Show how far it is."""
        before, self.last = self.last, progress
        self.show_notes(progress.notes)
        line = Text(progress_line(progress), no_wrap=True, overflow="ellipsis")
        if self._live is not None:
            self._live.update(line, refresh=True)
            return
        ended = progress.done + progress.failed
        news = before is None or ended > before.done + before.failed
        now = time.monotonic()
        if news or now - self._printed >= PLAIN_INTERVAL:
            self._printed = now
            print(progress_line(progress), flush=True)

    def show_notes(self, notes: tuple[str, ...]) -> None:
        """Print the notes that are new."""
        for note in notes[self._told :]:
            self._screen.print(note, markup=False, soft_wrap=True)
        self._told = max(self._told, len(notes))


def progress_line(progress: SweepProgress) -> str:
    """Counts, expected time and what runs, in one line."""
    left = "" if progress.expected is None else f", about {clock(progress.expected)} left"
    names = list(progress.running[:_NAMES_SHOWN])
    more = len(progress.running) - len(names)
    shown = ", ".join(names) + (f" and {more} more" if more else "")
    return (
        f"{progress.done} of {progress.total} done, {len(progress.running)} running, "
        f"{progress.failed} failed, {progress.waiting} waiting; {clock(progress.elapsed)}{left}"
        + (f": {shown}" if shown else "")
    )


def _print_end(screen: Console, result: SweepResult) -> None:
    """The main columns of the table, and the counts."""
    frame = result.table()
    heads = {"status": "", "cost_of_transport_J_per_m": "energy [J/m]",
             "deviation_s": "deviation [s]", "iterations": "iterations", "wall_time_s": "time [s]",
             "check_passed": "check"}  # fmt: skip
    table = Table(box=None, pad_edge=False)
    table.add_column("study")
    for head in heads.values():
        table.add_column(Text(head), justify="right")  # [s] would be markup
    for name, row in frame.head(_ROWS_SHOWN).iterrows():
        table.add_row(Text(str(name)), *(_cell(row[column]) for column in heads))
    screen.print(table)
    if len(frame) > _ROWS_SHOWN:
        screen.print(f"... and {len(frame) - _ROWS_SHOWN} more in sweep.csv")
    failed = len(result.failures)
    end = f"{len(frame) - failed} of {len(frame)} converged."
    if failed:
        end += f" {failed} failed; failed.json in their folders says why."
        end += " --retry-failed tries again."
    screen.print(end, markup=False, soft_wrap=True)


def _cell(value: object) -> Text:
    if isinstance(value, str):
        return Text(value)
    if value is None or value != value:  # nan
        return Text("-")
    if isinstance(value, bool):
        return Text("passed" if value else "not passed")
    return Text(f"{value:.4g}" if float(value) % 1 else f"{value:.0f}")  # type: ignore[arg-type]
