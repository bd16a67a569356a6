"""Reading and writing the elements of an SDF text that describe segments."""

from __future__ import annotations

from collections.abc import Sequence
from xml.etree import ElementTree
from xml.etree.ElementTree import Element

import numpy as np

from drakegait.errors import BadFile

OWN_MODEL = "your SDF model"
"""How messages name a text that came from no file of ours."""

_MOMENTS = {
    "ixx": (0, 0),
    "iyy": (1, 1),
    "izz": (2, 2),
    "ixy": (0, 1),
    "ixz": (0, 2),
    "iyz": (1, 2),
}


def parse_sdf(text: str, path: object) -> Element:
    """The root element of an SDF text; raises BadFile where there is none."""
    try:
        root = ElementTree.fromstring(text)
    except ElementTree.ParseError as error:
        raise BadFile(path, f"not a readable SDF text ({error}).") from None
    if root.tag != "sdf" or root.find("model") is None:
        raise BadFile(path, "not an SDF text with a model in it.")
    return root


def named_element(root: Element, tag: str, name: str, path: object = OWN_MODEL) -> Element:
    """The joint, link or frame called `name`; raises BadFile where there is none."""
    found = root.find(f"model/{tag}[@name='{name}']")
    if found is None:
        raise BadFile(path, f"the model has no {tag} named {name!r}.")
    return found


def read_numbers(element: Element | None, count: int) -> np.ndarray:
    """Numbers in the text of `element`, `count` zeros if it has none."""
    words = (element.text or "").split() if element is not None else []
    try:
        values = np.array([float(word) for word in words]) if words else np.zeros(count)
    except ValueError:
        values = np.full(1, np.nan)
    if not np.all(np.isfinite(values)):
        raise BadFile(OWN_MODEL, f"{element.tag} holds {element.text!r}, not numbers.")
    return values


def write_numbers(element: Element, values: Sequence[float]) -> None:
    """Replace the text of `element`, with all digits."""
    element.text = " ".join(repr(float(value)) for value in values)


def read_position(element: Element) -> np.ndarray:
    """Position (3,) [m] in the pose of `element`."""
    return read_numbers(element.find("pose"), 6)[:3]


def _rotation(roll: float, pitch: float, yaw: float) -> np.ndarray:
    """R_z(yaw) R_y(pitch) R_x(roll), the meaning of the angles of an SDF pose."""
    (sr, sp, sy), (cr, cp, cy) = np.sin([roll, pitch, yaw]), np.cos([roll, pitch, yaw])
    about_x = np.array([[1, 0, 0], [0, cr, -sr], [0, sr, cr]])
    about_y = np.array([[cp, 0, sp], [0, 1, 0], [-sp, 0, cp]])
    about_z = np.array([[cy, -sy, 0], [sy, cy, 0], [0, 0, 1]])
    return about_z @ about_y @ about_x


def read_inertial(link: Element) -> tuple[float, np.ndarray, np.ndarray]:
    """Mass [kg], mass centre (3,) [m] and inertia (3, 3) about it [kg m^2], in the link's axes."""
    block = link.find("inertial")
    if block is None or block.find("mass") is None or block.find("inertia") is None:
        raise BadFile(OWN_MODEL, f"link {link.get('name')!r} has no mass or inertia.")
    pose = read_numbers(block.find("pose"), 6)
    inertia = np.zeros((3, 3))
    for tag, (i, j) in _MOMENTS.items():
        inertia[i, j] = inertia[j, i] = read_numbers(block.find(f"inertia/{tag}"), 1)[0]
    turn = _rotation(*pose[3:])
    return float(read_numbers(block.find("mass"), 1)[0]), pose[:3], turn @ inertia @ turn.T


def write_inertial(link: Element, mass: float, com: np.ndarray, inertia: np.ndarray) -> None:
    """Replace what `read_inertial` reads, in the link's own axes."""
    block = link.find("inertial")
    block.clear()
    write_numbers(ElementTree.SubElement(block, "pose"), [*com, 0.0, 0.0, 0.0])
    write_numbers(ElementTree.SubElement(block, "mass"), [mass])
    matrix = ElementTree.SubElement(block, "inertia")
    for tag, (i, j) in _MOMENTS.items():
        write_numbers(ElementTree.SubElement(matrix, tag), [inertia[i, j]])
