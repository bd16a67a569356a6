"""Where the feet stand during one stride: the parameters p_g of the paper."""

from __future__ import annotations

import dataclasses
import math

from drakegait.errors import InvalidInput


@dataclasses.dataclass(frozen=True, kw_only=True)
class FootPlacement:
    """Positions of the flat feet of one stride on level ground.

    The right foot stands at (0, -step_width/2), the left foot before it at
    (-step_length_right, step_width/2) and after it at (step_length_left, step_width/2); the next
    right foot at (stride_length, -step_width/2). A planar walker has step_width and both toe
    angles equal to 0. Paper: p_g = [L_R, L_L, alpha_R, alpha_L, L_W] (Garcia-Vallejo & Schiehlen
    2012); `dataclasses.astuple` gives the fields in that order.

    Args:
        step_length_right: advance of the right ankle over the left at right heel strike [m].
        step_length_left: advance of the left ankle over the right at left heel strike [m].
        toe_angle_right: heading of the right foot about the upward vertical [rad]; toe-out < 0.
        toe_angle_left: heading of the left foot about the upward vertical [rad]; toe-out > 0.
        step_width: lateral distance of the ankles [m].

    Raises:
        InvalidInput: a value is not a finite number.
    """

    step_length_right: float
    step_length_left: float
    toe_angle_right: float = 0.0
    toe_angle_left: float = 0.0
    step_width: float = 0.0

    def __post_init__(self) -> None:
        for field in dataclasses.fields(self):
            value = getattr(self, field.name)
            try:
                finite = math.isfinite(value)
            except TypeError:
                finite = False
            if not finite:
                unit = "rad" if "angle" in field.name else "m"
                raise InvalidInput(field.name, value, f"a finite number [{unit}]")

    @property
    def stride_length(self) -> float:
        """Advance of the walker in one stride [m]."""
        return self.step_length_right + self.step_length_left

    def scaled(self, factor: float) -> FootPlacement:
        """The same placement with all lengths multiplied by `factor` and the angles kept."""
        return dataclasses.replace(
            self,
            step_length_right=factor * self.step_length_right,
            step_length_left=factor * self.step_length_left,
            step_width=factor * self.step_width,
        )
