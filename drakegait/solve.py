"""From a study to a gait: guess, solve, check, add control points where it fails."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np

from drakegait.check import check
from drakegait.errors import InvalidInput
from drakegait.gait import Gait
from drakegait.program.differences import DifferencedProgram
from drakegait.program.gait_program import GaitProgram
from drakegait.program.guess import guess_from_values
from drakegait.program.kkt import KktMultipliers
from drakegait.program.recentring import far_from_centres
from drakegait.program.starts import REFERENCE, Start
from drakegait.program.starts import starts as several_starts
from drakegait.resampling import values_for
from drakegait.solvers.advice import advice_for
from drakegait.solvers.condensed.iterate import Multipliers
from drakegait.solvers.monitor import Monitor, Progress
from drakegait.solvers.options import SolverOptions
from drakegait.solvers.outcome import Outcome
from drakegait.solvers.solution import MESSAGES, Solution
from drakegait.starts import best_of
from drakegait.study import GaitStudy
from drakegait.transcription.design_vector import DesignValues

MAX_ROUNDS = 3  # of added control points
_MAX_RECENTRINGS = 3
_AT_BOUND = 0.98  # of the reach of an event


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
            optimisation along the reference.
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
    _solver(options.solver)
    if options.derivatives != "analytic" and options.solver in ("ipopt", "snopt"):
        raise InvalidInput("solver", options.solver, "ipopt-mumps with finite differences")
    points = several_starts(starts, seed) if isinstance(starts, int) else list(starts)
    with Monitor(options.time_limit, report) as monitor:

        def attempt(start: Start) -> Gait:
            own = guess if start.kind == REFERENCE else None
            return _find(_Run(study, options, monitor), own, start, refine)

        if len(points) == 1:
            return attempt(points[0])
        return best_of(points, attempt, lambda: monitor.stop_reason is not None)


def _find(run: _Run, guess: Gait | None, start: Start, refine: bool) -> Gait:
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


def _solver(name: str) -> Callable[..., Solution]:
    """The function behind a solver's name; loads its libraries.

    Raises:
        InvalidInput: ipopt-mumps where `ipyopt` is not installed; it has wheels for Linux on
            x86-64 only, Drake's solvers run everywhere.
    """
    if name == "condensed":
        from drakegait.solvers.condensed.solve import solve_condensed

        return solve_condensed
    if name != "ipopt-mumps":
        from drakegait.solvers.drake import solve_with_drake

        return solve_with_drake
    try:
        from drakegait.solvers.ipopt_mumps import solve_with_ipopt_mumps
    except ImportError:
        allowed = "ipopt or snopt on this machine, which lacks the package ipyopt"
        raise InvalidInput("solver", name, allowed) from None
    return solve_with_ipopt_mumps


def _with_points(study: GaitStudy, interior_points: tuple[int, ...]) -> GaitStudy:
    """The study with other control points, and the same walker and reference: no second parsing."""
    other = study.replace(interior_points=interior_points)
    vars(other).update(walker=study.walker, reference_walk=study.reference_walk)
    return other


class _Run:
    """The rounds of one solve."""

    def __init__(self, study: GaitStudy, options: SolverOptions, monitor: Monitor):
        self.study, self.options, self.monitor = study, options, monitor
        self.setup_time = 0.0
        self.solver_time = 0.0
        self.iterations = 0
        self.refinements: list[str] = []
        self.program: GaitProgram
        self.solution: Solution

    def _stated(self, events: np.ndarray | None) -> GaitProgram:
        """The program of the study, its events bounded about `events`."""
        differences = self.options.derivatives == "finite-differences"
        kind = DifferencedProgram if differences else GaitProgram
        return kind(self.study.formulation(events))

    def first(self, guess: Gait | None, start: Start) -> None:
        """The first round, from an earlier gait or else from `start`."""
        started = time.monotonic()
        if guess is None:
            study = self.study
            centres = start.event_centres(study.reference_walk, study.symmetric)
            self.program = self._stated(centres)
            x = start.point(self.program)
        else:
            self.program = self._stated(guess.values.events)
            x = guess_from_values(self.program, values_for(self.study, guess))
        self.setup_time += time.monotonic() - started
        self._solve(x, warm=guess is not None, known=None if guess is None else guess.kkt)
        self._recentre()

    def refine(self, phases: set[int]) -> None:
        """One more round with denser control points in `phases`."""
        schedule = self.program.formulation.schedule
        phases = {phase % schedule.num_phases for phase in phases}
        denser = schedule.refined(phases)
        self.refinements.append(
            f"{schedule.num_points} -> {denser.num_points} control points, added in phases "
            + ", ".join(str(phase + 1) for phase in sorted(phases))
        )
        self.study = _with_points(self.study, denser.interior_points)
        self._again(self.program.values(self.solution.x))
        self._recentre()

    def _again(self, values: DesignValues) -> None:
        started, known = time.monotonic(), self._multipliers()
        self.program = self._stated(values.events)
        x = guess_from_values(self.program, values)
        self.setup_time += time.monotonic() - started
        self._solve(x, warm=True, known=known)

    def _recentre(self) -> None:
        """Events are bounded so that control points keep their window; move the bounds along."""
        for _ in range(_MAX_RECENTRINGS):
            values = self.program.values(self.solution.x)
            at_bound = far_from_centres(self.program, values.events, _AT_BOUND)
            if self.solution.status != "converged" or not at_bound:
                return
            self._again(values)

    def _solve(self, x: np.ndarray, warm: bool, known: KktMultipliers | None = None) -> None:
        self.monitor.begin(self.program)
        started, program = time.monotonic(), self.program
        solve_program, more = _solver(self.options.solver), {}
        # Only this solver can start from multipliers, and only from those of the same rows.
        if self.options.solver == "condensed" and known is not None:
            sizes = len(known.rows), len(known.x)
            if sizes == (program.num_constraints, program.num_variables):
                more = {"known": Multipliers(known.rows, known.lower, known.upper)}
        self.solution = solve_program(program, x, self.options, self.monitor, warm, **more)
        self.program = self.solution.program or program
        self.solver_time += time.monotonic() - started
        self.iterations += self.solution.iterations

    def gait(self) -> Gait:
        """The gait that this round found, checked."""
        program, solution = self.program, self.solution
        worst = () if solution.status == "converged" else tuple(program.worst(solution.x))
        parts = program.cost_parts(solution.x)
        message = MESSAGES[solution.status]
        if solution.status not in ("time_limit", "interrupted"):  # then the solver knows no more
            message += f" ({solution.detail})"
        outcome = Outcome(
            solver=self.options.solver,
            status=solution.status,
            message=message,
            iterations=self.iterations,
            wall_time=self.solver_time,
            setup_time=self.setup_time,
            num_variables=program.num_variables,
            num_constraints=program.num_constraints,
            jacobian_nonzeros=program.num_entries,
            worst=tuple(str(item) for item in worst),
            advice=advice_for(solution.status, worst),
            refinements=tuple(self.refinements),
        )
        found = Gait(
            study=_with_points(self.study, program.formulation.schedule.interior_points),
            values=program.values(solution.x),
            outcome=outcome,
            cost={"total": sum(parts.values()), **parts},
            kkt=self._multipliers(),
        )
        return replace(found, report=check(found))

    def _multipliers(self) -> KktMultipliers | None:
        """Those of the solution, if the solver gave them for it."""
        solution, centres = self.solution, np.array(self.program.formulation.event_centres)
        given = solution.row_multipliers, solution.lower_multipliers, solution.upper_multipliers
        if solution.status not in ("converged", "acceptable") or any(x is None for x in given):
            return None
        return KktMultipliers(solution.x, *given, centres)
