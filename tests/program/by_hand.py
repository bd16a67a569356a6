"""The laws of walking at each control point, written down a second time from the unknowns.

Loops, no sparsity, no chain rule, no window; the skeleton's and the muscles' own functions, which
have tests of their own, are taken as given.
"""

from __future__ import annotations

import numpy as np

from drakegait.program.gait_program import GaitProgram
from drakegait.walker import feet

# Who stands on what in each phase, docs/formulation.md 6.1: heel, toe or flat; right, left foot.
STANCE = (
    ("heel", "toe"), ("flat", "toe"), ("flat", None), ("toe", None),
    ("toe", "heel"), ("toe", "flat"), (None, "flat"), (None, "toe"),
)  # fmt: skip
CONTACTS = {
    None: (),
    "heel": ("heel x", "heel y", "heel z", "yaw"),
    "toe": ("toe x", "toe y", "toe z", "yaw"),
    # A rigid flat foot: heel placed, toe at its height, heading given.
    "flat": ("heel x", "heel y", "heel z", "toe z", "yaw"),
}


def contacts(phase: int, planar: bool) -> set[str]:
    """Contact rows of a phase by name."""
    found = set()
    for side, stance in zip("rl", STANCE[phase % 8], strict=True):
        for row in CONTACTS[stance]:
            word, *axis = row.split()
            name = f"foot_{side} yaw" if word == "yaw" else f"{word}_{side} {axis[0]}"
            if not (planar and (word == "yaw" or axis == ["y"])):
                found.add(name)
    return found


def mask(names: set[str]) -> np.ndarray:
    return np.array([name in names for name in feet.ROW_NAMES])


class ByHand:
    """Everything at the control points of `program` for the design vector `x`."""

    def __init__(self, program: GaitProgram, x: np.ndarray):
        self.program, self.formulation = program, program.formulation
        formulation, values = program.formulation, program.values(x)
        walker, splines = formulation.walker, formulation.splines
        self.walker, self.values = walker, values
        schedule = formulation.schedule
        ends = np.append(values.events, 1.0)[: schedule.num_phases + 1]
        self.tau = np.concatenate(
            [
                start + (stop - start) * np.arange(n + 1) / (n + 1)
                for start, stop, n in zip(ends, ends[1:], schedule.interior_points, strict=False)
            ]
        )
        self.phases = np.repeat(np.arange(schedule.num_phases),
                                np.array(schedule.interior_points) + 1)  # fmt: skip
        self.on_event = np.isin(self.tau, ends)
        period, advance = values.stride_time, values.placement[0] + values.placement[1]
        self.period, self.advance = period, advance

        def curve(coefficients):
            return [
                splines.evaluate(coefficients, self.tau, order).T / period**order
                for order in range(3)
            ]

        self.periodic, v, self.a = curve(values.coordinate_coefficients)
        self.q, self.v = self.periodic.copy(), v.copy()
        self.q[:, 0] += advance * self.tau
        self.v[:, 0] += advance / period
        self.forces = curve(values.force_coefficients)
        self.multipliers = values.multipliers
        # Trapezoids over a closed cycle, of which a symmetric walker does one half.
        length = ends[-1]
        after = np.append(self.tau[1:], length)
        before = np.append(self.tau[-1] - length, self.tau[:-1])
        self.share = 0.5 * (after - before) / length

    def rows_of_ground(self, point: int) -> tuple[np.ndarray, np.ndarray]:
        """Masks of the loaded and of the placed contact rows of a control point."""
        planar, phase = self.formulation.planar, int(self.phases[point])
        now = contacts(phase, planar)
        if not self.on_event[point]:
            return mask(now), mask(now)
        before = contacts(phase - 1, planar)
        return mask(min(now, before, key=len)), mask(now | before)

    def residual(self) -> np.ndarray:
        """e of eq. (18)."""
        walker, out = self.walker, []
        for k in range(len(self.tau)):
            skeleton = walker.skeleton
            torque = skeleton.inverse_dynamics(self.q[k], self.v[k], self.a[k])
            torque = torque - walker.passive.forces(self.q[k], self.v[k])
            torque = torque - walker.muscles.moment_arms.T @ self.forces[0][k]
            loaded, _ = self.rows_of_ground(k)
            contact = skeleton.contact_jacobian(self.q[k])[loaded]
            out.append(torque - contact.T @ self.multipliers[k, loaded])
        return np.array(out)

    def muscle_values(self) -> np.ndarray:
        muscles = self.walker.muscles
        lengths = [muscles.l0 - self.q @ muscles.moment_arms.T]
        lengths += [-rate @ muscles.moment_arms.T for rate in (self.v, self.a)]
        inputs = np.stack([*self.forces, *lengths], axis=-1)
        return self.walker.muscle_functions.evaluate(inputs, self.program.smoothing)

    def ground_reactions(self) -> np.ndarray:
        out = np.zeros((len(self.tau), 2, 3))
        for name, column in zip(feet.ROW_NAMES, self.multipliers.T, strict=True):
            place, axis = name.split()
            if axis != "yaw":
                out[:, "rl".index(place[-1]), "xyz".index(axis)] += column
        return out

    def footprint(self, k: int) -> dict[str, float]:
        """Prescribed value of each contact row."""
        right_step, left_step, right_angle, left_angle, width = self.values.placement
        print_of_left = 0 if self.phases[k] <= (2 if self.on_event[k] else 1) else 1
        out = {}
        for side, angle, y in (("r", right_angle, -width / 2), ("l", left_angle, width / 2)):
            x = 0.0 if side == "r" else (-right_step, left_step)[print_of_left]
            for point, arm in (("heel", self.walker.foot.heel), ("toe", self.walker.foot.toe)):
                out[f"{point}_{side} x"] = x + arm * np.cos(angle)
                out[f"{point}_{side} y"] = y + arm * np.sin(angle)
                out[f"{point}_{side} z"] = 0.0
            out[f"foot_{side} yaw"] = angle
        return out

    def contact_positions(self, k: int) -> dict[str, float]:
        skeleton = self.walker.skeleton
        points = skeleton.contact_points(self.q[k])
        out = {
            f"{name} {axis}": points[i, j]
            for i, name in enumerate(feet.POINT_NAMES)
            for j, axis in enumerate("xyz")
        }
        if not self.formulation.planar:
            yaw = skeleton.foot_yaw(self.q[k])
            out |= {"foot_r yaw": yaw[0], "foot_l yaw": yaw[1]}
        return out

    def cost_of_transport(self) -> float:
        power = self.muscle_values()[..., 2].sum(axis=1)
        return self.period * float(self.share @ power) / self.advance

    def deviation(self) -> float:
        reference = self.formulation.reference
        motion = self.periodic - reference.coordinate_values(self.tau)
        force = self.ground_reactions() - reference.ground_reactions(self.tau)
        rate = (reference.coordinate_weight * (motion / reference.coordinate_sigma) ** 2).sum(1)
        seen = reference.force_weight > 0.0
        rate += (reference.force_weight * force**2)[:, seen] @ (reference.force_sigma[seen] ** -2.0)
        return self.period * float(self.share @ rate)
