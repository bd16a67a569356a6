"""Rows in order, gaps closed, equal steps, noise removed: what any series needs first."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from scipy.interpolate import PchipInterpolator
from scipy.signal import butter, sosfiltfilt

from drakegait.errors import BadFile, InvalidInput
from drakegait.measured.notes import Notes

LONGEST_GAP = 0.1
_LONGEST_STEP = 0.1  # [s] between rows
"""Gap that is interpolated [s]; a walking knee turns by up to 40 degrees in it."""


@dataclass(frozen=True, eq=False, kw_only=True)
class Series:
    """Equidistant samples of several quantities.

    Attributes:
        time: (K,) [s].
        values: (K, num_columns), finite.
        usable: (K,) False where a gap was too long to be believed.
    """

    time: np.ndarray
    values: np.ndarray
    usable: np.ndarray

    @property
    def rate(self) -> float:
        """Samples per second."""
        return (self.time.size - 1) / float(self.time[-1] - self.time[0])

    def at(self, time: np.ndarray) -> np.ndarray:
        """Values (..., num_columns) at other times by linear interpolation [s]."""
        flat = [np.interp(time, self.time, column) for column in self.values.T]
        return np.stack(flat, axis=-1)

    def covers(self, start: float, end: float) -> bool:
        """Whether all of [start, end] was measured."""
        if start < self.time[0] - 1e-6 or end > self.time[-1] + 1e-6:
            return False
        inside = (self.time >= start) & (self.time <= end)
        return bool(self.usable[inside].all())


def in_order(path: str, time: np.ndarray, values: np.ndarray, notes: Notes):
    """Time and values with rows sorted by time.

    Raises:
        BadFile: two rows of one instant, or steps with which nobody measures walking.
    """
    if (np.diff(time) < 0.0).any():
        order = np.argsort(time, kind="stable")
        time, values = time[order], values[order]
        notes.say(f"The rows of {Path(path).name} were not in the order of time; sorted.")
    same = np.flatnonzero(np.diff(time) <= 0.0)
    if same.size:
        raise BadFile(
            path,
            f"has {same.size} rows twice or with different values for one instant, the first at "
            f"{time[same[0]]:g} s; remove them.",
        )
    step = float(np.median(np.diff(time))) if len(time) > 1 else 0.0
    if step > _LONGEST_STEP:
        raise BadFile(path, f"has a row every {step:.4g} s; is its time in ms?")
    return time, values


def without_gaps(
    path: str, names: Sequence[str], time: np.ndarray, values: np.ndarray, notes: Notes
) -> tuple[np.ndarray, np.ndarray]:
    """Values with short gaps interpolated (shape-preserving cubic), and which rows are usable.

    Rows in long gaps are bridged, so that they can be filtered, and marked as not usable.

    Raises:
        BadFile: a column without a number.
    """
    values = np.array(values, dtype=float)
    values[~np.isfinite(values)] = np.nan
    usable = np.ones(time.size, dtype=bool)
    closed, longest = [], []
    for k, name in enumerate(names):
        missing = np.isnan(values[:, k])
        if not missing.any():
            continue
        if (~missing).sum() < 2:
            raise BadFile(path, f"has no numbers in column {name!r}.")
        known = time[~missing]
        bridge = PchipInterpolator(known, values[~missing, k], extrapolate=False)(time)
        bridge[time < known[0]] = values[~missing, k][0]
        bridge[time > known[-1]] = values[~missing, k][-1]
        values[:, k] = bridge
        for start, end in runs(missing):
            before = time[start - 1] if start else -np.inf
            after = time[end] if end < time.size else np.inf
            if after - before > LONGEST_GAP:
                usable[start:end] = False
                longest.append((name, max(before, time[0]), min(after, time[-1])))
            else:
                closed.append(name)
    if closed:
        columns = ", ".join(dict.fromkeys(closed))
        notes.say(
            f"{Path(path).name}: {len(closed)} gaps of at most {LONGEST_GAP:g} s were "
            f"interpolated ({columns})."
        )
    if longest:
        name, start, end = max(longest, key=lambda gap: gap[2] - gap[1])
        notes.say(
            f"{Path(path).name}: gaps longer than {LONGEST_GAP:g} s cannot be interpolated, the "
            f"longest in {name} from {start:.3f} to {end:.3f} s; strides that touch one are not "
            "used."
        )
    return values, usable


def equidistant(
    time: np.ndarray, values: np.ndarray, usable: np.ndarray, most: float | None = None
) -> Series:
    """The series at equal steps, at its own rate (median step), or at `most` per second."""
    step = float(np.median(np.diff(time)))
    if most is not None:
        step = max(step, 1.0 / most)
    # A pause of the recording is a gap like any other.
    wide = np.flatnonzero(np.diff(time) > LONGEST_GAP)
    grid = np.linspace(time[0], time[-1], max(2, round((time[-1] - time[0]) / step) + 1))
    believed = np.interp(grid, time, usable.astype(float)) > 0.999
    for k in wide:
        believed &= ~((grid > time[k]) & (grid < time[k + 1]))
    even = np.stack([np.interp(grid, time, column) for column in values.T], axis=-1)
    return Series(time=grid, values=even, usable=believed)


def low_pass(series: Series, cutoff: float, name: str) -> Series:
    """Fourth-order zero-phase Butterworth filter (second order, forwards and backwards).

    The design frequency is raised so that the two passes together damp by 3 dB at `cutoff`
    (Winter, Biomechanics and Motor Control, 2009, 3.4.4.2).

    Args:
        cutoff: [Hz].
        name: of the option, for the message.

    Raises:
        InvalidInput: a cut-off beyond half the sampling rate.
    """
    design = cutoff / 0.802
    if not 0.0 < design < 0.5 * series.rate:
        allowed = f"above 0 and below {0.4 * series.rate:.3g} [Hz] at {series.rate:.4g} samples/s"
        raise InvalidInput(name, cutoff, allowed)
    sections = butter(2, design, fs=series.rate, output="sos")
    pad = min(series.time.size - 1, int(series.rate / cutoff) + 6)
    filtered = sosfiltfilt(sections, series.values, axis=0, padtype="odd", padlen=pad)
    return Series(time=series.time, values=filtered, usable=series.usable)


def runs(mask: np.ndarray) -> list[tuple[int, int]]:
    """Stretches [start, end) where the mask is True."""
    edges = np.flatnonzero(np.diff(np.concatenate([[0], mask.astype(np.int8), [0]])))
    return [(int(a), int(b)) for a, b in zip(edges[::2], edges[1::2], strict=True)]
