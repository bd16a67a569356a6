"""A reference in the other sequence of rotations."""

from __future__ import annotations

import dataclasses

from drakegait.reference.curves import SplineCurves
from drakegait.reference.reference import Reference
from drakegait.transcription.splines import PeriodicQuintic
from drakegait.walker.rotation_sequence import convert

_NODES = 201  # dense: the converted curves are not splines, errors stay below 1e-7 rad


def in_sequence(reference: Reference, sequence: str) -> Reference:
    """The same walk with the angles of trunk and hips in `sequence`, from the sequence 213.

    Angles go through rotation matrices at the nodes of a dense spline, so sigma and omega are
    those of the new angles. Planar references are the same in every sequence.
    """
    if sequence == "213" or reference.kind == "planar":
        return reference
    spline = PeriodicQuintic(_NODES)
    values = convert(reference.coordinate_values(spline.node_times), "213", sequence)
    return dataclasses.replace(
        reference, motion=SplineCurves(spline, spline.coefficients(values.T))
    )
