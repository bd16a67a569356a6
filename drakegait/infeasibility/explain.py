"""Why does this study have no walk?

    gait = solve(study)
    if not gait.converged:
        print(explain(gait))

First all laws are made elastic: if they can be held, the study is solved again from there. If
not, the smallest conflict is sought (`conflict`), the place where a law has to break (`place`),
and a change or two that help (`knobs`), each verified by a solve and its check.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

from drakegait.errors import InvalidInput
from drakegait.gait import Gait
from drakegait.infeasibility.conflict import Conflict, Relaxation, Relaxed, find_conflict
from drakegait.infeasibility.explanation import (
    CONFLICT,
    UNDECIDED,
    UNKNOWN,
    WALKS,
    Explanation,
    Remedy,
)
from drakegait.infeasibility.knobs import Knob, changed_study, knobs_for
from drakegait.infeasibility.laws import MUSCLES
from drakegait.infeasibility.place import Place, place_of, short_muscles
from drakegait.program.gait_program import GaitProgram
from drakegait.program.guess import guess_from_reference
from drakegait.solve import solve
from drakegait.solvers.monitor import Monitor, Progress
from drakegait.solvers.options import SolverOptions
from drakegait.solvers.outcome import Outcome
from drakegait.study import GaitStudy
from drakegait.study_rules import check_number

TIME_LIMIT = 600.0  # [s]
MOST_REMEDIES = 2
_FOR_CONFLICT = 0.6  # of the time; the rest is for remedies
_MAX_ITERATIONS = 200  # of a solve that verifies; walks take 40 to 150
_SHARE, _LEAST_SHARE = 0.25, 10.0  # of the time that is left, and [s], that one such solve may take
_MAX_HALVINGS = 4  # between a change that is too small and one that is enough
# Ends of a solve that was still on its way.
_ON_ITS_WAY = ("iteration_limit", "acceptable")
_LEAST_TIME = 1.0  # [s] without which no solve is begun


def explain(
    gait: Gait,
    *,
    time_limit: float = TIME_LIMIT,
    remedies: int = MOST_REMEDIES,
    report: Callable[[str, Progress | None], None] | None = None,
    **choices: object,
) -> Explanation:
    """Find out why the solve of `gait` did not converge.

    Args:
        gait: not converged. Where its solve ended at the iteration limit, it is continued first;
            otherwise only what was asked matters.
        time_limit: wall time for all of it [s], 1 to 1e6; what is known by then is returned,
            as after Ctrl-C.
        remedies: how many changes to look for, 0 to 5.
        report: told what is being tried, and of the progress of each solve.
        choices: options of the solves that verify, see `SolverOptions`.

    Raises:
        InvalidInput: the gait has converged; another form of the equations of motion than by
            components; this machine lacks `ipyopt`, which solves the elastic programs.
    """
    if gait.converged:
        raise InvalidInput("gait to explain", "converged", "one whose solve did not converge")
    check_number("time_limit", time_limit, 1.0, 1e6, "s")
    if isinstance(remedies, bool) or not isinstance(remedies, int) or not 0 <= remedies <= 5:
        raise InvalidInput("remedies", remedies, "a whole number from 0 to 5")
    options = SolverOptions(max_iterations=_MAX_ITERATIONS)
    search = _Search(gait.study, options.replace(**choices), time_limit, report)
    return search.run(remedies, gait if gait.outcome.status in _ON_ITS_WAY else None)


class _Search:
    """The steps of one explanation, and the time that they share."""

    def __init__(
        self,
        study: GaitStudy,
        options: SolverOptions,
        time_limit: float,
        report: Callable[[str, Progress | None], None] | None,
    ):
        self._study, self._options, self._report = study, options, report
        self._task = ""
        self._interrupted = False
        self._time_limit = time_limit
        self._monitor = Monitor(time_limit, self._progress)
        # The conflict may take so long; what remains is for the remedies.
        self._elastic = Monitor(_FOR_CONFLICT * time_limit, self._progress)

    # Time and words ----------------------------------------------------------------------

    def _progress(self, progress: Progress) -> None:
        if self._report is not None:
            remaining = self._monitor.remaining
            self._report(self._task, replace(progress, remaining=remaining))

    def _say(self, task: str) -> None:
        self._task = task
        if self._report is not None:
            self._report(task, None)

    @property
    def _ended(self) -> str | None:
        if self._interrupted or "interrupted" in (
            self._monitor.stop_reason, self._elastic.stop_reason,
        ):  # fmt: skip
            return "interrupted"
        short = self._monitor.remaining < _LEAST_TIME
        return "time_limit" if short else None

    # Steps -------------------------------------------------------------------------------

    def run(self, most: int, unfinished: Gait | None) -> Explanation:
        """The explanation, complete or as far as time allows."""
        with self._monitor:
            if unfinished is not None:
                self._say("continuing the solve")
                gait, _ = self._walk(self._study, (unfinished,))
                if gait is not None:
                    return self._told(Explanation(WALKS, gait=gait))
                if self._ended is not None:
                    return self._told(Explanation(UNKNOWN))
            self._say("making all laws elastic")
            program = GaitProgram(self._study.formulation())
            start = program.values(guess_from_reference(program))
            relaxation = Relaxation(self._study, start, self._elastic)
            with self._elastic:
                least = relaxation.least()
            if self._stopped_elastic() and least.broken:
                return self._told(Explanation(UNKNOWN))
            if not least.broken:
                return self._told(self._solved(relaxation, least))
            with self._elastic:
                conflict = find_conflict(relaxation, least, self._stopped_elastic, self._say)
            return self._told(self._explained(relaxation, conflict, most))

    def _stopped_elastic(self) -> bool:
        return self._ended is not None or self._elastic.stop_reason is not None

    def _told(self, found: Explanation) -> Explanation:
        ended = self._ended
        if found.verdict == CONFLICT and not found.conflict and ended is not None:
            found = Explanation(UNKNOWN)
        if ended is None and self._elastic.stop_reason == "time_limit" and not found.smallest:
            ended = "time_limit" if found.verdict in (CONFLICT, UNKNOWN) else None
        return replace(found, ended=ended, wall_time=self._monitor.elapsed)

    def _solved(self, relaxation: Relaxation, least: Relaxed) -> Explanation:
        """All laws can be held: the study itself, from there."""
        self._say("solving again from a walk that holds all laws")
        gait, why = self._walk(self._study, (_as_guess(relaxation, least), None))
        if gait is None:
            return Explanation(UNDECIDED, tried=(why,))
        return Explanation(WALKS, gait=gait)

    def _explained(self, relaxation: Relaxation, conflict: Conflict, most: int) -> Explanation:
        laws = [law for law in relaxation.laws if law.name in conflict.laws]
        enough = {
            name: relaxed for name, relaxed in conflict.alone.items() if not relaxed.broken
        }
        place = _place(relaxation, enough, conflict)
        muscular = place if place is not None and place.law == MUSCLES else None
        short = () if muscular is None else short_muscles(relaxation, enough[MUSCLES])
        found: list[_Turned] = []
        tried: list[str] = []
        for knob in knobs_for(relaxation, enough, muscular, short):
            if len(found) == most or self._ended is not None:
                break
            if any(knob.law == other.knob.law for other in found):
                continue
            turned = self._turn(knob, _as_guess(relaxation, enough[knob.law]), tried)
            if turned is not None:
                found.append(turned)
        found = [self._milder(turned) for turned in found]
        return Explanation(
            CONFLICT,
            conflict=conflict.laws,
            stated=tuple(law.words for law in laws if law.stated),
            others=tuple(law.words for law in laws if not law.stated),
            smallest=conflict.smallest,
            unique=conflict.unique,
            place=place,
            remedies=tuple(turned.remedy for turned in found),
            settled=conflict.least.converged,
            tried=tuple(tried),
        )

    def _turn(self, knob: Knob, near: Gait, tried: list[str]) -> _Turned | None:
        """The first of the knob's values with which a walk is found."""
        failed, why = knob.now, ""
        for value in knob.values:
            study = changed_study(knob, value)
            if study is None:
                continue
            words = knob.words(value)
            self._say(f"solving {words}")
            gait, why = self._walk(study, (near, None))
            if gait is not None:
                return _Turned(knob, failed, value, Remedy(words, study, gait))
            if self._ended is not None:
                return None
            failed = value
        if why:
            tried.append(f"{knob.words(failed)} ({why})")
        return None

    def _milder(self, turned: _Turned) -> _Turned:
        """The mildest change that is enough, by halving; each walk starts from the last."""
        knob = turned.knob
        for _ in range(_MAX_HALVINGS):
            value = knob.middle(turned.failed, turned.value)
            study = None if value is None else changed_study(knob, value)
            if value is None or study is None or self._ended is not None:
                break
            words = knob.words(value)
            self._say(f"solving {words}")
            gait, _ = self._walk(study, (turned.remedy.gait,))
            if gait is None:
                turned = replace(turned, failed=value)
            else:
                turned = replace(turned, value=value, remedy=Remedy(words, study, gait))
        return turned

    def _walk(
        self, study: GaitStudy, guesses: Sequence[Gait | None]
    ) -> tuple[Gait | None, str]:
        """A walk of `study`, converged and with its check passed, and else why there is none."""
        why = "no time was left"
        for guess in guesses:
            if self._ended is not None:
                break
            left = self._monitor.remaining
            time_limit = min(max(_SHARE * left, _LEAST_SHARE), max(left, _LEAST_TIME))
            options = self._options.replace(time_limit=time_limit)
            gait = solve(study, guess=guess, options=options, report=self._progress)
            self._interrupted |= gait.outcome.status == "interrupted"
            if not gait.converged:
                why = "did not converge"
            elif gait.report is None or not gait.report.passed:
                items = () if gait.report is None else gait.report.items
                failed = ", ".join(item.label for item in items if not item.passed)
                why = f"converged, but its check failed: {failed}"
            else:
                return gait, ""
        return None, why


@dataclass(frozen=True, eq=False)
class _Turned:
    """A change that is enough, and the next milder one that is not."""

    knob: Knob
    failed: float
    value: float
    remedy: Remedy


def _place(
    relaxation: Relaxation, enough: dict[str, Relaxed], conflict: Conflict
) -> Place | None:
    """Where the muscles are too weak, or else where a law breaks that alone is enough."""
    laws = sorted(enough, key=lambda name: name != MUSCLES)
    laws += [name for name in conflict.alone if name not in laws and name in conflict.laws]
    places = [place_of(relaxation, conflict.alone[law], law) for law in laws]
    known = [place for place in places if place is not None]
    # What has an instant tells more than what holds for the stride.
    return min(known, key=lambda place: not place.when, default=None)


def _as_guess(relaxation: Relaxation, relaxed: Relaxed) -> Gait:
    """A walk that breaks laws, as the start of a solve."""
    outcome = Outcome(
        solver="ipopt-mumps", status="failed", message="Laws were given up.", iterations=0,
        wall_time=0.0, setup_time=0.0, num_variables=0, num_constraints=0, jacobian_nonzeros=0,
    )  # fmt: skip
    study = relaxation.study.replace(
        interior_points=relaxation.program.formulation.schedule.interior_points
    )
    return Gait(study, relaxation.values(relaxed), outcome, {})
