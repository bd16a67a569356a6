"""Measured walking that a simulated gait is compared with."""

from __future__ import annotations

import dataclasses
import functools
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from drakegait.reference.curves import PeriodicCurves, SampledCurves, SplineCurves
from drakegait.reference.deviation import SIGMA_INSTANTS, DeviationSettings, sigma, weight
from drakegait.reference.embedded import embedded_stride
from drakegait.reference.export import table_columns, write_csv
from drakegait.reference.netcdf_file import is_netcdf, read_reference, write_subject
from drakegait.reference.periodicity import fit_periodic
from drakegait.reference.tables import FORCE_COLUMNS, StrideTable, read_stride
from drakegait.transcription.foot_placement import FootPlacement
from drakegait.transcription.splines import PeriodicQuintic
from drakegait.walker.coordinates import names, rotations
from drakegait.walker.subject import Subject


@dataclasses.dataclass(frozen=True, eq=False, kw_only=True)
class Reference:
    """One stride of measured walking, from right heel strike to right heel strike.

    Time is tau = t / stride_time; all functions have period 1. Coordinates are in the order and
    with the signs of the plant; `hat_x` is without its steady advance stride_length * tau. Use
    `Reference.embedded` or `Reference.from_table` to make one.

    Attributes:
        kind: `"spatial"` or `"planar"`.
        name: what it is, for reports.
        stride_time: [s].
        phase_fractions: durations of the eight contact phases as fractions of the stride.
        foot_placement: where the feet stand.
        motion: the coordinates as functions of tau.
        forces: six forces on the feet [N] (right x, y, z, left x, y, z), or None if not measured.
        deviation: how `coordinate_sigma`, `coordinate_weight`, ... are made.
    """

    kind: str
    name: str
    stride_time: float
    phase_fractions: tuple[float, ...]
    foot_placement: FootPlacement
    motion: PeriodicCurves
    forces: PeriodicCurves | None = None
    deviation: DeviationSettings = DeviationSettings()

    @classmethod
    def embedded(
        cls,
        kind: str,
        subject: Subject | None = None,
        name: str | None = None,
        deviation: DeviationSettings | None = None,
    ) -> Reference:
        """A gait that comes with the package, scaled to the subject's height and mass.

        Lengths grow with the height H, times with sqrt(H) (equal Froude number), forces with body
        weight. Level walking at 1.35 m/s for 1.80 m.

        Args:
            kind: `"spatial"` or `"planar"`.
            subject: default 1.80 m, 75 kg.
            name: `"normal"` (equal sides; default for spatial), `"asymmetric"` (both legs as
                measured, fitted to the contacts), `"measured"` (only converted and scaled: feet
                slide by centimetres), `"planar"` (fitted in the sagittal plane; default and the
                only one that stands on the ground for planar, where the others leave about 5 mm).
            deviation: rules of eqs (10) and (12).

        Raises:
            UnknownName: no such kind or gait; `"planar"` has no lateral coordinates.
        """
        stride = embedded_stride(kind, subject or Subject(), name)
        return cls(kind=kind, deviation=deviation or DeviationSettings(), **stride)

    @classmethod
    def from_table(
        cls,
        table: str | Path | Mapping[str, Any],
        *,
        kind: str,
        subject: Subject | None = None,
        nodes: int = 25,
        deviation: DeviationSettings | None = None,
        **facts: Any,
    ) -> Reference:
        """A stride measured elsewhere, from a CSV file or from named arrays.

        The first column is `percent` (0 to 100) or `time` [s]; first and last row are the same
        instant of the stride, right heel strike. The other columns are coordinates by our names
        (`hip_flexion_r`, anatomical signs: the name is the positive sense) or by the paper's
        (`b_13`, signs of the plant), and optionally the forces on the feet `right_x` ...
        `left_z`. A unit may follow a name in brackets: `hip_flexion_r [deg]`. hat_x may or may not
        contain the advance of the walker. Curves that do not close are closed by eq. (14).

        Args:
            table: path of the CSV file, or mapping of column names to arrays.
            kind: `"spatial"` or `"planar"`.
            subject: the person measured; heights and forces are checked against it.
            nodes: nodes of the periodic quintic spline through each coordinate.
            deviation: rules of eqs (10) and (12).
            facts: what the table does not say, see `tables.read_stride`: `stride_time`,
                `phase_fractions`, `foot_placement`, `angle_unit`, `length_unit`, `force_unit`. A
                CSV file may say them in leading lines such as `# stride_time = 1.07`.

        Raises:
            BadFile: the file cannot be read as a table.
            UnknownName: a column, unit or fact that does not exist.
            InvalidInput: gaps, missing columns or facts, not one stride, implausible units.
        """
        subject = subject or Subject()
        stride = read_stride(table, kind=kind, subject=subject, **facts)
        spline = PeriodicQuintic(nodes)
        fitted = fit_periodic(spline, stride.tau, stride.coordinates.T, names(kind))
        return cls(
            kind=kind,
            name=stride.name,
            stride_time=stride.stride_time,
            phase_fractions=stride.phase_fractions,
            foot_placement=stride.foot_placement,
            motion=SplineCurves(spline, fitted),
            forces=_table_forces(stride),
            deviation=deviation or DeviationSettings(),
        )

    @classmethod
    def load(cls, path: str | Path, kind: str | None = None) -> Reference:
        """A reference from a netCDF file of `save` or of `drakegait import`.

        Args:
            kind: `"spatial"` or `"planar"`; default the spatial one, if there is one.

        Raises:
            BadFile: missing, damaged, foreign, or of another version.
            UnknownName: the file has no reference of this kind.
        """
        return read_reference(path, kind)

    def save(self, path: str | Path, rows: int = 101) -> None:
        """Write a netCDF file (`.nc`) that `load` reads, or else a CSV file for `from_table`.

        The CSV file is a template for measurements of one's own: coordinates in anatomical signs,
        degrees and metres, hat_x with the advance; forces in N.

        Args:
            path: of the file, replaced if it is there.
            rows: of the CSV file, instants from 0 to 100 % of the stride.

        Raises:
            BadFile: the file cannot be written.
        """
        if is_netcdf(path):
            write_subject(path, (self,), None)
            return
        write_csv(path, self, table_columns(self, rows, FORCE_COLUMNS))

    @property
    def coordinates(self) -> tuple[str, ...]:
        """Names of the coordinates, in order."""
        return names(self.kind)

    @property
    def speed(self) -> float:
        """Mean walking speed [m/s]."""
        return self.foot_placement.stride_length / self.stride_time

    def coordinate_values(self, tau: np.ndarray, derivative: int = 0) -> np.ndarray:
        """Coordinates (..., num_coordinates) at tau (...,), or derivatives with respect to tau.

        Plant signs, m and rad. `hat_x` is the periodic part: add stride_length * tau for the
        position.
        """
        return self.motion.values(tau, derivative)

    def ground_reactions(self, tau: np.ndarray, derivative: int = 0) -> np.ndarray:
        """Forces of the ground on the feet (..., 2, 3) [N]: right, left; x, y, z.

        Zeros if not measured; y is zero for a planar walker. Derivatives 0 to 2 in tau.
        """
        shape = np.shape(tau) + (2, 3)
        if self.forces is None:
            return np.zeros(shape)
        return self.forces.values(tau, derivative).reshape(shape)

    @functools.cached_property
    def coordinate_sigma(self) -> np.ndarray:
        """sigma (num_coordinates,) of eq. (10) [m, rad]; of hat_x: without the advance."""
        return self._sigma(self.coordinate_values, self._coordinate_groups)

    @functools.cached_property
    def coordinate_weight(self) -> np.ndarray:
        """omega (num_coordinates,) of eq. (12), at most 1."""
        return weight(self.coordinate_sigma, self._coordinate_groups)

    @functools.cached_property
    def force_sigma(self) -> np.ndarray:
        """sigma (2, 3) of eq. (10) for the ground reactions [N]; ones if not measured."""
        if self.forces is None:
            return np.ones((2, 3))
        return self._sigma(self.ground_reactions, [np.arange(6)]).reshape(2, 3)

    @functools.cached_property
    def force_weight(self) -> np.ndarray:
        """omega (2, 3) of eq. (12) for the ground reactions; 0 for forces that do not count."""
        if self.forces is None:
            return np.zeros((2, 3))
        omega = weight(self.force_sigma.ravel(), [np.arange(6)]).reshape(2, 3)
        if self.kind == "planar":
            omega[:, 1] = 0.0
        return omega

    @property
    def _coordinate_groups(self) -> list[np.ndarray]:
        angles = rotations(self.kind)
        if self.deviation.groups == "single":
            return [np.arange(len(angles))]
        return [np.flatnonzero(angles), np.flatnonzero(~angles)]

    def _sigma(self, values: Callable[[np.ndarray], np.ndarray], groups: list[np.ndarray]):
        samples = values(SIGMA_INSTANTS)
        samples = samples.reshape(len(samples), -1)
        return sigma(samples, groups, self.stride_time, self.deviation.sigma_rule)


def _table_forces(stride: StrideTable) -> SampledCurves | None:
    if stride.forces is None:
        return None
    forces = stride.forces.copy()
    forces[[0, -1]] = 0.5 * (forces[0] + forces[-1])  # one instant, measured twice
    return SampledCurves(stride.tau, forces)
