"""Passive joint moments: ligaments and resting muscles at the ends of the range, and damping.

Sagittal joints: Riener & Edrich (1999), J. Biomech. 32, 539-544, with coupling between the
joints that two-joint muscles span. Hip adduction and rotation, which they do not treat: double
exponentials of Anderson (1999) that only bound the range. All moments are sums of exponentials of
linear functions of the angles,

    Q(q, v) = scale (M H)/(75 kg 1.80 m) [ sum_t sign_t exp(c_t + w_t . q) + constant ] - d v,

so that one product gives all joints, and their derivatives, at any number of instants.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from drakegait.settings import Settings, choice, quantity
from drakegait.walker import coordinates
from drakegait.walker.joint_springs import JointSpring, JointSprings
from drakegait.walker.subject import Subject

MAX_EXPONENT = 6.0
"""Above it an exponential goes on as its tangent: each term is linear beyond e^6 = 403 N m."""

# Riener & Edrich: for each moment (hip flexion, knee flexion, ankle PLANTARflexion) the terms
# sign exp(c + w . (hip flexion, knee flexion, ankle plantarflexion)), angles in degrees, N m.
_RIENER_EDRICH = (
    ("hip_flexion", 1.0, 1.4655, (-0.0750, -0.0034, 0.0)),
    ("hip_flexion", -1.0, 1.3403, (0.0305, -0.0226, 0.0)),
    ("knee_flexion", 1.0, 1.800, (0.0217, -0.0352, -0.0460)),
    ("knee_flexion", -1.0, -3.971, (-0.0128, 0.0495, -0.0004)),
    ("knee_flexion", 1.0, 2.220, (0.0, -0.150, 0.0)),
    ("ankle_dorsiflexion", 1.0, 2.1016, (0.0, -0.0176, -0.0843)),
    ("ankle_dorsiflexion", -1.0, -7.9763, (0.0, 0.0008, 0.1949)),
)
_RIENER_EDRICH_CONSTANT = {
    "hip_flexion": 8.072,
    "knee_flexion": -4.820,
    "ankle_dorsiflexion": -1.792,
}
# Sense of their angles in plant signs: the plant's + is hip extension, knee flexion and
# plantarflexion.
_SENSE = {"hip_flexion": -1.0, "knee_flexion": 1.0, "ankle_dorsiflexion": 1.0}

# Anderson (1999), as published with Falisse et al. (2019):
# M(x) = k1 exp(k2 (x - x_high)) + k3 exp(k4 (x - x_low)); k1, k3 in N m, k2, k4 in 1/rad,
# x in rad, positive in adduction, internal rotation, flexion, knee EXTENSION, dorsiflexion;
# last: that sense in plant signs of the right leg.
_DOUBLE_EXPONENTIAL = {
    "hip_adduction": (-0.03, 14.94, 0.03, -14.94, -0.50, 0.50, 1.0),
    "hip_rotation": (-0.03, 14.94, 0.03, -14.94, -0.92, 0.92, 1.0),
    "hip_flexion": (-2.44, 5.05, 1.51, -21.88, -0.6981, 1.81, -1.0),
    "knee_flexion": (-6.09, 33.94, 11.03, -11.33, -2.4, 0.13, -1.0),
    "ankle_dorsiflexion": (-2.03, 38.11, 0.18, -12.12, -0.74, 0.52, -1.0),
}


@dataclass(frozen=True, kw_only=True)
class PassiveSettings(Settings):
    """Passive moments of the joints.

    The damping is an estimate from the pendulum tests that the paper cites (Stein et al. 1996):
    damping ratios 0.05-0.10 with the inertia of the hanging shank and leg.
    """

    model: str = choice(
        "riener_edrich",
        ("riener_edrich", "double_exponential"),
        "elastic moments of hip flexion, knee and ankle",
    )
    scale: float = quantity(1.0, "-", 0.0, 10.0, "factor on all elastic moments")
    damping_hip: float = quantity(1.0, "N m s/rad", 0.0, 50.0, "hip flexion and adduction damping")
    damping_hip_rotation: float = quantity(0.1, "N m s/rad", 0.0, 50.0, "hip rotation damping")
    damping_knee: float = quantity(0.4, "N m s/rad", 0.0, 50.0, "knee damping")
    damping_ankle: float = quantity(0.0, "N m s/rad", 0.0, 50.0, "ankle damping")


class PassiveJoints:
    """Generalised forces of the passive structures, on the right-hand side, in plant signs.

    Args:
        kind: `"spatial"` or `"planar"`.
        subject: elastic moments are proportional to body mass times height; damping is not scaled.
        settings: model and constants.
        springs: further springs and dampers at joints.
        bands: further exponentials Q += pull exp(offset + slope . q) of tense muscles, as triples
            (pull (n,) [N m], offset, slope (n,) [1/rad]).
        bare: joints without any passive structure of the body, of which none at other joints
            knows their angle either.
    """

    def __init__(
        self,
        kind: str,
        subject: Subject | None = None,
        settings: PassiveSettings | None = None,
        springs: Sequence[JointSpring] = (),
        bands: Sequence[tuple[np.ndarray, float, np.ndarray]] = (),
        bare: Sequence[str] = (),
    ):
        subject, settings = subject or Subject(), settings or PassiveSettings()
        where = coordinates.index(kind)
        terms = [term for term in _terms(settings.model) if f"{term[0]}_r" in where]
        count, n = 2 * len(terms), len(where)
        self._offsets = np.zeros(count)
        self._slopes = np.zeros((count, n))
        self._signs = np.zeros((count, n))
        self._constant = np.zeros(n)
        self._damping = np.zeros(n)
        damping = {
            "hip_flexion": settings.damping_hip,
            "hip_adduction": settings.damping_hip,
            "hip_rotation": settings.damping_hip_rotation,
            "knee_flexion": settings.damping_knee,
            "ankle_dorsiflexion": settings.damping_ankle,
        }
        # Left and right alike: sagittal angles have equal signs, the others odd moments.
        for i, side in enumerate(("r", "l")):
            for row, (joint, sign, offset, slopes) in enumerate(terms, i * len(terms)):
                self._offsets[row] = offset
                self._signs[row, where[f"{joint}_{side}"]] = sign
                for name, slope in slopes.items():
                    self._slopes[row, where[f"{name}_{side}"]] = slope
            if settings.model == "riener_edrich":
                for joint, value in _RIENER_EDRICH_CONSTANT.items():
                    self._constant[where[f"{joint}_{side}"]] = _SENSE[joint] * value
            for joint, value in damping.items():
                if f"{joint}_{side}" in where:
                    self._damping[where[f"{joint}_{side}"]] = value
        scale = settings.scale * subject.mass_scale * subject.length_scale
        self._signs *= scale
        self._constant *= scale
        for joint in bare:
            for part in (self._signs, self._slopes):
                part[:, where[joint]] = 0.0
            self._constant[where[joint]] = self._damping[where[joint]] = 0.0
        if bands:
            pulls, offsets, slopes = (np.array(part) for part in zip(*bands, strict=True))
            self._signs = np.vstack([self._signs, pulls])
            self._offsets = np.concatenate([self._offsets, offsets])
            self._slopes = np.vstack([self._slopes, slopes])
        self.springs = tuple(springs)
        self._springs = JointSprings(kind, springs) if springs else None
        if self._springs is not None:
            self._damping = self._damping + self._springs.damping

    def forces(self, q: np.ndarray, v: np.ndarray) -> np.ndarray:
        """Generalised forces (..., n) [N m] at coordinates q and velocities v (..., n)."""
        value, _ = self._exponentials(q)
        forces = value @ self._signs + self._constant - self._damping * np.asarray(v)
        return forces if self._springs is None else forces + self._springs.forces(q)

    @property
    def constants(self) -> dict[str, np.ndarray]:
        """What `forces` is made of, for writers of other formats, in plant signs.

        forces = signs^T exp(offsets + slopes q) + constant - damping v, each exponential going on
        as its tangent above MAX_EXPONENT; `offsets` (terms,), `slopes` and `signs` (terms, n),
        `constant` and `damping` (n,). The moments of `springs` come on top, their dampers are in
        `damping`.
        """
        return {
            "offsets": self._offsets,
            "slopes": self._slopes,
            "signs": self._signs,
            "constant": self._constant,
            "damping": self._damping,
        }

    def derivatives(self, q: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Derivatives of `forces`: dQ/dq (..., n, n) [N m/rad] and dQ/dv (n, n) [N m s/rad]; the
        latter does not change."""
        _, slope = self._exponentials(q)
        by_q = (self._signs.T * slope[..., None, :]) @ self._slopes
        if self._springs is not None:
            by_q += self._springs.slopes(q)[..., None] * np.eye(len(self._damping))
        return by_q, -np.diag(self._damping)

    def curvature(self, q: np.ndarray, weights: np.ndarray) -> np.ndarray:
        """Second derivatives (..., n, n) by q of the weighted sum of forces, weights (..., n)."""
        exponents = np.asarray(q) @ self._slopes.T + self._offsets
        bent = np.where(exponents < MAX_EXPONENT, np.exp(np.minimum(exponents, MAX_EXPONENT)), 0.0)
        factor = bent * (weights @ self._signs.T)
        curvature = self._slopes.T @ (factor[..., None] * self._slopes)
        if self._springs is not None:
            bends = weights * self._springs.bends(q)
            curvature += bends[..., None] * np.eye(len(self._damping))
        return curvature

    def _exponentials(self, q: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Terms (..., terms) and their derivatives by the exponent; linear above MAX_EXPONENT."""
        exponents = np.asarray(q) @ self._slopes.T + self._offsets
        slope = np.exp(np.minimum(exponents, MAX_EXPONENT))
        return slope * (1.0 + np.maximum(exponents - MAX_EXPONENT, 0.0)), slope


def _terms(model: str) -> list[tuple[str, float, float, dict[str, float]]]:
    """Terms (joint, sign, offset, slopes) = sign exp(offset + slopes . q) of a leg, plant signs."""
    lateral = ("hip_adduction", "hip_rotation")
    if model == "double_exponential":
        return [term for joint in (*_SENSE, *lateral) for term in _double_exponential(joint)]
    terms = []
    for joint, sign, offset, per_degree in _RIENER_EDRICH:
        slopes = {
            name: math.degrees(slope) * _SENSE[name]
            for name, slope in zip(_SENSE, per_degree, strict=True)
            if slope
        }
        terms.append((joint, sign * _SENSE[joint], offset, slopes))
    return terms + [term for joint in lateral for term in _double_exponential(joint)]


def _double_exponential(joint: str) -> list[tuple[str, float, float, dict[str, float]]]:
    k1, k2, k3, k4, low, high, sense = _DOUBLE_EXPONENTIAL[joint]
    # k exp(x) = sign(k) exp(x + ln|k|): the limit of the exponent then is one of the moment.
    return [
        (joint, sense * math.copysign(1.0, k), math.log(abs(k)) - rate * end, {joint: sense * rate})
        for k, rate, end in ((k1, k2, high), (k3, k4, low))
    ]
