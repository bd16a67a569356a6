"""Other ways to state the same walk, for comparison with the paper.

Each default is the form that drakegait recommends; the others are those of the
paper or of what it compares itself with (docs/formulation.md 13).
"""

from __future__ import annotations

from dataclasses import dataclass

from drakegait.settings import Settings, choice


@dataclass(frozen=True, kw_only=True)
class Variants(Settings):
    """Forms of the problem that the paper argues about."""

    periodicity: str = choice(
        "exact",
        ("exact", "eq14"),
        "unknown curves: periodic splines as they are, or with the ends forced by eq. (14) too",
    )
    eom_form: str = choice(
        "components",
        ("components", "maximum"),
        "equations of motion: eq. (28), a bound at each control point, or eq. (29), one bound on "
        "the largest residual of each coordinate",
    )
    sequence: str = choice(
        "213",
        ("213", "123"),
        "order of the rotations of trunk and hips: about y, x, z or about x, y, z",
    )
