"""What counts as a number, the refusal of one that is out of range, and gravity."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from drakegait.errors import InvalidInput

GRAVITY = 9.81  # [m/s^2], docs/formulation.md 0.1


def is_number(value: Any) -> bool:
    """Whether it is a finite number, Python's or numpy's; True and False are none."""
    kinds = (int, float, np.integer, np.floating)
    return isinstance(value, kinds) and not isinstance(value, bool) and math.isfinite(value)


def is_whole(value: Any) -> bool:
    """Whether it is a whole number, Python's or numpy's."""
    return isinstance(value, (int, np.integer)) and not isinstance(value, bool)


def check_number(name: str, value: Any, low: float, high: float, unit: str) -> None:
    """Refuse anything but a number from `low` to `high`; raises InvalidInput."""
    if not is_number(value) or not low <= value <= high:
        raise InvalidInput(name, value, f"a number from {low:g} to {high:g} [{unit}]")


def check_count(name: str, value: Any, low: int, high: int) -> None:
    """Refuse anything but a whole number from `low` to `high`; raises InvalidInput."""
    if not is_whole(value) or not low <= value <= high:
        raise InvalidInput(name, value, f"a whole number from {low} to {high}")


def plain(value: Any) -> Any:
    """A number of numpy as one of Python, which JSON can hold; anything else as it is."""
    return value.item() if isinstance(value, np.generic) else value
