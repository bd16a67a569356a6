"""The search for the smallest conflict, on laws whose conflicts are known."""

from __future__ import annotations

import itertools

import numpy as np
import pytest

from drakegait.infeasibility.conflict import Relaxed, find_conflict

NAMES = ("muscles", "speed", "friction", "steps", "phase durations", "mechanics")
OTHERS = NAMES[:-1]  # that may be given up


class Known:
    """Laws that conflict in known sets; giving up one law of each set frees the rest."""

    names = NAMES

    def __init__(self, *conflicts: str):
        self.conflicts = [
            frozenset(name.replace("_", " ") for name in line.split()) for line in conflicts
        ]
        self.asked: list[frozenset[str]] = []
        self.pulled: tuple[str, ...] = ()

    def give_up(self, names, start=None) -> Relaxed:
        cheap = frozenset(names)
        self.asked.append(cheap)
        left = [conflict for conflict in self.conflicts if not conflict & cheap]
        broken = tuple(name for name in NAMES if any(name in conflict for conflict in left))
        members = set().union(*self.conflicts)
        pull = {name: 2.0 * (name in members or name in self.pulled) for name in NAMES}
        return Relaxed(cheap, np.zeros(1), np.zeros(1), broken, True, pull)


def found(known: Known, stop_after: int = 99):
    least = known.give_up(())
    return find_conflict(known, least, lambda: len(known.asked) > stop_after, lambda task: None)


@pytest.mark.parametrize("size", [1, 2, 3, 5])
def test_a_single_conflict_is_found_whole_and_called_unique(size):
    for members in itertools.combinations(OTHERS, size):
        known = Known(" ".join(members).replace("phase durations", "phase_durations"))
        conflict = found(known)
        assert conflict.laws == members
        assert conflict.smallest and conflict.unique


def test_of_two_conflicts_apart_one_is_found_and_not_called_unique():
    known = Known("muscles speed", "friction steps")
    conflict = found(known)
    assert frozenset(conflict.laws) in known.conflicts
    assert conflict.smallest and not conflict.unique


def test_of_two_conflicts_with_a_law_in_common_none_of_the_found_can_be_left_out():
    known = Known("muscles speed steps", "muscles friction")
    conflict = found(known)
    assert frozenset(conflict.laws) in known.conflicts
    assert "muscles" in conflict.laws and not conflict.unique
    assert not conflict.alone["muscles"].broken
    assert conflict.alone["speed"].broken


def test_laws_that_nothing_pulls_at_are_not_tried():
    known = Known("muscles speed")
    found(known)
    assert not any({"friction"} == cheap for cheap in known.asked)


def test_ended_early_it_tells_what_it_knows_and_claims_no_more():
    known = Known("muscles speed steps")
    conflict = found(known, stop_after=2)
    assert set(conflict.laws) == {"muscles", "speed"} and len(conflict.alone) == 2
    assert not conflict.smallest and not conflict.unique


def test_the_laws_of_mechanics_are_kept_and_not_named_beside_others():
    apart = ("muscles speed mechanics", "friction steps mechanics")
    for conflicts, possible in (
        (apart, ({"muscles", "speed"}, {"friction", "steps"})),
        (apart[:1], ({"muscles", "speed"},)),
    ):
        known = Known(*conflicts)
        assert set(found(known).laws) in possible
        assert all("mechanics" not in cheap for cheap in known.asked)


def test_where_mechanics_alone_breaks_that_is_the_conflict():
    assert found(Known("mechanics")).laws == ("mechanics",)


def test_no_more_laws_are_tried_once_those_in_every_conflict_are_one():
    known = Known("muscles speed")
    known.pulled = OTHERS
    conflict = found(known)
    assert conflict.laws == ("muscles", "speed") and conflict.smallest and conflict.unique
    assert list(conflict.alone) == ["muscles", "speed"]
    known = Known("muscles speed phase_durations")
    known.pulled = OTHERS
    conflict = found(known)
    assert conflict.laws == ("muscles", "speed", "phase durations") and conflict.unique
    assert list(conflict.alone) == list(OTHERS)
