"""Studies that several chapters start from; their names are the same everywhere."""

from __future__ import annotations

from drakegait.study import GaitStudy

WEIGHT = 2.0
"""On the right foot in sections 4.2 and 4.3 [kg]."""

SMALL = "nodes 19"
"""The walker of Table 2's first row, on which questions about the formulation are tried."""


def small(**statements) -> GaitStudy:
    """Symmetric in the plane, 19 nodes: the cheapest walk of the paper."""
    return GaitStudy.planar_symmetric(nodes=19, **statements)


def chain(names: list[str]) -> dict[str, str]:
    """Each study from the gait of the one before it."""
    return dict(zip(names[1:], names[:-1], strict=True))
