"""The chain rule from physical quantities to the local variables of a control point.

A constraint or cost of `num_rows` rows depends on coordinates, velocities,
accelerations, muscle forces and contact multipliers (densely, within a
declared mask), and in a few entries directly on the stride time, the events
and the placement. With the basis rows b of the splines,

    dq = b dc,  dq' = b' dc / T,  dq'' = b'' dc / T^2,

and the control point's tau and the stride time T enter through the same
quantities. Muscles, which depend on few coordinates each, have a chain rule
of their own in `excitation`, which `local_costs` shares.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from drakegait.program.control_points import LocalLayout
from drakegait.program.local_state import LocalState


@dataclass
class Partials:
    """Partial derivatives of rows (num, num_rows, ...); None stands for zero.

    Attributes:
        q, v, a: by coordinates, velocities, accelerations.
        f: by muscle forces.
        multipliers: by contact multipliers.
        residuals: by the residual variables.
        tau: directly by the normalised time (num, num_rows).
        stride_time: directly by T.
        events: directly by the three local events (num, num_rows, 3).
        placement: directly by the foot placement (num, num_rows, 5).
    """

    q: np.ndarray | None = None
    v: np.ndarray | None = None
    a: np.ndarray | None = None
    f: np.ndarray | None = None
    multipliers: np.ndarray | None = None
    residuals: np.ndarray | None = None
    tau: np.ndarray | None = None
    stride_time: np.ndarray | None = None
    events: np.ndarray | None = None
    placement: np.ndarray | None = None


@dataclass(frozen=True)
class Pattern:
    """Which physical quantities each row may depend on (masks with num_rows rows)."""

    coordinates: np.ndarray
    forces: np.ndarray
    multipliers: np.ndarray
    residuals: np.ndarray
    time: np.ndarray  # (num_rows, 4): T and the three local events
    placement: np.ndarray  # (num_rows, 5)

    def with_projected_multipliers(self) -> Pattern:
        """Rows that depend on multipliers depend on all that lambda* depends on."""
        touched = self.multipliers.any(axis=1, keepdims=True)
        time = self.time | np.where(touched, [[True, False, True, True]], False)
        placement = self.placement.copy()
        placement[:, :2] |= touched
        return Pattern(
            self.coordinates | touched,
            self.forces | touched,
            np.zeros_like(self.multipliers),
            np.zeros_like(self.residuals),
            time,
            placement,
        )

    def local(self, layout: LocalLayout) -> np.ndarray:
        """Mask over the local variables (num_rows, layout.size)."""
        return np.concatenate(
            [
                np.repeat(self.coordinates, layout.width, axis=1),
                np.repeat(self.forces, layout.width, axis=1),
                self.time,
                self.placement,
                self.multipliers,
                self.residuals,
            ],
            axis=1,
        )


def no_dependence(num_rows: int, layout: LocalLayout) -> dict[str, np.ndarray]:
    """Masks of a `Pattern` that depends on nothing, to be filled in."""
    return {
        "coordinates": np.zeros((num_rows, layout.num_coordinates), dtype=bool),
        "forces": np.zeros((num_rows, layout.num_muscles), dtype=bool),
        "multipliers": np.zeros((num_rows, layout.num_rows), dtype=bool),
        "residuals": np.zeros((num_rows, layout.num_coordinates), dtype=bool),
        "time": np.zeros((num_rows, 4), dtype=bool),
        "placement": np.zeros((num_rows, 5), dtype=bool),
    }


def eliminate_multipliers(state: LocalState, partials: Partials) -> Partials:
    """Replace dependence on lambda* by its derivatives (projected multipliers)."""
    if partials.multipliers is None:
        return partials
    by = state.multiplier_derivatives
    outer = partials.multipliers

    def add(mine: np.ndarray | None, inner: np.ndarray) -> np.ndarray:
        total = outer @ inner[:, : outer.shape[2]]
        return total if mine is None else mine + total

    return Partials(
        q=add(partials.q, by.by_q),
        v=add(partials.v, by.by_v),
        a=add(partials.a, by.by_a),
        f=add(partials.f, by.by_f),
        tau=partials.tau,
        stride_time=partials.stride_time,
        events=partials.events,
        placement=partials.placement,
    )


def chain(
    state: LocalState, partials: Partials, num_rows: int, advance: bool = True
) -> np.ndarray:
    """Derivatives by all local variables (num, num_rows, layout.size).

    Args:
        advance: whether the rows see hat_x with its steady advance (the plant does; the
            deviation from the reference does not).
    """
    if not state.formulation.lifted:
        partials = eliminate_multipliers(state, partials)
    layout, points = state.points.layout, state.points
    num = points.num
    out = np.zeros((num, num_rows, layout.size))
    basis, period = state.basis, state.stride_time[:, :, None]
    tau = np.zeros((num, num_rows)) if partials.tau is None else partials.tau.copy()
    time = out[:, :, layout.time : layout.placement]
    placement = out[:, :, layout.placement : layout.multipliers]
    motion = state.motion
    seen = [(k, p) for k, p in enumerate((partials.q, partials.v, partials.a)) if p is not None]
    for order, partial in seen:
        tau += (partial @ motion.by_tau[order][:, :, None])[..., 0]
    if seen:
        rows = np.stack([basis[order] / state.stride_time**order for order, _ in seen], axis=1)
        by_order = np.stack([partial for _, partial in seen], axis=-1)
        by_coordinate = by_order.reshape(num, -1, len(seen)) @ rows
        out[:, :, : layout.forces] = by_coordinate.reshape(num, num_rows, -1)
    if partials.v is not None:
        time[:, :, 0] -= (partials.v @ (state.v if advance else motion.rate)[:, :, None])[..., 0]
    if partials.a is not None:
        time[:, :, 0] -= 2.0 * (partials.a @ motion.acceleration[:, :, None])[..., 0]
    time[:, :, 0] /= period[:, :, 0]
    if advance:
        if partials.q is not None:
            placement[:, :, :2] += partials.q[:, :, :1] * state.tau[:, None, None]
            tau += partials.q[:, :, 0] * state.stride_length[:, None]
        if partials.v is not None:
            placement[:, :, :2] += partials.v[:, :, :1] / period
    if partials.f is not None:
        by_force = out[:, :, layout.forces : layout.time].reshape(
            num, num_rows, layout.num_muscles, layout.width
        )
        by_force += partials.f[..., None] * basis[0][:, None, None, :]
        tau += (partials.f @ state.forces.by_tau[0][:, :, None])[..., 0]
    if partials.multipliers is not None:
        stop = layout.multipliers + partials.multipliers.shape[2]  # may leave out toe torques
        out[:, :, layout.multipliers : stop] += partials.multipliers
    if partials.residuals is not None:
        out[:, :, layout.residuals :] += partials.residuals
    if partials.stride_time is not None:
        time[:, :, 0] += partials.stride_time
    if partials.events is not None:
        time[:, :, 1:] += partials.events
    time[:, :, 2] += tau * (1.0 - points.shares)[:, None]
    time[:, :, 3] += tau * points.shares[:, None]
    if partials.placement is not None:
        placement += partials.placement
    return out
