"""Starting points: what they share with the reference and in what they differ from it."""

from __future__ import annotations

import numpy as np
import pytest
from program_cases import dense_jacobian

from drakegait.errors import InvalidInput
from drakegait.program.gait_program import GaitProgram
from drakegait.program.guess import fit_forces, guess_from_reference, reference_values
from drakegait.program.starts import (
    NOISE,
    NOISE_LEVELS,
    REFERENCE,
    SILENT,
    STANDING,
    Start,
    starts,
)
from drakegait.study import GaitStudy
from drakegait.walker import feet

STUDIES = {
    "planar": GaitStudy.planar(14),
    "planar-symmetric": GaitStudy.planar_symmetric(15),
    "spatial": GaitStudy.spatial(12),
}


def program_of(study: GaitStudy, start: Start) -> GaitProgram:
    centres = start.event_centres(study.reference_walk, study.symmetric)
    return GaitProgram(study.formulation(centres))


def point(study: GaitStudy, start: Start) -> tuple[GaitProgram, np.ndarray]:
    program = program_of(study, start)
    return program, start.point(program)


def test_the_first_is_the_reference_and_the_rest_differ():
    found = starts(7, seed=3)
    assert [s.kind for s in found] == [REFERENCE, STANDING, SILENT] + 4 * [NOISE]
    assert len({s.name for s in found}) == 7
    levels = np.array([s.level for s in found[3:]])
    assert (levels >= NOISE_LEVELS[0]).all()
    assert (levels <= NOISE_LEVELS[1]).all()
    assert len(set(levels)) == 4


def test_equal_seeds_give_equal_starts_and_others_do_not():
    assert starts(9, 5) == starts(9, 5)
    assert starts(9, 5)[3:] != starts(9, 6)[3:]
    study = STUDIES["planar"]
    start = starts(4, 5)[3]
    np.testing.assert_array_equal(point(study, start)[1], point(study, start)[1])


@pytest.mark.parametrize(("count", "seed"), [(0, 0), (True, 0), (2.0, 0), (10**6, 0), (3, -1)])
def test_senseless_counts_and_seeds_are_refused(count, seed):
    with pytest.raises(InvalidInput):
        starts(count, seed)


def test_the_reference_is_the_usual_guess():
    study = STUDIES["planar"]
    assert Start().event_centres(study.reference_walk, False) is None
    program, x = point(study, Start())
    np.testing.assert_array_equal(x, guess_from_reference(program))


@pytest.mark.parametrize("study", STUDIES.values(), ids=STUDIES)
def test_contact_forces_of_the_reference_add_up_to_its_ground_reactions(study):
    program = GaitProgram(study.formulation())
    values = reference_values(program)

    def by_foot(rows: np.ndarray) -> np.ndarray:
        """(num_points, foot, heel or toe, axis) without the yaw."""
        rows = rows[:, : feet.NUM_ROWS].reshape(-1, 2, feet.ROWS_PER_FOOT)
        return rows[..., :6].reshape(-1, 2, 2, 3)

    forces = by_foot(values.multipliers).sum(axis=2)
    schedule = program.formulation.schedule
    centres = np.append(program.formulation.event_centres, 1.0)[: schedule.num_phases + 1]
    wanted = study.reference_walk.ground_reactions(schedule.instants(centres))
    loaded = by_foot(program.points.loaded).any(axis=2)
    np.testing.assert_allclose(forces, np.where(loaded, wanted, 0.0), atol=1e-9)
    assert np.abs(forces).max() > 500.0


@pytest.mark.parametrize("study", STUDIES.values(), ids=STUDIES)
def test_fitted_forces_are_the_best_compromise(study):
    """Equations of motion in tolerances, effort, distance from the reference's ground reactions: no
    other forces within their bounds have a smaller sum of squares."""
    program = GaitProgram(study.formulation())
    design = program.design
    start = np.clip(design.pack(reference_values(program)), design.lower, design.upper)
    muscles = slice(design.offsets["forces"], design.offsets["timing"])
    contacts = slice(design.offsets["multipliers"], design.offsets["residuals"])
    num_rows = program.row_numbers[0].max() + 1

    def slope(x: np.ndarray) -> np.ndarray:
        """Of half the sum of squares, as far as bounds leave it open."""
        x = x.copy()
        x[design.offsets["residuals"] :] = 0.0
        found = dense_jacobian(program, x)[:num_rows].T @ program.rows(x)[:num_rows]
        found[muscles] += 0.03 * x[muscles]
        found[contacts] += 0.3 * (x - start)[contacts]
        shut = ((found > 0.0) & (x < design.lower + 1e-4)) | (
            (found < 0.0) & (x > design.upper - 1e-4)
        )
        return np.concatenate([np.where(shut, 0.0, found)[part] for part in (muscles, contacts)])

    found = fit_forces(program, start)
    assert np.abs(slope(found)).max() < 1e-5 * np.abs(slope(start)).max()


@pytest.mark.parametrize("study", STUDIES.values(), ids=STUDIES)
def test_every_start_obeys_the_bounds_and_can_be_evaluated(study):
    for start in starts(5, seed=1):
        program, x = point(study, start)
        assert (x >= program.design.lower).all(), start.name
        assert (x <= program.design.upper).all(), start.name
        assert np.isfinite(program.rows(x)).all(), start.name
        assert np.isfinite(program.cost(x)), start.name


@pytest.mark.parametrize("study", STUDIES.values(), ids=STUDIES)
def test_who_stands_does_not_move_and_has_the_soles_on_the_ground(study):
    program, x = point(study, Start(STANDING))
    coefficients = program.values(x).coordinate_coefficients
    np.testing.assert_allclose(np.ptp(coefficients, axis=1), 0.0, atol=1e-12)
    points = study.walker.skeleton.contact_points(coefficients[:, 0])
    np.testing.assert_allclose(points[:, 2], 0.0, atol=1e-9)


def test_silent_muscles_pull_with_their_least_force_on_the_reference_s_motion():
    study = STUDIES["planar"]
    program, x = point(study, Start(SILENT))
    values, usual = program.values(x), program.values(guess_from_reference(program))
    least = study.muscles.min_force * study.walker.muscles.f_max
    np.testing.assert_allclose(values.force_coefficients, least[:, None] * np.ones((1, 13)))
    np.testing.assert_allclose(values.coordinate_coefficients, usual.coordinate_coefficients)
    assert np.abs(values.multipliers).max() == 0.0
    assert np.abs(usual.multipliers).max() > 100.0


@pytest.mark.parametrize("model", ["planar", "planar-symmetric"])
def test_noise_is_as_large_as_it_says(model):
    """Over many starts: nodal values off by `level` of their own deviation, durations too."""
    study, level = STUDIES[model], 0.2
    program = GaitProgram(study.formulation())
    splines = program.formulation.splines
    usual = program.values(guess_from_reference(program))
    nodal = splines.nodal_values(usual.coordinate_coefficients)
    spread = nodal.std(axis=1, keepdims=True)
    moving = slice(2, None)  # hat_x and hat_z move little and stay in narrow bounds
    off, durations = [], []
    for k in range(60):
        start = Start(NOISE, level, (11, k))
        values = program.design.unpack(
            program.design.pack(start._noisy(program, usual))  # before bounds cut it
        )
        found = splines.nodal_values(values.coordinate_coefficients)
        off.append(((found - nodal) / spread)[moving])
        events = start.event_centres(study.reference_walk, study.symmetric)
        durations.append(values.stride_time * np.diff(np.append(events, 1.0)))
    assert np.std(off) == pytest.approx(level, rel=0.05)
    assert np.mean(off) == pytest.approx(0.0, abs=0.02)
    relative = np.array(durations) / usual.phase_durations - 1.0
    # Short phases are cut off at their least duration.
    assert np.std(relative[:, 2]) == pytest.approx(level, rel=0.3)
    assert (np.array(durations) >= 0.0099).all()
    if study.symmetric:
        np.testing.assert_allclose(relative[:, :4], relative[:, 4:], atol=1e-12)
    else:
        assert np.abs(relative[:, :4] - relative[:, 4:]).max() > 0.1
