"""Control points: where they lie, how they move with the events, what they integrate."""

from __future__ import annotations

import numpy as np
import pytest

from drakegait.errors import InvalidInput
from drakegait.transcription.schedule import Schedule

COUNTS = (3, 0, 5, 2, 1, 0, 4, 2)
EVENTS = np.array([0.0, 0.06, 0.11, 0.36, 0.5, 0.57, 0.62, 0.87, 1.0])


@pytest.mark.parametrize("counts", [COUNTS, COUNTS[:4]])
def test_points_stay_in_their_phase_and_start_on_its_event(counts):
    schedule = Schedule(counts)
    events = EVENTS[: len(counts) + 1]
    tau = schedule.instants(events)
    assert len(tau) == schedule.num_points == sum(counts) + len(counts)
    assert (np.diff(tau) > 0.0).all()
    for phase, count in enumerate(counts):
        inside = tau[schedule.phases == phase]
        expected = np.linspace(events[phase], events[phase + 1], count + 2)[:-1]
        np.testing.assert_allclose(inside, expected)
    np.testing.assert_allclose(tau[schedule.shares == 0.0], events[:-1])


def shares_of_cycle(schedule: Schedule, events: np.ndarray) -> np.ndarray:
    """What each point stands for, from the weights by three neighbouring events."""
    before = np.concatenate([[events[-2] - events[-1]], events[:-2]])
    local = np.stack([before, events[:-1], events[1:]], axis=1)[schedule.phases]
    return (schedule.integration_weights() * local).sum(axis=1)


@pytest.mark.parametrize("counts", [COUNTS, COUNTS[:4]])
def test_weights_are_trapezoids_between_neighbours(counts):
    schedule, events = Schedule(counts), EVENTS[: len(counts) + 1]
    tau, end = schedule.instants(events), events[-1]
    after, before = np.append(tau[1:], end), np.append(tau[-1] - end, tau[:-1])
    weights = shares_of_cycle(schedule, events)
    np.testing.assert_allclose(weights, 0.5 * (after - before), atol=1e-15)
    assert weights.sum() == pytest.approx(end)
    # Where all events move alike, no point stands for more or less.
    np.testing.assert_allclose(schedule.integration_weights().sum(axis=1), 0.0, atol=1e-14)


def test_the_integral_converges_with_the_square_of_the_step():
    def error(factor):
        schedule = Schedule(tuple(factor * (n + 1) - 1 for n in COUNTS))
        tau = schedule.instants(EVENTS)
        integral = shares_of_cycle(schedule, EVENTS) @ np.exp(np.sin(2.0 * np.pi * tau))
        return abs(integral - 1.2660658777520084)  # the Bessel function I_0(1)

    assert error(4) < 1e-3
    assert error(4) / error(8) == pytest.approx(4.0, rel=0.05)


def test_only_the_failing_phases_get_denser():
    schedule = Schedule(COUNTS)
    denser = schedule.refined({2, 5})
    for phase, (old, new) in enumerate(
        zip(COUNTS, denser.interior_points, strict=True)
    ):
        assert (new > old) == (phase in (2, 5))
        if phase in (2, 5):
            assert new + 1 >= 1.5 * (old + 1)
    assert schedule.refined(set()) == schedule


@pytest.mark.parametrize("counts", [(), (1, 2, 3), (1,) * 9, (1, 1, -1, 1)])
def test_bad_counts_are_refused(counts):
    with pytest.raises(InvalidInput, match="interior_points"):
        Schedule(counts)
