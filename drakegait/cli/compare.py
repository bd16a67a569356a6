"""`drakegait compare`: gaits beside each other on one page."""

from __future__ import annotations

from typing import Annotated

import typer

from drakegait.cli.app import app


@app.command()
def compare(
    gaits: Annotated[list[str], typer.Argument(
        metavar="GAIT...", help="One to six gait.nc, or the folders that hold them; the first is "
        "what the others are compared with. All spatial or all planar.")],
    out: Annotated[str, typer.Option(
        "--out", "-o", metavar="FILE", help="The page: one HTML file that opens without a network "
        "and prints.")] = "report.html",
    labels: Annotated[str | None, typer.Option(
        "--labels", metavar="NAMES", help="A name for each gait, separated by commas. Default: "
        "names of their folders or files.")] = None,
    csv: Annotated[str | None, typer.Option(
        "--csv", metavar="DIR", help="Also write all tables as CSV files into this folder.",
    )] = None,
    reference: Annotated[bool, typer.Option(
        "--reference/--no-reference", help="Draw the reference walk behind the curves.")] = True,
) -> None:  # fmt: skip
    """Compare gaits: steps, energy by muscle, curves, symmetry, a common replay; one page.

    One gait alone gets a report. Exit code 0: done; 3: a gait has not converged or fails its
    check, which the page says in red; 2: bad input.
    """
    from drakegait.commands.compare import write_comparison

    raise typer.Exit(write_comparison(gaits, out, labels, csv, reference))
