"""Small helpers that write OpenSim's XML."""

from __future__ import annotations

from collections.abc import Iterable
from xml.etree import ElementTree
from xml.etree.ElementTree import Element, SubElement

DOCUMENT_VERSION = "40500"
"""Version of OpenSim's file format: the first with `FunctionBasedPath`, OpenSim 4.5."""


def document() -> Element:
    """The root of a file that OpenSim 4.5 and later read."""
    return Element("OpenSimDocument", Version=DOCUMENT_VERSION)


def add(parent: Element, tag: str, value: object = None, name: str | None = None) -> Element:
    """A new element with a text (number, flag, words or text) and perhaps a name."""
    child = SubElement(parent, tag) if name is None else SubElement(parent, tag, name=name)
    if value is not None:
        child.text = text(value)
    return child


def text(value: object) -> str:
    """How OpenSim spells a value; floats keep all digits."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        return value
    if isinstance(value, Iterable):
        return " ".join(text(item) for item in value)
    if isinstance(value, int):
        return str(value)
    return repr(float(value) + 0.0)  # no -0.0


def written(root: Element) -> str:
    """The file's text."""
    ElementTree.indent(root, "\t")
    return ElementTree.tostring(root, encoding="unicode", xml_declaration=True) + "\n"
