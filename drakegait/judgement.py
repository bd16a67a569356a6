"""What `check` measures, and the limits that a gait has to keep.

Limits are twice the tolerances of the study where it has one. See `drakegait.check`.
"""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from pydrake.math import BsplineBasis
from pydrake.trajectories import BsplineTrajectory

from drakegait.check import CheckItem
from drakegait.judged_disorders import EXCITATION_SLACK, disorders
from drakegait.loads import Loads, loads_along, muscle_inputs
from drakegait.motion import Motion
from drakegait.quantities import GRAVITY
from drakegait.walker import feet

if TYPE_CHECKING:
    from collections.abc import Callable

    from drakegait.gait import Gait

SLACK = 2.0  # times the tolerance, between control points
GRIP_SLACK = 0.02  # of the friction that the ground can hold
PULL_SLACK = 0.01  # of body weight that a point may pull at the ground
ENERGY_TOLERANCE = 0.01
SPEED_TOLERANCE = 0.002  # [m/s]
PERIODICITY_TOLERANCE = 1e-6
_DEGREE = 5


class Judged:
    """A gait evaluated at uniform instants, then just after and just before each event."""

    def __init__(self, gait: Gait, instants: int):
        self.gait, self.walker = gait, gait.study.walker
        self.uniform = instants
        events = np.asarray(gait.values.events)
        tau = np.arange(instants) / instants
        phases = np.searchsorted(events, tau, side="right") - 1
        self.tau = np.concatenate([tau, events, [*events[1:], 1.0]])
        self.phases = np.concatenate([phases, np.arange(8), np.arange(8)])
        self.stride_time = float(gait.values.stride_time)
        self.stride_length = float(gait.values.placement[:2].sum())
        self.motion = self.motion_at(self.tau)

    def motion_at(self, tau: np.ndarray) -> Motion:
        """Motion and muscle forces at tau in [0, 1], by Drake's B-splines."""
        values = self.gait.values
        motion, forces = (
            tuple(curve.MakeDerivative(order).vector_values(tau).T for order in range(3))
            for curve in map(
                _periodic_spline, (values.coordinate_coefficients, values.force_coefficients)
            )
        )
        return Motion.from_derivatives(tau, self.stride_time, self.stride_length, motion, forces)

    @cached_property
    def loads(self) -> Loads:
        """All forces."""
        return loads_along(self.walker, self.motion, self.phases)

    @cached_property
    def states(self) -> dict[str, np.ndarray]:
        """Muscles by the exact laws."""
        inputs = muscle_inputs(self.walker, self.motion)
        return self.walker.muscle_functions.states(inputs)

    @cached_property
    def contact_points(self) -> np.ndarray:
        """Heel and toe (K, 4, 3) [m]."""
        return self.walker.skeleton.contact_points(self.motion.q)

    @cached_property
    def body_weight(self) -> float:
        """Of the subject without added masses [N]."""
        return self.walker.subject.mass * GRAVITY

    def mean(self, rate: np.ndarray) -> np.ndarray:
        """Average over the stride: the rectangle rule, exact to high order for periodic rates."""
        return rate[: self.uniform].mean(axis=0)

    def place(self, instant: int) -> str:
        """An instant in gait terms."""
        phase = feet.PHASE_NAMES[self.phases[instant]]
        return f"{phase}, {100.0 * self.tau[instant]:.1f} %"

    def worst(
        self,
        name: str,
        label: str,
        values: np.ndarray,
        unit: str,
        limit: float,
        columns: tuple[str, ...],
        largest: bool = True,
    ) -> CheckItem:
        """The largest (or smallest) of `values` (K, columns); nan and -inf are passed over."""
        order = values if largest else -values
        order = np.where(np.isnan(order), np.inf, order)
        instant, column = np.unravel_index(np.argmax(order), order.shape)
        value = float(values[instant, column])
        bounds = {"high": limit} if largest else {"low": limit}
        fails = (order > (limit if largest else -limit)).any(axis=1)
        phases = tuple(int(phase) for phase in np.unique(self.phases[fails]))
        where = f"{self.place(instant)}, {columns[column]}"
        return CheckItem(name, label, value, unit, where=where, phases=phases, **bounds)


def judge(gait: Gait, instants: int) -> tuple[CheckItem, ...]:
    """All items of the check of `gait`, see `drakegait.check`."""
    judged = Judged(gait, instants)
    groups: list[Callable[[Judged], list[CheckItem]]] = [
        equations_of_motion, foot_contact, muscles, ground_forces, energy_balance, whole_stride,
        costs, disorders,
    ]  # fmt: skip
    return tuple(item for group in groups for item in group(judged))


def equations_of_motion(judged: Judged) -> list[CheckItem]:
    """|e| of eq. (18) in every coordinate, against eps_m."""
    tolerances, rotation = judged.gait.study.tolerances, judged.walker.is_rotation
    error = np.abs(judged.loads.residual)
    names = judged.walker.coordinate_names
    items = []
    for unit, rows, tolerance in (
        ("N", ~rotation, tolerances.force_tolerance),
        ("Nm", rotation, tolerances.moment_tolerance),
    ):
        here = np.flatnonzero(rows)
        items.append(
            judged.worst(
                f"equations_of_motion_max_{unit}",
                "equations of motion, " + ("forces" if unit == "N" else "moments"),
                error[:, here], unit.replace("Nm", "N m"), SLACK * tolerance,
                tuple(names[i] for i in here),
            )
        )  # fmt: skip
    return items


def foot_contact(judged: Judged) -> list[CheckItem]:
    """Standing feet against their prints (item 9 of the paper's 3.3), and depth in the ground."""
    study, points = judged.gait.study, judged.contact_points
    tolerance = study.tolerances.contact_tolerance
    rows = np.zeros((len(points), feet.NUM_ROWS))
    rows[:, [r for r in range(feet.NUM_ROWS) if r not in feet.YAW_ROWS]] = points.reshape(-1, 12)
    rows[:, list(feet.YAW_ROWS)] = judged.walker.skeleton.foot_yaw(judged.motion.q)
    prints = np.array([feet.left_print(phase) for phase in judged.phases])
    placement = np.tile(judged.gait.values.placement, (len(points), 1))
    wanted, _ = feet.footprints(placement, prints, judged.walker.foot)
    distance = np.abs(rows - wanted)
    # A heading in terms of length: 0.01 rad weighs as much as 2 mm, a lever of 0.2 m.
    distance[:, list(feet.YAW_ROWS)] *= tolerance / study.tolerances.yaw_tolerance
    distance = np.where(judged.loads.active[:, : feet.NUM_ROWS], distance, -np.inf)
    limit = 1e3 * SLACK * tolerance
    return [
        judged.worst(
            "foot_contact_max_mm", "standing foot off its print", 1e3 * distance, "mm", limit,
            feet.ROW_NAMES,
        ),
        judged.worst(
            "penetration_max_mm", "heel or toe in the ground", -1e3 * points[..., 2], "mm", limit,
            feet.POINT_NAMES,
        ),
    ]  # fmt: skip


def muscles(judged: Judged) -> list[CheckItem]:
    """Excitations between 0 and 1."""
    u, names = judged.states["excitation"], judged.walker.muscles.names
    return [
        judged.worst("excitation_min", "smallest excitation", u, "", -EXCITATION_SLACK, names,
                     largest=False),
        judged.worst("excitation_max", "largest excitation", u, "", 1.0 + EXCITATION_SLACK, names),
    ]  # fmt: skip


def ground_forces(judged: Judged) -> list[CheckItem]:
    """The ground only pushes and holds no more than friction allows, docs/formulation.md 6.9."""
    contact, loads = judged.gait.study.contact, judged.loads
    force, by_point = loads.ground_reactions, loads.point_forces[..., 2]
    active = loads.active[:, : feet.NUM_ROWS].reshape(-1, 2, feet.ROWS_PER_FOOT)
    standing = active.any(axis=2)
    # Horizontal forces that the tolerance of the equations of motion covers are no slip.
    unseen = SLACK * judged.gait.study.tolerances.force_tolerance
    grip = np.maximum(contact.friction * force[..., 2], unseen)
    slip = np.where(standing, np.hypot(force[..., 0], force[..., 1]) / grip, -np.inf)
    # The pivot is the heel while it is down, then the toe.
    arm = np.full(by_point.shape, contact.patch_radius)
    arm[..., 1] += np.where(active[..., 2], judged.walker.foot.length, 0.0)
    # Beyond the grip, a free moment is one more unexplained moment: judged by that tolerance.
    hold = contact.friction * np.sum(arm * np.maximum(by_point, 0.0), axis=2)
    twist = np.where(standing, np.abs(loads.pivot_moments) - hold, -np.inf)
    spare = SLACK * judged.gait.study.tolerances.moment_tolerance
    loaded = np.where(
        loads.active[:, list(feet.VERTICAL_ROWS)], by_point.reshape(-1, 4), np.inf
    )
    names = ("right foot", "left foot")
    torques = []
    if contact.toe_torque:
        size = np.abs(loads.toe_torques).reshape(-1, 4)
        limit = contact.toe_torque_limit + spare
        torques = [judged.worst("toe_torque_max_Nm", "torque at the toe", size, "N m", limit,
                                feet.TORQUE_NAMES)]  # fmt: skip
    return [
        judged.worst("friction_ratio_max", "friction used", slip, "", 1.0 + GRIP_SLACK, names),
        judged.worst("free_moment_excess_Nm", "free moment beyond grip", twist, "N m", spare,
                     names),
        judged.worst("normal_force_min_N", "smallest vertical force", loaded, "N",
                     -PULL_SLACK * judged.body_weight, feet.POINT_NAMES, largest=False),
        *torques,
    ]  # fmt: skip


def energy_balance(judged: Judged) -> list[CheckItem]:
    """Work of all forces against the change of energy, from the start to every instant.

    Muscles work along their paths, gravity by the height of the centre of mass, and the energy
    comes from positions and velocities: the laws of motion, the derivatives of the splines and the
    moment arms have to agree. The residual counts as a force here, so the balance holds for any
    motion: it judges the mechanics, NOT whether the walker lives on its own muscles. That is what
    the work of the residual and of the standing feet tell, both zero in nature. They are reported
    with their share of the muscles' work, and have no limit.
    """
    motion, loads, skeleton = judged.motion, judged.loads, judged.walker.skeleton
    num, period = judged.uniform, judged.stride_time
    inputs = muscle_inputs(judged.walker, motion)
    by_muscle = -inputs[..., 0] * inputs[..., 4]
    other = np.sum((loads.passive + loads.contact + loads.residual) * motion.v, axis=1)
    power = (by_muscle.sum(axis=1) + other)[:num]
    energy = skeleton.kinetic_energy(motion.q, motion.v) + skeleton.potential_energy(motion.q)
    change = np.append(energy[:num], energy[-1]) - energy[0]  # the last instant is tau = 1
    step = 0.5 * (power + np.roll(power, -1)) * period / num
    work = np.concatenate([[0.0], np.cumsum(step)])
    size = period * float(judged.mean(np.abs(by_muscle)).sum())
    error = np.max(np.abs(work - change)) / size
    items = [
        CheckItem("energy_balance_relative_error", "work against change of energy", float(error),
                  "", high=ENERGY_TOLERANCE)
    ]  # fmt: skip
    for name, label, force in (
        ("residual_work_J", "net work of the residual", loads.residual),
        ("contact_work_J", "net work of the standing feet", loads.contact),
    ):
        net = period * float(judged.mean(np.sum(force * motion.v, axis=1)))
        share = f"{100.0 * abs(net) / size:.1f} % of the muscles' work"
        items.append(CheckItem(name, label, net, "J", where=share))
    return items


def whole_stride(judged: Judged) -> list[CheckItem]:
    """Average velocity, and the next stride beginning as this one."""
    ends = judged.motion_at(np.array([0.0, 1.0]))
    jump_q = np.diff(ends.q, axis=0)[0]
    speed = jump_q[0] / judged.stride_time
    jump_q[0] -= judged.stride_length
    jump = np.concatenate([jump_q, np.diff(ends.v, axis=0)[0]])
    return [
        CheckItem("speed_error", "average velocity off by",
                  float(abs(speed - judged.gait.study.speed)), "m/s", high=SPEED_TOLERANCE),
        CheckItem("periodicity_error", "jump between strides", float(np.max(np.abs(jump))), "",
                  high=PERIODICITY_TOLERANCE),
    ]  # fmt: skip


def costs(judged: Judged) -> list[CheckItem]:
    """Both parts of eq. (13) without weights, on the dense grid."""
    walker, period = judged.walker, judged.stride_time
    basal = walker.energy_settings.basal_power(walker.subject.mass)
    energy = period * (float(judged.mean(judged.states["power"]).sum()) + basal)
    reference = judged.gait.study.reference_walk
    q = judged.motion.q.copy()
    q[:, 0] -= judged.stride_length * judged.tau
    motion = (q - reference.coordinate_values(judged.tau)) / reference.coordinate_sigma
    force = judged.loads.ground_reactions - reference.ground_reactions(judged.tau)
    force_sigma = np.where(reference.force_weight > 0.0, reference.force_sigma, 1.0)
    rate = motion**2 @ reference.coordinate_weight
    rate = rate + np.sum(reference.force_weight * (force / force_sigma) ** 2, axis=(1, 2))
    return [
        CheckItem("metabolic_cost_of_transport", "metabolic cost of transport, exact",
                  energy / judged.stride_length, "J/m"),
        CheckItem("deviation", "deviation from the reference", period * float(judged.mean(rate)),
                  "s"),
    ]  # fmt: skip


def _periodic_spline(coefficients: np.ndarray) -> BsplineTrajectory:
    """The functions with `coefficients` (num, M), M bells centred on the nodes k / M, on [0, 1]."""
    count = coefficients.shape[1]
    knots = np.arange(-_DEGREE, count + _DEGREE + 1) / count
    # The bell that starts at knot i is centred on node i - 2.
    wrapped = np.arange(-2, count + 3) % count
    control_points = coefficients[:, wrapped].T[..., None]
    return BsplineTrajectory(BsplineBasis(_DEGREE + 1, knots.tolist()), list(control_points))
