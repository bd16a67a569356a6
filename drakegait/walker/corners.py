"""Rounded corners of the muscles' laws, and how Newton's method gets across them.

A corner max(x, 0) is rounded over a width d:

    P(x) = (x + r) / 2,   r = sqrt(x^2 + d^2),   P'' = d^2 / (2 r^3)

Beside the corner P'' is next to nothing: a Newton step from one side does not see the other, and
where an optimum sits in a corner steps swing from side to side. As in primal-dual methods for total
variation (Chan, Golub & Mulet, SIAM J. Sci. Comput. 20, 1999) the slope P' = (1 + w) / 2 becomes an
unknown of its own with w r = x, which is linearised and w eliminated. That leaves

    P'' ~ (1 - w x / r) / (2 r),     w  <-  x / r + (1 - w x / r) dx / r   kept within -1..1

for a step from x to x + dx. Where w = x / r this is P''; where a step has left w on the other side
it is up to 1 / r, twice what the chord across the corner has.
"""

from __future__ import annotations

from typing import Any

import casadi
import numpy as np

TINY = 1e-40
"""Keeps derivatives of roots finite where their argument is exactly 0."""


def positive_part(math: Any, x: Any, width: Any) -> Any:
    """Smooth max(x, 0): (x + sqrt(x^2 + width^2)) / 2, too large by width/2 at x = 0."""
    return 0.5 * (x + math.sqrt(x * x + width * width))


def corner(math: Any, x: Any, width: Any) -> Any:
    """`positive_part`, one that steps of a solve have to get across."""
    return positive_part(math, x, width) + noted(math, x, width)


def noted(math: Any, x: Any, width: Any) -> Any:
    """What is to be added to a rounded max(x, 0): 0, as a symbol where `math` is `Corners`."""
    return math.note(x, width) if isinstance(math, Corners) else 0.0


class CornerSlopes:
    """The slopes that corners are taken to have, from one step of a solve to the next.

    Attributes:
        held: arguments x and then w of each corner (..., num_muscles, 2 num_corners); None before
            the first step.
    """

    def __init__(self) -> None:
        self.held: np.ndarray | None = None


class Corners:
    """Stands for `casadi` in a muscle's equations and notes their corners on the way."""

    def __init__(self) -> None:
        self._arguments: list[casadi.SX] = []
        self._widths: list[casadi.SX] = []
        self._shifts: list[casadi.SX] = []

    def __getattr__(self, name: str) -> Any:
        return getattr(casadi, name)

    def note(self, x: casadi.SX, width: casadi.SX) -> casadi.SX:
        """A symbol that shifts the value of the corner max(x, 0); see `hessian`."""
        self._arguments.append(x)
        self._widths.append(width)
        self._shifts.append(casadi.SX.sym("shift"))
        return self._shifts[-1]

    def hessian(
        self, value: casadi.SX, z: casadi.SX
    ) -> tuple[casadi.SX, casadi.SX, casadi.SX]:
        """Second derivatives of `value` by `z` with the curvature of corners as above.

        Corners that `value` falls with are concave: they keep their own.

        Returns:
            The Hessian, the symbol of `CornerSlopes.held` from the step before, and what is to be
            held for the next.
        """
        count = len(self._shifts)
        shifts, x, width = (
            casadi.vertcat(*parts) for parts in (self._shifts, self._arguments, self._widths)
        )
        expressions = [value, casadi.jacobian(value, shifts).T, x, width]
        value, weight, x, width = casadi.substitute(expressions, [shifts], [casadi.SX.zeros(count)])
        held = casadi.SX.sym("held", 2 * count)
        root = casadi.sqrt(x * x + width * width + TINY)
        before, slope = held[:count], held[count:]
        root_before = casadi.sqrt(before * before + width * width + TINY)
        share = before / root_before
        slope = share + (1.0 - slope * share) / root_before * (x - before)
        slope = casadi.fmin(1.0, casadi.fmax(-1.0, slope))
        more = 0.5 * ((1.0 - slope * x / root) / root - width * width / root**3)
        stiffness = casadi.fmax(weight, 0.0) * casadi.fmax(more, 0.0)
        along = casadi.jacobian(x, z)
        hessian = casadi.hessian(value, z)[0] + along.T @ casadi.diag(stiffness) @ along
        return hessian, held, casadi.vertcat(x, slope)
