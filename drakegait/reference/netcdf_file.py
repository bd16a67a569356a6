"""References as netCDF: a group of `gait.nc`, and `subject.nc`, a person's imported walk.

`subject.nc` holds a reference for each skeleton in groups of that name, and in the attributes of
the root the person's height and mass and what the import says about its quality, as JSON.
"""

from __future__ import annotations

import dataclasses
import json
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from drakegait.errors import BadFile, DrakegaitError, UnknownName
from drakegait.labelled_arrays import ROOT, LabelledArrays, write_netcdf
from drakegait.reference.curves import SampledCurves, SplineCurves
from drakegait.reference.deviation import DeviationSettings
from drakegait.transcription.foot_placement import FootPlacement
from drakegait.transcription.splines import PeriodicQuintic
from drakegait.walker.subject import Subject

if TYPE_CHECKING:
    from drakegait.reference.reference import Reference

FORMAT = "drakegait reference"
FORMAT_VERSION = 1
# Dense enough that a fitted spline is the same curve for every purpose (errors < 1e-7 rad).
_NODES = 201
_FORCE_INTERVALS = 1200  # a multiple of the usual tables' 50, 100, 200: then exact


def reference_arrays(reference: Reference) -> LabelledArrays:
    """A reference as arrays and facts."""
    motion = reference.motion
    if isinstance(motion, SplineCurves):
        coefficients = motion.coefficients
    else:
        spline = PeriodicQuintic(_NODES)
        coefficients = spline.coefficients(reference.coordinate_values(spline.node_times).T)
    arrays = {"coefficients": (("coordinate", "coefficient"), coefficients, {})}
    if reference.forces is not None:
        tau = np.linspace(0.0, 1.0, _FORCE_INTERVALS + 1)
        forces = reference.ground_reactions(tau).reshape(len(tau), 6)
        arrays["forces"] = (("instant", "force"), forces, {})
    facts = {
        "kind": reference.kind,
        "name": reference.name,
        "stride_time": reference.stride_time,
        "phase_fractions": list(reference.phase_fractions),
        "foot_placement": dataclasses.asdict(reference.foot_placement),
        "deviation": reference.deviation.to_dict(),
    }
    return LabelledArrays(arrays, attributes={"facts": _text(facts)})


def reference_of(arrays: dict[str, np.ndarray], attributes: dict[str, Any]) -> Reference:
    """The inverse of `reference_arrays`.

    Raises:
        KeyError, TypeError, ValueError, DrakegaitError: the arrays or facts are damaged.
    """
    from drakegait.reference.reference import Reference  # it imports this file

    facts = json.loads(attributes["facts"])
    coefficients = arrays["coefficients"]
    forces = arrays.get("forces")
    if not np.isfinite(coefficients).all() or (
        forces is not None and not np.isfinite(forces).all()
    ):
        raise ValueError("numbers that are not finite")
    if forces is not None:
        forces = np.vstack([forces[:-1], forces[:1]])  # the ends agree but for rounding
        forces = SampledCurves(np.linspace(0.0, 1.0, len(forces)), forces)
    return Reference(
        kind=facts["kind"],
        name=facts["name"],
        stride_time=facts["stride_time"],
        phase_fractions=tuple(facts["phase_fractions"]),
        foot_placement=FootPlacement(**facts["foot_placement"]),
        motion=SplineCurves(PeriodicQuintic(coefficients.shape[1] + 1), coefficients),
        forces=forces,
        deviation=DeviationSettings(**facts["deviation"]),
    )


def write_subject(
    path: str | Path, references: Sequence[Reference], subject: Subject | None, quality: Any = None
) -> None:
    """Write references of one person, beside the place first and renamed when complete.

    Args:
        references: at most one of each kind.
        subject: the person, if known.
        quality: plain types, kept for the reader.

    Raises:
        BadFile: the file cannot be written.
    """
    attributes = {
        "title": references[0].name,
        "format": FORMAT,
        "format_version": FORMAT_VERSION,
        "subject": _text(None if subject is None else subject.to_dict()),
        "quality": _text(quality),
    }
    groups = {reference.kind: reference_arrays(reference) for reference in references}
    write_netcdf(path, {ROOT: LabelledArrays(attributes=attributes), **groups})


def read_reference(path: str | Path, kind: str | None = None) -> Reference:
    """The reference of a kind (default: the only one, or the spatial one).

    Raises:
        BadFile: missing, damaged, foreign, or of another version.
        UnknownName: the file has no reference of this kind.
    """
    with _open(path) as file:
        kinds = [name for name in ("spatial", "planar") if name in file.groups]
        if kind is not None and kind not in kinds:
            raise UnknownName(f"reference in {path}", kind, kinds)
        try:
            group = file.groups[kind or kinds[0]]
            arrays = {name: np.array(x[...]) for name, x in group.variables.items()}
            return reference_of(arrays, dict(group.attrs))
        except (DrakegaitError, KeyError, IndexError, TypeError, ValueError) as error:
            raise BadFile(path, f"is damaged: {error}") from None


def read_subject(path: str | Path) -> Subject | None:
    """The person of a reference file, if it names one; raises BadFile."""
    with _open(path) as file:
        try:
            plain = json.loads(file.attrs["subject"])
            return None if plain is None else Subject(**plain)
        except (DrakegaitError, KeyError, TypeError, ValueError) as error:
            raise BadFile(path, f"is damaged: {error}") from None


def is_netcdf(path: str | Path) -> bool:
    """Whether a file is to be read as netCDF: by its suffix."""
    return Path(path).suffix.lower() in (".nc", ".nc4", ".netcdf")


def _open(path: str | Path):
    import h5netcdf

    path = Path(path)
    if not path.is_file():
        raise BadFile(path, "is a folder." if path.is_dir() else "does not exist.")
    try:
        file = h5netcdf.File(path, "r")
    except Exception:  # noqa: BLE001 - h5py raises almost anything on a damaged file
        raise BadFile(path, "cannot be read: damaged, or not a netCDF file.") from None
    found, version = file.attrs.get("format"), file.attrs.get("format_version")
    if found != FORMAT or version != FORMAT_VERSION:
        file.close()
        problem = f"has format {version}, but this drakegait reads {FORMAT_VERSION}."
        if found != FORMAT:
            problem = "is a netCDF file, but not a reference of drakegait (`drakegait import`)."
        raise BadFile(path, problem)
    return file


def _text(plain: Any) -> str:
    return json.dumps(plain, default=lambda number: number.item())
