"""`drakegait sweep`: many studies at once."""

from __future__ import annotations

from typing import Annotated

import typer

from drakegait.cli.app import app, whole


@app.command()
def sweep(
    file: Annotated[str, typer.Argument(
        metavar="FILE", help="A grid or list of studies (.toml), or a program that defines "
        "studies (.py); docs/sweep.md.")],
    out: Annotated[str | None, typer.Option(
        "--out", metavar="DIR",
        help="Folder for the results. Default: out/ and the name of FILE.")] = None,
    workers: Annotated[int | None, typer.Option(
        "--workers", metavar="N", parser=whole("--workers"),
        help="Solves at once on this machine. Default: one for each core.")] = None,
    scheduler: Annotated[str | None, typer.Option(
        "--scheduler", metavar="ADDRESS",
        help="Use the workers of a running Dask scheduler, for example "
        "tcp://host:8786.")] = None,
    retry_failed: Annotated[bool, typer.Option(
        "--retry-failed", help="Solve again what failed earlier.")] = False,
    no_pictures: Annotated[bool, typer.Option(
        "--no-pictures", help="Leave out sweep.svg and sweep.png.")] = False,
) -> None:  # fmt: skip
    """Solve many studies, each on a core of its own.

    What the folder already holds is not solved again: after Ctrl-C or a crash the same command
    goes on. Exit code 0: all converged; 3: some failed; 2: bad input.
    """
    from drakegait.commands.sweep import sweep as run

    raise typer.Exit(run(file, out, workers, scheduler, retry_failed, not no_pictures))
