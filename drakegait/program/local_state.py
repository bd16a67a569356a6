"""The physics at control points, each part computed once and only when asked for.

From the local variables of `ControlPoints` follow the motion and the muscle
forces with their time derivatives, and from those the equations of motion
(15), the contact kinematics and the muscles' activations and energy, all with
first derivatives by physical quantities. Constraints and costs read what they
need; `chain` turns partial derivatives into those by local variables.
"""

from __future__ import annotations

from functools import cached_property

import numpy as np

from drakegait.program.control_points import ControlPoints
from drakegait.program.formulation import Formulation
from drakegait.program.physical_quantities import Curve, Dynamics, MultiplierDerivatives
from drakegait.walker import feet


class LocalState:
    """Lazy evaluation of the physics at `points` for the local variables `z` (num, size)."""

    def __init__(
        self, formulation: Formulation, points: ControlPoints, z: np.ndarray, smoothing: float = 1.0
    ):
        self.formulation = formulation
        self.points = points
        self.smoothing = smoothing
        self.results: dict[tuple[str, str], np.ndarray] = {}  # rows made from this state
        # Drake ends the process where a position or velocity is no number: such points stand
        # still instead, and their equations of motion and costs become no numbers.
        self._lost = ~np.isfinite(z[:, : points.layout.multipliers]).all(axis=1)
        if self._lost.any():
            z = z.copy()
            motion = np.r_[: points.layout.forces, points.layout.time : points.layout.multipliers]
            z[np.ix_(self._lost, motion)] = 0.5
        parts = points.layout.split(z)
        self._coordinates, self._forces, self.time, self.placement = parts[:4]
        self._multipliers, self.residuals = parts[4:]
        self.stride_time = self.time[:, :1]
        self.stride_length = self.placement[:, 0] + self.placement[:, 1]
        start, end = self.time[:, 2], self.time[:, 3]
        self.tau = (1.0 - points.shares) * start + points.shares * end

    # Motion and muscle forces ------------------------------------------------------------

    @cached_property
    def basis(self) -> np.ndarray:
        """Weights of the window's coefficients for derivatives 0..3 by tau, (4, num, width)."""
        splines, points = self.formulation.splines, self.points
        width = points.layout.width
        return np.stack(
            [splines.windowed_basis(self.tau, points.first, width, order) for order in range(4)]
        )

    def _curve(self, coefficients: np.ndarray) -> Curve:
        orders = np.einsum("pcw,opw->opc", coefficients, self.basis)
        period = self.stride_time
        return Curve(
            value=orders[0],
            rate=orders[1] / period,
            acceleration=orders[2] / period**2,
            by_tau=np.stack([orders[1], orders[2] / period, orders[3] / period**2]),
        )

    @cached_property
    def motion(self) -> Curve:
        """Coordinates, velocities, accelerations; hat_x without its steady advance."""
        return self._curve(self._coordinates)

    @cached_property
    def forces(self) -> Curve:
        """Muscle (tendon) forces and their rates."""
        return self._curve(self._forces)

    @cached_property
    def q(self) -> np.ndarray:
        """Coordinates with the steady advance of hat_x, (num, num_coordinates)."""
        q = self.motion.value.copy()
        q[:, 0] += self.stride_length * self.tau
        return q

    @cached_property
    def v(self) -> np.ndarray:
        """Velocities with the steady advance."""
        v = self.motion.rate.copy()
        v[:, 0] += self.stride_length / self.stride_time[:, 0]
        return v

    def bending(self, rows: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Second derivatives by tau of motion and forces (num, functions, 3), without the advance.

        Args:
            rows: second derivatives by tau of the basis rows of the three orders.
        """
        return (
            np.einsum("pcw,paw->pca", self._coordinates, rows),
            np.einsum("pcw,paw->pca", self._forces, rows),
        )

    # Contact -----------------------------------------------------------------------------

    @cached_property
    def contact_jacobian(self) -> np.ndarray:
        """C of all contact rows (num, 14, num_coordinates); see docs/formulation.md 6.6."""
        return self.formulation.walker.skeleton.contact_jacobian(self.q)

    @cached_property
    def contact_turning(self) -> np.ndarray:
        """Derivative of C e by the coordinates, residual variables e held (num, 14, n)."""
        skeleton = self.formulation.walker.skeleton
        return skeleton.contact_velocity_derivative(self.q, self.residuals)

    @cached_property
    def contact_positions(self) -> tuple[np.ndarray, np.ndarray]:
        """Values of the contact rows (num, 14) and their gradients (num, 14, num_coordinates)."""
        skeleton = self.formulation.walker.skeleton
        values = np.zeros((self.points.num, feet.NUM_ROWS))
        gradients = self.contact_jacobian[:, : feet.NUM_ROWS].copy()
        columns = [row for row in range(feet.NUM_ROWS) if row not in feet.YAW_ROWS]
        values[:, columns] = skeleton.contact_points(self.q).reshape(self.points.num, -1)
        if not self.formulation.planar:
            yaw = list(feet.YAW_ROWS)
            values[:, yaw] = skeleton.foot_yaw(self.q)
            gradients[:, yaw] = skeleton.foot_yaw_gradient(self.q)
        return values, gradients

    @cached_property
    def footprints(self) -> tuple[np.ndarray, np.ndarray]:
        """Prescribed contact rows (num, 14) and derivatives by the placement (num, 14, 5)."""
        return feet.footprints(
            self.placement, self.points.left_prints, self.formulation.walker.foot
        )

    # Dynamics ----------------------------------------------------------------------------

    @cached_property
    def multipliers(self) -> np.ndarray:
        """Contact forces and moments (num, 14): variables, or lambda* of eq. (17)."""
        if self.formulation.lifted:
            return np.where(self.points.loaded, self._multipliers, 0.0)
        multipliers = np.zeros(self.points.loaded.shape)
        for k, needed in enumerate(self.unloaded - self.muscle_torques):
            rows = self.points.loaded[k]
            jacobian = self.contact_jacobian[k, rows]
            multipliers[k, rows] = np.linalg.solve(jacobian @ jacobian.T, jacobian @ needed)
        return multipliers

    @cached_property
    def muscle_torques(self) -> np.ndarray:
        """B A f of eq. (24), (num, num_coordinates)."""
        torques = self.forces.value @ self.formulation.walker.muscles.moment_arms
        torques[self._lost] = np.nan
        return torques

    @cached_property
    def dynamics(self) -> Dynamics:
        """The skeleton's residual and derivatives, contact forces held constant."""
        walker = self.formulation.walker
        residual, by_q, by_v, mass = walker.skeleton.residual_derivatives(
            self.q, self.v, self.motion.acceleration, self.multipliers
        )
        passive_by_q, passive_by_v = walker.passive.derivatives(self.q)
        return Dynamics(
            residual - walker.passive.forces(self.q, self.v),
            by_q - passive_by_q,
            by_v - passive_by_v,
            mass,
        )

    @cached_property
    def residual(self) -> np.ndarray:
        """e of eq. (18) in every coordinate, without derivatives (num, num_coordinates)."""
        if "dynamics" in self.__dict__:
            return self.dynamics.residual - self.muscle_torques
        contact = np.einsum("pri,pr->pi", self.contact_jacobian, self.multipliers)
        return self.unloaded - contact - self.muscle_torques

    @cached_property
    def unloaded(self) -> np.ndarray:
        """M q'' + k - q_r: generalised forces that muscles and ground must supply."""
        walker = self.formulation.walker
        needed = walker.skeleton.inverse_dynamics(self.q, self.v, self.motion.acceleration)
        return needed - walker.passive.forces(self.q, self.v)

    @cached_property
    def multiplier_derivatives(self) -> MultiplierDerivatives:
        """Derivatives of lambda* (projected multipliers only).

        With G = C C^T and dr' taken at constant lambda*: d lambda* = G^-1 (C dr' + dC e),
        because C e = 0 at lambda*; dC e is the change of the contact velocities at the joint
        velocity e.
        """
        (num, rows), size = self.points.loaded.shape, self.q.shape[1]
        arms = self.formulation.walker.muscles.moment_arms
        out = MultiplierDerivatives(
            *(np.zeros((num, rows, size)) for _ in range(3)),
            np.zeros((num, rows, len(arms))),
        )
        skeleton, dynamics = self.formulation.walker.skeleton, self.dynamics
        for k in range(num):
            rows = self.points.loaded[k]
            jacobian = self.contact_jacobian[k, rows]
            inverse = np.linalg.inv(jacobian @ jacobian.T)
            turning = skeleton.contact_velocity_derivative(self.q[k], self.residual[k])[rows]
            out.by_q[k, rows] = inverse @ (jacobian @ dynamics.by_q[k] + turning)
            out.by_v[k, rows] = inverse @ jacobian @ dynamics.by_v[k]
            out.by_a[k, rows] = inverse @ jacobian @ dynamics.mass_matrix[k]
            out.by_f[k, rows] = -inverse @ jacobian @ arms.T
        return out

    # Muscles -----------------------------------------------------------------------------

    @cached_property
    def muscle_inputs(self) -> np.ndarray:
        """f, f', f'', l, l', l'' of every muscle (num, num_muscles, 6)."""
        muscles = self.formulation.walker.muscles
        arms = muscles.moment_arms
        return np.stack(
            [
                self.forces.value,
                self.forces.rate,
                self.forces.acceleration,
                muscles.l0 - self.q @ arms.T,
                -self.v @ arms.T,
                -self.motion.acceleration @ arms.T,
            ],
            axis=-1,
        )

    @cached_property
    def muscles(self) -> tuple[np.ndarray, np.ndarray]:
        """Excitation rows and power (num, num_muscles, 3) and their Jacobian (..., 3, 6)."""
        functions = self.formulation.walker.muscle_functions
        return functions.evaluate_with_jacobian(self.muscle_inputs, self.smoothing)

    @cached_property
    def muscle_values(self) -> np.ndarray:
        """Excitation rows [1/s] and power [W] without derivatives (num, num_muscles, 3)."""
        if "muscles" in self.__dict__:
            return self.muscles[0]
        functions = self.formulation.walker.muscle_functions
        return functions.evaluate(self.muscle_inputs, self.smoothing)

    @cached_property
    def muscle_inputs_by_tau(self) -> np.ndarray:
        """Change of `muscle_inputs` with tau at fixed coefficients (num, num_muscles, 6)."""
        arms = self.formulation.walker.muscles.moment_arms
        force = np.moveaxis(self.forces.by_tau, 0, -1)
        # hat_x, which advances steadily, spans no muscle.
        length = np.moveaxis(-self.motion.by_tau @ arms.T, 0, -1)
        return np.concatenate([force, length], axis=-1)

    # Ground reactions --------------------------------------------------------------------

    @cached_property
    def ground_reactions(self) -> np.ndarray:
        """Force on each foot (num, 2, 3) [N]: sum of heel and toe."""
        return feet.foot_forces(self.multipliers)

    @cached_property
    def share_of_cycle(self) -> np.ndarray:
        """Integration weight of each control point as part of the stride (num,)."""
        share = np.einsum("pe,pe->p", self.points.weights, self.time[:, 1:4])
        return np.where(self._lost, np.nan, self.formulation.repeats * share)

    # Deviation from the reference -------------------------------------------------------

    @cached_property
    def deviation(self) -> tuple[np.ndarray, np.ndarray]:
        """Coordinates (num, n) and ground reactions (num, 2, 3) minus the reference."""
        reference, tau = self.formulation.reference, self.tau
        return (
            self.motion.value - reference.coordinate_values(tau),
            self.ground_reactions - reference.ground_reactions(tau),
        )

    @cached_property
    def deviation_slope(self) -> tuple[np.ndarray, np.ndarray]:
        """Minus the reference's slopes by tau alone."""
        reference, tau = self.formulation.reference, self.tau
        return (
            -reference.coordinate_values(tau, derivative=1),
            -reference.ground_reactions(tau, derivative=1),
        )
