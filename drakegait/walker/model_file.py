"""SDF text of one walker: the shipped file, scaled to the subject, with masses fixed to it.

The SDF files are written for 1.80 m and 75 kg. Lengths scale with height H,
masses with body mass M, moments of inertia with M H^2. Point masses join the
inertia of their segment by the parallel-axis theorem.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from xml.etree import ElementTree
from xml.etree.ElementTree import Element

import numpy as np

from drakegait.errors import BadFile, InvalidInput
from drakegait.walker.coordinates import names
from drakegait.walker.data_table import read_table
from drakegait.walker.sdf_elements import (
    OWN_MODEL,
    named_element,
    parse_sdf,
    read_inertial,
    read_numbers,
    read_position,
    write_inertial,
    write_numbers,
)
from drakegait.walker.segment_edits import SegmentEdit, distal_joint
from drakegait.walker.subject import SEGMENTS, AddedMass, Segment, Subject

CONTACT_FRAMES = ("heel_r", "toe_r", "heel_l", "toe_l")
"""Frames at the contact points, in the order of all arrays of contact points."""

_LENGTH_TAGS = ("radius", "length", "size", "radii", "scale")


def sdf_path(skeleton: str) -> Path:
    """Path of the shipped SDF file, in an installed package or in a source checkout.

    Raises:
        UnknownName: if the skeleton is neither `"spatial"` nor `"planar"`.
        BadFile: if the installation lacks the file.
    """
    names(skeleton)  # refuses unknown skeletons
    package = Path(__file__).resolve().parents[1]
    paths = [folder / "sdf" / f"human_{skeleton}.sdf" for folder in (package, package.parent)]
    for path in paths:
        if path.is_file():
            return path
    raise BadFile(paths[0], "the file is missing; reinstall drakegait.")


def model_sdf(
    skeleton: str,
    subject: Subject,
    added_masses: Sequence[AddedMass] = (),
    text: str | None = None,
    edits: Sequence[SegmentEdit] = (),
) -> str:
    """SDF text of the subject's walker.

    Args:
        skeleton: `"spatial"` or `"planar"`.
        subject: height, mass and anthropometry set.
        added_masses: point masses fixed to segments; they are not scaled.
        text: SDF text of your own, written for 1.80 m and 75 kg, instead of the shipped file. It
            needs a joint named like each coordinate, a link for each segment and the frames
            heel_r, toe_r, heel_l, toe_l.
        edits: what makes single segments differ, after scaling and before masses are added.

    Raises:
        BadFile: if the text is not SDF or lacks a joint, link or frame, which it names.
        InvalidInput: for another anthropometry set than the default together with your own text.
    """
    if text is None:
        path = sdf_path(skeleton)
        root = parse_sdf(path.read_text(encoding="utf-8"), path)
    else:
        if subject.anthropometry != "default":
            allowed = "'default' when you bring an SDF model of your own"
            raise InvalidInput("anthropometry", subject.anthropometry, allowed)
        path = OWN_MODEL
        root = parse_sdf(text, path)
    for tag, wanted in (
        ("joint", names(skeleton)),
        ("link", SEGMENTS),
        ("frame", CONTACT_FRAMES),
    ):
        for name in wanted:
            named_element(root, tag, name, path)
    _apply_anthropometry(root, subject.anthropometry)
    _scale(root, subject.length_scale, subject.mass_scale)
    for edit in edits:
        edit.apply(root)
    _add_point_masses(root, added_masses)
    return ElementTree.tostring(root, encoding="unicode")


def read_segments(text: str) -> dict[str, Segment]:
    """Mass properties of the seven segments in an SDF text, by name.

    Lengths are those between hip and shoulders, hip and knee, knee and ankle, heel and toe tip;
    they are read from the joints of knee and ankle and the frames `shoulders` and `toe_tip_*`.

    Raises:
        BadFile: if the text is not SDF, or lacks a link, joint or frame that is needed.
    """
    root = parse_sdf(text, OWN_MODEL)
    segments = {}
    for name in SEGMENTS:
        mass, com, inertia = read_inertial(named_element(root, "link", name))
        kind, _, side = name.partition("_")
        if kind == "hat":
            ends = np.zeros(3), read_position(named_element(root, "frame", "shoulders"))
        elif kind == "foot":
            ends = tuple(
                read_position(named_element(root, "frame", f"{end}_{side}"))
                for end in ("heel", "toe_tip")
            )
        else:
            far = named_element(root, "joint", distal_joint(kind, side))
            ends = np.zeros(3), read_position(far)
        length = float(np.linalg.norm(ends[1] - ends[0]))
        segments[name] = Segment(mass=mass, length=length, com=com, inertia=inertia)
    return segments


def _apply_anthropometry(root: Element, name: str) -> None:
    """Replace the values of the SDF file by those of the set `name`, where it has its own."""
    for row in (row for row in read_table("anthropometry") if row["set"] == name):
        kind = row["segment"]
        value = {key: float(row[key]) for key in row if key not in ("set", "segment")}
        com = np.array([value["com_x_m"], value["com_y_m"], value["com_z_m"]])
        inertia = np.diag([value["ixx_kgm2"], value["iyy_kgm2"], value["izz_kgm2"]])
        for segment in (s for s in SEGMENTS if s.partition("_")[0] == kind):
            side = segment.partition("_")[2]
            write_inertial(named_element(root, "link", segment), value["mass_kg"], com, inertia)
            length = value["length_m"]
            if kind in ("thigh", "shank"):
                pose = named_element(root, "joint", distal_joint(kind, side)).find("pose")
                write_numbers(pose, [0.0, 0.0, -length, 0.0, 0.0, 0.0])
            elif kind == "foot":
                heel = read_position(named_element(root, "frame", f"heel_{side}"))
                pose = named_element(root, "frame", f"toe_tip_{side}").find("pose")
                write_numbers(pose, [heel[0] + length, *heel[1:], 0.0, 0.0, 0.0])


def _scale(root: Element, length: float, mass: float) -> None:
    if length == 1.0 and mass == 1.0:
        return
    for pose in root.iter("pose"):
        values = read_numbers(pose, 6)
        write_numbers(pose, [*(values[:3] * length), *values[3:]])
    for tag in _LENGTH_TAGS:
        for element in root.iter(tag):
            write_numbers(element, read_numbers(element, 1) * length)
    for element in root.iter("mass"):
        write_numbers(element, read_numbers(element, 1) * mass)
    for matrix in root.iter("inertia"):
        for moment in matrix:
            write_numbers(moment, read_numbers(moment, 1) * mass * length**2)


def _add_point_masses(root: Element, added_masses: Sequence[AddedMass]) -> None:
    # The default point is the mass centre of the segment alone, also for the second mass on it.
    points = [
        np.array(added.point)
        if added.point is not None
        else read_inertial(named_element(root, "link", added.segment))[1]
        for added in added_masses
    ]
    for added, point in zip(added_masses, points, strict=True):
        link = named_element(root, "link", added.segment)
        mass, com, inertia = read_inertial(link)
        total = mass + added.mass
        arm = point - com
        # Two bodies about their common mass centre: I + (m1 m2 / (m1 + m2)) (|d|^2 1 - d d^T).
        inertia = inertia + mass * added.mass / total * (arm @ arm * np.eye(3) - np.outer(arm, arm))
        write_inertial(link, total, com + added.mass / total * arm, inertia)
