"""A gait carried over to another study, as the start of its solve."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from drakegait.gait import Gait
from drakegait.study import GaitStudy
from drakegait.transcription.design_vector import DesignValues
from drakegait.transcription.splines import PeriodicQuintic
from drakegait.walker.rotation_sequence import convert


def values_for(study: GaitStudy, guess: Gait) -> DesignValues:
    """The unknowns of `guess` in the nodes, muscles and joint sequence of `study`.

    Contact forces stay at the control points of `guess`.
    """
    values, nodes = guess.values, study.nodes
    splines = PeriodicQuintic(nodes)
    given, wanted = guess.study.variants.sequence, study.variants.sequence
    if given != wanted:
        nodal = guess.splines.nodal_values(values.coordinate_coefficients)
        nodal = convert(nodal.T, given, wanted).T
        values = replace(values, coordinate_coefficients=guess.splines.coefficients(nodal))
    muscles = study.walker.muscles
    if guess.muscle_names != muscles.names:
        # Another set of muscles: those that both have keep their forces.
        known = dict(zip(guess.muscle_names, values.force_coefficients, strict=True))
        least = study.muscles.min_force * muscles.f_max
        count = values.force_coefficients.shape[1]
        forces = [
            known.get(name, np.full(count, force))
            for name, force in zip(muscles.names, least, strict=True)
        ]
        values = replace(values, force_coefficients=np.array(forces))
    if guess.study.nodes != nodes:
        samples = np.arange(8 * nodes) / (8 * nodes)
        values = replace(
            values,
            coordinate_coefficients=splines.fit(
                samples, guess.splines.evaluate(values.coordinate_coefficients, samples)
            ),
            force_coefficients=splines.fit(
                samples, guess.splines.evaluate(values.force_coefficients, samples)
            ),
        )
    return values
