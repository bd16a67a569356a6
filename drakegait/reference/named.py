"""A reference as users name it: one of the embedded gaits, or a file."""

from __future__ import annotations

from pathlib import Path

from drakegait.errors import UnknownName
from drakegait.reference.embedded import GAITS
from drakegait.reference.netcdf_file import is_netcdf, read_subject
from drakegait.reference.reference import Reference
from drakegait.walker.subject import Subject


def named_reference(
    given: str,
    kind: str,
    subject: Subject,
    *,
    option: str = "reference",
    folder: Path | None = None,
) -> Reference:
    """The embedded reference, or that of the file, that is called `given`.

    Args:
        given: a name without suffix that is no file, or a path.
        kind: `"spatial"` or `"planar"`.
        subject: to whose size an embedded gait is scaled, and who is in a table.
        option: what a refusal calls the statement.
        folder: against which paths are resolved; default the working directory.

    Raises:
        UnknownName, BadFile: there is none.
    """
    path = (folder or Path()) / given
    if given in GAITS or not (path.suffix or path.exists()):
        try:
            return Reference.embedded(kind, subject, given)
        except UnknownName as error:
            raise UnknownName(option, given, (*error.known, "or the path of a file")) from None
    if is_netcdf(path):
        return Reference.load(path, kind)
    return Reference.from_table(path, kind=kind, subject=subject)


def measured_person(path: str | Path, kind: str) -> tuple[Subject | None, float] | None:
    """Whose walk an imported reference is, if it says so, and its speed [m/s].

    None for anything but the file of an imported reference.
    """
    if not is_netcdf(path):
        return None
    return read_subject(path), round(Reference.load(path, kind).speed, 3)
