"""Joint moments and powers of the reference stride, by inverse dynamics through our own walker.

A reference holds a motion and forces under the feet, but no moments. With the motion q(t) the
equations of motion want

    tau + C^T lambda = M q'' + k - q_g,

tau the internal moments of the joints, lambda the forces at heels and toes, in each of the eight
phases those that docs/formulation.md 6.1 lets bear load. The rows of the floating trunk, which no
joint drives, must be borne by lambda alone; in double support they leave open which foot bears
what. There the recorded forces decide. So lambda is the least-squares solution of

    trunk's rows / (0.01 body weights, also times 1 m),
    (force of each foot - recorded) / (0.05 body weights),

and tau is what remains in the rows of the joints. The method is the usual one of gait analysis,
with the model's points of contact in place of a measured centre of pressure. Segments and contact
are the model's: this is no measurement, and it inherits the reference's errors.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from drakegait.quantities import GRAVITY
from drakegait.walker import coordinates, feet

if TYPE_CHECKING:
    from drakegait.study import GaitStudy

_TRUNK = 0.01
"""What may be missing in the rows of the trunk [body weights, for moments times 1 m]."""
_RECORDED = 0.05
"""Standard deviation of the recorded force of a foot [body weights]: what import's fit assumes."""
_SHARE = 1.0
"""The same of what heel and toe, or a free moment, bear apart from the foot's sum [body weights]:
loose, it only chooses where the other rows leave a choice."""
_INSTANTS = 400


@dataclass(frozen=True, eq=False)
class ReferenceDynamics:
    """Internal moments and powers over the reference stride at fractions 0, 1/400, ... of it.

    Attributes:
        joints: names of the joints' coordinates.
        moments: (400, num_joints) [N m], anatomical signs, of muscles and passive structures.
        powers: (400, num_joints) [W], positive where energy is given to the segments.
        residual: (400, 6 or 3) what no force bears in the rows of the trunk [N, N m].
    """

    joints: tuple[str, ...]
    moments: np.ndarray
    powers: np.ndarray
    residual: np.ndarray

    def at(self, tau: np.ndarray, values: np.ndarray) -> np.ndarray:
        """Values (400,) at fractions of the stride (num,), which may lie beyond one stride."""
        grid = np.arange(_INSTANTS + 1) / _INSTANTS
        return np.interp(np.mod(tau, 1.0), grid, np.append(values, values[0]))


def reference_dynamics(study: GaitStudy) -> ReferenceDynamics | None:
    """Inverse dynamics of the reference of a study, by the walker without its changes.

    Returns:
        None if the reference has no forces: in double support nothing then tells the feet apart.
    """
    reference = study.reference_walk
    if reference.forces is None:
        return None
    plain = study.replace(
        added_masses=(), disorders=(), limits=(), strength={}, muscle_changes={}
    )  # fmt: skip
    skeleton, kind = plain.walker.skeleton, study.skeleton_kind
    tau = np.arange(_INSTANTS) / _INSTANTS
    period = reference.stride_time
    q, v, a = (reference.coordinate_values(tau, k) / period**k for k in range(3))
    v = v.copy()
    v[:, 0] += reference.speed  # hat_x is the periodic part
    needed = (
        np.einsum("kij,kj->ki", skeleton.mass_matrix(q), a)
        + skeleton.bias(q, v)
        - skeleton.gravity_forces(q)
    )
    rows = coordinates.joint_angles(kind)
    trunk = np.setdiff1d(np.arange(q.shape[1]), rows)
    jacobian = skeleton.contact_jacobian(q)[:, : feet.NUM_ROWS]
    phases = np.searchsorted(np.cumsum(reference.phase_fractions)[:-1], tau, side="right")
    weight = study.subject.mass * GRAVITY
    recorded = reference.ground_reactions(tau)
    left = needed.copy()
    for instant, phase in enumerate(phases):
        borne = feet.active_rows(phase, kind == "planar")
        contact = jacobian[instant][borne]
        multipliers = _contact_forces(
            contact[:, trunk].T, needed[instant, trunk], borne, recorded[instant], weight
        )
        left[instant] -= contact.T @ multipliers
    signs = coordinates.anatomical_signs(kind)[rows]
    return ReferenceDynamics(
        joints=tuple(np.array(coordinates.names(kind))[rows]),
        moments=signs * left[:, rows],
        powers=left[:, rows] * v[:, rows],
        residual=left[:, trunk],
    )


def _contact_forces(
    bearing: np.ndarray, needed: np.ndarray, borne: np.ndarray, recorded: np.ndarray, weight: float
) -> np.ndarray:
    """Forces of the contact rows that bear load, by weighted least squares.

    Args:
        bearing: (num_trunk, num_borne) what they do in the rows of the trunk.
        needed: (num_trunk,) what those rows need.
        borne: mask of the contact rows (14,).
        recorded: forces of right and left foot (2, 3).
        weight: of the body [N].
    """
    where = np.flatnonzero(borne)
    foot, within = np.divmod(where, feet.ROWS_PER_FOOT)
    is_force = within < 6
    sums = np.zeros((6, len(where)))  # right x, y, z, left x, y, z
    sums[3 * foot[is_force] + within[is_force] % 3, np.flatnonzero(is_force)] = 1.0
    there = sums.any(axis=1)
    matrix = np.vstack([
        bearing / (_TRUNK * weight),
        sums[there] / (_RECORDED * weight),
        np.eye(len(where)) / (_SHARE * weight),
    ])  # fmt: skip
    wanted = np.concatenate([
        needed / (_TRUNK * weight),
        recorded.ravel()[there] / (_RECORDED * weight),
        np.zeros(len(where)),
    ])  # fmt: skip
    return np.linalg.lstsq(matrix, wanted, rcond=None)[0]
