"""What is read off a gait, on the reference stride, whose answer is known."""

from __future__ import annotations

import numpy as np
import pytest
from gait_cases import reference_gait

from drakegait.fidelity import timing, walking
from drakegait.fidelity.contents import SECTIONS
from drakegait.fidelity.leg import Leg, largest, least, when
from drakegait.paper.numbers import Missing, Numbers
from drakegait.report.curves import GaitCurves


@pytest.fixture(scope="module")
def gait():
    return reference_gait("spatial")


@pytest.fixture(scope="module")
def found(gait) -> dict[str, float]:
    return walking.anchors_of(gait)


def test_every_anchor_has_its_numbers(found):
    assert set(found) == {key for anchor in walking.ANCHORS for key in anchor.keys}
    assert all(np.isfinite(value) for value in found.values())


def test_the_angles_are_those_of_the_curves(gait, found):
    data = gait.sample(401)
    for side in ("right", "left"):
        knee = data.coordinates.sel(coordinate=f"knee_flexion_{side[0]}").values
        assert found[f"knee flexion {side}"] == pytest.approx(knee.max())
        assert found[f"knee extension {side}"] == pytest.approx(knee.min())
    at = data.percent.values[data.coordinates.sel(coordinate="knee_flexion_r").values.argmax()]
    assert found["time of knee flexion right"] == pytest.approx(at)


def test_stance_of_one_leg_and_both_double_supports_fill_the_cycle(found):
    # Right stance is the left swing and both double supports.
    left_swing = 100.0 - found["stance left"]
    both = found["double support right"] + found["double support left"]
    assert found["stance right"] == pytest.approx(left_swing + both)


def test_signs_are_those_of_the_words(gait, found):
    moment = gait.sample(401).joint_moment.sel(joint="ankle_dorsiflexion_r").values
    assert found["ankle moment right"] == pytest.approx(-moment.min() / gait.study.subject.mass)
    assert found["ankle moment right"] > 0.0 and found["braking right"] < 0.0
    assert found["propulsion right"] > 0.0 and 0.5 < found["first peak right"] < 1.6


def test_windows_and_places():
    curve = (np.arange(0.0, 101.0), np.abs(np.arange(0.0, 101.0) - 40.0))
    take = lambda leg: curve  # noqa: E731
    assert least(take)(None) == 0.0 and when(take, -1)(None) == 40.0
    assert largest(take)(None) == 60.0 and largest(take, 0.0, 50.0)(None) == 40.0
    assert when(take, 1, 0.0, 50.0)(None) == 0.0


def test_a_planar_walker_has_no_adduction():
    leg = Leg(GaitCurves(reference_gait("planar")), "right")
    with pytest.raises(Missing, match="hip_adduction"):
        leg.angle("hip_adduction")


def test_times_can_be_read_back(gait):
    numbers = Numbers({}, timing.times_of(gait))
    data = gait.sample(401)
    for group in timing.MUSCLES:
        for side in ("right", "left"):
            times = timing.ours(numbers, group, side)
            assert all(0.0 <= on < off <= 100.0 for on, off in times)
            excitation = data.excitation.sel(muscle=f"{group}_{side[0]}").values
            assert bool(times) == (excitation.max() >= 0.05)


def test_every_line_knows_its_source_and_its_reason():
    from drakegait.fidelity.sources import SOURCES

    for section in SECTIONS:
        for line in section.lines:
            assert line.why and set(line.source.split(", ")) <= set(SOURCES)


def test_sections_do_not_mean_different_studies_by_a_name():
    known: dict[str, object] = {}
    for section in SECTIONS:
        for name, study in section.studies().items():
            assert known.setdefault(name, study) == study
        assert set(section.warm) | set(section.warm.values()) <= set(section.own_names)
