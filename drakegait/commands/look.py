"""`drakegait check`, `plot` and `replay`: look at a gait that was saved."""

from __future__ import annotations

import time
from collections.abc import Sequence

from drakegait.check import check
from drakegait.commands.gait_files import (
    FIGURES_FOLDER,
    gait_path,
    load_gait,
    output_file,
    output_folder,
)
from drakegait.commands.screen import console, print_report, quiet_drake

NOT_PASSED = 3


def print_check(name: str, instants: int) -> int:
    """Judge a gait anew and print the table; returns the exit code."""
    gait = load_gait(name)
    report = check(gait, instants)
    screen = console()
    if not gait.converged:
        screen.print(f"This gait has not converged ({gait.outcome.status}).", markup=False)
    print_report(screen, report)
    return 0 if report.passed else NOT_PASSED


def draw_figures(name: str, folder: str | None, others: Sequence[str]) -> None:
    """Write the figures of a gait and say where they are."""
    default = str(gait_path(name).parent / FIGURES_FOLDER)
    target = output_folder("--out", default if folder is None else folder)
    gaits = [load_gait(each) for each in (name, *others)]
    from drakegait.report.figures import plot

    files = plot(gaits[0], target, gaits[1:])
    names = ", ".join(dict.fromkeys(path.stem for path in files))
    console().print(f"Figures in {target} (svg, png): {names}.", markup=False, soft_wrap=True)


def show_replay(name: str, html: str | None, strides: int, port: int | None) -> None:
    """Write the recording, or show it live until Ctrl-C."""
    page = None if html is None else output_file("--html", html, ".html")
    gait = load_gait(name)
    from drakegait.replay import replay

    quiet_drake()
    meshcat = replay(gait, html=page, strides=strides, port=port)
    if html is not None:
        console().print(f"Replay in {html}: open it in a browser.", markup=False, soft_wrap=True)
        return
    screen = console()
    screen.print(f"Replay at {meshcat.web_url()}; Ctrl-C ends it.", markup=False, soft_wrap=True)
    try:
        while True:
            time.sleep(1.0)
    except KeyboardInterrupt:
        screen.print("Ended.")
