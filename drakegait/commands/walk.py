"""`drakegait walk`: everything is validated, then solved, then saved, and compared if asked."""

from __future__ import annotations

import dataclasses
import time
from pathlib import Path

from rich.console import Console

from drakegait.commands.explain import EXPLAINED_STATUSES, EXPLANATION, explain_gait, walks_in
from drakegait.commands.gait_files import (
    FIGURES_FOLDER,
    GAIT_FILE,
    REPLAY_FILE,
    REPORT_FILE,
    SENSITIVITIES_FILE,
    SUMMARY_FILE,
    writable_folder,
)
from drakegait.commands.request import WalkRequest
from drakegait.commands.screen import (
    ProgressDisplay,
    console,
    print_report,
    print_starts,
    quiet_drake,
)
from drakegait.commands.unchanged import LABEL, UNCHANGED_FOLDER, known_gait, unchanged
from drakegait.errors import InvalidInput
from drakegait.gait import Gait
from drakegait.infeasibility.explanation import Explanation
from drakegait.report.study_words import who
from drakegait.solve import solve
from drakegait.solvers.options import SolverOptions
from drakegait.study import GaitStudy
from drakegait.whole_file import write_json

NOT_CONVERGED = 3
EXPLAIN_LIMIT = 300.0  # [s] for the explanation of a walk that was not found
_LEAST_EXPLAIN = 5.0  # [s] below which it is not begun


def walk(request: WalkRequest) -> int:
    """Solve what is asked, save and show it; returns the exit code."""
    study, options, guess = request.prepare()
    folder = writable_folder(request.out)
    screen = console()
    if not request.compare:
        _warn_of_old(screen, folder, REPORT_FILE)
        gait = _walk(screen, request, study, options, guess, folder)
        return 0 if gait.converged else NOT_CONVERGED
    other = writable_folder(folder / UNCHANGED_FOLDER)
    without = unchanged(study)
    before = known_gait(without, guess)
    if before is None:
        screen.print("First of two walks, the unchanged walker:", style="bold")
        bare = dataclasses.replace(request, no_pictures=True)
        before = _walk(screen, bare, without, options, guess, other)
        if before.outcome.status == "interrupted":
            _warn_of_old(screen, folder, GAIT_FILE, FIGURES_FOLDER, REPLAY_FILE, REPORT_FILE)
            _say(screen, "Interrupted in the first of two walks: the second was not solved, and "
                 "there is no comparison.")  # fmt: skip
            return NOT_CONVERGED
    else:
        _save(before, other)
        _say(screen, f"{request.guess} is the unchanged walker: not solved again.")
    # The same instants, so that the difference is the walker's alone.
    study = study.replace(interior_points=before.study.interior_points)
    screen.print("\nSecond walk, with what makes the walker differ:", style="bold")
    gait = _walk(screen, request, study, options, before, folder)
    _compare(screen, before, gait, folder)
    return 0 if before.converged and gait.converged else NOT_CONVERGED


def _walk(
    screen: Console, request: WalkRequest, study: GaitStudy, options: SolverOptions,
    guess: Gait | None, folder: Path,
) -> Gait:  # fmt: skip
    """One walk: solved, saved into `folder`, and shown."""
    _say(screen, f"{_who(study)}. Ctrl-C ends with the best gait so far.")
    started = time.monotonic()
    with ProgressDisplay(screen) as display:
        gait = solve(
            study, guess=guess, options=options, refine=request.refine, starts=request.starts,
            seed=request.seed, report=display.report,
        )  # fmt: skip
    earlier = walks_in(folder)
    files = _save(gait, folder)
    if gait.report is not None:
        print_report(screen, gait.report)
    print_starts(screen, gait.outcome)
    _print_end(screen, gait)
    if request.explain and gait.outcome.status in EXPLAINED_STATUSES:
        spent = time.monotonic() - started
        found = _explain(screen, gait, folder, options.time_limit - spent)
        if found is not None:
            earlier = []
            write_json(folder / SUMMARY_FILE, {**gait.summary(), EXPLANATION: found.to_dict()})
    _warn_of_old(screen, folder, *earlier)
    if request.no_pictures:
        _warn_of_old(screen, folder, FIGURES_FOLDER, REPLAY_FILE)
    else:
        try:
            files += _pictures(screen, gait, folder)
        except KeyboardInterrupt:
            _say(screen, "Interrupted while drawing: pictures are missing or of an earlier gait.")
        _warn_of_old(screen, folder, f"{FIGURES_FOLDER}/{SENSITIVITIES_FILE}")
    _say(screen, f"Files in {folder}: {', '.join(files)}.")
    return gait


def _save(gait: Gait, folder: Path) -> list[str]:
    gait.save(folder / GAIT_FILE)
    write_json(folder / SUMMARY_FILE, gait.summary())
    return [GAIT_FILE, SUMMARY_FILE]


def _compare(screen: Console, before: Gait, gait: Gait, folder: Path) -> None:
    """Write the report of both walks and say what was found."""
    from drakegait.commands.compare import print_findings
    from drakegait.report.compare import compare, default_labels

    quiet_drake()
    path = folder / REPORT_FILE
    label = default_labels((before, gait))[1]
    comparison = compare(before, gait, labels=(LABEL, label))
    try:
        with screen.status("comparing ..."):
            comparison.save(path)
    except KeyboardInterrupt:
        _warn_of_old(screen, folder, REPORT_FILE)
        _say(screen, "Interrupted while comparing: `drakegait compare "
             f"{folder / UNCHANGED_FOLDER} {folder}` makes up for it.")  # fmt: skip
        return
    print_findings(screen, comparison)
    _say(screen, f"Report in {path}; it opens in any browser and prints.")


def _who(study: GaitStudy) -> str:
    return f"{who(study)}, {study.speed:g} m/s, {study.nodes} nodes"


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
        _say(screen, line)


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


def _warn_of_old(screen: Console, folder: Path, *names: str) -> None:
    old = [name for name in names if (folder / name).exists()]
    if old:
        verb = "is" if len(old) == 1 else "are"
        _say(screen, f"Note: {', '.join(old)} in {folder} {verb} of an earlier walk.")


def _say(screen: Console, text: str) -> None:
    screen.print(text, markup=False, soft_wrap=True)
