"""The search for the mildest change, on a walker whose limits are known."""

from __future__ import annotations

import pytest
from infeasibility_cases import TINY

from drakegait.infeasibility import remedies as remedies_module
from drakegait.infeasibility.knobs import Knob
from drakegait.infeasibility.remedies import MOST_FAILURES, RemedySearch


def _middle(failed: float, good: float) -> float | None:
    half = 0.5 * (failed + good)
    return half if abs(good - failed) > 10.0 else None


KNOB = Knob(
    "muscles", 0.0, (50.0, 100.0, 200.0, 400.0), lambda value: TINY,
    lambda value: f"with {value:g} more", _middle, True,
)  # fmt: skip


class Limits:
    """Laws hold from `holds` on; walks are found from `walks` on."""

    def __init__(self, holds: float, walks: float, solves: int = 99):
        self.holds, self.walks, self.left = holds, walks, solves
        self.asked: list[float] = []
        self.solved: list[float] = []

    @property
    def ended(self) -> str | None:
        return None if self.left > 0 else "time_limit"

    def say(self, task: str) -> None:
        self.task = float(task.split("with ")[1].split()[0])

    def holding(self, study, near):
        self.asked.append(self.task)
        self.left -= 1
        return f"near {self.task}" if self.task >= self.holds else None

    def walk(self, study, guesses, share):
        assert guesses == (f"near {self.task}",)  # the walk that held all laws of this very study
        self.solved.append(self.task)
        self.left -= 1
        return ("gait", "") if self.task >= self.walks else (None, "did not converge")


def search(limits: Limits, failures: int = 0) -> RemedySearch:
    return RemedySearch(KNOB, "near", limits, failures)  # type: ignore[arg-type]


@pytest.fixture(autouse=True)
def words_alone(monkeypatch):
    monkeypatch.setattr(remedies_module, "Remedy", lambda words, study, gait: words)


def test_the_mildest_change_that_is_enough_is_found_by_asking():
    limits = Limits(holds=130.0, walks=130.0)
    assert search(limits).run() == "with 137.5 more"
    assert limits.asked == [50.0, 100.0, 200.0, 150.0, 125.0, 137.5]
    assert limits.solved == [200.0, 137.5]


def test_where_the_mildest_has_no_walk_the_first_that_held_is_the_remedy():
    limits = Limits(holds=130.0, walks=180.0)
    assert search(limits).run() == "with 200 more"
    assert limits.solved == [200.0, 137.5]


def test_where_the_first_that_held_has_no_walk_larger_ones_follow():
    limits = Limits(holds=130.0, walks=300.0)
    assert search(limits).run() == "with 400 more"
    assert limits.asked[:4] == [50.0, 100.0, 200.0, 400.0]
    assert limits.solved == [200.0, 400.0, 225.0]


def test_it_ends_after_some_failures_and_says_what_came_of_the_last():
    limits = Limits(holds=10.0, walks=1e9)
    search_ = search(limits)
    assert search_.run() is None
    assert len(limits.solved) == search_.failures == MOST_FAILURES
    assert search_.why == f"with {limits.solved[-1]:g} more (did not converge)"
    again = search(Limits(holds=10.0, walks=0.0), failures=MOST_FAILURES)
    assert again.run() is None  # this law had its chances


def test_where_laws_break_with_every_value_nothing_is_solved():
    limits = Limits(holds=1e9, walks=0.0)
    search_ = search(limits)
    assert search_.run() is None and not limits.solved
    assert search_.why == "with 400 more (laws break)"


@pytest.mark.parametrize("solves", range(4))
def test_it_stops_when_time_is_up(solves):
    limits = Limits(holds=130.0, walks=130.0, solves=solves)
    assert search(limits).run() is None
    assert len(limits.asked) + len(limits.solved) == solves


def test_a_remedy_that_is_known_when_time_is_up_is_told():
    assert search(Limits(holds=130.0, walks=130.0, solves=4)).run() == "with 200 more"
