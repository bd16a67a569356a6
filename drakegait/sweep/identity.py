"""What makes two studies the same: a digest of everything that decides the answer."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping
from typing import Any

import numpy as np

from drakegait.reference.reference import Reference
from drakegait.solvers.options import SolverOptions
from drakegait.study import GaitStudy

LIMITS = ("time_limit", "max_iterations")
"""Solver options that decide whether an answer is reached, not which: no part of the identity."""
_INSTANTS = np.arange(400) / 400.0  # of a stride, at which a reference is compared
_DIGITS = 9  # of rad, m, N: below what any solve sees, above rounding


def study_key(study: GaitStudy, options: SolverOptions, refine: bool) -> str:
    """Digest of the study with its reference, the way to solve it and drakegait's version.

    Not part of it: the name, the guess, and the limits of time and iterations. So a sweep can be
    extended, and the ones that ran out of time tried again, without solving the others anew.
    """
    import drakegait

    content = {
        "study": study.to_dict(),
        "reference": None if study.reference is None else _reference(study.reference),
        "solver": {key: x for key, x in options.to_dict().items() if key not in LIMITS},
        "refine": refine,
        "drakegait": drakegait.__version__,
    }
    text = json.dumps(plain(content), sort_keys=True)
    return hashlib.sha256(text.encode()).hexdigest()[:32]


def plain(value: Any) -> Any:
    """`value` with every number a float, every sequence a list: 1, 1.0 and numpy's 1 are one."""
    if isinstance(value, Mapping):
        return {str(name): plain(item) for name, item in value.items()}
    if isinstance(value, np.ndarray):
        return plain(value.tolist())
    if isinstance(value, (list, tuple)):
        return [plain(item) for item in value]
    if isinstance(value, (bool, np.bool_)):
        return bool(value)
    if isinstance(value, (int, float, np.number)):
        return float(value)
    return value if value is None else str(value)


def _reference(reference: Reference) -> dict[str, Any]:
    placement = vars(reference.foot_placement)
    arrays = (reference.coordinate_values(_INSTANTS), reference.ground_reactions(_INSTANTS))
    # Adding zero makes -0.0 and 0.0 one.
    curves = [hashlib.sha256((np.round(x, _DIGITS) + 0.0).tobytes()).hexdigest() for x in arrays]
    return {
        "kind": reference.kind,
        "stride_time": reference.stride_time,
        "phase_fractions": reference.phase_fractions,
        "foot_placement": placement,
        "deviation": reference.deviation.to_dict(),
        "curves": curves,
    }
