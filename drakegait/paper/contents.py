"""All chapters, in the order of the paper; the last three are questions of our own."""

from __future__ import annotations

from drakegait.paper import (
    convergence,
    cost_front,
    formulation_claims,
    heavy_foot_planar,
    heavy_foot_spatial,
    muscle_table,
    rulings,
    spatial_symmetric,
    speeds,
    worn_masses,
)

CHAPTERS = (
    muscle_table.CHAPTER,
    convergence.CHAPTER,
    heavy_foot_planar.CHAPTER,
    heavy_foot_spatial.CHAPTER,
    spatial_symmetric.CHAPTER,
    formulation_claims.CHAPTER,
    rulings.CHAPTER,
    cost_front.CHAPTER,
    speeds.CHAPTER,
    worn_masses.CHAPTER,
)
