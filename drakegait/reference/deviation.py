"""How far from the reference counts as far: eqs (10) and (12) of the paper."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Sequence

import numpy as np

from drakegait.errors import InvalidInput
from drakegait.settings import Settings, choice

SIGMA_INSTANTS = np.arange(400) / 400.0
"""Instants of the integral in eq. (10): uniform, hence exact for the embedded harmonics."""

SIGMA_FLOOR = 1e-3
"""Smallest sigma relative to the largest of its group: a row at rest must not divide by zero."""


@dataclasses.dataclass(frozen=True, kw_only=True)
class DeviationSettings(Settings):
    """How the terms of the deviation J_dev, eq. (11), are made comparable.

    sigma_rule:
        rms: sigma_i = sqrt((1/T) int (x_i - X_i)^2 dt), the root mean square deviation of the
            measured variable from its mean.
        printed: eq. (10) as printed, (1/T) sqrt(int ...), which is rms / sqrt(T) [s^-1/2].
    groups: which variables share a sigma_max in omega_i = sigma_i / sigma_max.
        three: rotations; translations; forces, as angles and lengths do not compare.
        single: all coordinates together, as the paper has it; forces apart.
    """

    sigma_rule: str = choice("rms", ("rms", "printed"), "reading of eq. (10)")
    groups: str = choice("three", ("three", "single"), "coordinates that share a sigma_max")


def sigma(
    samples: np.ndarray, groups: Sequence[np.ndarray], stride_time: float, rule: str
) -> np.ndarray:
    """Deviation of each variable from its mean over the stride, eq. (10).

    Args:
        samples: (num_instants, num_variables), uniform over one period.
        groups: indices of the variables that share a sigma_max.
        stride_time: [s].
        rule: `sigma_rule` of `DeviationSettings`.

    Raises:
        InvalidInput: all variables of a group are constant.
    """
    result = samples.std(axis=0)
    for group in groups:
        largest = result[group].max()
        if largest <= 0.0:
            raise InvalidInput("reference", "at rest", "a motion")
        result[group] = np.maximum(result[group], SIGMA_FLOOR * largest)
    return result / math.sqrt(stride_time) if rule == "printed" else result


def weight(sigmas: np.ndarray, groups: Sequence[np.ndarray]) -> np.ndarray:
    """omega_i = sigma_i / sigma_max of its group, eq. (12)."""
    result = np.empty_like(sigmas)
    for group in groups:
        result[group] = sigmas[group] / sigmas[group].max()
    return result
