"""`drakegait import`: take in a measured walk."""

from __future__ import annotations

from typing import Annotated

import typer

from drakegait.cli.app import app, number, whole


@app.command("import")
def import_(
    motion: Annotated[str, typer.Argument(
        metavar="MOTION", help="Joint angles: OpenSim .mot or .sto, or CSV; or "
        "markers: C3D.")],
    forces: Annotated[str, typer.Argument(
        metavar="FORCES", help="Ground forces: OpenSim .mot or .sto, CSV, or C3D.")],
    height: Annotated[float, typer.Option(
        "--height", metavar="H", parser=number("--height"),
        help="Body height in m, 1.2 to 2.2.")],
    mass: Annotated[float, typer.Option(
        "--mass", metavar="M", parser=number("--mass"), help="Body mass in kg, 30 to 200.")],
    out: Annotated[str, typer.Option(
        "--output", "-o", metavar="FILE",
        help="The file to write; a page about its quality goes beside it.")] = "subject.nc",
    treadmill_speed: Annotated[float | None, typer.Option(
        "--treadmill-speed", metavar="V", parser=number("--treadmill-speed"),
        help="Speed of the belt in m/s. Default: found from the standing feet.")] = None,
    stride: Annotated[int | None, typer.Option(
        "--stride", metavar="N", parser=whole("--stride"),
        help="Number of the stride to take, from 1. Default: the best.")] = None,
    columns: Annotated[str | None, typer.Option(
        "--columns", metavar="MAP",
        help="TOML or JSON file that says which column or marker is what, "
        "docs/your_own_data.md.")] = None,
    side: Annotated[list[str] | None, typer.Option(
        "--side", metavar="PLATE=SIDE",
        help="Foot on a plate, right or left, if it cannot be told otherwise. "
        "Repeatable.")] = None,
    knee: Annotated[str, typer.Option(
        "--knee", metavar="SIGN",
        help="Sign of the knee angle in the file: auto, flexion-positive or "
        "flexion-negative.")] = "auto",
    motion_cutoff: Annotated[float, typer.Option(
        "--motion-cutoff", metavar="HZ", parser=number("--motion-cutoff"),
        help="Low-pass filter of the motion in Hz.")] = 6.0,
    force_cutoff: Annotated[float, typer.Option(
        "--force-cutoff", metavar="HZ", parser=number("--force-cutoff"),
        help="Low-pass filter of the forces in Hz.")] = 20.0,
) -> None:  # fmt: skip
    """Turn a person's measured walk into the reference of a study.

    The file that it writes is given to `drakegait walk --reference`, which then walks with this
    person's height, mass and speed.
    """
    from drakegait.commands.import_walk import import_files

    import_files(
        motion, forces, out, side, height=height, mass=mass, treadmill_speed=treadmill_speed,
        stride=stride, columns=columns, knee=knee, motion_cutoff=motion_cutoff,
        force_cutoff=force_cutoff,
    )  # fmt: skip
