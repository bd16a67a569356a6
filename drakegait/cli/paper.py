"""`drakegait paper`: the paper's studies."""

from __future__ import annotations

from typing import Annotated

import typer

from drakegait.cli.app import app, whole


@app.command()
def paper(
    out: Annotated[str, typer.Option(
        "--out", metavar="DIR",
        help="Folder for the gaits, the page and the numbers.")] = "out/paper",
    only: Annotated[list[str] | None, typer.Option(
        "--only", metavar="NAME",
        help="Only this chapter, with what it builds on; may be repeated.")] = None,
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
        help="Also write the generated part of DIR/paper.md and DIR/paper_results.json.")] = None,
) -> None:  # fmt: skip
    """Run every study of the paper and write one page with its numbers beside ours.

    Takes an hour or less on 2 cores. After Ctrl-C or a crash the same command goes on. Exit code 0:
    done, whatever the verdicts; 2: bad input; 130: interrupted. Studies that do not converge are
    results; the page names them.
    """
    from drakegait.commands.paper import paper as run

    raise typer.Exit(run(out, tuple(only or ()), workers, scheduler, retry_failed, docs))
