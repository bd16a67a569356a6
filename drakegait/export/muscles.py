"""The muscles as forces of OpenSim, on paths whose moment arms are ours exactly.

A path is a `FunctionBasedPath` (OpenSim 4.5) with the linear length l = l0 - sum(arm coordinate).

`"degroote_fregly"` writes OpenSim's muscle with our strength, lengths and pennation; its curves are
OpenSim's (De Groote et al. 2016) and differ from ours (docs/formulation.md 2):

- pennation: constant thickness of the belly, as ours (also where a study says `constant_angle`);
- tendon: an exponential with our strain at f_max, where ours is a parabola rounded at zero;
- force-length: three bells, `active_force_width_scale` fitted to our parabola of half width w;
- force-velocity: a logarithm with our v_max = B/A, ours are hyperbolas with plateau `f_asympt`;
- activation: a' = (u - a)/(t_a (0.5 + 1.5 a)) rising, (u - a) (0.5 + 1.5 a)/t_d falling, blended by
  a tanh, with our t_a and t_d, where ours is (u - a)(t1 u + t2);
- no passive force of the fibres (our option `parallel_element = quadratic` is left out).

`"actuators"` writes ideal `PathActuator`s: tension = f_max * control, control 0 to 1.5 (1.5 is our
bound for lengthening fibres). With control = force/f_max they reproduce our joint torques exactly.
"""

from __future__ import annotations

from collections.abc import Mapping
from xml.etree.ElementTree import Element

import numpy as np

from drakegait.errors import UnknownName
from drakegait.export.xml_text import add
from drakegait.walker import coordinates
from drakegait.walker.walker import Walker

KINDS = ("degroote_fregly", "actuators", "none")
"""How muscles can be written."""

HIGHEST_CONTROL = 1.5
_LEAST_WIDTH, _MOST_WIDTH = 1.0, 6.0
# De Groote et al. 2016, appendix: rows b1, b2, b3, b4 of each bell
# b1 exp(-0.5 (l - b2)^2 / (b3 + b4 l)^2), as in OpenSim's DeGrooteFregly2016Muscle.
_BELLS = (
    (0.8150671134243542, 1.055033428970575, 0.162384573599574, 0.063303448465465),
    (0.433004984392647, 0.716775413397760, -0.029947116970696, 0.200356847296188),
    (0.1, 1.0, 0.353553390593274, 0.0),
)


def add_muscles(forces: Element, walker: Walker, kind: str, paths: Mapping[str, str]) -> None:
    """Append all muscles to a set of forces.

    Args:
        forces: the element `objects` of the model's ForceSet.
        kind: one of `KINDS`.
        paths: OpenSim's path of each coordinate, by our name.

    Raises:
        UnknownName: for another kind.
    """
    if kind not in KINDS:
        raise UnknownName("kind of muscles", kind, KINDS)
    if kind == "none":
        return
    muscles, constants = walker.muscles, walker.muscle_functions.constants
    settings = walker.muscle_functions.settings
    signs = coordinates.anatomical_signs(walker.skeleton.kind)
    for i, name in enumerate(muscles.names):
        tag = "PathActuator" if kind == "actuators" else "DeGrooteFregly2016Muscle"
        force = add(forces, tag, name=name)
        least = 0.0 if kind == "actuators" else walker.lowest_excitation[i]
        add(force, "min_control", least)
        add(force, "max_control", HIGHEST_CONTROL if kind == "actuators" else 1.0)
        slopes = {
            paths[coordinate]: -sign * arm
            for coordinate, sign, arm in zip(
                walker.coordinate_names, signs, muscles.moment_arms[i], strict=True
            )
            if arm
        }
        path = add_path(force, slopes)
        function = add(add(path, "length_function"), "LinearFunction")
        add(function, "coefficients", [*slopes.values(), muscles.l0[i]])
        if kind == "actuators":
            add(force, "optimal_force", muscles.f_max[i])
            continue
        half_width = (-constants.curvature[i]) ** -0.5
        for tag, value in (
            ("max_isometric_force", muscles.f_max[i]),
            ("optimal_fiber_length", muscles.l_opt[i]),
            ("tendon_slack_length", muscles.l_slack[i]),
            ("pennation_angle_at_optimal", muscles.pennation[i]),
            ("max_contraction_velocity", constants.b_rel[i] / constants.a_rel[i]),
            ("activation_time_constant", constants.time_activation[i]),
            ("deactivation_time_constant", constants.time_deactivation[i]),
            ("default_activation", 0.05),
            ("active_force_width_scale", width_scale(half_width)),
            ("fiber_damping", 0.0),
            ("tendon_strain_at_one_norm_force", settings.tendon_strain),
            ("ignore_passive_fiber_force", True),
            ("tendon_compliance_dynamics_mode", "implicit"),
        ):
            add(force, tag, value)


def add_path(force: Element, coordinate_paths: Mapping[str, object]) -> Element:
    """A path along the coordinates; the caller adds its functions."""
    path = add(force, "FunctionBasedPath", name="path")
    add(path, "coordinate_paths", list(coordinate_paths))
    return path


def width_scale(half_width: float) -> float:
    """The `active_force_width_scale` that comes closest to our parabola, 1 to 6.

    Least squares of the active force over fibre lengths of 0.5 to 1.5.
    """
    length = np.linspace(0.5, 1.5, 101)
    ours = np.maximum(1.0 - ((length - 1.0) / half_width) ** 2, 0.0)
    scales = np.linspace(_LEAST_WIDTH, _MOST_WIDTH, 1001)
    error = [np.sum((active_force(length, scale) - ours) ** 2) for scale in scales]
    return float(scales[int(np.argmin(error))])


def active_force(length: np.ndarray, scale: float) -> np.ndarray:
    """Active force-length curve of De Groote et al. (2016) at normalised fibre lengths."""
    x = (length - 1.0) / scale + 1.0
    return sum(b1 * np.exp(-0.5 * ((x - b2) / (b3 + b4 * x)) ** 2) for b1, b2, b3, b4 in _BELLS)
