"""`drakegait export`: a gait that was saved, for other programs."""

from __future__ import annotations

from pathlib import Path

from drakegait.commands.gait_files import load_gait, output_file, output_folder
from drakegait.commands.screen import console
from drakegait.errors import InvalidInput
from drakegait.export import export_csv, export_opensim, export_sdf


def write_exports(
    name: str,
    opensim: str | None,
    csv: str | None,
    sdf: str | None,
    instants: int,
    strides: int,
    muscles: str,
) -> None:
    """Write what is asked for and say where it is.

    Raises:
        InvalidInput: nothing is asked for, or a value is out of range.
        BadFile: the gait cannot be read or a file cannot be written.
    """
    if opensim is None and csv is None and sdf is None:
        raise InvalidInput("export", "nothing", "at least one of --opensim, --csv and --sdf")
    opensim_folder = None if opensim is None else output_folder("--opensim", opensim)
    csv_folder = None if csv is None else output_folder("--csv", csv)
    model = None if sdf is None else output_file("--sdf", sdf, ".sdf")
    gait = load_gait(name)
    screen = console()
    if not gait.converged:
        screen.print(f"This gait has not converged ({gait.outcome.status}).", markup=False)
    lines = []
    if opensim_folder is not None:
        files = export_opensim(
            gait, opensim_folder, num=instants, strides=strides, muscles=muscles
        )
        lines.append(f"For OpenSim in {opensim}: {_names(files)}.")
    if csv_folder is not None:
        lines.append(f"Tables in {csv}: {_names(export_csv(gait, csv_folder, num=instants))}.")
    if model is not None:
        lines.append(f"Walker in {export_sdf(gait, model)}.")
    for line in lines:
        screen.print(line, markup=False, soft_wrap=True)


def _names(files: list[Path]) -> str:
    return ", ".join(path.name for path in files)
