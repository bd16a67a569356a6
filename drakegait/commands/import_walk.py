"""`drakegait import`: a person's measured walk becomes the reference of a study."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from drakegait.commands.gait_files import output_file
from drakegait.commands.screen import console
from drakegait.errors import BadFile, DrakegaitError, InvalidInput
from drakegait.measured.imported import ImportedWalk, quality_path
from drakegait.measured.walk import import_walk
from drakegait.reference.reference import Reference

_SIDE = "PLATE=SIDE with side right or left, for example 'plate 1=right'"


def import_files(
    motion: str, forces: str, out: str, sides: Sequence[str] | None, **options: object
) -> None:
    """Import, save, and say what was found.

    Raises:
        BadFile, InvalidInput, UnknownName: in one sentence, what cannot be used.
    """
    target = output_file("--output", out, ".nc")
    if target.exists():
        _check_reference(target)
    if not target.parent.is_dir():
        raise BadFile(target.parent, "does not exist; make the folder first.")
    walk = import_walk(motion, forces, sides=dict(_side(text) for text in sides or ()), **options)
    walk.save(target)
    _print(walk, target)


def _check_reference(path: Path) -> None:
    """Refuse to replace what is no reference, such as a gait."""
    try:
        Reference.load(path)
    except DrakegaitError:
        raise BadFile(path, "is there and holds no imported walk; name another file.") from None


def _side(text: str) -> tuple[str, str]:
    name, equals, side = (part.strip() for part in text.partition("="))
    if not equals or not name or side.lower() not in ("right", "left", "r", "l"):
        raise InvalidInput("--side", text, _SIDE)
    return name, side.lower()[0]


def _print(walk: ImportedWalk, target: Path) -> None:
    screen = console()
    lines = [f"{name}: {text}" for name, text in walk.quality.facts.items()]
    lines += [f"Note: {sentence}" for sentence in walk.warnings]
    before = max(row["before_mm"] for row in walk.quality.contacts)
    after = max(row["after_mm"] for row in walk.quality.contacts)
    lines.append(
        f"Feet on their prints: worst phase {before:.1f} mm before, {after:.1f} mm after the fit."
    )
    lines.append(f"Files: {target}, {quality_path(target)}. Look at the page before you go on.")
    lines.append(
        f"Next: drakegait walk --reference {target}, and for a comparison for example "
        "--added-mass foot_r=2 --compare"
    )
    for line in lines:
        screen.print(line, markup=False, soft_wrap=True)
