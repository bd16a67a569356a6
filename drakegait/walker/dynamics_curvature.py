"""Second derivatives of the equations of motion and of the contact rows.

Drake's plant gives the tree of joints and bodies; CasADi differentiates the
virtual power of that tree twice, exactly. With virtual joint velocities w the
equations of motion read (Jourdain's principle)

    w . (M a + k - g) = sum_b  m_b a_b . v_b(w) + (I_b alpha_b + omega_b x I_b omega_b) . omega_b(w)

with gravity as an upward acceleration of the ground, and a contact row contributes
the velocity of its point, or the vertical angular velocity of its foot, at w.
Velocities and accelerations are carried from joint to joint in the axes of each
link (Featherstone 2008, chapter 5), which keeps the expressions small.
"""

from __future__ import annotations

from dataclasses import dataclass

import casadi
import numpy as np

from drakegait.walker import feet
from drakegait.walker.skeleton import GRAVITY, Skeleton


@dataclass(frozen=True)
class Weights:
    """Weights of the sum that is differentiated, (num, ...) each.

    Attributes:
        motion: w, of the equations of motion (n,).
        velocities: nu, of the rows C(q) e (14,).
        positions: rho, of the contact positions, yaw by heading (14,).
    """

    motion: np.ndarray
    velocities: np.ndarray
    positions: np.ndarray


@dataclass(frozen=True)
class MotionCurvature:
    """Second derivatives of the weighted sum, (num, n, n) each but `ql` (num, n, 14).

    The letters say by what: coordinates q, velocities v, accelerations a, contact multipliers
    l, residuals e.
    """

    qq: np.ndarray
    qv: np.ndarray
    vv: np.ndarray
    qa: np.ndarray
    ql: np.ndarray
    qe: np.ndarray


class DynamicsCurvature:
    """Curvature of `w.(M a + k - g - C^T lambda) + nu.C e + rho.positions` at many instants."""

    def __init__(self, skeleton: Skeleton):
        self._function, self._places = _build(skeleton)
        self._mapped: dict[int, casadi.Function] = {}

    def evaluate(
        self,
        q: np.ndarray,
        v: np.ndarray,
        a: np.ndarray,
        multipliers: np.ndarray,
        residuals: np.ndarray,
        weights: Weights,
    ) -> MotionCurvature:
        """Blocks of second derivatives at instants (num, ...)."""
        parts = [q, v, a, multipliers, residuals, *vars(weights).values()]
        values = self._call(np.concatenate(parts, axis=1))
        blocks = {}
        for name, (start, rows, columns, shape) in self._places.items():
            block = np.zeros((len(q), *shape))
            block[:, rows, columns] = values[:, start : start + len(rows)]
            blocks[name] = block
        return MotionCurvature(**blocks)

    def _call(self, inputs: np.ndarray) -> np.ndarray:
        """The compiled function at all instants, shared out to two threads."""
        num = len(inputs)
        if num not in self._mapped:
            self._mapped[num] = self._function.map(num, "thread", min(2, num))
        out = np.empty((num, self._function.nnz_out(0)))
        buffer, run = self._mapped[num].buffer()
        inputs = np.ascontiguousarray(inputs)
        buffer.set_arg(0, memoryview(inputs))
        buffer.set_res(0, memoryview(out))
        run()
        return out


def _build(skeleton: Skeleton) -> tuple[casadi.Function, dict[str, tuple]]:
    n = skeleton.num_coordinates
    q, v, a, w, e = (casadi.SX.sym(name, n) for name in "qvawe")
    num = feet.NUM_ROWS_WITH_TORQUES if skeleton.toe_torque else feet.NUM_ROWS
    multipliers, nu = (casadi.SX.sym(name, num) for name in ("l", "nu"))
    rho = casadi.SX.sym("rho", feet.NUM_ROWS)
    links = _links(skeleton, q, v, a, (w, e))
    total = _virtual_power(skeleton, links)
    for foot, side in enumerate("rl"):
        rows = slice(feet.ROWS_PER_FOOT * foot, feet.ROWS_PER_FOOT * (foot + 1))
        link = links[f"foot_{side}"]
        points = [
            skeleton.plant.GetFrameByName(f"{name}_{side}").GetFixedPoseInBodyFrame().translation()
            for name in ("heel", "toe")
        ]
        total += casadi.dot(_row_velocities(link, points, 0), -multipliers[rows])
        total += casadi.dot(_row_velocities(link, points, 1), nu[rows])
        total += casadi.dot(_row_positions(link, points), rho[rows])
        if skeleton.toe_torque:
            rows = slice(feet.ROLL_ROWS[foot], feet.PITCH_ROWS[foot] + 1)
            total += casadi.dot(_tilt_velocities(link, 0), -multipliers[rows])
            total += casadi.dot(_tilt_velocities(link, 1), nu[rows])
    by_q = casadi.gradient(total, q)
    blocks = {
        "qq": casadi.jacobian(by_q, q),
        "qv": casadi.jacobian(by_q, v),
        "vv": casadi.jacobian(casadi.gradient(total, v), v),
        "qa": casadi.jacobian(by_q, a),
        "ql": casadi.jacobian(by_q, multipliers),
        "qe": casadi.jacobian(by_q, e),
    }
    places, parts, start = {}, [], 0
    for name, block in blocks.items():
        rows_, columns = block.sparsity().get_triplet()
        places[name] = (start, np.array(rows_, int), np.array(columns, int), block.shape)
        parts.append(casadi.vertcat(*block.nonzeros()))
        start += block.nnz()
    inputs = casadi.vertcat(q, v, a, multipliers, e, w, nu, rho)
    return casadi.Function("curvature", [inputs], [casadi.vertcat(*parts)]), places


@dataclass
class _Link:
    """Motion of a link's origin in the link's own axes, and its pose in the world."""

    rotation: casadi.SX
    origin: casadi.SX
    omega: casadi.SX
    alpha: casadi.SX
    acceleration: casadi.SX
    virtual: list[tuple[casadi.SX, casadi.SX]]  # angular, linear velocity at w and at e


def _links(
    skeleton: Skeleton, q: casadi.SX, v: casadi.SX, a: casadi.SX, rates: tuple[casadi.SX, ...]
) -> dict[str, _Link]:
    """Every link by its name."""
    plant = skeleton.plant
    joints = {name: plant.GetJointByName(name) for name in skeleton.coordinates}
    inboard = {joint.child_body().name(): name for name, joint in joints.items()}
    zero = casadi.SX.zeros(3)
    lift = casadi.SX([0.0, 0.0, GRAVITY])
    ground = _Link(casadi.SX.eye(3), zero, zero, zero, lift, [(zero, zero) for _ in rates])
    links: dict[str, _Link] = {}

    def link(body: str) -> _Link:
        if body not in inboard:
            return ground
        if body not in links:
            name = inboard[body]
            joint, index = joints[name], skeleton.coordinates.index(name)
            parent = link(joint.parent_body().name())
            own = (q[index], v[index], a[index], [rate[index] for rate in rates])
            links[body] = _step(parent, joint, *own)
        return links[body]

    for body in inboard:
        link(body)
    return links


def _step(parent: _Link, joint, q, v, a, rates: list) -> _Link:  # noqa: ANN001 - Drake, CasADi
    """The link beyond a joint with one axis, whose frames have the links' directions."""
    offset = joint.frame_on_parent().GetFixedPoseInBodyFrame()
    on_child = joint.frame_on_child().GetFixedPoseInBodyFrame()
    assert offset.rotation().IsNearlyIdentity() and on_child.IsNearlyIdentity(1e-12)
    arm = casadi.SX(offset.translation())
    turns = joint.type_name() == "revolute"
    axis = joint.revolute_axis() if turns else joint.translation_axis()
    slide, slide_rate, slide_acceleration = (
        (0.0, 0.0, 0.0) if turns else (axis * q, axis * v, axis * a)
    )
    arm = casadi.sparsify(arm + slide)
    down = _turn(axis, q).T if turns else casadi.SX.eye(3)
    omega, alpha = parent.omega, parent.alpha
    velocity_of_arm = casadi.cross(omega, arm)
    acceleration = parent.acceleration + casadi.cross(alpha, arm)
    acceleration += casadi.cross(omega, velocity_of_arm + 2.0 * slide_rate) + slide_acceleration
    virtual = []
    for (angular, linear), rate in zip(parent.virtual, rates, strict=True):
        moved = linear + casadi.cross(angular, arm) + (0.0 if turns else axis * rate)
        virtual.append((down @ angular + (axis * rate if turns else 0.0), down @ moved))
    carried = down @ omega
    spin = axis * v if turns else casadi.SX.zeros(3)
    return _Link(
        parent.rotation @ down.T,
        parent.origin + parent.rotation @ arm,
        carried + spin,
        down @ alpha + (axis * a if turns else 0.0) + casadi.cross(carried, spin),
        down @ acceleration,
        virtual,
    )


def _turn(axis: np.ndarray, angle: casadi.SX) -> casadi.SX:
    """Rotation about a unit axis (Rodrigues)."""
    cross = np.array([[0, -axis[2], axis[1]], [axis[2], 0, -axis[0]], [-axis[1], axis[0], 0]])
    turn = np.outer(axis, axis) + casadi.cos(angle) * (-cross @ cross) + casadi.sin(angle) * cross
    return casadi.sparsify(casadi.SX(turn))


def _virtual_power(skeleton: Skeleton, links: dict[str, _Link]) -> casadi.SX:
    total = casadi.SX(0.0)
    for name, link in links.items():
        body = skeleton.plant.GetBodyByName(name)
        mass = body.default_mass()
        if mass == 0.0:
            continue
        inertia = body.default_spatial_inertia()
        com = inertia.get_com()
        about_com = inertia.Shift(com).CalcRotationalInertia().CopyToFullMatrix3()
        about_com = casadi.sparsify(casadi.SX(np.where(np.abs(about_com) < 1e-12, 0, about_com)))
        arm = casadi.sparsify(casadi.SX(com))
        omega, alpha = link.omega, link.alpha
        acceleration = link.acceleration + casadi.cross(alpha, arm)
        acceleration += casadi.cross(omega, casadi.cross(omega, arm))
        angular, linear = link.virtual[0]
        total += mass * casadi.dot(acceleration, linear + casadi.cross(angular, arm))
        torque = about_com @ alpha + casadi.cross(omega, about_com @ omega)
        total += casadi.dot(torque, angular)
    return total


def _row_velocities(link: _Link, points: list[np.ndarray], which: int) -> casadi.SX:
    """Contact rows of C(q) times the virtual velocities number `which` (7,)."""
    angular, linear = link.virtual[which]
    velocities = [link.rotation @ (linear + casadi.cross(angular, point)) for point in points]
    return casadi.vertcat(*velocities, (link.rotation @ angular)[2])


def _tilt_velocities(link: _Link, which: int) -> casadi.SX:
    """Rotations about x and y at the virtual velocities number `which` (2,)."""
    return (link.rotation @ link.virtual[which][0])[:2]


def _row_positions(link: _Link, points: list[np.ndarray]) -> casadi.SX:
    """Positions of heel and toe and the heading of the foot (7,)."""
    heel, toe = (link.origin + link.rotation @ point for point in points)
    along = toe - heel
    return casadi.vertcat(heel, toe, casadi.atan2(along[1], along[0]))
