"""The Typer application and the readers of options that all commands share."""

from __future__ import annotations

from typing import Annotated, Any

import typer

from drakegait.errors import InvalidInput

app = typer.Typer(
    add_completion=False,
    no_args_is_help=True,
    context_settings={"help_option_names": ["-h", "--help"]},
    help="Muscle-driven human walking, found by optimisation: walk, check, plot, replay.",
)


def option(*names: str, panel: str, help: str, metavar: str | None = None, **more: Any) -> Any:
    """An option, shown in the help under the heading `panel`."""
    return typer.Option(*names, rich_help_panel=panel, help=help, metavar=metavar, **more)


def number(option: str) -> Any:
    """A reader of numbers that refuses in the words of all our refusals."""

    def read(text: object) -> float:
        try:
            return float(text)  # type: ignore[arg-type]
        except ValueError:
            raise InvalidInput(option, text, "a number") from None

    return read


def whole(option: str) -> Any:
    """The same for whole numbers."""

    def read(text: object) -> int:
        try:
            return int(text)  # type: ignore[call-overload]
        except ValueError:
            raise InvalidInput(option, text, "a whole number") from None

    return read


def two_numbers(option: str) -> Any:
    """The same for two numbers, of which the second may be missing and another option stand for it.

    A callback: it is called before the words that are left are refused.
    """

    def read(texts: tuple[str, str]) -> tuple[float, float]:
        try:
            return float(texts[0]), float(texts[1])
        except ValueError:
            raise InvalidInput(option, " ".join(texts), "two numbers") from None

    return read


def _show_version(wanted: bool) -> None:
    if wanted:
        import drakegait

        typer.echo(f"drakegait {drakegait.__version__}")
        raise typer.Exit


@app.callback()
def _drakegait(
    version: Annotated[
        bool,
        typer.Option("--version", callback=_show_version, is_eager=True, help="Print the version."),
    ] = False,
) -> None:
    pass


GAIT = typer.Argument(metavar="GAIT", help="A gait.nc, or the folder that holds it.")
"""The argument of commands that look at one gait."""
