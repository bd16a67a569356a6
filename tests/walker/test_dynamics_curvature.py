"""Second derivatives of the skeleton against differences of its first derivatives."""

from __future__ import annotations

import functools

import numpy as np
import pytest

from drakegait.walker import coordinates, feet
from drakegait.walker.dynamics_curvature import DynamicsCurvature, MotionCurvature, Weights
from drakegait.walker.skeleton import Skeleton
from drakegait.walker.subject import AddedMass, Subject

COUNT = 3  # instants
MASSES = (AddedMass("foot_r", 2.0, (0.1, 0.03, -0.05)), AddedMass("hat", 5.0))
STEP = 1e-5


@functools.cache
def skeleton(kind: str, loaded: bool) -> Skeleton:
    subject = Subject(height=1.7, mass=68.0) if loaded else Subject()
    return Skeleton.load(kind, subject, MASSES if loaded else ())


@functools.cache
def curvature(kind: str, loaded: bool) -> DynamicsCurvature:
    return DynamicsCurvature(skeleton(kind, loaded))


def instants(kind: str) -> tuple[dict[str, np.ndarray], Weights]:
    """Random q, v, a, multipliers l and residuals e, and weights."""
    random, n = np.random.default_rng(4), len(coordinates.names(kind))
    sizes = {"q": 0.5, "v": 2.0, "a": 9.0, "e": 2.0}
    inputs = {name: random.normal(scale=size, size=(COUNT, n)) for name, size in sizes.items()}
    inputs["l"] = random.normal(scale=300.0, size=(COUNT, feet.NUM_ROWS))
    motion = random.normal(size=(COUNT, n))
    velocities, positions = random.normal(size=(2, COUNT, feet.NUM_ROWS))
    if kind == "planar":  # no lateral forces, no yaw
        inputs["l"] *= active(kind)
        velocities, positions = velocities * active(kind), positions * active(kind)
    return inputs, Weights(motion, velocities, positions)


def active(kind: str) -> np.ndarray:
    planar = kind == "planar"
    return np.any([feet.active_rows(phase, planar) for phase in range(8)], axis=0)


def first_derivatives(walker: Skeleton, inputs: dict, weights: Weights) -> dict[str, np.ndarray]:
    """Of the weighted sum, by q and v; from the skeleton's own first derivatives."""
    q, v, a, multipliers = (inputs[name] for name in "qval")
    _, by_q, by_v, _ = walker.residual_derivatives(q, v, a, multipliers)
    positions = walker.contact_jacobian(q).copy()
    if walker.kind == "spatial":  # headings as positions, not the angular velocity
        positions[:, list(feet.YAW_ROWS)] = walker.foot_yaw_gradient(q)
    slope = np.einsum("pi,pij->pj", weights.motion, by_q)
    turning = walker.contact_velocity_derivative(q, inputs["e"])
    slope += np.einsum("pr,prj->pj", weights.velocities, turning)
    slope += np.einsum("pr,prj->pj", weights.positions, positions)
    return {"q": slope, "v": np.einsum("pi,pij->pj", weights.motion, by_v)}


def by_differences(walker: Skeleton, inputs: dict, weights: Weights, of: str, by: str):
    """Derivatives of `first_derivatives` (COUNT, of, by)."""
    columns = []
    for way in STEP * np.eye(inputs[by].shape[1]):
        more, less = (
            first_derivatives(walker, inputs | {by: inputs[by] + sign * way}, weights)[of]
            for sign in (1.0, -1.0)
        )
        columns.append((more - less) / (2.0 * STEP))
    return np.stack(columns, axis=-1)


def evaluate(kind: str, loaded: bool, inputs: dict, weights: Weights) -> MotionCurvature:
    ordered = (inputs[name] for name in "qvale")
    return curvature(kind, loaded).evaluate(*ordered, weights)


@pytest.mark.parametrize("loaded", [False, True])
@pytest.mark.parametrize("kind", coordinates.SKELETONS)
@pytest.mark.parametrize(
    ("block", "of", "by"),
    [("qq", "q", "q"), ("qv", "q", "v"), ("vv", "v", "v"), ("qa", "q", "a"), ("ql", "q", "l"),
     ("qe", "q", "e")],
)  # fmt: skip
def test_every_block_against_first_derivatives(kind, loaded, block, of, by):
    inputs, weights = instants(kind)
    found = getattr(evaluate(kind, loaded, inputs, weights), block)
    expected = by_differences(skeleton(kind, loaded), inputs, weights, of, by)
    assert np.abs(found).max() > 0.01
    if by == "l" and kind == "planar":
        found, expected = found[..., active(kind)], expected[..., active(kind)]
    np.testing.assert_allclose(found, expected, atol=1e-7 * (1.0 + np.abs(expected).max()))


@pytest.mark.parametrize("kind", coordinates.SKELETONS)
def test_second_derivatives_are_symmetric(kind):
    inputs, weights = instants(kind)
    blocks = evaluate(kind, False, inputs, weights)
    for block in (blocks.qq, blocks.vv):
        np.testing.assert_allclose(block, np.swapaxes(block, 1, 2), atol=1e-9)


def test_added_mass_is_felt():
    inputs, weights = instants("planar")
    plain, loaded = (evaluate("planar", heavy, inputs, weights).qq for heavy in (False, True))
    assert np.abs(plain - loaded).max() > 1.0


def test_where_the_walker_stands_does_not_matter():
    inputs, weights = instants("spatial")
    moved = inputs | {"q": inputs["q"].copy()}
    moved["q"][:, :3] += [3.0, -2.0, 0.5]
    here, there = (evaluate("spatial", False, at, weights).qq for at in (inputs, moved))
    np.testing.assert_allclose(here, there, rtol=1e-9, atol=1e-8)
    np.testing.assert_array_equal(here[:, :3], 0.0)
