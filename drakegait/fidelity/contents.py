"""All sections, in the order of the page."""

from __future__ import annotations

from drakegait.fidelity import cost, timing, walking, worn

SECTIONS = (walking.SECTION, timing.SECTION, cost.SECTION, worn.SECTION)
