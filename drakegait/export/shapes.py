"""The pictures of the segments, from the visuals of the SDF text to OpenSim's geometry."""

from __future__ import annotations

from xml.etree import ElementTree
from xml.etree.ElementTree import Element

import numpy as np
from scipy.spatial.transform import Rotation

from drakegait.export.bodies import Part
from drakegait.export.xml_text import add
from drakegait.walker.coordinates import TO_OPENSIM

_PLAIN = (0.7, 0.7, 0.7)


def add_shapes(body: Element, part: Part, sdf: str) -> None:
    """Append the visuals of one link to a body; shapes unknown to OpenSim are left out.

    Limbs, which are capsules, become ellipsoids of the same length and width.

    Args:
        body: the body's element, without `components`.
        sdf: text of the model.
    """
    link = ElementTree.fromstring(sdf).find(f"model/link[@name='{part.name}']")
    visuals = [] if link is None else link.findall("visual")
    components = add(body, "components") if visuals else None
    for visual in visuals:
        geometry = _geometry(visual)
        if geometry is None:
            continue
        tag, sizes = geometry
        pose = _numbers(visual.find("pose"), np.zeros(6))
        # An SDF pose turns about fixed axes x, y, z; OpenSim's angles are about moving ones.
        turn = part.link_rotation @ Rotation.from_euler("xyz", pose[3:]).as_matrix() @ TO_OPENSIM.T
        frame = add(components, "PhysicalOffsetFrame", name=f"{visual.get('name')}_frame")
        shape = add(add(frame, "attached_geometry"), tag, name=visual.get("name"))
        add(shape, "socket_frame", "..")
        color = _numbers(visual.find("material/diffuse"), np.array(_PLAIN))
        add(add(shape, "Appearance"), "color", color[:3])
        for name, value in sizes.items():
            add(shape, name, value)
        add(frame, "socket_parent", "..")
        add(frame, "translation", part.link_place + part.link_rotation @ pose[:3])
        add(frame, "orientation", Rotation.from_matrix(turn).as_euler("XYZ"))


def _geometry(visual: Element) -> tuple[str, dict[str, object]] | None:
    """OpenSim's shape and its sizes, with y where SDF has z and z where SDF has y."""
    item = next(iter(visual.find("geometry")), None)
    if item is None:
        return None
    size = {child.tag: _numbers(child, np.zeros(1)) for child in item}
    radius, length = (float(size.get(tag, [0.0])[0]) for tag in ("radius", "length"))
    if item.tag == "sphere":
        return "Sphere", {"radius": radius}
    if item.tag == "cylinder":
        return "Cylinder", {"radius": radius, "half_height": 0.5 * length}
    if item.tag == "capsule":
        return "Ellipsoid", {"radii": [radius, 0.5 * length + radius, radius]}
    if item.tag == "ellipsoid":
        return "Ellipsoid", {"radii": size["radii"][[0, 2, 1]]}
    if item.tag == "box":
        return "Brick", {"half_lengths": 0.5 * size["size"][[0, 2, 1]]}
    return None


def _numbers(element: Element | None, default: np.ndarray) -> np.ndarray:
    if element is None or not (element.text or "").strip():
        return default
    return np.array([float(word) for word in element.text.split()])
