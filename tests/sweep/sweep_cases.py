"""Solves that cost nothing and leave a trace, for tests of the machinery around them.

Workers import this file: they are other processes, told what to do by the environment.
"""

from __future__ import annotations

import json
import os
import shutil
import signal
import time
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from drakegait.errors import InvalidInput
from drakegait.solvers.outcome import Outcome
from drakegait.study import GaitStudy

TRACE = "DRAKEGAIT_TEST_TRACE"
"""Environment variable: the folder of the trace and of the gates."""
DEADLINE = 300.0  # [s]; nothing here takes longer unless it hangs


def studies(*speeds: float) -> dict[str, GaitStudy]:
    """One small study for each speed [m/s], by names such as `"1.1"`."""
    start = GaitStudy.planar_symmetric(nodes=13, interior_points=(1, 1, 3, 2))
    return {f"{speed:g}": start.replace(speed=speed) for speed in speeds}


@dataclass(frozen=True)
class Answer:
    """As much of a Gait as a worker asks for."""

    study: GaitStudy
    outcome: Outcome

    @property
    def converged(self) -> bool:
        return self.outcome.converged

    def save(self, path: Path) -> None:
        """A copy of the prepared gait with the speed of this one."""
        import h5py

        shutil.copy(Path(os.environ[TRACE]) / "gait.nc", path)
        with h5py.File(path, "r+") as file:
            study = json.loads(file.attrs["study"]) | {"speed": self.study.speed}
            file.attrs["study"] = json.dumps(study)

    def summary(self) -> dict[str, Any]:
        return {
            "solver": {"status": self.outcome.status, "iterations": 7, "wall_time_s": 2.0,
                       "setup_time_s": 0.5},
            "cost": {"metabolic_cost_of_transport_J_per_m": 300.0 + self.study.speed,
                     "deviation": float("nan"), "total": 4.0},
            "check": {"passed": True},
            "versions": {"drakegait": _version()},
        }  # fmt: skip


def solve(study: GaitStudy, *, guess: Any = None, options: Any, refine: bool) -> Answer:
    """What the file `do_<speed>` in the trace's folder says: wait, raise, stop, die; else answer.

    Writes `begin <speed> <process>` before and `end <speed> <process>` after, with the speed of
    the guess as a fourth word if there is one.
    """
    folder, name = Path(os.environ[TRACE]), f"{study.speed:g}"
    write(folder, f"begin {name} {os.getpid()}")
    order = folder / f"do_{name}"
    deed = order.read_text() if order.exists() else ""
    if deed == "wait":
        wait_for(lambda: (folder / "gate").exists(), "the gate")
    elif deed == "die":
        os.kill(os.getpid(), signal.SIGKILL)
    elif deed == "refuse":
        raise InvalidInput("friction", 7, "less")
    elif deed == "raise":
        raise ZeroDivisionError("of a test")
    started = "" if guess is None else f" {guess.study.speed:g}"
    write(folder, f"end {name} {os.getpid()}{started}")
    status = "infeasible" if deed == "stop" else "converged"
    outcome = Outcome("test", status, "As told.", 7, 2.0, 0.5, 1, 1, 1, advice="Try less.")
    return Answer(study, outcome)


def tell(folder: Path, name: str, deed: str) -> None:
    """Order what the solve of a study does."""
    (folder / f"do_{name}").write_text(deed)


def write(folder: Path, line: str) -> None:
    """Add a line to the trace, whole even if processes write at once."""
    with open(folder / "trace", "a") as file:
        file.write(f"{line}\n")


def trace(folder: Path, word: str) -> list[str]:
    """Names of the studies that began or ended, in order."""
    return [line.split()[1] for line in _lines(folder) if line.split()[0] == word]


def processes(folder: Path, name: str = "") -> list[int]:
    """Processes that began a study, or the study `name`, in order."""
    words = [line.split() for line in _lines(folder)]
    return [int(word[2]) for word in words if word[0] == "begin" and name in ("", word[1])]


def guesses(folder: Path) -> dict[str, str | None]:
    """The study from which each started that ended, by name."""
    words = [line.split() for line in _lines(folder)]
    return {word[1]: (word[3:] or [None])[0] for word in words if word[0] == "end"}


def alive(pid: int) -> bool:
    """Whether a process runs; a zombie does not."""
    try:
        return Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0] != "Z"
    except OSError:
        return False


def wait_for(true: Any, what: str) -> None:
    """Come back when `true()` holds; fail at the deadline."""
    end = time.monotonic() + DEADLINE
    while not true():
        assert time.monotonic() < end, f"waited in vain for {what}"
        time.sleep(0.02)


def read(path: Path) -> dict[str, Any]:
    return json.loads(path.read_text())


def _lines(folder: Path) -> list[str]:
    path = folder / "trace"
    return path.read_text().splitlines() if path.exists() else []


def _version() -> str:
    import drakegait

    return drakegait.__version__
