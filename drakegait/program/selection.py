"""The local variables of all control points as affine functions of the design vector."""

from __future__ import annotations

import numpy as np

from drakegait.program.control_points import ControlPoints
from drakegait.program.formulation import Formulation
from drakegait.transcription.design_vector import Affine, DesignVector
from drakegait.walker import feet


def local_variables(
    formulation: Formulation, points: ControlPoints, design: DesignVector
) -> Affine:
    """Local variables (num_points, layout.size) from the design vector."""
    num = points.num
    width, intervals = points.layout.width, formulation.splines.num_intervals
    window = (points.first[:, None] + np.arange(width)) % intervals
    events = _local_events(formulation, points)
    parts = []
    for name in DesignVector.ORDER:
        full = design.selection(name)
        if name in ("coordinates", "forces"):
            take = lambda a: a[:, window].transpose(1, 0, 2).reshape(num, -1)  # noqa: E731
            parts.append(Affine(take(full.index), take(full.factor), take(full.constant)))
        elif name == "timing":
            which, shift = events
            constant = full.constant[which] + shift
            parts.append(Affine(full.index[which], full.factor[which], constant))
        elif name == "placement":
            parts.append(Affine(*(np.tile(a, (num, 1)) for a in
                                  (full.index, full.factor, full.constant))))  # fmt: skip
        else:
            parts.append(full)
    return Affine(
        *(np.concatenate([getattr(part, field) for part in parts], axis=1)
          for field in ("index", "factor", "constant"))
    )  # fmt: skip


def _local_events(
    formulation: Formulation, points: ControlPoints
) -> tuple[np.ndarray, np.ndarray]:
    """Positions in the timing block of T and the local events, and their shifts."""
    phases, num = points.phases, formulation.schedule.num_phases
    end = num / feet.NUM_PHASES
    before = np.where(phases == 0, num, phases)  # theta of the previous phase's start
    which = np.stack([0 * phases, before, phases + 1, phases + 2], axis=1)
    shift = np.zeros(which.shape)
    shift[phases == 0, 1] = -end
    return which, shift
