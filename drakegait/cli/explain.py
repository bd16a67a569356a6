"""`drakegait explain`: why a walk was not found."""

from __future__ import annotations

from typing import Annotated

import typer

from drakegait.cli.app import GAIT, app, number, whole


@app.command()
def explain(
    gait: Annotated[str, GAIT],
    time_limit: Annotated[float, typer.Option(
        "--time-limit", metavar="S", parser=number("--time-limit"),
        help="Wall time in s; what is known by then is told.")] = 600.0,
    remedies: Annotated[int, typer.Option(
        "--remedies", metavar="N", parser=whole("--remedies"),
        help="How many changes that make the walk possible to look for, 0 to 5.")] = 2,
) -> None:  # fmt: skip
    """Tell why a walk was not found: which laws are in conflict, where, and what would help.

    For a gait whose solve did not converge. Laws are given up one after the other; changes are
    verified by solving again, and their walks saved beside GAIT. Ctrl-C ends with what is known.
    Exit code 0: explained; 3: ended before anything was known.
    """
    from drakegait.commands.explain import explain_file

    raise typer.Exit(explain_file(gait, time_limit, remedies))
