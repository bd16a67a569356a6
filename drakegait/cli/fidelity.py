"""`drakegait fidelity`: published walking beside ours."""

from __future__ import annotations

from typing import Annotated

import typer

from drakegait.cli.app import app, whole


@app.command()
def fidelity(
    out: Annotated[str, typer.Option(
        "--out", metavar="DIR",
        help="Folder for the gaits, the page and the numbers.")] = "out/fidelity",
    workers: Annotated[int | None, typer.Option(
        "--workers", metavar="N", parser=whole("--workers"),
        help="Solves at once on this machine. Default: one for each core.")] = None,
    scheduler: Annotated[str | None, typer.Option(
        "--scheduler", metavar="ADDRESS",
        help="Use the workers of a running Dask scheduler.")] = None,
    retry_failed: Annotated[bool, typer.Option(
        "--retry-failed", help="Solve again what failed earlier.")] = False,
    docs: Annotated[str | None, typer.Option(
        "--docs", metavar="DIR",
        help="Also write the generated part of DIR/fidelity.md, DIR/fidelity_results.json and "
        "figures in DIR/pictures.")] = None,
) -> None:  # fmt: skip
    """Hold the model against published measurements of walking people and write one page.

    Ten walks: angles, forces, moments, timing of muscles, cost, masses worn on the body; some
    minutes. After Ctrl-C or a crash the same command goes on. Exit code 0: done, whatever lies
    inside or outside; 2: bad input; 130: interrupted.
    """
    from drakegait.commands.fidelity import fidelity as run

    raise typer.Exit(run(out, workers, scheduler, retry_failed, docs))
