"""Measured walking: the embedded gaits, tables of the user, deviation from them."""

from drakegait.reference.reference import DeviationSettings, Reference

__all__ = ["DeviationSettings", "Reference"]
