"""A person's walk as an import leaves it: references, subject, quality."""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import numpy as np

from drakegait.measured.fit import FittedStride, StrideFit, StrideTarget
from drakegait.measured.posture import sagittal
from drakegait.measured.quality import Quality
from drakegait.reference.curves import SampledCurves, SplineCurves
from drakegait.reference.netcdf_file import write_subject
from drakegait.reference.reference import Reference
from drakegait.walker.skeleton import Skeleton
from drakegait.walker.subject import Subject


@dataclass(frozen=True, eq=False, kw_only=True)
class ImportedWalk:
    """One stride of a person, ready for a study.

    Attributes:
        reference: in space; `GaitStudy.spatial(reference=walk.reference, subject=walk.subject)`.
        subject: height and mass.
        quality: what was read, changed and doubted.
        target: what the fit stayed close to: the coordinates before the fit, at equidistant
            instants from right heel strike, plant signs, hat_x without the advance.
        needed_force: (K, 3) ground force that the fitted motion needs, m (a + g) [N].
    """

    reference: Reference
    subject: Subject
    quality: Quality
    target: StrideTarget
    needed_force: np.ndarray

    @property
    def warnings(self) -> tuple[str, ...]:
        """What a user should know, in words."""
        return self.quality.warnings

    @cached_property
    def planar_reference(self) -> Reference:
        """The stride in the sagittal plane, fitted anew to the walker that has no other."""
        tau = np.arange(len(self.target.coordinates)) / len(self.target.coordinates)
        placement = dataclasses.replace(
            self.reference.foot_placement, toe_angle_right=0.0, toe_angle_left=0.0, step_width=0.0
        )
        target = dataclasses.replace(
            self.target, coordinates=sagittal(self.reference.coordinate_values(tau)),
            placement=placement,
        )  # fmt: skip
        fit = StrideFit(Skeleton.load("planar", self.subject), target)
        instants = np.linspace(0.0, 1.0, FORCE_ROWS)
        forces = self.reference.ground_reactions(instants).reshape(FORCE_ROWS, 6)
        return reference_of_fit(self.reference.name, fit, fit.solve()[1], forces)

    def save(self, path: str | Path, page: bool = True) -> None:
        """Write `subject.nc`, and beside it the page `subject_quality.html`.

        Raises:
            BadFile: a file cannot be written.
        """
        path = Path(path)
        both = (self.reference, self.planar_reference)
        write_subject(path, both, self.subject, self.quality.to_dict())
        if page:
            from drakegait.measured.quality_page import write_page

            write_page(self, quality_path(path))


FORCE_ROWS = 201
"""Rows of the forces of an imported stride, from 0 to 100 %."""


def quality_path(path: Path) -> Path:
    """The page beside an imported walk."""
    return path.with_name(f"{path.stem}_quality.html")


def reference_of_fit(
    name: str, fit: StrideFit, stride: FittedStride, forces: np.ndarray
) -> Reference:
    """A fitted stride as reference; forces (FORCE_ROWS, 6) [N]."""
    forces = forces.copy()
    forces[-1] = forces[0]
    if fit.planar:
        forces[:, [1, 4]] = 0.0
    return Reference(
        kind=fit.skeleton.kind,
        name=name,
        stride_time=fit.target.stride_time,
        phase_fractions=tuple(np.diff(np.append(fit.target.events, 1.0)).tolist()),
        foot_placement=stride.placement,
        motion=SplineCurves(fit.spline, stride.coefficients),
        forces=SampledCurves(np.linspace(0.0, 1.0, len(forces)), forces),
    )
