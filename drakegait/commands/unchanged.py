"""`walk --compare`: the same walk without what makes this walker differ."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from drakegait.errors import InvalidInput

if TYPE_CHECKING:
    from drakegait.gait import Gait
    from drakegait.study import GaitStudy

UNCHANGED_FOLDER = "unchanged"
LABEL = "unchanged walker"
_ALLOWED = (
    "one that differs by --added-mass, --strength, --muscle, --limit or an option of the panel "
    '"The disorder"'
)


def unchanged(study: GaitStudy) -> GaitStudy:
    """The study without added masses, other strengths, limits and disorders.

    Height, mass, model file, speed, reference, weights and constants stay.

    Raises:
        InvalidInput: nothing makes the walker differ, so that there is nothing to compare.
    """
    plain = replace(
        study, added_masses=(), strength={}, muscle_changes={}, limits=(), disorders=()
    )  # fmt: skip
    if plain == study:
        raise InvalidInput("walker of --compare", "the unchanged one", _ALLOWED)
    return plain


def known_gait(study: GaitStudy, guess: Gait | None) -> Gait | None:
    """The guess, if it has solved just this study; else None."""
    from drakegait.report.study_words import differences

    if guess is None or not guess.converged:
        return None
    return None if differences(study, guess.study) else guess
