"""Other points to start a solve from: optima are local, and a second start may find a better one.

- the reference: static optimisation along it, the default (`guess`);
- standing: the neutral posture at every instant, the body carried along at the wanted speed;
- silent muscles: the reference's motion, all muscle and contact forces at their least;
- the reference with noise: every nodal value and every phase duration is off at random.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from drakegait.program.design import PHASE_DURATIONS
from drakegait.program.gait_program import GaitProgram
from drakegait.program.guess import fit_forces, guess_from_reference, reference_values
from drakegait.quantities import check_count
from drakegait.reference.reference import Reference
from drakegait.transcription.design_vector import DesignValues

REFERENCE, STANDING, SILENT, NOISE = "reference", "standing", "silent muscles", "noise"
NOISE_LEVELS = (0.1, 0.3)
"""Standard deviation of the noise: of nodal values in units of the coordinate's own standard
deviation over the stride, of phase durations in units of the duration."""
MOST_STARTS = 1000
_HALF = np.sqrt(2.0)  # a mirrored walker averages two values, which halves the noise's variance


@dataclass(frozen=True)
class Start:
    """Where to start from.

    Attributes:
        kind: `REFERENCE`, `STANDING`, `SILENT` or `NOISE`.
        level: of the noise [-].
        seed: of the noise.
    """

    kind: str = REFERENCE
    level: float = 0.0
    seed: tuple[int, int] = (0, 0)

    @property
    def name(self) -> str:
        """In words."""
        if self.kind == NOISE:
            return f"reference with {100.0 * self.level:.0f} % noise, number {self.seed[1]}"
        return self.kind

    def event_centres(self, reference: Reference, symmetric: bool) -> np.ndarray | None:
        """Fractions of the cycle (8,) about which this start's program lets events move.

        None stands for those of the reference.
        """
        if self.kind != NOISE:
            return None
        durations = self._durations(reference, symmetric)
        return np.concatenate([[0.0], np.cumsum(durations)[:-1]]) / durations.sum()

    def point(self, program: GaitProgram) -> np.ndarray:
        """Design vector; `program` has this start's event centres."""
        if self.kind == REFERENCE:
            return guess_from_reference(program)
        values = reference_values(program)
        if self.kind == STANDING:
            values = replace(
                values, coordinate_coefficients=_standing(program, values.coordinate_coefficients)
            )
        elif self.kind == SILENT:
            values = replace(values, multipliers=np.zeros_like(values.multipliers))
            return _within_bounds(program, values)
        else:
            values = self._noisy(program, values)
        return fit_forces(program, _within_bounds(program, values))

    def _durations(self, reference: Reference, symmetric: bool) -> np.ndarray:
        """Phase durations (8,) with noise, in fractions of the reference's stride."""
        durations = np.array(reference.phase_fractions, dtype=float)
        noise = np.random.default_rng((*self.seed, 0)).normal(size=len(durations))
        noise = np.tile(noise[:4], 2) if symmetric else noise
        factors = np.clip(1.0 + self.level * noise, 0.4, 1.6)
        shortest, longest = np.array(PHASE_DURATIONS) / reference.stride_time
        return np.clip(factors * durations, shortest, longest)

    def _noisy(self, program: GaitProgram, values: DesignValues) -> DesignValues:
        formulation = program.formulation
        splines = formulation.splines
        nodal = splines.nodal_values(values.coordinate_coefficients)
        spread = self.level * nodal.std(axis=1, keepdims=True)
        spread = spread * (_HALF if formulation.symmetric else 1.0)
        noise = np.random.default_rng((*self.seed, 1)).normal(size=nodal.shape)
        durations = self._durations(formulation.reference, formulation.symmetric)
        return replace(
            values,
            coordinate_coefficients=splines.coefficients(nodal + spread * noise),
            stride_time=values.stride_time * float(durations.sum()),
        )


def starts(count: int, seed: int = 0) -> list[Start]:
    """`count` starts: the reference, standing, silent muscles, then the reference with noise.

    Args:
        seed: whole number from 0; the same one gives the same starts.

    Raises:
        InvalidInput: a count below 1 or above `MOST_STARTS`, or a negative seed.
    """
    for name, value, low, high in (("starts", count, 1, MOST_STARTS), ("seed", seed, 0, 2**31)):
        check_count(name, value, low, high)
    generator = np.random.default_rng(seed)
    levels = generator.uniform(*NOISE_LEVELS, size=count)
    noisy = [Start(NOISE, float(level), (seed, k)) for k, level in enumerate(levels, 1)]
    return [Start(), Start(STANDING), Start(SILENT), *noisy][:count]


def _within_bounds(program: GaitProgram, values: DesignValues) -> np.ndarray:
    design = program.design
    return np.clip(design.pack(values), design.lower, design.upper)


def _standing(program: GaitProgram, like: np.ndarray) -> np.ndarray:
    """Coefficients of the neutral posture with the soles on the ground."""
    skeleton = program.formulation.walker.skeleton
    neutral = np.zeros(skeleton.num_coordinates)
    height = skeleton.coordinates.index("hat_z")
    neutral[height] = -skeleton.contact_points(neutral)[:, 2].min()
    return np.broadcast_to(neutral[:, None], like.shape).copy()
