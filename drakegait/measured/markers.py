"""Joint angles from markers on the skin, in closed form, as Plug-in Gait does it.

Frames of the body, x forward, y to the left, z up when standing:

- pelvis: y from right to left ASIS, x from the middle of the PSIS (or the sacrum) to that of the
  ASIS;
- hip joint centres: regression of Harrington et al. (2007), J. Biomech. 40, 595-602, on pelvic
  width W and depth D, from the middle of the ASIS [mm]: -0.24 D - 9.9 forward, 0.33 W + 7.3 to the
  side, -0.30 W - 10.9 up;
- knee and ankle centres: between lateral and medial marker, or, without a medial one, half a width
  inward of the lateral one at right angles to the leg, along the pelvis;
- thigh: z from knee to hip, y along the knee's axis (lateral to medial marker; without medial ones
  the pelvis' y, and rotation of the hip counts as not measured);
- knee and ankle: hinges about that axis, for the direction of the shank and the line heel to toe;
- trunk: z from (T10, STRN) to (C7, CLAV), x from (C7, T10) to (CLAV, STRN).

Constant offsets of the pelvis' tilt and of the foot's pitch are taken out later, see `walk.py`.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from drakegait.walker.rotation_sequence import rotation_angles

SIDED = ("ASI", "KNE", "ANK", "HEE", "TOE")
NEEDED = tuple(f"{side}{name}" for side in "RL" for name in SIDED)
"""Markers without which nothing can be said, by their names in Plug-in Gait."""
BACK = ("RPSI", "LPSI", "SACR")
MEDIAL = ("RKNM", "LKNM", "RMED", "LMED")
TRUNK = ("C7", "T10", "CLAV", "STRN")
MARKERS = (*NEEDED, *BACK, *MEDIAL, *TRUNK)
"""All markers that are used."""
# Widths of knee and ankle with skin and marker [body heights]; estimates for adults.
_KNEE_WIDTH, _ANKLE_WIDTH = 0.06, 0.042


def marker_angles(
    places: Mapping[str, np.ndarray], height: float
) -> tuple[dict[str, np.ndarray], tuple[str, ...]]:
    """Columns of a motion table from markers.

    Args:
        places: (K, 3) of each marker [m], x forward, y left, z up; nan where it was not seen. All
            of `NEEDED` and, of `BACK`, either both PSIS or the sacrum.
        height: of the body [m].

    Returns:
        Columns by our names, anatomical signs, degrees and m; `hat_...` are those of the pelvis and
        of the middle of the hips. And which groups of markers were not there (`"medial"`,
        `"trunk"`).
    """
    front = 0.5 * (places["RASI"] + places["LASI"])
    has_both = "RPSI" in places and "LPSI" in places
    back = 0.5 * (places["RPSI"] + places["LPSI"]) if has_both else places["SACR"]
    pelvis = _frame(y=places["LASI"] - places["RASI"], x=front - back)
    width = np.nanmedian(np.linalg.norm(places["LASI"] - places["RASI"], axis=-1))
    depth = np.nanmedian(np.linalg.norm(front - back, axis=-1))
    hips = {
        side: front + pelvis @ _hip_centre(width, depth, out)
        for side, out in (("R", -1.0), ("L", 1.0))
    }
    found = _turns("hat", pelvis) | dict(
        zip(("hat_x", "hat_y", "hat_z"), (0.5 * (hips["R"] + hips["L"])).T, strict=True)
    )
    medial = all(name in places for name in MEDIAL)
    for side in "RL":
        found |= _leg(side, places, pelvis, hips[side], height, medial)
    trunk = all(name in places for name in TRUNK)
    if trunk:
        found |= _trunk(places, pelvis)
    return found, tuple(
        name for name, there in (("medial", medial), ("trunk", trunk)) if not there
    )


def _hip_centre(width: float, depth: float, out: float) -> np.ndarray:
    """From the middle of the ASIS, in the pelvis' axes; `out` is +1 on the left [m]."""
    return np.array([-0.24 * depth - 0.0099, out * (0.33 * width + 0.0073),
                     -0.30 * width - 0.0109])  # fmt: skip


def _leg(side, places, pelvis, hip, height: float, medial: bool) -> dict[str, np.ndarray]:
    left = pelvis[..., 1]
    inward = left if side == "R" else -left
    centres = []
    for name, inner, width, above in (
        ("KNE", "KNM", _KNEE_WIDTH, hip), ("ANK", "MED", _ANKLE_WIDTH, None),
    ):  # fmt: skip
        outer = places[side + name]
        if medial:
            centres.append(0.5 * (outer + places[side + inner]))
            continue
        along = _unit((centres[0] if above is None else above) - outer)
        across = _unit(inward - np.sum(inward * along, axis=-1, keepdims=True) * along)
        centres.append(outer + 0.5 * width * height * across)
    knee, ankle = centres
    axis = left
    if medial:
        axis = places[side + "KNM"] - places[side + "KNE"]
        axis = axis if side == "R" else -axis
    thigh = _frame(z=hip - knee, y=axis)
    turn = rotation_angles(np.swapaxes(pelvis, -1, -2) @ thigh)
    shank = _within(thigh, knee - ankle)
    flexion = np.arctan2(shank[:, 0], shank[:, 2])
    foot = _within(thigh, places[side + "TOE"] - places[side + "HEE"])
    # R_y(flexion + plantarflexion) takes x to (cos, 0, -sin)
    pitch = np.arctan2(-foot[:, 2], foot[:, 0])
    out, low = (1.0 if side == "R" else -1.0), side.lower()
    found = {
        f"hip_flexion_{low}": -turn[:, 0],
        f"hip_adduction_{low}": out * turn[:, 1],
        f"knee_flexion_{low}": flexion,
        f"ankle_dorsiflexion_{low}": -_wrapped(pitch - flexion),
    }
    if medial:
        found[f"hip_rotation_{low}"] = out * turn[:, 2]
    return {name: np.degrees(values) for name, values in found.items()}


def _trunk(places, pelvis) -> dict[str, np.ndarray]:
    up = places["C7"] + places["CLAV"] - places["T10"] - places["STRN"]
    ahead = places["CLAV"] + places["STRN"] - places["C7"] - places["T10"]
    y = np.cross(up, ahead)
    trunk = _frame(z=up, y=y)
    b, a, g = np.degrees(rotation_angles(np.swapaxes(pelvis, -1, -2) @ trunk)).T
    return {"lumbar_extension": -b, "lumbar_bending": a, "lumbar_rotation": g}


def _turns(name: str, rotation: np.ndarray) -> dict[str, np.ndarray]:
    b, a, g = np.degrees(rotation_angles(rotation)).T
    return {f"{name}_tilt": b, f"{name}_list": a, f"{name}_rotation": g}


def _frame(*, y: np.ndarray, x: np.ndarray | None = None, z: np.ndarray | None = None):
    """Rotations (K, 3, 3) with the axes as columns.

    With x: y is kept and x made perpendicular to it; with z: z is kept and y made perpendicular.
    """
    if z is not None:
        third = _unit(z)
        first = _unit(np.cross(y, third))
        return np.stack([first, np.cross(third, first), third], axis=-1)
    second = _unit(y)
    third = _unit(np.cross(x, second))
    return np.stack([np.cross(second, third), second, third], axis=-1)


def _within(frame: np.ndarray, vectors: np.ndarray) -> np.ndarray:
    """Vectors (K, 3) in the axes of frames (K, 3, 3)."""
    return np.einsum("kij,ki->kj", frame, vectors)


def _unit(vectors: np.ndarray) -> np.ndarray:
    return vectors / np.linalg.norm(vectors, axis=-1, keepdims=True)


def _wrapped(angle: np.ndarray) -> np.ndarray:
    return (angle + np.pi) % (2.0 * np.pi) - np.pi
