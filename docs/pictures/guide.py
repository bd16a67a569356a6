"""The programs whose outputs and figures are in the guide."""

from __future__ import annotations

import os
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PRINTED = "printed.txt"


@dataclass(frozen=True)
class Program:
    """One program.

    Attributes:
        name: of its folder and of the markers in the page.
        command: arguments of Python; `{out}` is its folder, `{runs}` the folder of all.
        shown: as the page gives it.
        page: where its output is shown; None where it is not.
    """

    name: str
    command: tuple[str, ...]
    shown: str
    page: str | None


def _example(name: str, *options: str) -> Program:
    shown = " ".join(["python", f"examples/{name}.py", *options])
    return Program(name, (f"examples/{name}.py", "{out}", *options), shown, f"{name}.md")


_OWN = Program("own_data", ("examples/own_data.py", "{out}"), "python examples/own_data.py",
               "your_own_data.md")  # fmt: skip
_CHECK = Program("check", ("-m", "drakegait.cli", "check", "{runs}/first_walk"),
                 "drakegait check out/first", "reading_the_check.md")  # fmt: skip
_SWEEP = Program(
    "sweep_foot_mass",
    ("-m", "drakegait.cli", "sweep", "examples/sweep_foot_mass.py", "--workers", "1",
     "--out", "{out}"),
    "", None,
)  # fmt: skip
_SENSITIVITIES = Program(
    "sensitivities",
    ("-m", "drakegait.cli", "sensitivities", "{runs}/first_walk", "--out", "{out}"), "", None,
)  # fmt: skip

RUNS = (
    _example("first_walk"),
    _CHECK,
    _SENSITIVITIES,
    _OWN,
    _example("heavy_foot", "--planar"),
    _example("weak_muscle"),
    _example("prosthesis"),
    _example("disorders"),
    _SWEEP,
)
"""In an order in which each finds what it needs."""

PICTURES = {
    "first_walk_angles": "first_walk/figures/joint_angles.png",
    "sensitivities": "sensitivities/sensitivities.png",
    "heavy_foot_angles": "heavy_foot/figures/joint_angles.png",
    "weak_muscle_moments": "weak_muscle/figures/joint_moments.png",
    "prosthesis_forces": "prosthesis/figures/ground_reactions.png",
    "prosthesis_moments": "prosthesis/figures/joint_moments.png",
    "sweep_foot_mass": "sweep_foot_mass/sweep.png",
}
"""Picture -> the figure that it is, in the folder of all runs."""


def run(program: Program, runs: Path, keep: bool) -> str:
    """What the program prints; SystemExit if it fails."""
    out = runs / program.name
    if keep and (out / PRINTED).is_file():
        return (out / PRINTED).read_text(encoding="utf-8")
    out.mkdir(parents=True, exist_ok=True)
    print(f"{program.name} ...", flush=True)
    command = [word.format(out=out, runs=runs) for word in program.command]
    paths = [str(ROOT), *filter(None, [os.environ.get("PYTHONPATH")])]
    # Tables of 110 columns fit on a page. Drake's IPOPT asks for OMP_CANCELLATION.
    settings = {"PYTHONPATH": os.pathsep.join(paths), "MPLBACKEND": "Agg", "COLUMNS": "110",
                "OMP_CANCELLATION": "TRUE", "NO_COLOR": "1"}  # fmt: skip
    ended = subprocess.run(
        [sys.executable, *command], cwd=ROOT, env={**os.environ, **settings}, text=True,
        stdout=subprocess.PIPE,
    )  # fmt: skip
    if ended.returncode != 0:
        raise SystemExit(f"{program.shown or program.name} ended with {ended.returncode}.")
    (out / PRINTED).write_text(ended.stdout, encoding="utf-8")
    return ended.stdout


def guide_output(program: Program, printed: str) -> str:
    """The output as a block of the page, without progress, folders and empty ends."""
    lines = [line.rsplit("\r", 1)[-1].rstrip() for line in printed.splitlines()]
    lines = [line for line in lines if not line.startswith(("look into", "figures and gaits"))]
    lines = [line for line in lines if not line.startswith(("iteration ", "solving "))]
    text = "\n".join(lines).strip("\n")
    return f"```text\n$ {program.shown}\n{text}\n```\n"
