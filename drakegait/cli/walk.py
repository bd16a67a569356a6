"""`drakegait walk`: find a walking cycle."""

from __future__ import annotations

from typing import Annotated, Any

import typer
from typer.core import TyperCommand

from drakegait.cli import disorder_options as disorder
from drakegait.cli.app import app, number, option, two_numbers, whole


class _WalkCommand(TyperCommand):
    """`walk`, whose help ends with every constant that `--set` takes."""

    def format_help(self, context: Any, formatter: Any) -> None:
        super().format_help(context, formatter)
        from drakegait.commands.constants import print_constants

        print_constants()


_PERSON, _QUESTION, _WAY, _FILES = "The person", "The walk", "The way to it", "Files"


@app.command(cls=_WalkCommand)
def walk(
    context: typer.Context,
    model: Annotated[str, option(
        "--model", panel=_QUESTION, metavar="MODEL",
        help="spatial, planar, spatial-symmetric or planar-symmetric.")] = "spatial",
    nodes: Annotated[int | None, option(
        "--nodes", panel=_QUESTION, metavar="N", parser=whole("--nodes"),
        help="Spline nodes per stride, 10 to 141; odd for symmetric models. Default: 18, "
        "spatial-symmetric 19, planar-symmetric 35.")] = None,
    speed: Annotated[float | None, option(
        "--speed", panel=_QUESTION, metavar="V", parser=number("--speed"),
        help="Average forward velocity in m/s, 0.3 to 2.5. Default: 1.2, or that of an imported "
        "reference.")] = None,
    weights: Annotated[tuple[str, str], option(
        "--weights", panel=_QUESTION, metavar="ENERGY DEVIATION", callback=two_numbers("--weights"),
        help="Weights of metabolic energy and of deviation from the reference in the cost, "
        "no unit, 0 to 1000.")] = (1.0, 1.0),  # type: ignore[assignment]
    reference: Annotated[str | None, option(
        "--reference", panel=_QUESTION, metavar="FILE|NAME",
        help="Walk to stay close to: a person's from `drakegait import` (.nc), a CSV file "
        "(docs/conventions.md), or normal, asymmetric, measured, planar. Default: normal, for "
        "planar models planar.")] = None,
    limit: Annotated[list[str] | None, option(
        "--limit", panel=_QUESTION, metavar="COORDINATE=LOW:HIGH",
        help="Keep a coordinate in a range, degrees or m, anatomical sign; one end may be left "
        "out. Example: knee_flexion_r=:45. Repeatable.")] = None,
    height: Annotated[float | None, option(
        "--height", panel=_PERSON, metavar="H", parser=number("--height"),
        help="Body height in m, 1.2 to 2.2. Default: 1.8, or that of an imported "
        "reference.")] = None,
    mass: Annotated[float | None, option(
        "--mass", panel=_PERSON, metavar="M", parser=number("--mass"),
        help="Body mass in kg, 30 to 200. Default: 75, or that of an imported "
        "reference.")] = None,
    added_mass: Annotated[list[str] | None, option(
        "--added-mass", panel=_PERSON, metavar="SEGMENT=KG[@X,Y,Z]",
        help="Weight in kg worn on hat, thigh_r, shank_r, foot_r, thigh_l, shank_l or foot_l, at "
        "its centre of mass or at a point in m of its frame. Example: foot_r=2.0. "
        "Repeatable.")] = None,
    strength: Annotated[list[str] | None, option(
        "--strength", panel=_PERSON, metavar="MUSCLE=FACTOR",
        help="Factor 0.01 to 10 on the largest force of a muscle (soleus_l), of both sides "
        "(soleus) or of a group (SOL). Repeatable.")] = None,
    muscle: Annotated[list[str] | None, option(
        "--muscle", panel=_PERSON, metavar="MUSCLE.ENTRY=VALUE",
        help="Another value in the muscle table, for 1.80 m and 75 kg: f_max in N, l_opt, l_slack "
        "or l0 in m, width without unit; a fifth to five times what is there. "
        "Example: SOL.l_slack=0.245. Repeatable.")] = None,
    planar_muscles: Annotated[str, option(
        "--planar-muscles", panel=_PERSON, metavar="SET",
        help="Muscle set of the planar models: table3 or gait2d.")] = "table3",
    weakness: disorder.Weakness = None,
    contracture: disorder.Contracture = None,
    spasticity: disorder.Spasticity = None,
    stiffness: disorder.Stiffness = None,
    range_: disorder.Range = None,
    leg_length: disorder.LegLength = None,
    prosthesis: disorder.Prosthesis = None,
    orthosis: disorder.Orthosis = None,
    asymmetry: disorder.Asymmetry = None,
    pain: disorder.Pain = None,
    sdf: Annotated[str | None, option(
        "--sdf", panel=_PERSON, metavar="FILE",
        help="SDF model of your own, written for 1.80 m and 75 kg, with the joints, links and "
        "frames of sdf/README.md.")] = None,
    set_: Annotated[list[str] | None, option(
        "--set", panel=_PERSON, metavar="NAME=VALUE",
        help="Change a tolerance, physiological constant or solver option; all are listed below. "
        "Example: friction=0.4. Repeatable.")] = None,
    solver: Annotated[str | None, option(
        "--solver", panel=_WAY, metavar="SOLVER",
        help="condensed (interior point of our own), ipopt-mumps (IPOPT with MUMPS), or "
        "Drake's own ipopt or snopt. Default: condensed.")] = None,
    multipliers: Annotated[str, option(
        "--multipliers", panel=_WAY, metavar="KIND",
        help="Contact forces: lifted (as variables) or projected (pseudo-inverse of "
        "the paper).")] = "lifted",
    guess: Annotated[str | None, option(
        "--guess", panel=_WAY, metavar="GAIT",
        help="Start from an earlier gait.nc of the same skeleton. Default: the reference with the "
        "muscle forces that fit it best.")] = None,
    time_limit: Annotated[float, option(
        "--time-limit", panel=_WAY, metavar="S", parser=number("--time-limit"),
        help="Wall time in s for the whole solve; then the best gait so far is saved. With "
        "--compare each walker has as much.")] = 3600.0,
    refine: Annotated[bool, option(
        "--refine/--no-refine", panel=_WAY,
        help="Add control points where the check fails and solve again, at most "
        "3 times.")] = True,
    starts: Annotated[int, option(
        "--starts", panel=_WAY, metavar="K", parser=whole("--starts"),
        help="Solve from K starting points, one after the other, and keep the cheapest gait: the "
        "guess, standing, silent muscles, then the reference with noise.")] = 1,
    seed: Annotated[int, option(
        "--seed", panel=_WAY, metavar="N", parser=whole("--seed"),
        help="Seed of the noise of --starts.")] = 0,
    compare: Annotated[bool, option(
        "--compare", panel=_QUESTION,
        help="Walk twice: without what makes the walker differ (added masses, strengths, limits, "
        "disorders) into unchanged/, then with it, and compare both in report.html. A --guess that "
        "is the unchanged walk is taken as it is.")] = False,
    explain: Annotated[bool, option(
        "--explain/--no-explain", panel=_WAY,
        help="Where no walk is found, tell which laws are in conflict, where, and what would help; "
        "takes up to 5 minutes, within --time-limit.")] = True,
    out: Annotated[str, option(
        "--out", panel=_FILES, metavar="DIR",
        help="Folder for gait.nc, summary.json, figures/ and replay.html; with --compare also "
        "unchanged/ and report.html.")] = "out/walk",
    no_pictures: Annotated[bool, option(
        "--no-pictures", panel=_FILES,
        help="Leave out figures/ and replay.html.")] = False,
) -> None:  # fmt: skip
    """Find a walking cycle, check it, and save it with pictures.

    Ctrl-C ends the solve with the best gait so far. Exit code 0: converged; 3: not converged, the
    files are written nevertheless; 2: bad input. With --compare both walkers must have converged.
    """
    from drakegait.commands.request import WalkRequest
    from drakegait.commands.walk import walk as run

    raise typer.Exit(run(WalkRequest(**context.params)))
