"""Why does this study have no walk?

    gait = solve(study)
    if not gait.converged:
        print(explain(gait))

First all laws are made elastic: if they can be held, the study is solved again from there. If
not, the smallest conflict is sought (`conflict`), the place where a law has to break (`place`),
and a change or two that help (`remedies`), each verified by a solve and its check.
"""

from __future__ import annotations

from dataclasses import replace

from drakegait.errors import InvalidInput
from drakegait.gait import Gait
from drakegait.infeasibility.attempts import Attempts, Report
from drakegait.infeasibility.conflict import Conflict, Relaxation, Relaxed, find_conflict
from drakegait.infeasibility.explanation import (
    CONFLICT,
    UNDECIDED,
    UNKNOWN,
    WALKS,
    Explanation,
    Remedy,
)
from drakegait.infeasibility.knobs import knobs_for
from drakegait.infeasibility.laws import MUSCLES
from drakegait.infeasibility.place import Place, place_of, short_muscles
from drakegait.infeasibility.remedies import MOST_FAILURES, RemedySearch
from drakegait.program.gait_program import GaitProgram
from drakegait.program.guess import guess_from_reference
from drakegait.quantities import check_count, check_number
from drakegait.solvers.options import SolverOptions

TIME_LIMIT = 600.0  # [s]
MOST_REMEDIES = 2
_LATER_FAILURES = 2  # solves without success once a remedy is known
_MAX_ITERATIONS = 200  # of a solve that verifies; walks take 40 to 150
# Ends of a solve that was still on its way.
_ON_ITS_WAY = ("iteration_limit", "acceptable")


def explain(
    gait: Gait,
    *,
    time_limit: float = TIME_LIMIT,
    remedies: int = MOST_REMEDIES,
    report: Report | None = None,
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
            components; a program that the default solver does not take, on a machine that lacks
            `ipyopt`, which does.
    """
    if gait.converged:
        raise InvalidInput("gait to explain", "converged", "one whose solve did not converge")
    check_number("time_limit", time_limit, 1.0, 1e6, "s")
    check_count("remedies", remedies, 0, 5)
    options = SolverOptions(max_iterations=_MAX_ITERATIONS)
    attempts = Attempts(time_limit, options.replace(**choices), report)
    with attempts.monitor:
        found = _explained(gait, remedies, attempts)
    ended = attempts.ended
    if found.verdict == CONFLICT and not found.conflict and ended is not None:
        found = Explanation(UNKNOWN)
    late = attempts.elastic.stop_reason == "time_limit" and not found.smallest
    if ended is None and late and found.verdict in (CONFLICT, UNKNOWN):
        ended = "time_limit"
    return replace(found, ended=ended, wall_time=attempts.monitor.elapsed)


def _explained(gait: Gait, most: int, attempts: Attempts) -> Explanation:
    """The explanation, complete or as far as time allows."""
    study = gait.study
    if gait.outcome.status in _ON_ITS_WAY:
        attempts.say("continuing the solve")
        walk, _ = attempts.walk(study, (gait,))
        if walk is not None:
            return Explanation(WALKS, gait=walk)
        if attempts.ended is not None:
            return Explanation(UNKNOWN)
    attempts.say("making all laws elastic")
    program = GaitProgram(study.formulation())
    start = program.values(guess_from_reference(program))
    relaxation = Relaxation(study, start, attempts.elastic)
    with attempts.elastic:
        least = relaxation.least()
    if attempts.conflict_ended() and least.broken:
        return Explanation(UNKNOWN)
    if not least.broken:
        attempts.say("solving again from a walk that holds all laws")
        walk, why = attempts.walk(study, (relaxation.gait(least), None))
        if walk is None:
            return Explanation(UNDECIDED, tried=(why,))
        return Explanation(WALKS, gait=walk)
    with attempts.elastic:
        conflict = find_conflict(relaxation, least, attempts.conflict_ended, attempts.say)
    return _told(relaxation, conflict, most, attempts)


def _told(
    relaxation: Relaxation, conflict: Conflict, most: int, attempts: Attempts
) -> Explanation:
    """The conflict, its place and what helps."""
    laws = [law for law in relaxation.laws if law.name in conflict.laws]
    enough = {name: relaxed for name, relaxed in conflict.alone.items() if not relaxed.broken}
    place = _place(relaxation, enough, conflict)
    muscular = place if place is not None and place.law == MUSCLES else None
    short = () if muscular is None else short_muscles(relaxation, enough[MUSCLES])
    found: dict[str, Remedy] = {}  # by the law that they ease
    tried: list[str] = []
    failures: dict[str, int] = {}
    later = 0
    for knob in knobs_for(relaxation, enough, muscular, short):
        if len(found) == most or attempts.ended is not None:
            break
        # Another remedy beside one is not worth many solves.
        spent = MOST_FAILURES - _LATER_FAILURES + later if found else failures.get(knob.law, 0)
        if knob.law in found or spent >= MOST_FAILURES:
            continue
        search = RemedySearch(knob, relaxation.gait(enough[knob.law]), attempts, spent)
        remedy = search.run()
        if found:
            later += search.failures - spent
        failures[knob.law] = search.failures
        if remedy is not None:
            found[knob.law] = remedy
        elif search.why:
            tried.append(search.why)
    return Explanation(
        CONFLICT,
        conflict=conflict.laws,
        stated=tuple(law.words for law in laws if law.stated),
        others=tuple(law.words for law in laws if not law.stated),
        smallest=conflict.smallest,
        unique=conflict.unique,
        place=place,
        remedies=tuple(found.values()),
        settled=conflict.least.converged,
        tried=tuple(tried),
    )


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
