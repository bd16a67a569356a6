"""The best of several starts: which gait is kept, what is told about the others."""

from __future__ import annotations

import dataclasses
import math

import pytest
from gait_cases import reference_gait

from drakegait.errors import InvalidInput
from drakegait.gait import Gait
from drakegait.program.starts import NOISE, Start, starts
from drakegait.solve import solve
from drakegait.starts import best_of
from drakegait.study import GaitStudy

STUDY = GaitStudy.planar_symmetric(11, interior_points=(3, 2, 6, 5))


def gait_with(status: str, cost: float) -> Gait:
    gait = reference_gait("planar-symmetric")
    outcome = dataclasses.replace(gait.outcome, status=status)
    return dataclasses.replace(gait, outcome=outcome, cost={"total": cost})


def best(*ends: tuple[str, float], stop_after: int = 99) -> Gait:
    tried = []

    def attempt(start: Start) -> Gait:
        tried.append(start)
        return gait_with(*ends[len(tried) - 1])

    found = best_of(starts(len(ends)), attempt, lambda: len(tried) >= stop_after)
    assert [record.start for record in found.outcome.starts] == [start.name for start in tried]
    return found


def test_the_cheapest_gait_that_converged_is_kept():
    found = best(("converged", 3.5), ("infeasible", 1.0), ("converged", 3.4), ("converged", 3.6))
    assert found.converged
    assert found.cost["total"] == 3.4
    assert [record.cost for record in found.outcome.starts] == [3.5, 1.0, 3.4, 3.6]
    assert found.outcome.spread == pytest.approx(0.2 / 3.4)


def test_without_a_converged_one_the_cheapest_is_kept():
    found = best(("failed", 9.0), ("infeasible", math.nan), ("time_limit", 4.0))
    assert found.outcome.status == "time_limit"
    assert math.isnan(found.outcome.spread)


def test_an_interruption_keeps_the_best_so_far():
    found = best(
        ("converged", 3.5), ("interrupted", 2.0), ("converged", 1.0), stop_after=2
    )
    assert found.converged
    assert found.cost["total"] == 3.5
    assert len(found.outcome.starts) == 2


def test_the_record_survives_the_file_and_is_in_the_summary(tmp_path):
    found = best(("converged", 3.5), ("converged", 3.4))
    found.save(tmp_path / "gait.nc")
    again = Gait.load(tmp_path / "gait.nc")
    assert again.outcome == found.outcome
    listed = again.summary()["solver"]["starts"]
    assert [item["cost"] for item in listed] == [3.5, 3.4]
    assert len(listed[0]["phase_durations_s"]) == 8
    assert reference_gait("planar").summary()["solver"]["starts"] == []


def test_a_senseless_number_of_starts_is_refused_before_anything_is_solved():
    with pytest.raises(InvalidInput, match="starts"):
        solve(STUDY, starts=0)
    with pytest.raises(InvalidInput, match="seed"):
        solve(STUDY, starts=2, seed=-1)
    for none in ([], "3", True):
        with pytest.raises(InvalidInput, match="starts"):
            solve(STUDY, starts=none)


@pytest.mark.solve
def test_two_starts_are_solved_and_the_better_one_is_handed_back():
    chosen = [Start(), Start(NOISE, 0.1, (0, 1))]
    found = solve(STUDY, starts=chosen, refine=False, time_limit=60.0)
    alone = solve(STUDY, refine=False, time_limit=60.0)
    assert found.converged
    assert [record.status for record in found.outcome.starts] == ["converged"] * 2
    assert found.outcome.starts[0].cost == alone.cost["total"]  # to the last bit
    assert found.cost["total"] == min(record.cost for record in found.outcome.starts)
    assert alone.outcome.starts == ()


@pytest.mark.solve
def test_the_time_limit_is_for_all_starts_together():
    found = solve(STUDY, starts=500, refine=False, time_limit=4.0)
    assert len(found.outcome.starts) < 30
    assert found.outcome.starts[-1].status in ("time_limit", "converged")
