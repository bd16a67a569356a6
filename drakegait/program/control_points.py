"""The control points of a formulation as arrays, and their local variables.

Each control point sees only a window of the spline coefficients: those that
its bounded event times can reach. Its *local variables* are, in this order,

    coordinate coefficients (num_coordinates, width) | force coefficients
    (num_muscles, width) | stride time T | theta_before, theta_start, theta_end
    | foot placement (5) | contact multipliers (14) | residuals (num_coordinates,)

in physical units, all of them affine functions of the design vector. Arrays
carry the control point as their leading axis, so one code evaluates one point
(a Drake binding) or all of them (a fast solver).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from drakegait.program.formulation import Formulation
from drakegait.transcription.splines import SUPPORT
from drakegait.walker import feet


@dataclass(frozen=True)
class LocalLayout:
    """Positions of the local variables of a control point."""

    num_coordinates: int
    num_muscles: int
    width: int
    num_rows: int = feet.NUM_ROWS  # of contacts; more with torques at the toe

    @property
    def forces(self) -> int:
        """First force coefficient."""
        return self.num_coordinates * self.width

    @property
    def time(self) -> int:
        """Stride time, followed by theta_before, theta_start, theta_end."""
        return self.forces + self.num_muscles * self.width

    @property
    def placement(self) -> int:
        """First of the five placement parameters."""
        return self.time + 4

    @property
    def multipliers(self) -> int:
        """First of the contact multipliers."""
        return self.placement + 5

    @property
    def residuals(self) -> int:
        """First of the residuals of the equations of motion."""
        return self.multipliers + self.num_rows

    @property
    def size(self) -> int:
        """Number of local variables."""
        return self.residuals + self.num_coordinates

    def split(self, z: np.ndarray) -> tuple[np.ndarray, ...]:
        """Coordinate and force coefficients, time, placement, multipliers, residuals."""
        num = len(z)
        return (
            z[:, : self.forces].reshape(num, self.num_coordinates, self.width),
            z[:, self.forces : self.time].reshape(num, self.num_muscles, self.width),
            z[:, self.time : self.placement],
            z[:, self.placement : self.multipliers],
            z[:, self.multipliers : self.residuals],
            z[:, self.residuals :],
        )


@dataclass(frozen=True)
class ControlPoints:
    """Constant data of a set of control points, all with the leading axis `num`.

    Attributes:
        numbers: their place in the schedule.
        phases, shares: phase (0..7) and share of it.
        first: first coefficient of the window (unwrapped, may be negative).
        weights: integration weights by the three local events (num, 3).
        loaded: contact rows with a force (num, 14), or (num, 18) with torques at the toe.
        placed: contact rows with a prescribed position (num, 14).
        free_points: contact points that must stay above the ground (num, 4).
        left_prints: footprint of the left foot, 0 or 1.
    """

    layout: LocalLayout
    numbers: np.ndarray
    phases: np.ndarray
    shares: np.ndarray
    first: np.ndarray
    weights: np.ndarray
    loaded: np.ndarray
    placed: np.ndarray
    free_points: np.ndarray
    left_prints: np.ndarray

    @property
    def num(self) -> int:
        """Number of control points."""
        return len(self.numbers)

    def only(self, which: int) -> ControlPoints:
        """The set that holds just the control point at position `which`."""
        at = slice(which, which + 1)
        return ControlPoints(
            self.layout, self.numbers[at], self.phases[at], self.shares[at], self.first[at],
            self.weights[at], self.loaded[at], self.placed[at], self.free_points[at],
            self.left_prints[at],
        )  # fmt: skip

    @classmethod
    def of(cls, formulation: Formulation) -> ControlPoints:
        """The control points of `formulation`."""
        schedule, planar = formulation.schedule, formulation.planar
        torques = formulation.contact.toe_torque
        phases, shares = schedule.phases, schedule.shares
        loaded, placed = [], []
        for phase, share in zip(phases, shares, strict=True):
            on_event = share == 0.0
            loaded.append(
                feet.loaded_rows_at_start(phase, planar, torques)
                if on_event
                else feet.active_rows(phase, planar, torques)
            )
            placed.append(
                feet.placed_rows_at_start(phase, planar)
                if on_event
                else feet.active_rows(phase, planar)
            )
        placed = np.array(placed)
        first, width = _windows(formulation)
        return cls(
            layout=LocalLayout(
                formulation.walker.skeleton.num_coordinates,
                len(formulation.walker.muscles.names),
                width,
                len(loaded[0]),
            ),
            numbers=np.arange(schedule.num_points),
            phases=phases,
            shares=shares,
            first=first,
            weights=schedule.integration_weights(),
            loaded=np.array(loaded),
            placed=placed,
            free_points=~placed[:, list(feet.VERTICAL_ROWS)],
            left_prints=np.array(
                [
                    feet.left_print(phase, share == 0.0)
                    for phase, share in zip(phases, shares, strict=True)
                ]
            ),
        )


def event_bounds(formulation: Formulation) -> tuple[np.ndarray, np.ndarray]:
    """Lowest and highest value of theta_1 .. theta_P and of the end, (num_phases + 1,)."""
    num = formulation.schedule.num_phases
    end = num / feet.NUM_PHASES
    centres = np.append(np.array(formulation.event_centres)[:num], end)
    reach = np.full(num + 1, formulation.event_reach)
    reach[[0, -1]] = 0.0
    return centres - reach, centres + reach


def _windows(formulation: Formulation) -> tuple[np.ndarray, int]:
    low, high = event_bounds(formulation)
    splines = formulation.splines
    _, first = splines.basis(formulation.schedule.instants(low))
    _, last = splines.basis(formulation.schedule.instants(high))
    width = min(int((last - first).max()) + SUPPORT, splines.num_intervals)
    return first, width
