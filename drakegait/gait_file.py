"""`gait.nc`: a gait as a netCDF file that stands alone.

The root holds the sampled arrays with their units, for any program that reads netCDF (open it
with `xarray.open_dataset`), and the study, the outcome and the check as JSON in its attributes.
The group `design` holds the unknowns from which everything is computed anew on loading, the group
`kkt` the multipliers of an optimum in the solver's scaled variables and rows; the group `reference`
the walk to compare with, if it is not the embedded one.
"""

from __future__ import annotations

import dataclasses
import json
from pathlib import Path
from typing import Any

import numpy as np

from drakegait.check import CheckReport
from drakegait.errors import BadFile, DrakegaitError
from drakegait.gait import Gait
from drakegait.labelled_arrays import ROOT, LabelledArrays, write_netcdf
from drakegait.program.kkt import KktMultipliers
from drakegait.reference.netcdf_file import reference_arrays, reference_of
from drakegait.sampling import sample
from drakegait.solvers.outcome import Outcome, StartRecord
from drakegait.study import GaitStudy
from drakegait.summary import versions
from drakegait.transcription.design_vector import DesignValues

FORMAT = "drakegait gait"
FORMAT_VERSION = 1
_DESIGN_DIMS = {
    "coordinate_coefficients": ("coordinate", "coefficient"),
    "force_coefficients": ("muscle", "coefficient"),
    "stride_time": (),
    "events": ("phase",),
    "placement": ("placement_parameter",),
    "multipliers": ("control_point", "contact_row"),
    "residuals": ("control_point", "coordinate"),
}
_KKT_DIMS = {
    "x": "variable", "rows": "row", "lower": "variable", "upper": "variable",
    "event_centres": "event_centre",
}  # fmt: skip


def save(gait: Gait, path: str | Path) -> None:
    """Write `gait` to `path`, beside it first and renamed when complete.

    Raises:
        BadFile: the folder does not exist or cannot be written to.
    """
    attributes = {
        "title": f"{gait.study.model} walking at {gait.speed:.3g} m/s",
        "format": FORMAT,
        "format_version": FORMAT_VERSION,
        "study": _text(gait.study.to_dict()),
        "outcome": _text(dataclasses.asdict(gait.outcome)),
        "cost": _text(dict(gait.cost)),
        "check": _text(None if gait.report is None else gait.report.to_dict()),
        "versions": _text(versions()),
    }
    groups = {
        ROOT: dataclasses.replace(sample(gait), attributes=attributes),
        "design": LabelledArrays({
            name: (dims, np.asarray(getattr(gait.values, name), dtype=float), {})
            for name, dims in _DESIGN_DIMS.items()
        }),
    }  # fmt: skip
    if gait.kkt is not None:
        groups["kkt"] = LabelledArrays(
            {name: ((dim,), getattr(gait.kkt, name), {}) for name, dim in _KKT_DIMS.items()}
        )
    if gait.study.reference is not None:
        groups["reference"] = reference_arrays(gait.study.reference)
    write_netcdf(path, groups)


def load(path: str | Path) -> Gait:
    """Read a gait that `save` has written.

    Raises:
        BadFile: missing, damaged, foreign, or of a newer format.
    """
    path = Path(path)
    if not path.is_file():
        raise BadFile(path, "is a folder." if path.is_dir() else "does not exist.")
    attributes, groups = _read(path)
    if attributes.get("format") != FORMAT:
        raise BadFile(path, "is a netCDF file, but not a gait of drakegait.")
    version = attributes.get("format_version")
    if version != FORMAT_VERSION:
        raise BadFile(path, f"has format {version}, but this drakegait reads {FORMAT_VERSION}.")
    try:
        reference = reference_of(*groups["reference"]) if "reference" in groups else None
        study = GaitStudy.from_dict(json.loads(attributes["study"]), reference)
        design = {name: groups["design"][0][name] for name in _DESIGN_DIMS}
        if not all(np.isfinite(array).all() for array in design.values()):
            raise ValueError("numbers that are not finite")
        design["stride_time"] = float(design["stride_time"])
        outcome = json.loads(attributes["outcome"])
        lists = {name: tuple(x) for name, x in outcome.items() if isinstance(x, list)}
        lists["starts"] = tuple(_start_record(item) for item in lists.get("starts", ()))
        report = json.loads(attributes["check"])
        kkt = groups["kkt"][0] if "kkt" in groups else None
        return Gait(
            study=study,
            values=DesignValues(**design),
            outcome=Outcome(**{**outcome, **lists}),
            cost=json.loads(attributes["cost"]),
            report=None if report is None else CheckReport.from_dict(report),
            kkt=None if kkt is None else KktMultipliers(**{name: kkt[name] for name in _KKT_DIMS}),
        )
    except KeyError as error:
        raise BadFile(path, f"is damaged: {error} is missing.") from None
    except (DrakegaitError, TypeError, ValueError) as error:
        raise BadFile(path, f"is damaged: {error}") from None


Group = tuple[dict[str, np.ndarray], dict[str, Any]]


def _read(path: Path) -> tuple[dict[str, Any], dict[str, Group]]:
    """Attributes of the root, and arrays and attributes of the groups."""
    import h5netcdf  # alone: reading needs nothing of xarray, which is slow to import

    try:
        with h5netcdf.File(path, "r") as file:
            groups = {
                name: (
                    {key: np.array(variable[...]) for key, variable in group.variables.items()},
                    dict(group.attrs),
                )
                for name, group in file.groups.items()
            }
            return dict(file.attrs), groups
    except Exception:  # noqa: BLE001 - h5py raises almost anything on a damaged file
        raise BadFile(path, "cannot be read: damaged, or not a netCDF file.") from None


def _start_record(plain: dict[str, Any]) -> StartRecord:
    return StartRecord(**{**plain, "phase_durations": tuple(plain["phase_durations"])})


def _text(plain: Any) -> str:
    return json.dumps(plain, default=lambda number: number.item())
