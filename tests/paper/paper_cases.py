"""Chapters and solves that cost little, for tests of the machinery. Workers import this file."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

from drakegait.gait import Gait
from drakegait.paper import verdict
from drakegait.paper.chapter import Chapter
from drakegait.paper.claim import Claim
from drakegait.paper.own_reference import reference_of
from drakegait.program.gait_program import GaitProgram
from drakegait.program.guess import guess_from_reference
from drakegait.solvers.outcome import Outcome
from drakegait.study import GaitStudy

TRACE = "DRAKEGAIT_TEST_PAPER_TRACE"
"""Environment variable: the file to which every solve adds a line."""


def small(speed: float, **statements: Any) -> GaitStudy:
    return GaitStudy.planar_symmetric(
        nodes=13, interior_points=(1, 1, 3, 2), speed=speed, **statements
    )


def solve(study: GaitStudy, *, guess: Any = None, options: Any, refine: bool) -> Gait:
    """The starting guess, called converged; at 1.5 m/s called infeasible."""
    with open(Path(os.environ[TRACE]), "a") as file:
        own = "own" if study.reference is not None else "embedded"
        file.write(f"{study.speed:g} {own} {'refined' if refine else 'as stated'}\n")
    program = GaitProgram(study.formulation())
    x = guess_from_reference(program)
    status = "infeasible" if study.speed == 1.5 else "converged"
    worst = ("excitation | soleus_l full: off by 3 1/s",) if status == "infeasible" else ()
    outcome = Outcome("test", status, "As told.", 7, 2.0, 0.5, 1, 1, 1, worst, "Try less.")
    parts = program.cost_parts(x)
    return Gait(study, program.values(x), outcome, {"total": sum(parts.values()), **parts})


FIRST = Chapter(
    name="first", title="First", place="1", about="Two walks.",
    studies=lambda: {"slow": small(1.0), "fast": small(1.2)},
    warm={"fast": "slow"},
    measures=(
        lambda gaits: {"stride of slow": gaits["slow"].stride_time},
        lambda gaits: {"stride of no one": gaits["no one"].stride_time},
    ),
    claims=(
        Claim("Fast costs other than slow", "1", "", lambda n: f"{n.energy('slow'):.0f}",
              lambda n: verdict.rises(n.energy("slow"), n.energy("fast"))),
        Claim("No one walks", "-", "", lambda n: f"{n['stride of no one']}", None),
    ),
)  # fmt: skip
SECOND = Chapter(
    name="second", title="Second", place="2", about="Builds on the first.",
    studies=lambda slow: {"after slow": small(1.1, reference=reference_of(slow, "slow"))},
    after=("slow",), names=("after slow",),
)  # fmt: skip
THIRD = Chapter(
    name="third", title="Third", place="3", about="As stated, and one that fails.",
    studies=lambda: {"stated": small(1.3), "lost": small(1.5)}, refine=False,
)  # fmt: skip
