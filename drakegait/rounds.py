"""The rounds of one solve: from fewer nodes, with events moved along, with added control points."""

from __future__ import annotations

import time
from dataclasses import replace

import numpy as np

from drakegait.check import check
from drakegait.gait import Gait
from drakegait.program.differences import DifferencedProgram
from drakegait.program.gait_program import GaitProgram
from drakegait.program.guess import guess_from_values
from drakegait.program.kkt import KktMultipliers
from drakegait.program.recentring import AT_BOUND, MOST_RECENTRINGS, far_from_centres
from drakegait.program.starts import Start
from drakegait.resampling import values_for
from drakegait.solvers.advice import advice_for
from drakegait.solvers.by_name import solver_of
from drakegait.solvers.condensed.iterate import Multipliers
from drakegait.solvers.monitor import Monitor
from drakegait.solvers.options import SolverOptions
from drakegait.solvers.outcome import Outcome
from drakegait.solvers.solution import MESSAGES, Solution
from drakegait.study import GaitStudy
from drakegait.transcription.design_vector import DesignValues

# From so many nodes on it is quicker to begin with half as many (docs/formulation.md 12.4).
MANY_NODES = 48


def _changed(study: GaitStudy, **statements: object) -> GaitStudy:
    """The study with other nodes or points, same walker and reference: no second parsing."""
    other = study.replace(**statements)
    vars(other).update(walker=study.walker, reference_walk=study.reference_walk)
    return other


class Rounds:
    """The rounds of one solve.

    Args:
        study: what is asked; control points may be added to it.
        options, monitor: of the solve.

    Attributes:
        program, solution: of the last round.
    """

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
        """The first round, from an earlier gait or else from `start`.

        With many nodes it begins at the walk with half as many.
        """
        if guess is None and self.study.nodes >= MANY_NODES:
            guess = self._coarser(start)
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

    def _coarser(self, start: Start) -> Gait | None:
        """The walk with half as many nodes; None if that gets nowhere."""
        nodes = self.study.nodes // 2
        if self.study.symmetric:
            nodes += 1 - nodes % 2
        coarser = Rounds(_changed(self.study, nodes=nodes), self.options, self.monitor)
        coarser.first(None, start)
        self.iterations += coarser.iterations
        self.setup_time += coarser.setup_time
        self.solver_time += coarser.solver_time
        if coarser.solution.status != "converged" and self.monitor.stop_reason is None:
            return None
        self.refinements += coarser.refinements
        self.refinements.append(
            f"{nodes} -> {self.study.nodes} spline nodes, after {coarser.iterations} iterations"
        )
        return coarser.unchecked()

    def refine(self, phases: set[int]) -> None:
        """One more round with denser control points in `phases`."""
        schedule = self.program.formulation.schedule
        phases = {phase % schedule.num_phases for phase in phases}
        denser = schedule.refined(phases)
        self.refinements.append(
            f"{schedule.num_points} -> {denser.num_points} control points, added in phases "
            + ", ".join(str(phase + 1) for phase in sorted(phases))
        )
        self.study = _changed(self.study, interior_points=denser.interior_points)
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
        for _ in range(MOST_RECENTRINGS):
            values = self.program.values(self.solution.x)
            at_bound = far_from_centres(self.program, values.events, AT_BOUND)
            if self.solution.status != "converged" or not at_bound:
                return
            self._again(values)

    def _solve(self, x: np.ndarray, warm: bool, known: KktMultipliers | None = None) -> None:
        self.monitor.begin(self.program)
        started, program = time.monotonic(), self.program
        solve_program, more = solver_of(self.options.solver), {}
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
        """The gait that the last round found, checked."""
        found = self.unchecked()
        return replace(found, report=check(found))

    def unchecked(self) -> Gait:
        """The gait that the last round found."""
        program, solution = self.program, self.solution
        worst = () if solution.status == "converged" else tuple(program.worst(solution.x))
        parts = program.cost_parts(solution.x)
        message = MESSAGES[solution.status]
        if solution.detail and solution.status not in ("time_limit", "interrupted"):
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
        points = program.formulation.schedule.interior_points
        return Gait(
            study=_changed(self.study, interior_points=points),
            values=program.values(solution.x),
            outcome=outcome,
            cost={"total": sum(parts.values()), **parts},
            kkt=self._multipliers(),
        )

    def _multipliers(self) -> KktMultipliers | None:
        """Those of the solution, if the solver gave them for it."""
        solution, centres = self.solution, np.array(self.program.formulation.event_centres)
        given = solution.row_multipliers, solution.lower_multipliers, solution.upper_multipliers
        if solution.status not in ("converged", "acceptable") or any(x is None for x in given):
            return None
        return KktMultipliers(solution.x, *given, centres)
