"""`drakegait sensitivities`: what every number of a study does to its optimum."""

from __future__ import annotations

from typing import Annotated

import typer

from drakegait.cli.app import GAIT, app, whole


@app.command()
def sensitivities(
    gait: Annotated[str, GAIT],
    out: Annotated[str | None, typer.Option(
        "-o", "--out", metavar="DIR",
        help="Folder for sensitivities.csv, .svg and .png. Default: figures/ beside GAIT.")] = None,
    count: Annotated[int, typer.Option(
        "--count", metavar="N", parser=whole("--count"),
        help="How many of the largest answers to print and to draw, 1 to 60.")] = 15,
    exact: Annotated[bool, typer.Option(
        "--exact",
        help="Solve on to the very optimum first, which takes seconds. Derivatives of the cost of "
        "transport are exact there and estimates where a walk usually ends.")] = False,
) -> None:  # fmt: skip
    """Tell what each number of a study does to its optimum, without solving for each of them.

    Derivatives of the cost f and of the metabolic cost of transport by masses, strengths,
    tolerances, speed and constants, from the multipliers of a gait that has converged.
    """
    from drakegait.commands.sensitivities import print_sensitivities

    print_sensitivities(gait, out, count, exact)
