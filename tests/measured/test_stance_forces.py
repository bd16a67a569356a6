"""Which recorded stance a foot's force over the stride is taken from, and what is said of it."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

from drakegait.errors import BadFile
from drakegait.measured.contacts import Contact
from drakegait.measured.notes import Notes
from drakegait.measured.stance_forces import stance_forces
from drakegait.measured.strides import Stride

DURATION, STANCE = 1.0, 0.6
TAU = np.arange(100) / 100.0
# Right heel strikes at 2, left ones half a stride later.
STRIDES = {
    "r": Stride(lead="r", start=2.0, end=3.0, other_off=2.1, other_strike=2.5, lead_off=2.6,
                gap=0.0, loaded=2, score=0.0),
    "l": Stride(lead="l", start=1.5, end=2.5, other_off=1.6, other_strike=2.0, lead_off=2.1,
                gap=0.0, loaded=2, score=0.0),
}  # fmt: skip


class Series:
    """A force that grows with every stance, to 100 N more than 100 N times its number."""

    time = np.arange(0.0, 8.0, 0.002)

    def __init__(self, first: float):
        share = (self.time - first) % DURATION / STANCE
        number = np.floor((self.time - first) / DURATION)
        shape = np.where(share < 1.0, np.sin(np.pi * share), 0.0)
        self.values = np.outer((100.0 * number + 100.0) * shape, [0.0, 0.1, 1.0])

    def covers(self, start: float, end: float) -> bool:
        return True


RECORDS = {side: SimpleNamespace(series=Series(first)) for side, first in (("r", 0.0), ("l", 0.5))}


def taken(lead: str, right: list[int], left: list[int]) -> tuple[list[float], list[str]]:
    """Numbers of the stances that right and left force come from, and what was said."""
    contacts = [
        Contact(side=side, start=start, end=start + STANCE, record=RECORDS[side], whole=True)
        for side, first, numbers in (("r", 0.0, right), ("l", 0.5, left))
        for start in (first + DURATION * n for n in numbers)
    ]
    notes = Notes()
    forces = stance_forces(STRIDES[lead], contacts, TAU, notes)
    return [round(forces[:, k].max() / 100.0 - 1.0, 1) for k in (2, 5)], list(notes.sentences)


@pytest.mark.parametrize("lead", ["r", "l"])
def test_each_foot_has_its_own_stance_of_the_stride(lead):
    assert taken(lead, [0, 1, 2, 3], [0, 1, 2, 3]) == ([2.0, 2.0 if lead == "r" else 1.0], [])


def test_the_stance_that_the_stride_begins_with_is_of_the_stride_too():
    assert taken("r", [2], [0, 1]) == ([2.0, 1.0], [])
    assert taken("l", [0, 1], [1]) == ([1.0, 1.0], [])


@pytest.mark.parametrize(
    ("lead", "right", "left"), [("r", [3], [2]), ("r", [1], [2]), ("l", [2], [2])]
)
def test_another_stance_is_said(lead, right, left):
    numbers, said = taken(lead, right, left)
    assert numbers == [float(right[0]), float(left[0])]
    assert len(said) == 1 and "was not recorded completely" in said[0]


def test_without_a_stance_of_a_foot_it_is_the_other_s_mirrored():
    (right, left), said = taken("r", [2], [])
    assert right == left == 2.0
    assert "mirrored" in said[0]
    with pytest.raises(BadFile, match="no stance"):
        taken("r", [], [])
