"""The passive joint moments as forces of OpenSim, exactly.

Each is a sum of exponentials of linear functions of angles, sign exp(c + w . q), plus a constant,
springs and damping. What depends on the joint's own angle becomes one
`ExpressionBasedCoordinateForce`. A term of a muscle that spans several joints becomes a
`PathSpring` of 1 N/m whose "length" is the exponential and whose moment arms are given apart from
it: its weight on the joint on which the term acts, 0 on the others, so that arm times "tension" is
the moment. (Such moments have no potential; a spring whose arms were the derivatives of its length
could not make them.)
"""

from __future__ import annotations

from collections.abc import Mapping
from xml.etree.ElementTree import Element

import numpy as np

from drakegait.export.muscles import add_path
from drakegait.export.xml_text import add, text
from drakegait.walker import coordinates
from drakegait.walker.joint_springs import ROUNDING, JointSpring
from drakegait.walker.passive_joints import MAX_EXPONENT
from drakegait.walker.walker import Walker


def add_passive_moments(forces: Element, walker: Walker, paths: Mapping[str, str]) -> None:
    """Append the passive moments of all joints to a set of forces.

    Args:
        forces: the element `objects` of the model's ForceSet.
        paths: OpenSim's path of each coordinate, by our name.
    """
    names, passive = walker.coordinate_names, walker.passive.constants
    flip = coordinates.anatomical_signs(walker.skeleton.kind)
    slopes, signs = passive["slopes"] * flip, passive["signs"] * flip
    for j, name in enumerate(names):
        own: list[str] = []
        for row in np.flatnonzero(signs[:, j]):
            across = np.flatnonzero(slopes[row])
            factor, offset = signs[row, j], passive["offsets"][row]
            if list(across) == [j]:
                own.append(_term(factor, offset, {"q": slopes[row, j]}))
            else:
                exponents = {names[i]: slopes[row, i] for i in across}
                title = f"passive_{name}_{row}"
                _add_coupled(forces, title, name, factor, offset, exponents, paths)
        constant, damping = flip[j] * passive["constant"][j], passive["damping"][j]
        own += [text(constant)] if constant else []
        own += [f"-{text(damping)}*qdot"] if damping else []
        own += [_spring(spring) for spring in walker.passive.springs if spring.coordinate == name]
        if own:
            force = add(forces, "ExpressionBasedCoordinateForce", name=f"passive_{name}")
            add(force, "coordinate", name)
            add(force, "expression", _sum(own))


def _add_coupled(
    forces: Element, title: str, name: str, factor: float, offset: float,
    slopes: Mapping[str, float], paths: Mapping[str, str],
) -> None:  # fmt: skip
    along = [*slopes, *([] if name in slopes else [name])]
    force = add(forces, "PathSpring", name=title)
    path = add_path(force, {paths[each]: None for each in along})
    length = add(add(path, "length_function"), "ExpressionBasedFunction")
    add(length, "expression", _term(1.0, offset, slopes))
    add(length, "variables", along)
    arms = add(path, "moment_arm_functions")
    for each in along:
        function = add(arms, "LinearFunction")
        add(function, "coefficients", [0.0] * len(along) + [factor if each == name else 0.0])
    add(force, "resting_length", 0.0)
    add(force, "stiffness", 1.0)
    add(force, "dissipation", 0.0)


def _term(factor: float, offset: float, slopes: Mapping[str, float]) -> str:
    """factor exp(offset + sum slope name), its tangent above MAX_EXPONENT."""
    exponent = _sum([text(offset), *(f"{text(slope)}*{name}" for name, slope in slopes.items())])
    limit = text(MAX_EXPONENT)
    front = "" if factor == 1.0 else f"{text(factor)}*"
    return f"{front}exp(min({exponent},{limit}))*(1+max({exponent}-{limit},0))"


def _spring(spring: JointSpring) -> str:
    """Elastic moment of `drakegait.walker.joint_springs` in the anatomical sense."""
    beyond, width = f"(q-{_braced(spring.neutral)})", text(ROUNDING)
    rounded = f"0.5*({beyond}+sqrt({beyond}*{beyond}+{width}*{width})-{width})"
    rise = _braced(spring.above - spring.below)
    return f"-({text(spring.below)}*{beyond}+{rise}*{rounded})"


def _braced(number: float) -> str:
    return f"({text(number)})"


def _sum(terms: list[str]) -> str:
    """Terms joined by + or by their own minus."""
    return "".join(
        item if i == 0 or item.startswith("-") else f"+{item}" for i, item in enumerate(terms)
    )
