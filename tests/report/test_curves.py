"""Signs of curves, and the scales on which they are drawn."""

import numpy as np
from gait_cases import reference_gait

from drakegait.report import style
from drakegait.report.comparison_figures import trunk_figure
from drakegait.report.curves import GaitCurves


def test_a_moment_that_turns_the_toes_inward_is_positive_for_both_feet():
    """About the vertical, up: that of the right foot to the left, that of the left to the right."""
    curves = GaitCurves(reference_gait("spatial"))
    for side, inward in (("right", 1.0), ("left", -1.0)):
        turning = 1.0 + np.arange(curves.samples)
        curves.data.free_moment.loc[{"foot": side}] = turning
        np.testing.assert_array_equal(curves.free_moment(side), inward * turning)


def test_small_angles_of_the_trunk_are_not_magnified():
    """A panel of a comparison covers 8 degrees at least, about its curves."""
    with style.look():
        figure = trunk_figure([GaitCurves(reference_gait("spatial"))])
    panels = [axes for axes in figure.axes if axes.lines]
    assert len(panels) == 3
    for axes in panels:
        low, high = axes.get_ylim()
        assert high - low >= 8.0 - 1e-9
        curves = np.concatenate([x.get_ydata() for x in axes.lines if len(x.get_ydata()) > 9])
        assert low <= curves.min() and curves.max() <= high
