"""`drakegait export`: a gait for other programs."""

from __future__ import annotations

from typing import Annotated

import typer

from drakegait.cli.app import GAIT, app, whole


@app.command()
def export(
    gait: Annotated[str, GAIT],
    opensim: Annotated[str | None, typer.Option(
        "--opensim", metavar="DIR",
        help="Folder for OpenSim 4.5 or later: model, coordinates, muscles, joint moments, ground "
        "reactions.")] = None,
    csv: Annotated[str | None, typer.Option(
        "--csv", metavar="DIR", help="Folder for tables, one file for each quantity.")] = None,
    sdf: Annotated[str | None, typer.Option(
        "--sdf", metavar="FILE", help="SDF model of the walker, with its added masses.")] = None,
    instants: Annotated[int, typer.Option(
        "--instants", metavar="N", parser=whole("--instants"),
        help="Instants per stride in the tables, both ends counted.")] = 201,
    strides: Annotated[int, typer.Option(
        "--strides", metavar="N", parser=whole("--strides"),
        help="Strides one after the other in the files of OpenSim, 1 to 20.")] = 1,
    muscles: Annotated[str, typer.Option(
        "--muscles", metavar="KIND",
        help="Muscles of the OpenSim model: degroote_fregly, actuators (ideal, exactly our forces) "
        "or none.")] = "degroote_fregly",
) -> None:  # fmt: skip
    """Write a gait as files of OpenSim, as CSV tables, or its walker as SDF; at least one."""
    from drakegait.commands.export import write_exports

    write_exports(gait, opensim, csv, sdf, instants, strides, muscles)
