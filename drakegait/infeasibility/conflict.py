"""The smallest set of laws that cannot all hold, by giving up laws group by group.

A law is given up by making it cheap to break while all others stay dear. If then nothing dear is
broken, every conflict needs that law. Those laws together are tested with all others given
up: if they still break, they are the only conflict and the smallest. If not, or if no law is in
every conflict, the deletion filter (Chinneck 2008, section 6.2) ends with one from which
no law can be left out. All solves find local optima; so does what follows from them. The laws of
mechanics are kept throughout: a conflict is one with them, and smallest beside them.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass

import numpy as np

from drakegait.errors import InvalidInput
from drakegait.gait import Gait
from drakegait.infeasibility.laws import MECHANICS, cheap_prices, laws_of
from drakegait.program.elastic import ElasticHessian, ElasticProgram
from drakegait.program.gait_program import GaitProgram
from drakegait.program.guess import guess_from_values
from drakegait.program.recentring import AT_BOUND, MOST_RECENTRINGS, far_from_centres
from drakegait.solvers.condensed.solve_elastic import ELASTIC_OPTIONS, solve_elastic
from drakegait.solvers.condensed.supported import why_not
from drakegait.solvers.monitor import Monitor
from drakegait.solvers.outcome import Outcome
from drakegait.solvers.solution import Solution
from drakegait.study import GaitStudy
from drakegait.transcription.design_vector import DesignValues


@dataclass(frozen=True, eq=False)
class Relaxed:
    """The walk that breaks the dear laws least.

    Attributes:
        given_up: names of the laws that were cheap.
        point: extended unknowns.
        missing: of each soft row, in its unit, see `ElasticProgram.missing` (num_soft,).
        broken: names of the dear laws that do not hold.
        converged: whether the solver ended at an optimum.
        pull: largest multiplier of each law, relative to its price when given up.
    """

    given_up: frozenset[str]
    point: np.ndarray
    missing: np.ndarray
    broken: tuple[str, ...]
    converged: bool
    pull: dict[str, float]


class Relaxation:
    """The elastic program of a study, solved with one set of laws given up after the other.

    Args:
        study: what has no walk.
        values: the unknowns to start from.
        monitor: of all solves.
        near: they are those of a walk that breaks the laws least, of this study or one like it.

    Attributes:
        program, elastic, laws: as their classes say.
        law_of_row: number of the law of each soft row (num_soft,).
    """

    def __init__(
        self, study: GaitStudy, values: DesignValues, monitor: Monitor, near: bool = False
    ):
        self.study, self._monitor, self._near = study, monitor, near
        self._state(values)

    def _state(self, values: DesignValues) -> None:
        self.program = GaitProgram(self.study.formulation(values.events))
        self.laws = laws_of(self.program)
        self.elastic = ElasticProgram.of(self.program)
        rows = np.argmax([law.rows for law in self.laws], axis=0)
        bounds = np.argmax([law.variables for law in self.laws], axis=0)[self.elastic.freed]
        self.law_of_row = np.concatenate([rows, bounds])[self.elastic.ends]
        self._dear, self._cheap = self.elastic.prices, cheap_prices(self.elastic)
        self._known: dict[frozenset[str], Relaxed] = {}
        self._first = self.elastic.start(guess_from_values(self.program, values))

    @property
    def names(self) -> tuple[str, ...]:
        """Of all laws."""
        return tuple(law.name for law in self.laws)

    def values(self, relaxed: Relaxed) -> DesignValues:
        """The unknowns of a walk that breaks laws."""
        return self.program.values(self.elastic.unknowns(relaxed.point))

    def gait(self, relaxed: Relaxed) -> Gait:
        """A walk that breaks laws, as the start of a solve."""
        outcome = Outcome(
            solver="condensed", status="failed", message="Laws were given up.", iterations=0,
            wall_time=0.0, setup_time=0.0, num_variables=0, num_constraints=0, jacobian_nonzeros=0,
        )  # fmt: skip
        points = self.program.formulation.schedule.interior_points
        return Gait(
            self.study.replace(interior_points=points), self.values(relaxed), outcome, {}
        )

    def least(self) -> Relaxed:
        """The walk that breaks all laws least; events are free to move far."""
        found = self.give_up(())
        for _ in range(MOST_RECENTRINGS):
            values = self.values(found)
            # What holds, holds wherever the events are.
            stop = self._monitor.stop_reason is not None or not found.broken
            if stop or not far_from_centres(self.program, values.events, AT_BOUND):
                break
            self._state(values)
            self._near = True
            found = self.give_up(())
        return found

    def give_up(self, names: Iterable[str], start: Relaxed | None = None) -> Relaxed:
        """The walk that breaks least with the laws of these names given up."""
        cheap = frozenset(names)
        if start is not None and cheap in self._known:
            return self._known[cheap]
        elastic, monitor = self.elastic, self._monitor
        given_up = np.array([law.name in cheap for law in self.laws])[self.law_of_row]
        elastic.prices = np.where(given_up, self._cheap, self._dear)
        solution = _solved(elastic, self._first if start is None else start.point, monitor,
                           near=self._near or start is not None)  # fmt: skip
        missing = elastic.missing(solution.x)
        off = self._largest(elastic.off(solution.x))
        broken = tuple(
            law.name
            for law, size in zip(self.laws, off, strict=True)
            if law.name not in cheap and size > 1.0
        )
        pulls = self._largest(np.abs(solution.row_multipliers[elastic.ends]) / self._cheap)
        found = Relaxed(
            cheap, solution.x, missing, broken, solution.status == "converged",
            dict(zip(self.names, map(float, pulls), strict=True)),
        )  # fmt: skip
        if monitor.stop_reason is None:
            self._known[cheap] = found
        return found

    def _largest(self, amounts: np.ndarray) -> np.ndarray:
        """The largest of each law's rows (num_laws,)."""
        most = np.zeros(len(self.laws))
        np.maximum.at(most, self.law_of_row, amounts)
        return most


def _solved(elastic: ElasticProgram, x: np.ndarray, monitor: Monitor, near: bool) -> Solution:
    """The elastic program minimised; programs outside the default solver's structure by IPOPT.

    Raises:
        InvalidInput: such a program, and IPOPT is not installed.
    """
    reason = why_not(elastic.program, ELASTIC_OPTIONS)
    if not reason:
        return solve_elastic(elastic, x, monitor, near)
    try:
        from drakegait.solvers.ipopt_mumps import solve_with_ipopt_mumps
    except ImportError:
        allowed = "on a machine with the package ipyopt, which relaxes the laws"
        raise InvalidInput(f"explaining a conflict with {reason}", "asked for", allowed) from None
    curvature = ElasticHessian(elastic) if elastic.formulation.lifted else None
    monitor.begin(elastic)
    return solve_with_ipopt_mumps(elastic, x, ELASTIC_OPTIONS, monitor, near, curvature)


@dataclass(frozen=True, eq=False)
class Conflict:
    """Laws that cannot all hold.

    Attributes:
        laws: names, in the order of `Relaxation.laws`.
        least: the walk that breaks all laws least.
        alone: for each law that was given up alone, the walk that was found.
        smallest: whether it was shown that none of them can be left out, and that they
            conflict with all others given up.
        unique: whether every conflict contains all of them.
    """

    laws: tuple[str, ...]
    least: Relaxed
    alone: dict[str, Relaxed]
    smallest: bool
    unique: bool


def find_conflict(
    relaxation: Relaxation, least: Relaxed, stopped: Callable[[], bool], say: Callable[[str], None]
) -> Conflict:
    """Give up one law after the other.

    Args:
        relaxation: of the study.
        least: the walk that breaks all laws least, and breaks some.
        stopped: whether to end with what is known.
        say: told what is tried next.
    """
    # A law whose multipliers stay below the lower price would be kept as well at that price:
    # giving it up changes nothing. Laws that a study states come first.
    suspects = [
        name for name in relaxation.names
        if name != MECHANICS and (name in least.broken or least.pull[name] > 1.0)
    ]  # fmt: skip
    alone: dict[str, Relaxed] = {}
    tested: tuple[str, ...] = ()
    for name in suspects:
        if stopped():
            return Conflict(_enough(alone), least, alone, False, False)
        say(f"giving up {name}")
        alone[name] = relaxation.give_up((name,), least)
        enough, last = _enough(alone), name == suspects[-1]
        if stopped() or enough == tested or (len(enough) < 2 and not last):
            continue
        # Each of these is in every conflict. If they are one, it is the only one.
        say("giving up all but " + ", ".join(enough))
        others = relaxation.give_up(set(relaxation.names) - {*enough, MECHANICS}, least)
        tested = enough
        if others.broken and not stopped():
            return Conflict(enough, least, alone, others.converged, True)
    enough = _enough(alone)
    given_up = set(relaxation.names) - {*suspects, MECHANICS}
    for name in [name for name in reversed(suspects) if name not in enough]:
        if stopped():
            return Conflict(enough, least, alone, False, False)
        say("giving up " + ", ".join([name, *sorted(given_up)]))
        if relaxation.give_up({*given_up, name}, least).broken:
            given_up.add(name)
    kept = [name for name in relaxation.names if name not in given_up]
    laws = tuple(name for name in kept if name != MECHANICS or kept == [MECHANICS])
    return Conflict(laws, least, alone, not stopped(), False)


def _enough(alone: dict[str, Relaxed]) -> tuple[str, ...]:
    """Laws without which the others hold."""
    return tuple(name for name, relaxed in alone.items() if not relaxed.broken)
