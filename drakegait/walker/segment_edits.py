"""Changes of single segments in an SDF text: another length, another mass."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from xml.etree.ElementTree import Element

import numpy as np

from drakegait.errors import InvalidInput
from drakegait.walker.sdf_elements import (
    named_element,
    read_inertial,
    read_numbers,
    read_position,
    write_inertial,
    write_numbers,
)

_DISTAL = {"thigh": "knee_flexion", "shank": "ankle_dorsiflexion"}


def distal_joint(kind: str, side: str) -> str:
    """Joint at the far end of a thigh or shank."""
    return f"{_DISTAL[kind]}_{side}"


class SegmentEdit(ABC):
    """A change of one segment."""

    @abstractmethod
    def apply(self, root: Element) -> None:
        """Change the SDF text in place."""


@dataclass(frozen=True)
class LengthEdit(SegmentEdit):
    """A thigh or shank longer or shorter by `change` [m], of unchanged mass.

    The mass centre keeps its share of the length; the moments of inertia about the transverse
    axes grow with the square of the length, that about the segment's own axis stays.
    """

    segment: str
    change: float

    def apply(self, root: Element) -> None:
        kind, _, side = self.segment.partition("_")
        joint = named_element(root, "joint", distal_joint(kind, side))
        end = read_position(joint)
        length = float(np.linalg.norm(end))
        if not length + self.change > 0.0:
            allowed = f"a change that leaves something of its {length:.3f} m"
            raise InvalidInput(f"length of {self.segment}", self.change, allowed)
        factor = 1.0 + self.change / length
        pose = joint.find("pose")
        write_numbers(pose, [*(factor * end), *read_numbers(pose, 6)[3:]])
        link = named_element(root, "link", self.segment)
        mass, com, inertia = read_inertial(link)
        stretch = np.array([factor, factor, 1.0])
        write_inertial(link, mass, factor * com, inertia * np.outer(stretch, stretch))
        self._draw(link, factor)

    def _draw(self, link: Element, factor: float) -> None:
        """Visual shapes move along; what is long becomes longer."""
        for visual in link.findall("visual"):
            pose = visual.find("pose")
            if pose is not None:
                values = read_numbers(pose, 6)
                values[2] *= factor
                write_numbers(pose, values)
            for shape in visual.iter("length"):
                write_numbers(shape, [max(0.01, read_numbers(shape, 1)[0] + self.change)])


@dataclass(frozen=True)
class MassEdit(SegmentEdit):
    """A segment of other mass, with the radii of gyration that it had.

    Attributes:
        segment: name.
        mass: factor on the mass [-].
        centre: factor on the distance of the mass centre from the proximal joint [-].
    """

    segment: str
    mass: float
    centre: float = 1.0

    def apply(self, root: Element) -> None:
        link = named_element(root, "link", self.segment)
        mass, com, inertia = read_inertial(link)
        write_inertial(link, self.mass * mass, self.centre * com, self.mass * inertia)
