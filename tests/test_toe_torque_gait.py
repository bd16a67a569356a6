"""A gait with torques at the toe: solved, checked, saved and read again."""

from __future__ import annotations

import numpy as np
import pytest

from drakegait.gait import Gait
from drakegait.solve import solve
from drakegait.study import GaitStudy


@pytest.mark.solve
def test_a_walk_with_toe_torques(tmp_path):
    study = GaitStudy.planar_symmetric(nodes=19).with_settings(toe_torque=True)
    gait = solve(study, refine=False)
    assert gait.converged
    assert gait.report.passed
    assert gait.values.multipliers.shape[1] == 18
    assert 1.0 < gait.report.item("toe_torque_max_Nm").value <= 24.0
    gait.save(tmp_path / "gait.nc")
    again = Gait.load(tmp_path / "gait.nc")
    np.testing.assert_array_equal(again.values.multipliers, gait.values.multipliers)
    sampled = again.sample()
    centre = sampled.centre_of_pressure.sel(foot="right", axis="x")
    toes = sampled.contact_points.sel(contact_point="toe_r", axis="x")
    assert np.isfinite(centre).any()
    # The torque moves the centre of pressure off the toe while the foot stands on it.
    alone = sampled.phase.values == 4
    assert np.abs((centre - toes).values[alone]).max() > 1e-3
    # Without torques, as a guess for a study that has none, forces are fitted anew.
    plain = solve(GaitStudy.planar_symmetric(nodes=19), guess=gait, refine=False)
    assert plain.converged
    assert plain.values.multipliers.shape[1] == 14
