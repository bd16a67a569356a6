"""From a study to a gait: guess, solve, check, add control points where it fails."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

from drakegait.errors import InvalidInput
from drakegait.gait import Gait
from drakegait.program.starts import REFERENCE, Start
from drakegait.program.starts import starts as several_starts
from drakegait.rounds import Rounds
from drakegait.solvers.by_name import solver_of
from drakegait.solvers.monitor import Monitor, Progress
from drakegait.solvers.options import SolverOptions
from drakegait.starts import best_of
from drakegait.study import GaitStudy

MAX_ROUNDS = 3  # of added control points


def solve(
    study: GaitStudy,
    *,
    guess: Gait | None = None,
    options: SolverOptions | None = None,
    refine: bool = True,
    starts: int | Sequence[Start] = 1,
    seed: int = 0,
    report: Callable[[Progress], None] | None = None,
    **choices: object,
) -> Gait:
    """Find the gait of `study`.

    Args:
        study: what is asked.
        guess: an earlier gait to start from, of the same skeleton; default static
            optimisation along the reference, and with many nodes the walk with half as many.
        options: solver, tolerances, time limit; `choices` change single ones
            (`solver="snopt"`, `time_limit=60.0` [s]).
        refine: add control points where the check fails and solve again from there, at most
            `MAX_ROUNDS` times.
        starts: solve from so many starting points, one after the other, and keep the best: the
            guess, standing, silent muscles, then the reference with 10 to 30 per cent of noise;
            or from those given (`drakegait.program.starts`).
        seed: of the noise.
        report: called with the progress of the solve.

    Returns:
        A gait with its check, whatever happened: `gait.outcome` tells whether it converged
        and, if not, which laws are broken where. Ctrl-C and the time limit end the solve with
        the best gait so far.

    Raises:
        InvalidInput, UnknownName: a choice or guess that cannot be used.
    """
    options = (options or SolverOptions()).replace(**choices)
    if guess is not None:
        check_guess(study, guess)
    solver_of(options.solver)
    if options.derivatives != "analytic" and options.solver in ("ipopt", "snopt"):
        raise InvalidInput("solver", options.solver, "ipopt-mumps with finite differences")
    given = isinstance(starts, Sequence) and not isinstance(starts, str)
    points = list(starts) if given else several_starts(starts, seed)
    if not points:
        raise InvalidInput("starts", starts, "a whole number, or starting points, at least one")
    with Monitor(options.time_limit, report) as monitor:

        def attempt(start: Start) -> Gait:
            own = guess if start.kind == REFERENCE else None
            return _find(Rounds(study, options, monitor), own, start, refine)

        if len(points) == 1:
            return attempt(points[0])
        return best_of(points, attempt, lambda: monitor.stop_reason is not None)


def _find(run: Rounds, guess: Gait | None, start: Start, refine: bool) -> Gait:
    """One solve with its rounds of added control points."""
    run.first(guess, start)
    gait = run.gait()
    rounds = MAX_ROUNDS if refine else 0
    for _ in range(rounds):
        failing = gait.report.worst_phases() if run.solution.status == "converged" else set()
        if not failing or run.monitor.stop_reason is not None:
            break
        run.refine(failing)
        denser = run.gait()
        if denser.outcome.status != "converged":
            return _unrefined(gait, denser)
        gait = denser
    return gait


def _unrefined(gait: Gait, denser: Gait) -> Gait:
    """The last converged gait, with what was spent on a round that did not end."""
    outcome = replace(
        gait.outcome,
        iterations=denser.outcome.iterations,
        wall_time=denser.outcome.wall_time,
        setup_time=denser.outcome.setup_time,
        refinements=(
            *denser.outcome.refinements,
            f"the last round was dropped: {denser.outcome.message}",
        ),
    )
    return replace(gait, outcome=outcome)


def check_guess(study: GaitStudy, guess: Gait) -> None:
    """Refuse a guess of another skeleton than the study's.

    Raises:
        InvalidInput: naming what differs.
    """
    ours, theirs = study.skeleton_kind, guess.study.skeleton_kind
    if theirs != ours:
        allowed = f"{ours} or {ours}-symmetric, as the study is"
        raise InvalidInput("model of the guess", guess.study.model, allowed)
