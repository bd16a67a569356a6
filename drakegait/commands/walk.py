"""`drakegait walk`: everything is validated, then solved, then saved."""

from __future__ import annotations

import time
from pathlib import Path

from rich.console import Console

from drakegait.commands.explain import EXPLAINED_STATUSES, EXPLANATION, explain_gait
from drakegait.commands.gait_files import (
    FIGURES_FOLDER,
    GAIT_FILE,
    REPLAY_FILE,
    SUMMARY_FILE,
    writable_folder,
    write_summary,
)
from drakegait.commands.request import WalkRequest
from drakegait.commands.screen import (
    ProgressDisplay,
    console,
    print_report,
    print_starts,
    quiet_drake,
)
from drakegait.errors import InvalidInput
from drakegait.gait import Gait
from drakegait.infeasibility.explanation import Explanation
from drakegait.solve import solve
from drakegait.study import GaitStudy

NOT_CONVERGED = 3
EXPLAIN_LIMIT = 300.0  # [s] for the explanation of a walk that was not found
_LEAST_EXPLAIN = 5.0  # [s] below which it is not begun


def walk(request: WalkRequest) -> int:
    """Solve what is asked, save and show it; returns the exit code."""
    study, options, guess = request.prepare()
    folder = writable_folder(request.out)
    screen, started = console(), time.monotonic()
    screen.print(f"{_who(study)}. Ctrl-C ends with the best gait so far.", markup=False)
    with ProgressDisplay(screen) as display:
        gait = solve(
            study, guess=guess, options=options, refine=request.refine, starts=request.starts,
            seed=request.seed, report=display.report,
        )  # fmt: skip
    gait.save(folder / GAIT_FILE)
    summary = gait.summary()
    write_summary(summary, folder / SUMMARY_FILE)
    if gait.report is not None:
        print_report(screen, gait.report)
    print_starts(screen, gait.outcome)
    _print_end(screen, gait)
    if request.explain and gait.outcome.status in EXPLAINED_STATUSES:
        spent = time.monotonic() - started
        found = _explain(screen, gait, folder, options.time_limit - spent)
        if found is not None:
            write_summary({**summary, EXPLANATION: found.to_dict()}, folder / SUMMARY_FILE)
    files = [GAIT_FILE, SUMMARY_FILE]
    if request.no_pictures:
        _warn_of_old_pictures(screen, folder)
    else:
        try:
            files += _pictures(screen, gait, folder)
        except KeyboardInterrupt:
            screen.print("Interrupted while drawing: pictures are missing or of an earlier gait.")
    screen.print(f"Files in {folder}: {', '.join(files)}.", markup=False, soft_wrap=True)
    return 0 if gait.converged else NOT_CONVERGED


def _who(study: GaitStudy) -> str:
    subject = study.subject
    worn = "".join(f", {item.mass:g} kg on {item.segment}" for item in study.added_masses)
    worn += "".join(f", {item.describe()}" for item in study.disorders)
    return (
        f"{study.model} walker, {subject.height:g} m, {subject.mass:g} kg{worn}, "
        f"{study.speed:g} m/s, {study.nodes} nodes"
    )


def _print_end(screen: Console, gait: Gait) -> None:
    """How it ended and the main numbers, in plain words."""
    outcome, report = gait.outcome, gait.report
    state = "Converged" if gait.converged else f"NOT CONVERGED ({outcome.status})"
    lines = [
        f"{state} after {outcome.iterations} iterations, {outcome.wall_time:.1f} s in the solver "
        f"and {outcome.setup_time:.1f} s before it. {outcome.message}"
    ]
    lines += [f"Refined: {step}." for step in outcome.refinements]
    lines += [f"Holds least: {row}" for row in outcome.worst]
    if outcome.advice:
        lines.append(f"What to try: {outcome.advice}")
    if report is not None and not report.passed:
        failed = "; ".join(item.label for item in report.items if not item.passed)
        which = "Converged, but the check" if gait.converged else "The check"
        lines.append(f"{which} did NOT pass: {failed}.")
    kilogram = gait.metabolic.cost_of_transport / gait.study.subject.mass
    lines.append(
        f"Cost of transport {gait.metabolic.cost_of_transport:.1f} J/m ({kilogram:.2f} J/(kg m)), "
        f"{gait.speed:.3f} m/s, stride {gait.stride_length:.3f} m in {gait.stride_time:.3f} s."
    )
    for line in lines:
        screen.print(line, markup=False, soft_wrap=True)


def _explain(screen: Console, gait: Gait, folder: Path, left: float) -> Explanation | None:
    """Why no walk was found, as far as the time allows; None if it could not be asked."""
    limit = min(EXPLAIN_LIMIT, left)
    if limit < _LEAST_EXPLAIN:
        screen.print("No time is left to explain it: drakegait explain does.", markup=False)
        return None
    try:
        return explain_gait(screen, gait, folder, limit)
    except InvalidInput as error:
        screen.print(f"Not explained: {error}", markup=False, soft_wrap=True)
        return None


def _pictures(screen: Console, gait: Gait, folder: Path) -> list[str]:
    """Draw and record; these need Matplotlib and Meshcat, which are slow to import."""
    from drakegait.replay import replay
    from drakegait.report.figures import plot

    quiet_drake()
    with screen.status("drawing ..."):
        plot(gait, folder / FIGURES_FOLDER)
        replay(gait, html=folder / REPLAY_FILE)
    return [f"{FIGURES_FOLDER}/", REPLAY_FILE]


def _warn_of_old_pictures(screen: Console, folder: Path) -> None:
    old = [name for name in (FIGURES_FOLDER, REPLAY_FILE) if (folder / name).exists()]
    if old:
        screen.print(
            f"Note: {' and '.join(old)} in {folder} show an earlier gait.", markup=False,
            soft_wrap=True,
        )  # fmt: skip
