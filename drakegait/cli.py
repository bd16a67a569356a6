"""The command `drakegait`: parse, call, print.

What the commands do is in `drakegait.commands`; those modules are imported when a command runs,
because Drake takes its time and `--help` should not.

Exit codes: 0 done; 2 bad input (one sentence on stderr, nothing solved, nothing written);
3 not converged or check not passed (files are written); 130 interrupted outside a solve.
"""

from __future__ import annotations

import sys
from typing import Annotated, Any

import typer
from typer.core import TyperCommand

from drakegait.errors import DrakegaitError, InvalidInput

BAD_INPUT, INTERRUPTED = 2, 130
# Typer's errors about options derive from these; where Typer keeps them depends on its version.
_USAGE_ERROR = typer.BadParameter.__mro__[1]
_COMMAND_LINE_ERROR = typer.BadParameter.__mro__[2]

app = typer.Typer(
    add_completion=False,
    no_args_is_help=True,
    context_settings={"help_option_names": ["-h", "--help"]},
    help="Muscle-driven human walking, found by optimisation: walk, check, plot, replay.",
)


class _WalkCommand(TyperCommand):
    """`walk`, whose help ends with every constant that `--set` takes."""

    def format_help(self, context: Any, formatter: Any) -> None:
        super().format_help(context, formatter)
        from drakegait.commands.constants import print_constants

        print_constants()


def _option(*names: str, panel: str, help: str, metavar: str | None = None, **more: Any) -> Any:
    return typer.Option(*names, rich_help_panel=panel, help=help, metavar=metavar, **more)


def _number(option: str) -> Any:
    """A reader of numbers that refuses in the words of all our refusals."""

    def read(text: object) -> float:
        try:
            return float(text)  # type: ignore[arg-type]
        except ValueError:
            raise InvalidInput(option, text, "a number") from None

    return read


def _whole(option: str) -> Any:
    """The same for whole numbers."""

    def read(text: object) -> int:
        try:
            return int(text)  # type: ignore[call-overload]
        except ValueError:
            raise InvalidInput(option, text, "a whole number") from None

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


_PERSON, _QUESTION, _WAY, _FILES = "The person", "The walk", "The way to it", "Files"


@app.command(cls=_WalkCommand)
def walk(
    context: typer.Context,
    model: Annotated[str, _option(
        "--model", panel=_QUESTION, metavar="MODEL",
        help="spatial, planar, spatial-symmetric or planar-symmetric.")] = "spatial",
    nodes: Annotated[int | None, _option(
        "--nodes", panel=_QUESTION, metavar="N", parser=_whole("--nodes"),
        help="Spline nodes per stride, 10 to 141; odd for symmetric models. Default: 18, "
        "spatial-symmetric 19, planar-symmetric 35.")] = None,
    speed: Annotated[float, _option(
        "--speed", panel=_QUESTION, metavar="V", parser=_number("--speed"),
        help="Average forward velocity in m/s, 0.3 to 2.5.")] = 1.2,
    weights: Annotated[tuple[str, str], _option(
        "--weights", panel=_QUESTION, metavar="ENERGY DEVIATION",
        help="Weights of metabolic energy and of deviation from the reference in the cost, "
        "no unit, 0 to 1000.")] = ("1", "1"),
    reference: Annotated[str | None, _option(
        "--reference", panel=_QUESTION, metavar="FILE|NAME",
        help="Walk to stay close to: a CSV file (docs/conventions.md) or normal, asymmetric, "
        "measured, planar. Default: normal, for planar models planar.")] = None,
    limit: Annotated[list[str] | None, _option(
        "--limit", panel=_QUESTION, metavar="COORDINATE=LOW:HIGH",
        help="Keep a coordinate in a range, degrees or m, anatomical sign; one end may be left "
        "out. Example: knee_flexion_r=:45. Repeatable.")] = None,
    height: Annotated[float, _option(
        "--height", panel=_PERSON, metavar="H", parser=_number("--height"),
        help="Body height in m, 1.2 to 2.2.")] = 1.8,
    mass: Annotated[float, _option(
        "--mass", panel=_PERSON, metavar="M", parser=_number("--mass"),
        help="Body mass in kg, 30 to 200.")] = 75.0,
    added_mass: Annotated[list[str] | None, _option(
        "--added-mass", panel=_PERSON, metavar="SEGMENT=KG[@X,Y,Z]",
        help="Weight in kg worn on hat, thigh_r, shank_r, foot_r, thigh_l, shank_l or foot_l, at "
        "its centre of mass or at a point in m of its frame. Example: foot_r=2.0. "
        "Repeatable.")] = None,
    strength: Annotated[list[str] | None, _option(
        "--strength", panel=_PERSON, metavar="MUSCLE=FACTOR",
        help="Factor 0.01 to 10 on the largest force of a muscle (soleus_l), of both sides "
        "(soleus) or of a group (SOL). Repeatable.")] = None,
    planar_muscles: Annotated[str, _option(
        "--planar-muscles", panel=_PERSON, metavar="SET",
        help="Muscle set of the planar models: table3 or gait2d.")] = "table3",
    sdf: Annotated[str | None, _option(
        "--sdf", panel=_PERSON, metavar="FILE",
        help="SDF model of your own, written for 1.80 m and 75 kg, with the joints, links and "
        "frames of sdf/README.md.")] = None,
    set_: Annotated[list[str] | None, _option(
        "--set", panel=_PERSON, metavar="NAME=VALUE",
        help="Change a tolerance, physiological constant or solver option; all are listed below. "
        "Example: friction=0.4. Repeatable.")] = None,
    solver: Annotated[str | None, _option(
        "--solver", panel=_WAY, metavar="SOLVER",
        help="ipopt-mumps (IPOPT with MUMPS), or Drake's own ipopt or snopt. "
        "Default: ipopt-mumps.")] = None,
    multipliers: Annotated[str, _option(
        "--multipliers", panel=_WAY, metavar="KIND",
        help="Contact forces: lifted (as variables) or projected (pseudo-inverse of "
        "the paper).")] = "lifted",
    guess: Annotated[str | None, _option(
        "--guess", panel=_WAY, metavar="GAIT",
        help="Start from an earlier gait.nc of the same skeleton. Default: the reference with the "
        "muscle forces that fit it best.")] = None,
    time_limit: Annotated[float, _option(
        "--time-limit", panel=_WAY, metavar="S", parser=_number("--time-limit"),
        help="Wall time in s for the whole solve; then the best gait so far is saved.")] = 3600.0,
    refine: Annotated[bool, _option(
        "--refine/--no-refine", panel=_WAY,
        help="Add control points where the check fails and solve again, at most "
        "3 times.")] = True,
    out: Annotated[str, _option(
        "--out", panel=_FILES, metavar="DIR",
        help="Folder for gait.nc, summary.json, figures/ and replay.html.")] = "out/walk",
    no_pictures: Annotated[bool, _option(
        "--no-pictures", panel=_FILES, help="Leave out figures/ and replay.html.")] = False,
) -> None:  # fmt: skip
    """Find a walking cycle, check it, and save it with pictures.

    Ctrl-C ends the solve with the best gait so far. Exit code 0: converged; 3: not converged, the
    files are written nevertheless; 2: bad input.
    """
    from drakegait.commands.request import WalkRequest
    from drakegait.commands.walk import walk as run

    raise typer.Exit(run(WalkRequest(**context.params)))


_GAIT = typer.Argument(metavar="GAIT", help="A gait.nc, or the folder that holds it.")


@app.command()
def check(
    gait: Annotated[str, _GAIT],
    instants: Annotated[int, typer.Option(
        "--instants", metavar="N", parser=_whole("--instants"),
        help="Instants of the stride to judge, at least 100.")] = 1000,
) -> None:  # fmt: skip
    """Judge a gait between its control points, by a path of its own.

    Exit code 0: passed; 3: not passed.
    """
    from drakegait.commands.look import print_check

    raise typer.Exit(print_check(gait, instants))


@app.command()
def plot(
    gait: Annotated[str, _GAIT],
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
    gait: Annotated[str, _GAIT],
    html: Annotated[str | None, typer.Option(
        "--html", metavar="FILE",
        help="Write one self-contained file for any browser. Default: show it live until "
        "Ctrl-C.")] = None,
    strides: Annotated[int, typer.Option(
        "--strides", metavar="N", parser=_whole("--strides"),
        help="Strides to walk, 1 to 20.")] = 3,
    port: Annotated[int | None, typer.Option(
        "--port", metavar="P", parser=_whole("--port"),
        help="Port of the live view, 1024 to 65535. Default: the first free one from "
        "7000.")] = None,
) -> None:  # fmt: skip
    """Show the gait walking in a browser."""
    from drakegait.commands.look import show_replay

    show_replay(gait, html, strides, port)


def main(arguments: list[str] | None = None) -> None:
    """Run the command line and exit with its code; see the top of this file."""
    command = typer.main.get_command(app)
    try:
        code = command.main(args=arguments, prog_name="drakegait", standalone_mode=False)
    except typer.Exit as ending:
        code = ending.exit_code
    except (KeyboardInterrupt, typer.Abort):
        code = INTERRUPTED
    except DrakegaitError as error:
        _say(str(error))
        code = BAD_INPUT
    except _COMMAND_LINE_ERROR as error:
        code = _explain(error)
    except ImportError as error:
        if not isinstance(error.__cause__, KeyboardInterrupt):
            raise
        code = INTERRUPTED  # while Drake's libraries were loaded
    if code == INTERRUPTED:
        _say("interrupted.")
    sys.exit(code)


def _explain(error: Any) -> int:
    """Print a refused option in one sentence."""
    if not str(error.format_message()):  # `drakegait` alone: Typer has shown the help
        return BAD_INPUT
    context = getattr(error, "ctx", None)
    command = context.command_path if isinstance(error, _USAGE_ERROR) and context else "drakegait"
    message = str(error.format_message()).strip()
    end = "" if message.endswith((".", "?", ")")) else "."
    _say(f"{message}{end} See {command} --help.")
    return BAD_INPUT


def _say(sentence: str) -> None:
    print(f"drakegait: {sentence}", file=sys.stderr)


if __name__ == "__main__":
    main()
