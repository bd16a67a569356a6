"""Contact points, rows, their ranks: what the feet can and cannot hold."""

from __future__ import annotations

import numpy as np
import pinocchio as pin
import pytest
from skeleton_cases import differences, pinocchio_model, state

from drakegait.walker import coordinates
from drakegait.walker.skeleton import Skeleton

# Foot points that hold each phase, as contact rows: heel xyz + yaw, toe z, toe xyz + yaw.
_HEEL, _TOE_DOWN, _TOE = (0, 1, 2, 6), (5,), (3, 4, 5, 6)
PHASES = {
    1: (_HEEL, _TOE),
    2: (_HEEL + _TOE_DOWN, _TOE),
    3: (_HEEL + _TOE_DOWN, ()),
    4: (_TOE, ()),
    5: (_TOE, _HEEL),
    6: (_TOE, _HEEL + _TOE_DOWN),
    7: ((), _HEEL + _TOE_DOWN),
    8: ((), _TOE),
}


@pytest.fixture(params=coordinates.SKELETONS, name="skeleton", scope="module")
def fixture_skeleton(request) -> Skeleton:
    return Skeleton.load(request.param)


def test_contact_points_and_jacobian_agree_with_pinocchio(skeleton):
    model, order = pinocchio_model(skeleton.kind)
    data = model.createData()
    q, _, _ = state(skeleton)
    pin.computeJointJacobians(model, data, q[np.argsort(order)])
    pin.updateFramePlacements(model, data)
    points = skeleton.contact_points(q)
    rows = skeleton.contact_jacobian(q)
    for i, name in enumerate(("heel_r", "toe_r", "heel_l", "toe_l")):
        frame = model.getFrameId(name)
        np.testing.assert_allclose(points[i], data.oMf[frame].translation, atol=1e-12)
        theirs = pin.getFrameJacobian(model, data, frame, pin.LOCAL_WORLD_ALIGNED)[:, order]
        first = 7 * (i // 2)
        here = rows[first + 3 * (i % 2) : first + 3 * (i % 2) + 3]
        np.testing.assert_allclose(here, theirs[:3], atol=1e-12)
        np.testing.assert_allclose(rows[first + 6], theirs[5], atol=1e-12)


def test_contact_jacobian_is_the_slope_of_the_contact_points(skeleton):
    q, _, _ = state(skeleton)
    slope = differences(skeleton.contact_points, q).reshape(12, -1)
    rows = skeleton.contact_jacobian(q)
    np.testing.assert_allclose(np.delete(rows, [6, 13], axis=0), slope, atol=1e-8)
    np.testing.assert_allclose(skeleton.foot_yaw_gradient(q), differences(skeleton.foot_yaw, q),
                               atol=1e-7)  # fmt: skip


def test_yaw_row_follows_the_turning_of_the_foot(skeleton):
    """e_z . w = psi' + d_z (w_x d_x + w_y d_y) / (1 - d_z^2), d the unit vector heel to toe."""
    q, v, _ = state(skeleton)
    h = 1e-6
    poses = [skeleton.body_poses(q + s * h * v) for s in (-1, 0, 1)]
    points = skeleton.contact_points(q)
    rates = skeleton.contact_jacobian(q)[[6, 13]] @ v
    for i, foot in enumerate(("foot_r", "foot_l")):
        turn = (poses[2][foot][0] - poses[0][foot][0]) / (2 * h) @ poses[1][foot][0].T
        w = np.array([turn[2, 1], turn[0, 2], turn[1, 0]])
        assert rates[i] == pytest.approx(w[2], abs=1e-6)
        d = points[2 * i + 1] - points[2 * i]
        d /= np.linalg.norm(d)
        lean = d[2] * (w[0] * d[0] + w[1] * d[1]) / (1 - d[2] ** 2)
        assert (skeleton.foot_yaw_gradient(q) @ v)[i] == pytest.approx(w[2] - lean, abs=1e-6)


def level_walking(skeleton: Skeleton) -> np.ndarray:
    """A posture with the right leg forward and both feet down, soles level."""
    angles = {
        "hip_flexion_r": 0.45, "knee_flexion_r": 0.10, "hip_flexion_l": -0.25,
        "knee_flexion_l": 0.35, "hat_list": 0.03, "hip_adduction_r": 0.05, "hip_adduction_l": -0.04,
        "hip_rotation_r": 0.06, "hip_rotation_l": -0.03, "hat_rotation": 0.05,
        "ankle_dorsiflexion_r": 0.1, "ankle_dorsiflexion_l": -0.15, "hat_tilt": 0.04,
    }  # fmt: skip
    q = np.zeros(skeleton.num_coordinates)
    for name, value in angles.items():
        if name in skeleton.coordinates:
            q[skeleton.coordinates.index(name)] = value
    return coordinates.to_plant(skeleton.kind, q)


def phase_rows(skeleton: Skeleton, phase: int) -> list[int]:
    right, left = PHASES[phase]
    rows = [*right, *(7 + row for row in left)]
    if skeleton.kind == "planar":
        rows = [row for row in rows if row % 7 not in (1, 4, 6)]
    return rows


def rank(matrix: np.ndarray) -> int:
    return int(np.linalg.matrix_rank(matrix, tol=1e-6))


@pytest.mark.parametrize("phase", PHASES)
def test_contact_rows_are_independent_in_each_phase(skeleton, phase):
    rows = skeleton.contact_jacobian(level_walking(skeleton))[phase_rows(skeleton, phase)]
    counts = {"spatial": (8, 9, 5, 4, 8, 9, 5, 4), "planar": (4, 5, 3, 2, 4, 5, 3, 2)}
    assert len(rows) == counts[skeleton.kind][phase - 1] == rank(rows)
    assert np.linalg.cond(rows) < 100


@pytest.mark.parametrize("phase", PHASES)
def test_rank_of_the_root_columns(skeleton, phase):
    root = 6 if skeleton.kind == "spatial" else 3
    q = level_walking(skeleton)
    rows = skeleton.contact_jacobian(q)[phase_rows(skeleton, phase)][:, :root]
    expected = {
        "spatial": (6, 6, 5, 4, 6, 6, 5, 4),
        "planar": (3, 3, 3, 2, 3, 3, 3, 2),
    }[skeleton.kind]
    points = skeleton.contact_points(q)
    assert abs(points[0, 2] - points[3, 2]) > 1e-3  # not level: no special line
    assert rank(rows) == expected[phase - 1]


@pytest.mark.parametrize("phase", [1, 5])
def test_two_points_on_level_ground_cannot_turn_about_the_line_through_them(phase):
    skeleton = Skeleton.load("spatial")
    q = level_walking(skeleton)
    pair = (0, 3) if phase == 1 else (1, 2)
    # Tilting the trunk and both legs with it brings the two points to one height.
    tilt = coordinates.position("spatial", "hat_tilt")
    for _ in range(20):
        heights = skeleton.contact_points(q)[:, 2]
        rows = skeleton.contact_jacobian(q)[[2, 5, 9, 12]]
        slope = rows[pair[0], tilt] - rows[pair[1], tilt]
        q[tilt] -= (heights[pair[0]] - heights[pair[1]]) / slope
    rows = skeleton.contact_jacobian(q)[phase_rows(skeleton, phase)]
    assert rank(rows) == 8
    assert rank(rows[:, :6]) == 5
