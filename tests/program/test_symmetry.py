"""A symmetric walker is a walker: mirrored by construction, judged alike by the full program."""

from __future__ import annotations

import dataclasses
import functools

import numpy as np
import pytest
from program_cases import FORMS, dense_jacobian, jiggled, program

from drakegait.program.gait_program import GaitProgram
from drakegait.study import GaitStudy
from drakegait.walker import coordinates, feet

SKELETONS = ("spatial", "planar")
_SIDES = {"right": "left", "left": "right"}


def mirrored(values):
    """The walk seen in a mirror, half a cycle later: the same walk if it is symmetric."""
    kind = "spatial" if len(values.coordinate_coefficients) == 16 else "planar"
    half = values.coordinate_coefficients.shape[1] // 2
    motion = np.roll(coordinates.mirror(kind, values.coordinate_coefficients.T).T, -half, axis=1)
    # Both walks start at the origin with the right foot: the image is counted from the left print.
    motion[0] += 0.5 * (values.placement[0] - values.placement[1])
    legs = np.roll(values.force_coefficients, len(values.force_coefficients) // 2, axis=0)
    return dataclasses.replace(
        values,
        coordinate_coefficients=motion,
        force_coefficients=np.roll(legs, -half, axis=1),
        events=np.roll(values.events, -4) + np.array([-0.5] * 4 + [0.5] * 4),
        placement=values.placement[[1, 0, 3, 2, 4]] * [1.0, 1.0, -1.0, -1.0, 1.0],
        multipliers=_other_half(mirrored_multipliers(values.multipliers)),
        residuals=_other_half(coordinates.mirror(kind, values.residuals)),
    )


def _other_half(by_point: np.ndarray) -> np.ndarray:
    """The control points of the second half of the stride first."""
    return np.roll(by_point, len(by_point) // 2, axis=0)


def mirrored_multipliers(multipliers: np.ndarray) -> np.ndarray:
    signs = np.array([-1.0 if row in feet.SIDE_ROWS else 1.0 for row in range(feet.NUM_ROWS)])
    return signs * np.roll(multipliers, feet.ROWS_PER_FOOT, axis=1)


def swapped(text: str) -> str:
    """A name on the other side of the body."""
    words = [_SIDES.get(word, word) for word in text.split(" ")]
    return " ".join(
        word[:-1] + {"r": "l", "l": "r"}[word[-1]] if word[-2:] in ("_r", "_l") else word
        for word in words
    )


def both_halves(values):
    """Multipliers and residuals of the mirrored half of the stride added to those of the first."""
    kind = "spatial" if values.residuals.shape[1] == 16 else "planar"
    image = mirrored_multipliers(values.multipliers)
    return dataclasses.replace(
        values,
        multipliers=np.concatenate([values.multipliers, image]),
        residuals=np.concatenate(
            [values.residuals, coordinates.mirror(kind, values.residuals)]
        ),
    )


@functools.cache
def full_program(kind: str, form: str) -> GaitProgram:
    """The full stride on the same nodes and control points as the symmetric program."""
    half = program(f"{kind}-symmetric", form).formulation
    study = GaitStudy(
        model=kind,
        nodes=half.splines.num_nodes,
        interior_points=2 * half.schedule.interior_points,
        multipliers=form,
    )
    return GaitProgram(study.formulation(np.array(half.event_centres)))


@pytest.mark.parametrize("kind", SKELETONS)
def test_the_full_walk_is_its_own_mirror_image(kind):
    model = f"{kind}-symmetric"
    values = program(model).values(jiggled(model))
    image = mirrored(values)
    for name in ("coordinate_coefficients", "force_coefficients", "events", "placement"):
        np.testing.assert_allclose(getattr(image, name), getattr(values, name), atol=1e-12)
    # Curves as a user sees them: the left knee does what the right knee did half a stride before.
    splines, tau = program(model).formulation.splines, np.linspace(0.0, 1.0, 37)
    items = coordinates.coordinates(kind)
    names = coordinates.names(kind)
    for item, row in zip(items, values.coordinate_coefficients, strict=True):
        other = values.coordinate_coefficients[names.index(item.mirror_of)]
        np.testing.assert_allclose(
            splines.evaluate(row, tau),
            item.mirror_sign * splines.evaluate(other, tau + 0.5),
            atol=1e-12,
        )


@pytest.mark.parametrize("kind", SKELETONS)
@pytest.mark.parametrize("form", FORMS)
def test_a_walk_and_its_mirror_image_obey_the_same_laws(kind, form):
    """Also a walk that limps: right and left are nowhere mistaken for each other."""
    full = full_program(kind, form)
    random = np.random.default_rng(8)
    x = full.design.pack(both_halves(program(f"{kind}-symmetric", form).values(
        jiggled(f"{kind}-symmetric", form))))  # fmt: skip
    x = np.clip(x + random.uniform(-0.1, 0.1, x.size), full.design.lower, full.design.upper)
    # The clock of the image starts at left heel strike, here half-way.
    events = full.values(x).events
    x = full.design.pack(dataclasses.replace(
        full.values(x), events=np.where(np.arange(8) == 4, 0.5, events)))  # fmt: skip
    image = mirrored(full.values(x))
    y = full.design.pack(image)
    assert np.abs(y - x).max() > 0.05
    np.testing.assert_allclose(full.design.pack(mirrored(image)), x, atol=1e-10)
    energy = "metabolic cost of transport"
    assert full.cost_parts(y)[energy] == pytest.approx(full.cost_parts(x)[energy], rel=1e-9)
    rows = dict(zip(full.row_names, full.rows(y), strict=True))
    for name, value in zip(full.row_names, full.rows(x), strict=True):
        image_row = rows[" | ".join(swapped(part) for part in name.split(" | "))]
        # Mirrored rows keep their size; those across the sagittal plane change their sign.
        assert abs(image_row) == pytest.approx(abs(value), abs=1e-6, rel=1e-7), name


@pytest.mark.parametrize("kind", SKELETONS)
@pytest.mark.parametrize("form", FORMS)
def test_the_full_program_judges_it_alike(kind, form):
    model = f"{kind}-symmetric"
    half, full = program(model, form), full_program(kind, form)
    x = jiggled(model, form)
    y = full.design.pack(both_halves(half.values(x)))
    for name, value in half.cost_parts(x).items():
        assert full.cost_parts(y)[name] == pytest.approx(value, rel=1e-9), name

    in_full = dict(zip(full.row_names, full.rows(y), strict=True))
    seen = set()
    for name, value in zip(half.row_names, half.rows(x), strict=True):
        law, place, what = name.split(" | ")
        if law == "joint limit":
            continue
        image = f"{law} | {swapped(place)} | {swapped(what)}"
        assert in_full[name] == pytest.approx(value, abs=1e-6), name
        if law != "average speed":
            assert abs(in_full[image]) == pytest.approx(abs(value), abs=1e-6), (name, image)
        seen |= {name, image}
    assert set(in_full) <= seen


@pytest.mark.parametrize("kind", SKELETONS)
def test_derivatives_are_the_full_ones_folded(kind):
    """d(half)/dx = d(full)/dy dy/dx, with dy/dx read off the packing."""
    model = f"{kind}-symmetric"
    half, full = program(model), full_program(kind, "lifted")
    x = jiggled(model)

    def unfold(at):
        return full.design.pack(both_halves(half.values(at)))

    way = np.random.default_rng(4).normal(size=x.size)
    along = unfold(x + way) - unfold(x)  # packing is affine
    y = unfold(x)
    assert half.gradient(x) @ way == pytest.approx(full.gradient(y) @ along, rel=1e-9)
    in_full = dict(zip(full.row_names, dense_jacobian(full, y) @ along, strict=True))
    for name, value in zip(half.row_names, dense_jacobian(half, x) @ way, strict=True):
        if not name.startswith("joint limit"):
            assert in_full[name] == pytest.approx(value, abs=1e-5, rel=1e-7), name


@pytest.mark.parametrize("kind", SKELETONS)
def test_what_is_not_symmetric_is_averaged(kind):
    """Packing a walk that no symmetric walker can do gives the mean of it and its image."""
    half = program(f"{kind}-symmetric")
    values = half.values(jiggled(f"{kind}-symmetric"))
    random = np.random.default_rng(9)
    shape = values.coordinate_coefficients.shape
    odd = dataclasses.replace(
        values,
        coordinate_coefficients=values.coordinate_coefficients + random.normal(size=shape),
    )
    packed = half.values(half.design.pack(odd))
    image = mirrored(odd)
    mean = 0.5 * (odd.coordinate_coefficients + image.coordinate_coefficients)
    np.testing.assert_allclose(packed.coordinate_coefficients, mean, atol=1e-12)
    limping = dataclasses.replace(values, placement=values.placement + [0.1, 0, 0, 0, 0])
    packed = half.values(half.design.pack(limping))
    np.testing.assert_allclose(packed.placement[:2], limping.placement[:2].mean(), atol=1e-12)
