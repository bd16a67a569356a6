"""From a study to a gait: guess, solve, check, add control points where it fails."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import replace

import numpy as np

from drakegait.check import check
from drakegait.errors import InvalidInput
from drakegait.gait import Gait
from drakegait.program.gait_program import GaitProgram
from drakegait.program.guess import guess_from_reference, guess_from_values
from drakegait.solvers.advice import advice_for
from drakegait.solvers.monitor import Monitor, Progress
from drakegait.solvers.options import SolverOptions
from drakegait.solvers.outcome import Outcome
from drakegait.solvers.solution import MESSAGES, Solution
from drakegait.study import GaitStudy
from drakegait.transcription.design_vector import DesignValues

MAX_ROUNDS = 3  # of added control points
_MAX_RECENTRINGS = 3
_AT_BOUND = 0.02  # of the reach of an event


def solve(
    study: GaitStudy,
    *,
    guess: Gait | None = None,
    options: SolverOptions | None = None,
    refine: bool = True,
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
    started = time.monotonic()
    with Monitor(options.time_limit, report) as monitor:
        run = _Run(study, options, monitor)
        run.first(guess)
        gait = run.gait(started)
        rounds = MAX_ROUNDS if refine else 0
        for _ in range(rounds):
            failing = gait.report.worst_phases() if run.solution.status == "converged" else set()
            if not failing or monitor.stop_reason is not None:
                break
            run.refine(failing)
            denser = run.gait(started)
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
    if name != "ipopt-mumps":
        from drakegait.solvers.drake import solve_with_drake

        return solve_with_drake
    try:
        from drakegait.solvers.ipopt_mumps import solve_with_ipopt_mumps
    except ImportError:
        allowed = "ipopt or snopt on this machine, which lacks the package ipyopt"
        raise InvalidInput("solver", name, allowed) from None
    return solve_with_ipopt_mumps


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

    def first(self, guess: Gait | None) -> None:
        """The first round, from the reference or from an earlier gait."""
        started = time.monotonic()
        events = None if guess is None else guess.values.events
        self.program = GaitProgram(self.study.formulation(events))
        if guess is None:
            x = guess_from_reference(self.program)
        else:
            x = guess_from_values(self.program, self._resampled(guess))
        self.setup_time += time.monotonic() - started
        self._solve(x, warm=guess is not None)
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
        self.study = self.study.replace(interior_points=denser.interior_points)
        self._again(self.program.values(self.solution.x))
        self._recentre()

    def _again(self, values: DesignValues) -> None:
        started = time.monotonic()
        self.program = GaitProgram(self.study.formulation(values.events))
        x = guess_from_values(self.program, values)
        self.setup_time += time.monotonic() - started
        self._solve(x, warm=True)

    def _recentre(self) -> None:
        """Events are bounded so that control points keep their window; move the bounds along."""
        for _ in range(_MAX_RECENTRINGS):
            formulation = self.program.formulation
            values = self.program.values(self.solution.x)
            moved = np.abs(values.events - np.array(formulation.event_centres))
            at_bound = np.any(moved > (1.0 - _AT_BOUND) * formulation.event_reach)
            if self.solution.status != "converged" or not at_bound:
                return
            self._again(values)

    def _solve(self, x: np.ndarray, warm: bool) -> None:
        self.monitor.begin(self.program)
        started = time.monotonic()
        solve_program = _solver(self.options.solver)
        self.solution = solve_program(self.program, x, self.options, self.monitor, warm)
        self.solver_time += time.monotonic() - started
        self.iterations += self.solution.iterations

    def _resampled(self, guess: Gait) -> DesignValues:
        """The guess on this study's nodes; its contact forces are fitted anew if points differ."""
        values, nodes = guess.values, self.study.nodes
        splines = self.program.formulation.splines
        if guess.study.nodes != nodes:
            samples = np.arange(8 * nodes) / (8 * nodes)
            values = replace(
                values,
                coordinate_coefficients=splines.fit(
                    samples, guess.splines.evaluate(values.coordinate_coefficients, samples)
                ),
                force_coefficients=splines.fit(
                    samples, guess.splines.evaluate(values.force_coefficients, samples)
                ),
            )
        return values

    def gait(self, started: float) -> Gait:
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
            study=self.study.replace(interior_points=program.formulation.schedule.interior_points),
            values=program.values(solution.x),
            outcome=outcome,
            cost={"total": sum(parts.values()), **parts},
        )
        return replace(found, report=check(found))
