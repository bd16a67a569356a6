"""Second derivatives of the two costs beyond those of muscles and motion.

Both are sums of share * T * integrand, so the weight of a control point and
its integrand are differentiated as a product. Friction and footprints, which
do not see the motion, are added here as well.
"""

from __future__ import annotations

import numpy as np

from drakegait.program.excitation import MuscleChain
from drakegait.program.foot_contact import FootContact
from drakegait.program.ground_forces import Friction
from drakegait.program.hessian_blocks import NUM_LATE, NUM_TIME, HessianBlocks
from drakegait.program.hessian_chain import Directions
from drakegait.program.local_costs import Deviation, MetabolicCost
from drakegait.program.local_state import LocalState
from drakegait.program.physical_hessian import LawWeights
from drakegait.walker import feet


def power_weight(state: LocalState, objective: float) -> np.ndarray:
    """d f / d(power) at each control point (num,) [1/W]."""
    rate = 0.01 * state.formulation.energy_weight * objective
    return rate * state.share_of_cycle * state.stride_time[:, 0] / state.stride_length


def add_energy_weights(
    blocks: HessianBlocks,
    cost: MetabolicCost,
    directions: Directions,
    spans: MuscleChain,
    objective: float,
) -> None:
    """Product rule between the weight share * T / (L_R + L_L) and the metabolic power."""
    state = blocks.state
    first, second = _power_weight_derivatives(state, objective)
    slopes = state.muscles[1][:, :, 2]
    blocks.late += cost.power(state)[:, None, None] * second
    by_length = -spans.arms.T @ slopes[:, :, 3:]
    blocks.late_force[..., :3] += first[:, :, None, None] * slopes[:, None, :, :3]
    blocks.late_motion[..., :3] += first[:, :, None, None] * by_length[:, None]
    num = len(first)
    along = slopes[:, :, :3].reshape(num, 1, -1) @ _flat(directions.force)
    along += by_length.reshape(num, 1, -1) @ _flat(directions.motion)
    late = (along @ directions.by_late)[:, 0]
    blocks.late += _both_ways(first, late)


def _power_weight_derivatives(
    state: LocalState, objective: float
) -> tuple[np.ndarray, np.ndarray]:
    """First and second derivatives of `power_weight` by the late variables."""
    num = len(state.q)
    rate = 0.01 * state.formulation.energy_weight * objective
    weights = state.formulation.repeats * state.points.weights
    share, period, length = state.share_of_cycle, state.stride_time[:, 0], state.stride_length
    first = np.zeros((num, NUM_LATE))
    second = np.zeros((num, NUM_LATE, NUM_LATE))
    first[:, 0] = share / length
    first[:, 1:4] = weights * (period / length)[:, None]
    first[:, 4:6] = -(share * period / length**2)[:, None]
    second[:, 0, 1:4] = second[:, 1:4, 0] = weights / length[:, None]
    for k in (4, 5):
        second[:, 0, k] = second[:, k, 0] = -share / length**2
        second[:, 1:4, k] = second[:, k, 1:4] = -weights * (period / length**2)[:, None]
        second[:, k, 4:6] = (2.0 * share * period / length**3)[:, None]
    return rate * first, rate * second


def add_deviation(blocks: HessianBlocks, cost: Deviation, objective: float) -> None:
    """The deviation from the reference, quadratic in coordinates and ground reactions."""
    state, reference = blocks.state, blocks.state.formulation.reference
    rate = state.formulation.deviation_weight * objective
    period, share = state.stride_time[:, 0], state.share_of_cycle
    factor = rate * share * period
    motion, force = state.deviation
    slope, force_slope = state.deviation_slope
    slope = slope + state.motion.by_tau[0]
    wq, wf = cost.coordinate_weight, cost.force_weight
    diagonal = np.arange(motion.shape[1])
    bend = 2.0 * factor[:, None] * wq
    blocks.motion[:, diagonal, 0, diagonal, 0] += bend
    time, by_time = blocks.tau_by_time, blocks.late_motion[:, :NUM_TIME]
    by_time[..., 0] += time[:, :, None] * (bend * slope)[:, None]
    # The rows of order 1 are over T, those of the slope by tau are not.
    by_time[..., 1] += time[:, :, None] * (bend * motion * period[:, None])[:, None]
    motion_bend = state.bending(blocks.b_tau_tau)[0][:, :, 0]
    motion_bend = motion_bend - reference.coordinate_values(state.tau, derivative=2)
    force_bend = -reference.ground_reactions(state.tau, derivative=2)
    by_tau_tau = (slope**2 + motion * motion_bend) @ wq
    by_tau_tau += _reactions(force_slope**2 + force * force_bend, wf)
    late = blocks.late[:, :NUM_TIME, :NUM_TIME]
    late += (2.0 * factor * by_tau_tau)[:, None, None] * time[:, :, None] * time[:, None]
    both = 2.0 * factor[:, None, None] * wf
    blocks.multipliers += _on_points(state, both)
    blocks.heel_toe += both.reshape(len(both), -1)
    blocks.multiplier_time += _on_points(state, both * force_slope)[:, :, None] * time[:, None]
    # The weight share * T against everything.
    weights = state.formulation.repeats * state.points.weights
    first = np.concatenate([(rate * share)[:, None], rate * weights * period[:, None]], axis=1)
    second = np.zeros((len(first), NUM_TIME, NUM_TIME))
    second[:, 0, 1:] = second[:, 1:, 0] = rate * weights
    late += cost.rate(state)[:, None, None] * second
    by_time[..., 0] += first[:, :, None] * (2.0 * motion * wq)[:, None]
    blocks.multiplier_time += _on_points(state, 2.0 * wf * force)[:, :, None] * first[:, None]
    by_tau = 2.0 * ((motion * slope) @ wq + _reactions(force * force_slope, wf))
    late += _both_ways(first, by_tau[:, None] * time)


def add_friction(blocks: HessianBlocks, weights: LawWeights) -> None:
    """The cones mu^2 N^2 - F^2, quadratic in the contact forces of a foot."""
    state = blocks.state
    by_axis = np.array([-2.0, -2.0, 2.0 * state.formulation.contact.friction**2])
    values = weights(Friction)[:, :, None] * by_axis
    blocks.multipliers += _on_points(state, values)
    blocks.heel_toe += values.reshape(len(values), -1)


def add_footprints(blocks: HessianBlocks, weights: LawWeights) -> None:
    """Footprints turn with the toe angle: cos and sin of it, twice differentiated."""
    state, contact = blocks.state, weights(FootContact)
    geometry = state.formulation.walker.foot
    for foot in range(2):
        base, at = feet.ROWS_PER_FOOT * foot, NUM_TIME + 2 + foot
        angle = state.placement[:, 2 + foot]
        for offset, arm in ((0, geometry.heel), (3, geometry.toe)):
            blocks.late[:, at, at] += arm * (
                contact[:, base + offset] * np.cos(angle)
                + contact[:, base + offset + 1] * np.sin(angle)
            )


def _on_points(state: LocalState, by_foot: np.ndarray) -> np.ndarray:
    """Values (num, 2, 3) of the feet's forces on the multipliers of heel and toe (num, 14)."""
    out = np.zeros((len(by_foot), 2, feet.ROWS_PER_FOOT))
    out[:, :, 0:3] = out[:, :, 3:6] = by_foot
    found = np.zeros(state.points.loaded.shape)  # zero for torques at the toe
    found[:, : feet.NUM_ROWS] = out.reshape(len(by_foot), -1)
    return found * state.points.loaded


def _reactions(values: np.ndarray, weights: np.ndarray) -> np.ndarray:
    return np.einsum("pfa,fa->p", values, weights)


def _flat(directions: np.ndarray) -> np.ndarray:
    """(num, 3 directions, functions, orders) -> (num, functions * orders, 3)."""
    return np.swapaxes(directions.reshape(*directions.shape[:2], -1), 1, 2)


def _both_ways(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    return a[:, :, None] * b[:, None] + b[:, :, None] * a[:, None]
