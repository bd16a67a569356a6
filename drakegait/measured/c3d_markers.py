"""Markers in C3D files, through ezc3d, as a table of joint angles."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import numpy as np

from drakegait.errors import BadFile, InvalidInput
from drakegait.measured.c3d_file import open_c3d
from drakegait.measured.column_map import ColumnMap, axes_matrix
from drakegait.measured.markers import BACK, MARKERS, NEEDED, marker_angles
from drakegait.measured.notes import Notes
from drakegait.measured.table import Table

_LEG = (0.3, 0.8)  # of the height, from heel to the front of the pelvis
_METRES = {"mm": 1e-3, "cm": 1e-2, "m": 1.0}


def read_c3d_motion(
    path: str | Path, columns: ColumnMap, *, height: float, notes: Notes
) -> Table:
    """The table of joint angles that the markers of a C3D file give.

    Args:
        columns: its `markers` name the file's markers, by those of Plug-in Gait; its `axes` the
            laboratory's, found from the body where they are not said.
        height: of the body [m].

    Raises:
        BadFile: ezc3d is missing, the file cannot be read, or lacks a marker.
        InvalidInput: two markers of the map are one.
    """
    file = open_c3d(path)
    try:
        points = np.asarray(file["data"]["points"], dtype=float)[:3]
        labels = [str(label).strip() for label in file["parameters"]["POINT"]["LABELS"]["value"]]
        rate = float(file["parameters"]["POINT"]["RATE"]["value"][0])
        first = int(file["header"]["points"]["first_frame"])
        units = file["parameters"]["POINT"].get("UNITS", {}).get("value", [])
    except (KeyError, IndexError, ValueError) as error:
        raise BadFile(path, f"cannot be read as C3D with markers ({error}).") from None
    places = _places(path, labels, points, columns.markers)
    unit = str(units[0]).strip().lower() if len(units) else ""
    # hips are about a metre above the feet
    size = float(np.nanmedian(np.linalg.norm(places["RASI"] - places["RHEE"], axis=-1)))
    scale = _METRES.get(unit, 1e-3 if size > 50.0 else 1.0)
    if not _LEG[0] * height <= scale * size <= _LEG[1] * height:
        raise BadFile(
            path, f"has the front of the pelvis {scale * size:.3g} m from the heel, in its unit "
            f"{unit or 'mm or m'!r}; a person of {height:g} m has {_LEG[0] * height:.2g} to "
            f"{_LEG[1] * height:.2g} m. Is the unit wrong?",
        )  # fmt: skip
    turn = _axes(places, notes, path) if columns.axes is None else axes_matrix(columns.axes)
    places = {name: scale * place @ turn.T for name, place in places.items()}
    angles, without = marker_angles(places, height)
    name = Path(path).name
    notes.say(f"{name}: joint angles were computed from {len(places)} markers, hip centres by "
              "the regression of Harrington et al. (2007).")  # fmt: skip
    if "medial" in without:
        notes.say(f"{name} has no medial markers at knees and ankles (RKNM, LKNM, RMED, LMED): "
                  "their centres were put half a usual width inward.")  # fmt: skip
    time = (first + np.arange(points.shape[2])) / rate
    return Table(path=str(path), columns={"time": time, **angles}, degrees=True)


def _places(
    path: str | Path, labels: list[str], points: np.ndarray, given: Mapping[str, str]
) -> dict[str, np.ndarray]:
    """Places (K, 3) of the markers that are there, by the names of Plug-in Gait."""
    short = {label.rpartition(":")[2].upper(): k for k, label in enumerate(labels)}
    exact = {label: k for k, label in enumerate(labels)}
    found: dict[str, int] = {}
    for name in MARKERS:
        wanted = given.get(name)
        if wanted is not None and wanted not in exact:
            raise BadFile(path, f"has no marker {wanted!r}, which the map gives for {name}; it has "
                          f"{_list(labels)}.")  # fmt: skip
        place = exact[wanted] if wanted is not None else short.get(name)
        if place is not None:
            found[name] = place
    twice = [name for name in found if list(found.values()).count(found[name]) > 1]
    if twice:
        raise InvalidInput("markers", f"{twice[0]} and {twice[1]} for one", "different markers")
    missing = [name for name in NEEDED if name not in found]
    if "SACR" not in found and not {"RPSI", "LPSI"} <= set(found):
        missing += [name for name in BACK[:2] if name not in found]
    if missing:
        raise BadFile(path, f"has no marker {', '.join(missing)}; name yours in a map, [markers], "
                      f"or give joint angles as the motion. It has {_list(labels)}.")  # fmt: skip
    places = {}
    for name, k in found.items():
        place = points[:, k].T.copy()
        place[~place.any(axis=1)] = np.nan  # some programs write zeros for what was not seen
        if np.isfinite(place).all(axis=1).sum() < 20:
            raise BadFile(path, f"shows marker {labels[k]!r} in fewer than 20 frames.")
        places[name] = place
    return places


def _list(labels: list[str]) -> str:
    return ", ".join(labels[:40]) + (" ..." if len(labels) > 40 else "") or "none"


def _axes(places: Mapping[str, np.ndarray], notes: Notes, path: str | Path) -> np.ndarray:
    """Rotation from the laboratory's axes to ours: up from heels to hips, forward as the feet."""

    def axis(vector: np.ndarray) -> str:
        k = int(np.argmax(np.abs(vector)))
        return ("-" if vector[k] < 0.0 else "") + "xyz"[k]

    def mean(one: str, other: str) -> np.ndarray:
        return np.nanmean(
            [places[side + one] - places[side + other] for side in "RL"], axis=(0, 1)
        )

    up = axis(mean("ASI", "HEE"))
    ahead = mean("TOE", "HEE")
    ahead["xyz".index(up[-1])] = 0.0
    forward = axis(ahead)
    notes.say(f"{Path(path).name}: {up} is up, and the feet point along {forward}.")
    return axes_matrix((forward, up))
