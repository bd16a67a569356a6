"""The unknowns of a walking problem: sizes, bounds and names of every variable."""

from __future__ import annotations

import numpy as np

from drakegait.program.control_points import ControlPoints, event_bounds
from drakegait.program.formulation import Formulation
from drakegait.transcription.design_vector import (
    Affine,
    Block,
    DesignVector,
    mirrored_coefficients,
)
from drakegait.walker import coordinates, feet

# Bounds of coordinates in anatomical sense [rad], wider than walking needs (Riener & Edrich 1999
# and common clinical ranges of motion); translations in fractions of body height. See
# docs/formulation.md 0.2.
RANGES = {
    "hat_list": (-0.6, 0.6),
    "hat_tilt": (-0.6, 0.8),
    "hat_rotation": (-0.8, 0.8),
    "hip_adduction": (-0.7, 0.7),
    "hip_flexion": (-0.8, 1.5),
    "hip_rotation": (-0.9, 0.9),
    "knee_flexion": (-0.15, 2.0),
    "ankle_dorsiflexion": (-0.9, 0.7),
}
_OF_HAT = {"hat_x": (-0.35, 0.35), "hat_y": (-0.1, 0.1), "hat_z": (0.35, 0.6)}

STRIDE_TIMES = (0.5, 3.0)  # [s]
PHASE_DURATIONS = (0.01, 0.40)  # [s], docs/formulation.md 6.1
STEP_LENGTHS = (0.3, 1.0)  # [m], docs/formulation.md 6.5, like the next two
TOE_ANGLES = (-0.35, 0.35)  # [rad]
STEP_WIDTHS = (0.02, 0.25)  # [m]

_ROTATION, _LENGTH, _TIME, _EVENT = 0.2, 0.1, 0.1, 0.05  # typical sizes [rad, m, s, -]
_FORCE_SHARE = 0.3  # of the largest muscle force
_HIGHEST_FORCE = 1.5  # of the largest muscle force: eccentric limit
_YAW_MOMENT = 10.0  # [N m]


def design_vector(formulation: Formulation, points: ControlPoints) -> DesignVector:
    """All unknowns of `formulation`."""
    return DesignVector(
        {
            "coordinates": _coordinates(formulation),
            "forces": _forces(formulation),
            "timing": _timing(formulation),
            "placement": _placement(formulation),
            "multipliers": _multipliers(formulation, points),
            "residuals": _residuals(formulation, points),
        }
    )


def coordinate_bounds(kind: str, height: float) -> np.ndarray:
    """Lowest and highest value of each coordinate, plant signs (num_coordinates, 2)."""
    bounds = []
    for item in coordinates.coordinates(kind):
        base = coordinates.without_side(item.name)
        if base in _OF_HAT:
            low, high = _OF_HAT[base]
            bounds.append((low * height, high * height))
        else:
            low, high = RANGES[base]
            bounds.append((low, high) if item.anatomical_sign > 0 else (-high, -low))
    return np.array(bounds)


def _coordinates(formulation: Formulation) -> Block:
    kind, num = formulation.walker.skeleton.kind, formulation.splines.num_intervals
    items = coordinates.coordinates(kind)
    shape = (len(items), num)
    affine = Affine.free(shape)
    if formulation.symmetric:
        affine = mirrored_coefficients(
            num,
            coordinates.mirror_positions(kind),
            coordinates.mirror_signs(kind),
            np.array([item.name.endswith("_l") for item in items]),
        )
    bounds = coordinate_bounds(kind, formulation.walker.subject.height)
    size = np.where(coordinates.rotations(kind), _ROTATION, _LENGTH)
    return Block(
        affine,
        np.broadcast_to(size[:, None], shape),
        np.broadcast_to(bounds[:, :1], shape),
        np.broadcast_to(bounds[:, 1:], shape),
        [f"{item.name} | coefficient {k}" for item in items for k in range(num)],
    )


def _forces(formulation: Formulation) -> Block:
    muscles, num = formulation.walker.muscles, formulation.splines.num_intervals
    shape = (len(muscles.names), num)
    affine = Affine.free(shape)
    if formulation.symmetric:
        half = len(muscles.names) // 2
        affine = mirrored_coefficients(
            num,
            np.roll(np.arange(2 * half), half),
            np.ones(2 * half),
            np.arange(2 * half) >= half,
        )
    strongest = np.broadcast_to(muscles.f_max[:, None], shape)
    least = formulation.walker.muscle_functions.settings.min_force
    return Block(
        affine,
        _FORCE_SHARE * strongest,
        least * strongest,
        _HIGHEST_FORCE * strongest,
        [f"{name} force | coefficient {k}" for name in muscles.names for k in range(num)],
    )


def _timing(formulation: Formulation) -> Block:
    low, high = event_bounds(formulation)
    num = formulation.schedule.num_phases
    index = np.arange(num + 2) - 1
    index[0], index[1], index[-1] = 0, -1, -1
    constant = np.zeros(num + 2)
    constant[-1] = num / feet.NUM_PHASES
    return Block(
        Affine(index, np.ones(num + 2), constant),
        np.concatenate([[_TIME], np.full(num + 1, _EVENT)]),
        np.concatenate([STRIDE_TIMES[:1], low]),
        np.concatenate([STRIDE_TIMES[1:], high]),
        ["stride time", *(f"event | {name}" for name in feet.EVENT_NAMES[:num]), "end"],
    )


def _placement(formulation: Formulation) -> Block:
    index = np.arange(5)
    factor = np.ones(5)
    if formulation.symmetric:
        index, factor[3] = np.array([0, 0, 1, 1, 2]), -1.0
    if formulation.planar:
        index = np.where(np.arange(5) < 2, index, -1)
    bounds = np.array([STEP_LENGTHS, STEP_LENGTHS, TOE_ANGLES, TOE_ANGLES, STEP_WIDTHS])
    return Block(
        Affine(index, factor, np.zeros(5)),
        np.array([_LENGTH, _LENGTH, _LENGTH, _LENGTH, _LENGTH]),
        bounds[:, 0],
        bounds[:, 1],
        ["step length right", "step length left", "toe angle right", "toe angle left",
         "step width"],
    )


def _multipliers(formulation: Formulation, points: ControlPoints) -> Block:
    shape = points.loaded.shape
    loaded = points.loaded if formulation.lifted else np.zeros(shape, dtype=bool)
    index = np.full(shape, -1)
    index[loaded] = np.arange(loaded.sum())
    num = shape[1]
    size = np.full(num, _FORCE_SHARE * formulation.body_weight)
    size[list(feet.YAW_ROWS)] = _YAW_MOMENT
    lower, upper = np.full(num, -np.inf), np.full(num, np.inf)
    lower[list(feet.VERTICAL_ROWS)] = 0.0  # the ground only pushes (item 3)
    size[feet.NUM_ROWS :] = _YAW_MOMENT
    upper[feet.NUM_ROWS :] = formulation.contact.toe_torque_limit
    lower[feet.NUM_ROWS :] = -formulation.contact.toe_torque_limit
    return Block(
        Affine(index, np.ones(shape), np.zeros(shape)),
        np.broadcast_to(size, shape),
        np.broadcast_to(lower, shape),
        np.broadcast_to(upper, shape),
        [
            f"contact force {name} | control point {k}"
            for k in range(points.num)
            for name in (*feet.ROW_NAMES, *feet.TORQUE_NAMES)[:num]
        ],
    )


def _residuals(formulation: Formulation, points: ControlPoints) -> Block:
    names = formulation.walker.coordinate_names
    shape = (points.num, len(names))
    affine = Affine.free(shape)
    if not formulation.lifted:
        affine = Affine(np.full(shape, -1), np.ones(shape), np.zeros(shape))
    size = np.broadcast_to(formulation.row_tolerances, shape)
    bounded = formulation.variants.eom_form == "components"
    bound = size if bounded else np.full(shape, np.inf)
    return Block(
        affine,
        size,
        -bound,
        bound,
        [f"residual {name} | control point {k}" for k in range(points.num) for name in names],
    )
