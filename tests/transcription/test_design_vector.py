"""The unknowns: packing and unpacking, mirrored coefficients, sizes and bounds."""

from __future__ import annotations

import numpy as np
import pytest

from drakegait.program.gait_program import GaitProgram
from drakegait.study import GaitStudy
from drakegait.transcription.design_vector import Affine, DesignVector, mirrored_coefficients
from drakegait.transcription.splines import PeriodicQuintic

MODELS = ("spatial", "planar", "spatial-symmetric", "planar-symmetric")


@pytest.fixture(scope="module", params=[(m, f) for m in MODELS for f in ("lifted", "projected")],
                ids="-".join)  # fmt: skip
def program(request):
    model, form = request.param
    points = (1, 0, 1, 0) if model.endswith("symmetric") else (1, 0, 1, 0, 0, 1, 0, 0)
    study = GaitStudy(model=model, nodes=11, interior_points=points, multipliers=form)
    return GaitProgram(study.formulation())


@pytest.fixture
def x(program):
    return np.random.default_rng(3).normal(size=program.num_variables)


def test_packing_undoes_unpacking(program, x):
    np.testing.assert_allclose(program.design.pack(program.design.unpack(x)), x, atol=1e-12)


def test_every_unknown_has_a_name_of_its_own(program):
    names = program.design.names
    assert len(names) == len(set(names)) == program.num_variables


def test_every_unknown_moves_what_its_name_says(program, x):
    """One unit of the solver is `scale` in physical units, in the place that the name tells."""
    design, walker = program.design, program.formulation.walker
    before = design.unpack(x)
    for i in np.random.default_rng(1).choice(x.size, 40, replace=False):
        moved = x.copy()
        moved[i] += 1.0
        after, (head, *tail) = design.unpack(moved), design.names[i].split(" | ")
        if head in walker.coordinate_names:
            row, column = walker.coordinate_names.index(head), int(tail[0].split()[-1])
            change = after.coordinate_coefficients - before.coordinate_coefficients
            got = change[row, column]
        elif head.removesuffix(" force") in walker.muscles.names:
            row = walker.muscles.names.index(head.removesuffix(" force"))
            change = after.force_coefficients - before.force_coefficients
            got = change[row, int(tail[0].split()[-1])]
        elif head == "stride time":
            change = got = after.stride_time - before.stride_time
        else:
            parts = [np.atleast_1d(a - b) for a, b in (
                (after.events, before.events), (after.placement, before.placement),
                (after.multipliers, before.multipliers), (after.residuals, before.residuals),
            )]  # fmt: skip
            change = np.concatenate([part.ravel() for part in parts])
            got = np.abs(change).max()
        assert got == pytest.approx(design.scale[i]), design.names[i]
        twins = 2 if program.formulation.symmetric else 1
        assert 1 <= np.count_nonzero(np.abs(change) > 1e-12) <= twins, design.names[i]


def test_bounds_leave_room(program):
    design = program.design
    assert (design.lower < design.upper).all()
    assert (design.scale > 0.0).all()
    forces = [i for i, name in enumerate(design.names) if " force | coefficient" in name]
    # Every coefficient above the least force keeps the whole curve above it (convex hull).
    lowest = design.unpack(np.where(np.isfinite(design.lower), design.lower, 0.0))
    f_max = program.formulation.walker.muscles.f_max
    np.testing.assert_allclose(
        lowest.force_coefficients, 0.0005 * np.repeat(f_max[:, None], 10, axis=1)
    )
    assert len(forces) == len(f_max) * 10 // (2 if program.formulation.symmetric else 1)


def test_events_cannot_swap(program):
    """Bounds of neighbouring events, which fix the windows, hold the order of the phases."""
    design = program.design
    low = design.unpack(np.where(np.isfinite(design.lower), design.lower, 0.0)).events
    high = design.unpack(np.where(np.isfinite(design.upper), design.upper, 0.0)).events
    centre = np.array(program.formulation.event_centres)
    count = program.formulation.schedule.num_phases
    np.testing.assert_allclose(0.5 * (low + high)[:count], centre[:count], atol=1e-12)
    assert low[0] == high[0] == 0.0


def test_lifted_forms_have_contact_forces_as_unknowns_projected_ones_have_not(program):
    words = ("contact force", "residual")
    found = [name for name in program.design.names if name.startswith(words)]
    if not program.formulation.lifted:
        assert found == []
        return
    lower = dict(zip(program.design.names, program.design.lower, strict=True))
    residuals = [name for name in found if name.startswith("residual")]
    coordinates = len(program.formulation.walker.coordinate_names)
    assert len(residuals) == coordinates * program.formulation.schedule.num_points
    assert {lower[name] for name in residuals} == {-1.0}  # one tolerance


def test_selection_reads_what_unpack_gives(program, x):
    values = program.design.unpack(x)
    for name, expected in (
        ("coordinates", values.coordinate_coefficients),
        ("forces", values.force_coefficients),
        ("placement", values.placement),
        ("multipliers", values.multipliers),
        ("residuals", values.residuals),
    ):
        np.testing.assert_allclose(program.design.selection(name).values(x), expected, atol=1e-12)
    assert tuple(program.design.offsets) == DesignVector.ORDER


def test_phase_durations_make_up_the_stride(program, x):
    values = program.design.unpack(x)
    assert values.phase_durations.sum() == pytest.approx(values.stride_time)


@pytest.mark.parametrize("intervals", [8, 10, 18])
def test_mirrored_coefficients_make_mirrored_functions(intervals):
    """Two pairs and two functions that are their own image, with either sign."""
    partners, signs = np.array([3, 1, 2, 0, 5, 4]), np.array([1.0, 1.0, -1.0, 1.0, -1.0, -1.0])
    is_left = np.array([False, False, False, True, False, True])
    affine = mirrored_coefficients(intervals, partners, signs, is_left)
    assert affine.num_free == 2 * intervals + 2 * (intervals // 2)
    free = np.random.default_rng(6).normal(size=affine.num_free)
    coefficients = affine.values(free)
    splines, tau = PeriodicQuintic(intervals + 1), np.linspace(0.0, 1.0, 41)
    for i, partner in enumerate(partners):
        np.testing.assert_allclose(
            splines.evaluate(coefficients[i], tau),
            signs[i] * splines.evaluate(coefficients[partner], tau + 0.5),
            atol=1e-12,
        )
    np.testing.assert_allclose(affine.reduce(coefficients), free, atol=1e-12)


def test_reducing_is_least_squares():
    affine = Affine(
        np.array([0, 0, 1, 2, -1, 1]), np.array([1.0, -1.0, 2.0, 1.0, 1.0, 0.5]),
        np.array([0.0, 0.3, 0.0, 1.0, 7.0, 0.0]),
    )  # fmt: skip
    full = np.random.default_rng(0).normal(size=6)
    matrix = np.stack([affine.values(e) - affine.constant for e in np.eye(3)], axis=1)
    expected = np.linalg.lstsq(matrix, full - affine.constant, rcond=None)[0]
    np.testing.assert_allclose(affine.reduce(full), expected, atol=1e-12)
    assert affine.values(expected)[4] == 7.0  # a constant stays
