"""`drakegait check`, `plot` and `replay`: look at a gait."""

from __future__ import annotations

from typing import Annotated

import typer

from drakegait.cli.app import GAIT, app, whole


@app.command()
def check(
    gait: Annotated[str, GAIT],
    instants: Annotated[int, typer.Option(
        "--instants", metavar="N", parser=whole("--instants"),
        help="Instants of the stride to judge, at least 100.")] = 1000,
) -> None:  # fmt: skip
    """Judge a gait between its control points, by a path of its own.

    Exit code 0: passed; 3: not passed.
    """
    from drakegait.commands.look import print_check

    raise typer.Exit(print_check(gait, instants))


@app.command()
def plot(
    gait: Annotated[str, GAIT],
    out: Annotated[str | None, typer.Option(
        "--out", metavar="DIR", help="Folder for the figures. Default: figures/ beside GAIT.",
    )] = None,
    others: Annotated[list[str] | None, typer.Option(
        "--with", metavar="OTHER", help="Another gait to draw into the same figures. Repeatable.",
    )] = None,
) -> None:  # fmt: skip
    """Draw joint angles, ground reactions, excitations, moments and a stick figure."""
    from drakegait.commands.look import draw_figures

    draw_figures(gait, out, others or [])


@app.command()
def replay(
    gait: Annotated[str, GAIT],
    html: Annotated[str | None, typer.Option(
        "--html", metavar="FILE",
        help="Write one self-contained file for any browser. Default: show it live until "
        "Ctrl-C.")] = None,
    strides: Annotated[int, typer.Option(
        "--strides", metavar="N", parser=whole("--strides"),
        help="Strides to walk, 1 to 20.")] = 3,
    port: Annotated[int | None, typer.Option(
        "--port", metavar="P", parser=whole("--port"),
        help="Port of the live view, 1024 to 65535. Default: the first free one from "
        "7000.")] = None,
) -> None:  # fmt: skip
    """Show the gait walking in a browser."""
    from drakegait.commands.look import show_replay

    show_replay(gait, html, strides, port)
