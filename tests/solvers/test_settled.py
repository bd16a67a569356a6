"""The second test of convergence: when the cost counts as settled."""

from __future__ import annotations

import pytest

from drakegait.solvers.options import SolverOptions
from drakegait.solvers.settled import Settled

OPTIONS = SolverOptions(optimality=1e-3, feasibility=1e-3, cost_change=1e-4)
SMALLEST = 1e-5  # a hundredth of the optimality
COST, HOLDS = 5.0, 1e-4  # a violation that is within the feasibility


def count(settled: Settled, barrier: float, cost: float = COST, violation: float = HOLDS) -> int:
    """Iterations until the cost has settled, 100 at most."""
    for iteration in range(1, 101):
        if settled.after(cost, violation, barrier):
            assert settled.reached
            return iteration
        assert not settled.reached
    return 100


def test_it_reports_after_some_iterations_and_later_at_the_smallest_barrier():
    assert count(Settled(OPTIONS), 1e-2) == Settled.LENGTH
    assert count(Settled(OPTIONS), SMALLEST) == Settled.LENGTH_AT_END > Settled.LENGTH


def test_the_last_barrier_parameter_is_the_end():
    settled = Settled(OPTIONS)
    settled.after(COST, HOLDS, 1.01 * SMALLEST)
    assert not settled.at_end
    settled.after(COST, HOLDS, SMALLEST)
    assert settled.at_end
    assert "1e-04" in settled.sentence or "0.0001" in settled.sentence
    assert str(Settled.LENGTH_AT_END) in settled.sentence


@pytest.mark.parametrize("sign", [1.0, -1.0])
@pytest.mark.parametrize(("spread", "settles"), [(0.9e-4, True), (1.1e-4, False)])
def test_the_cost_may_change_by_its_part_and_no_more(sign, spread, settles):
    settled = Settled(OPTIONS)
    reached = [
        settled.after(sign * COST * (1.0 + spread * (i % 2)), HOLDS, 1e-2) for i in range(60)
    ]
    assert any(reached) == settles


def test_a_steady_fall_has_not_settled():
    """Small steps, all in one direction, add up."""
    settled = Settled(OPTIONS)
    assert not any(settled.after(COST * 0.99998**i, HOLDS, 1e-2) for i in range(60))


def test_zero_change_never_settles():
    assert count(Settled(OPTIONS.replace(cost_change=0.0)), 1e-2) == 100


def test_laws_that_do_not_hold_start_it_anew():
    settled = Settled(OPTIONS)
    for _ in range(Settled.LENGTH - 1):
        assert not settled.after(COST, HOLDS, 1e-2)
    assert not settled.after(COST, 0.5, 1e-2)  # far off: all is forgotten
    # The iteration far off is the first of those to come: its cost counts, its laws do not.
    assert count(settled, 1e-2) == Settled.LENGTH - 1


def test_laws_that_hold_nearly_only_delay_it():
    settled = Settled(OPTIONS)
    for _ in range(Settled.LENGTH - 1):
        assert not settled.after(COST, HOLDS, 1e-2)
    assert not settled.after(COST, 5e-3, 1e-2)
    assert count(settled, 1e-2) == 1


def test_another_barrier_parameter_starts_it_anew():
    settled = Settled(OPTIONS)
    for _ in range(Settled.LENGTH - 1):
        assert not settled.after(COST, HOLDS, 1e-2)
    assert count(settled, 1e-3) == Settled.LENGTH


def test_a_restart_starts_it_anew_even_at_the_same_barrier_parameter():
    settled = Settled(OPTIONS)
    count(settled, 1e-2)
    settled.next_barrier()
    assert count(settled, 1e-2) == Settled.LENGTH


def test_barrier_parameters_fall_to_the_smallest_and_it_starts_anew():
    settled = Settled(OPTIONS)
    barriers = [1e-2]
    while not (count(settled, barriers[-1]) and settled.at_end):
        assert settled.reached
        barriers.append(settled.next_barrier())
        assert not settled.reached
    falls = [later / before for before, later in zip(barriers[:-1], barriers[1:], strict=True)]
    assert all(fall <= Settled.FACTOR * 1.001 for fall in falls[:-1])
    assert len(barriers) < 5
    # Below the barrier parameter at which the conditions of optimality count as held, not far.
    assert 0.05 * SMALLEST < barriers[-1] <= SMALLEST
    assert settled.next_barrier() == pytest.approx(0.09 * SMALLEST)
