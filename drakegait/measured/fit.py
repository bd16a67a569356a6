"""Inverse kinematics over a whole stride: as measured, but with the feet on the ground.

Unknown are the coefficients of periodic quintic splines through all coordinates, and the footprints
p_g of eq. (5). Least squares over equidistant instants k of one stride:

    angles       (q_k - measured_k) / 3 deg,   (q''_k - measured''_k) / (3 deg (8 pi)^2),
                 of the trunk the latter / (0.3 deg (8 pi)^2)
    translations (q_k - measured_k) / 20 mm, where the hips' path was measured
    contacts     (point - footprint) / 1.5 mm, heading / 0.5 deg, in the phases of docs/formulation.md 6.1
    clearance    min(0, height) / 1.5 mm of points that do not stand
    forces       (m (a_com + g) - measured force) / 0.05 m g, where both feet's forces were measured

The weights say what is believed: contacts to a millimetre, as shoes do not sink; angles to a few
degrees, the error of skin markers (Leardini et al. 2005). The trunk, two thirds of the body, may not
twitch: 0.3 degrees four times a stride already need some 15 N m, which legs would have to bear.
"""  # noqa: E501

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from drakegait.measured.levenberg_marquardt import minimise
from drakegait.quantities import GRAVITY
from drakegait.transcription.foot_placement import FootPlacement
from drakegait.transcription.splines import PeriodicQuintic
from drakegait.walker.coordinates import names, rotations
from drakegait.walker.feet import (
    NUM_ROWS,
    VERTICAL_ROWS,
    YAW_ROWS,
    active_rows,
    footprints,
    left_print,
)
from drakegait.walker.skeleton import Skeleton

INSTANTS = 100
"""Instants of a stride at which the sums are taken."""
NODES = 25
"""Nodes of the splines of an imported stride."""
_ANGLE, _TRANSLATION, _POINT, _HEADING = np.radians(3.0), 0.02, 0.0015, np.radians(0.5)
_FORCE = 0.05  # of body weight
_BEND = (8.0 * np.pi) ** 2  # second derivative of a fourth harmonic of unit amplitude
_TRUNK_BEND = 0.1  # of that, for the rotations of the trunk
_PLACE = np.array([0.03, 0.03, np.radians(5.0), np.radians(5.0), 0.03])


@dataclass(frozen=True, eq=False, kw_only=True)
class StrideTarget:
    """What a fit stays close to.

    Attributes:
        coordinates: (INSTANTS, n) plant signs, hat_x without the advance.
        forces: (INSTANTS, 3) sum of both feet's forces [N], or None.
        events: (8,) starts of the phases, fractions of the cycle.
        placement: first guess of the footprints.
        stride_time: [s].
        translations: (3,) whether x, y, z of the hips were measured.
    """

    coordinates: np.ndarray
    forces: np.ndarray | None
    events: np.ndarray
    placement: FootPlacement
    stride_time: float
    translations: tuple[bool, bool, bool] = (True, True, True)


@dataclass(frozen=True, eq=False, kw_only=True)
class FittedStride:
    """The result of a fit.

    Attributes:
        coefficients: (n, NODES - 1).
        placement: footprints.
    """

    coefficients: np.ndarray
    placement: FootPlacement


class StrideFit:
    """The least-squares problem of one stride.

    Args:
        skeleton: spatial or planar.
        target: what to stay close to.
    """

    def __init__(self, skeleton: Skeleton, target: StrideTarget):
        self.skeleton, self.target = skeleton, target
        self.planar = skeleton.kind == "planar"
        self.spline = PeriodicQuintic(NODES)
        self.tau = np.arange(INSTANTS) / INSTANTS
        self._basis = self.spline.dense_basis(self.tau)
        self._bend = self.spline.dense_basis(self.tau, 2)
        self.phases = np.searchsorted(target.events, self.tau, side="right") - 1
        self.active = np.stack([active_rows(p, self.planar) for p in self.phases])
        self._prints = np.array([left_print(p) for p in self.phases])
        self._feet = skeleton.foot
        self._length = target.placement.stride_length
        self._angles = rotations(skeleton.kind)
        trunk = np.array([name.startswith("hat_") for name in names(skeleton.kind)])
        self._bend_share = _BEND * np.where(trunk & self._angles, _TRUNK_BEND, 1.0)
        self._measured = self.spline.fit(self.tau, target.coordinates.T)
        self._wave = _second_derivative(INSTANTS, (NODES - 1) // 2)

    def solve(self) -> tuple[FittedStride, FittedStride]:
        """The stride as measured, laid on the ground as well as it can be, and the fitted one.

        In the first only the hips' translations and the footprints are free, no angle.
        """
        start = np.concatenate([self._measured.ravel(), self._free_placement()])
        free = np.concatenate(
            [np.repeat(~self._angles, NODES - 1), np.ones(start.size - self._measured.size, bool)]
        )
        placed = self._minimise(start, free, tolerance=1e-4)
        fitted = self._minimise(placed, np.ones(start.size, dtype=bool), tolerance=1e-4)
        return self._result(placed), self._result(fitted)

    def contact_errors(self, stride: FittedStride) -> np.ndarray:
        """Distance of the contact rows from the footprints (INSTANTS, 14), nan where inactive."""
        errors, _ = self._contacts(self._pack(stride))
        return np.where(self.active, errors, np.nan)

    def free_heights(self, stride: FittedStride) -> np.ndarray:
        """Heights (INSTANTS, 4) of points that do not stand, nan where they do [m]."""
        _, heights = self._contacts(self._pack(stride))
        return np.where(self.active[:, VERTICAL_ROWS], np.nan, heights)

    def ground_force(self, stride: FittedStride) -> np.ndarray:
        """Force (INSTANTS, 3) that the motion needs, m (a + g) [N]."""
        return self._force(self._pack(stride))

    # The rows ----------------------------------------------------------------------------

    def _minimise(self, start: np.ndarray, free: np.ndarray, tolerance: float) -> np.ndarray:
        point = start.copy()

        def rows(x: np.ndarray) -> np.ndarray:
            point[free] = x
            return self._rows(point)

        def slopes(x: np.ndarray) -> np.ndarray:
            point[free] = x
            return self._slopes(point)[:, free]

        point[free] = minimise(rows, slopes, start[free], tolerance)
        return point.copy()

    def _split(self, x: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        size = self._measured.size
        return x[:size].reshape(self._measured.shape), x[size:]

    def _free_placement(self, placement: FootPlacement | None = None) -> np.ndarray:
        """Right step length and, in space, toe angles and width; the stride length is measured."""
        p = placement or self.target.placement
        values = [p.step_length_right]
        if not self.planar:
            values += [p.toe_angle_right, p.toe_angle_left, p.step_width]
        return np.array(values)

    def _placement(self, free: np.ndarray) -> np.ndarray:
        values = np.zeros(5)
        values[0], values[1] = free[0], self._length - free[0]
        if not self.planar:
            values[2:] = free[1:]
        return values

    def _placement_slopes(self) -> np.ndarray:
        slopes = np.zeros((5, 1 if self.planar else 4))
        slopes[0, 0], slopes[1, 0] = 1.0, -1.0
        if not self.planar:
            slopes[2:, 1:] = np.eye(3)
        return slopes

    def _pack(self, stride: FittedStride) -> np.ndarray:
        return np.concatenate(
            [stride.coefficients.ravel(), self._free_placement(stride.placement)]
        )

    def _result(self, x: np.ndarray) -> FittedStride:
        coefficients, free = self._split(x)
        values = self._placement(free)
        placement = FootPlacement(
            step_length_right=float(values[0]), step_length_left=float(values[1]),
            toe_angle_right=float(values[2]), toe_angle_left=float(values[3]),
            step_width=float(values[4]),
        )  # fmt: skip
        return FittedStride(coefficients=coefficients.copy(), placement=placement)

    def _coordinates(self, x: np.ndarray) -> np.ndarray:
        """(INSTANTS, n) with the advance of hat_x."""
        q = self._basis @ self._split(x)[0].T
        q[:, 0] += self._length * self.tau
        return q

    def _contacts(self, x: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Errors of all contact rows (INSTANTS, 14) and heights of the points (INSTANTS, 4)."""
        q = self._coordinates(x)
        points = self.skeleton.contact_points(q)
        rows = np.zeros((INSTANTS, NUM_ROWS))
        for foot in range(2):
            base = 7 * foot
            rows[:, base : base + 6] = points[:, 2 * foot : 2 * foot + 2].reshape(-1, 6)
        rows[:, YAW_ROWS] = 0.0 if self.planar else self.skeleton.foot_yaw(q)
        return rows - self._footprints(x)[0], rows[:, VERTICAL_ROWS]

    def _contact_slopes(self, x: np.ndarray) -> np.ndarray:
        """Derivatives (INSTANTS, 14, n) of the contact rows by the coordinates."""
        q = self._coordinates(x)
        slopes = np.array(self.skeleton.contact_jacobian(q))
        slopes[:, YAW_ROWS] = 0.0 if self.planar else self.skeleton.foot_yaw_gradient(q)
        return slopes

    def _footprints(self, x: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        placement = np.broadcast_to(self._placement(self._split(x)[1]), (INSTANTS, 5))
        return footprints(placement, self._prints, self._feet)

    def _force(self, x: np.ndarray) -> np.ndarray:
        q = self._coordinates(x)
        place = self.skeleton.center_of_mass(q)
        place[:, 0] -= self._length * self.tau
        acceleration = self._wave @ place / self.target.stride_time**2
        acceleration[:, 2] += GRAVITY
        return self.skeleton.total_mass * acceleration

    @property
    def _scales(self) -> tuple[np.ndarray, np.ndarray]:
        """Scales of coordinates (n,) and contact rows (14,)."""
        soft = [_TRANSLATION if known else 0.1 for known in self.target.translations]
        if self.planar:
            soft = [soft[0], soft[2]]
        values = np.where(self._angles, _ANGLE, 1.0)
        values[~self._angles] = soft
        contact = np.full(NUM_ROWS, _POINT)
        contact[list(YAW_ROWS)] = _HEADING
        return values, contact

    def _rows(self, x: np.ndarray) -> np.ndarray:
        coefficients, free = self._split(x)
        scale, contact = self._scales
        away = coefficients - self._measured
        errors, heights = self._contacts(x)
        parts = [
            (self._basis @ away.T) / scale,
            (self._bend @ away.T) / (scale * self._bend_share),
            np.where(self.active, errors / contact, 0.0),
            np.where(self.active[:, VERTICAL_ROWS], 0.0, np.minimum(heights, 0.0) / _POINT),
        ]
        if self.target.forces is not None:
            weight = _FORCE * GRAVITY * self.skeleton.total_mass
            parts.append(((self._force(x) - self.target.forces) / weight)[:, self._force_axes])
        prior = (self._placement(free) - self._placement(self._free_placement())) / _PLACE
        return np.concatenate([*(part.ravel() for part in parts), prior])

    @property
    def _force_axes(self) -> list[int]:
        return [0, 2] if self.planar else [0, 1, 2]

    def _slopes(self, x: np.ndarray) -> np.ndarray:
        size = self._measured.size
        scale, contact = self._scales
        by_q, place, eye = self._contact_slopes(x), self._placement_slopes(), np.diag(1.0 / scale)
        sunk = (self._contacts(x)[1] < 0.0) & ~self.active[:, VERTICAL_ROWS]
        weight, deep = (self.active / contact)[..., None], (sunk / _POINT)[..., None]
        blocks = [
            np.einsum("ij,km->kijm", eye, self._basis),
            np.einsum("ij,km->kijm", eye / self._bend_share, self._bend),
            np.einsum("kri,km->krim", by_q * weight, self._basis),
            np.einsum("kri,km->krim", by_q[:, VERTICAL_ROWS] * deep, self._basis),
        ]
        if self.target.forces is not None:
            blocks.append(self._force_slopes(x))
        by_place = [np.zeros((block[..., 0, 0].size, place.shape[1])) for block in blocks]
        by_place[2] = (-(self._footprints(x)[1] @ place) * weight).reshape(by_place[2].shape)
        rows = [
            np.hstack([block.reshape(-1, size), extra])
            for block, extra in zip(blocks, by_place, strict=True)
        ]
        rows.append(np.hstack([np.zeros((5, size)), place / _PLACE[:, None]]))
        return np.vstack(rows)

    def _force_slopes(self, x: np.ndarray) -> np.ndarray:
        by_q = self.skeleton.center_of_mass_jacobian(self._coordinates(x))
        factor = 1.0 / (_FORCE * GRAVITY * self.target.stride_time**2)
        slopes = np.einsum("kl,lai,lm->kaim", self._wave, by_q, self._basis, optimize=True)
        return factor * slopes[:, self._force_axes]


def _second_derivative(count: int, harmonics: int) -> np.ndarray:
    """Matrix (count, count): second derivative in tau of a periodic series, by its harmonics."""
    order = np.abs(np.fft.fftfreq(count, 1.0 / count))
    response = np.where(order <= harmonics, -((2.0 * np.pi * order) ** 2), 0.0)
    return np.real(np.fft.ifft(response[:, None] * np.fft.fft(np.eye(count), axis=0), axis=0))

