"""Foot placement: five numbers, their sum and their scaling."""

from __future__ import annotations

import dataclasses

import pytest

from drakegait.errors import InvalidInput
from drakegait.transcription.foot_placement import FootPlacement

PLACEMENT = FootPlacement(
    step_length_right=0.70, step_length_left=0.75, toe_angle_right=-0.1, toe_angle_left=0.1,
    step_width=0.1,
)  # fmt: skip


def test_stride_is_the_sum_of_both_steps_and_the_order_that_of_the_paper():
    assert PLACEMENT.stride_length == pytest.approx(1.45)
    assert dataclasses.astuple(PLACEMENT) == (0.70, 0.75, -0.1, 0.1, 0.1)


def test_scaling_keeps_angles():
    tall = PLACEMENT.scaled(1.2)
    assert dataclasses.astuple(tall) == pytest.approx((0.84, 0.90, -0.1, 0.1, 0.12))


@pytest.mark.parametrize("value", [float("nan"), float("inf"), None, "0.7"])
def test_numbers_only(value):
    with pytest.raises(InvalidInput, match="step_length_right"):
        FootPlacement(step_length_right=value, step_length_left=0.7)
