"""Which disorders one walker can have together, and their way back from a file."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import fields, replace
from typing import Any

from drakegait.errors import InvalidInput, UnknownName
from drakegait.walker import coordinates
from drakegait.walker.disorders.base import Disorder
from drakegait.walker.disorders.habits import Asymmetry, Pain
from drakegait.walker.disorders.joints import JointStiffness, LimitedRange, Orthosis
from drakegait.walker.disorders.limbs import LegLength, Prosthesis
from drakegait.walker.disorders.muscles import Contracture, Spasticity, Weakness
from drakegait.walker.muscles import MuscleSet, select

KINDS: dict[str, type[Disorder]] = {
    kind.kind: kind
    for kind in (
        Weakness, Contracture, Spasticity, JointStiffness, LimitedRange, LegLength, Prosthesis,
        Orthosis, Asymmetry, Pain,
    )
}  # fmt: skip
"""Classes of disorders by their name in files."""


def from_plain(plain: Mapping[str, Any]) -> Disorder:
    """Inverse of `to_plain`.

    Raises:
        UnknownName: for a kind of disorder, or a value of it, that does not exist.
    """
    values = dict(plain)
    kind = values.pop("kind", None)
    if kind not in KINDS:
        raise UnknownName("kind of disorder", str(kind), tuple(KINDS))
    known = tuple(item.name for item in fields(KINDS[kind]))  # type: ignore[arg-type]
    for name in values:
        if name not in known:
            raise UnknownName(f"value of {kind}", name, known)
    return KINDS[kind](**values)


def check_disorders(disorders: Sequence[Disorder], kind: str, symmetric: bool) -> None:
    """Refuse disorders that no walker of this skeleton can have together.

    Args:
        kind: `"spatial"` or `"planar"`.
        symmetric: whether the left side mirrors the right.

    Raises:
        InvalidInput, UnknownName: in one sentence.
    """
    joints = [name for name in coordinates.names(kind) if not name.startswith("hat_")]
    taken: dict[tuple, Disorder] = {}
    replaced = {
        joint for item in disorders if isinstance(item, Prosthesis) for joint in item.bare_joints()
    }
    for item in disorders:
        if not isinstance(item, Disorder):
            raise InvalidInput("disorder", item, "one of " + ", ".join(KINDS))
        for side in item.sides:
            key = (item.kind, *item.target, side)
            if key in taken:
                allowed = f"stated once; there is also {taken[key].describe()!r}"
                raise InvalidInput("disorder", item.describe(), allowed)
            taken[key] = item
        for joint in item.named_joints():
            if joint not in joints:
                raise UnknownName(f"joint of a {kind} walker", joint, joints)
            if joint in replaced and not isinstance(item, LimitedRange):
                allowed = "about a joint that no prosthesis replaces"
                raise InvalidInput("disorder", item.describe(), allowed)
    if symmetric:
        _check_symmetric(disorders)


def _check_symmetric(disorders: Sequence[Disorder]) -> None:
    sided = {_of_side(item, side) for item in disorders for side in item.sides}
    for item in disorders:
        alone = any(_of_side(item.mirrored(), side) not in sided for side in item.mirrored().sides)
        if isinstance(item, Asymmetry) or alone:
            raise InvalidInput(
                "disorder", item.describe(),
                "the same on both sides of a symmetric model; take spatial or planar",
            )  # fmt: skip


def _of_side(item: Disorder, side: str) -> Disorder:
    """The part of a disorder that concerns one side."""
    return replace(item, side=side) if hasattr(item, "side") else item  # type: ignore[type-var]


def check_walker(
    disorders: Sequence[Disorder], muscles: MuscleSet, changed: Iterable[str] = ()
) -> None:
    """Refuse disorders, strengths and muscle entries of muscles that the walker does not have.

    Args:
        muscles: those of the unchanged subject.
        changed: muscles or groups with another strength or other entries in the table.

    Raises:
        InvalidInput, UnknownName: in one sentence.
    """
    lost: set[int] = set()
    for item in disorders:
        if isinstance(item, Prosthesis):
            lost |= set(item.removed_muscles(muscles).nonzero()[0].tolist())
    for item in disorders:
        gone = [muscles.names[i] for i in item.named_muscles(muscles) if i in lost]
        if gone:
            allowed = f"about a muscle that is there; the prosthesis has no {gone[0]}"
            raise InvalidInput("disorder", item.describe(), allowed)
    for name in changed:
        stated = set(select(name, muscles.names, muscles.abbreviations))
        if stated and stated <= lost:
            raise InvalidInput(
                "muscle with another strength or entry", name,
                f"one that is there; the prosthesis has no {muscles.names[min(stated)]}",
            )  # fmt: skip
