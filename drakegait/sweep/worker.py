"""What a worker does: one study in, one answer out, as bytes.

The answer travels back to the process that called `sweep`, which alone writes files. So workers
need no shared folder, in a container on another machine as little as in a process on this one.
"""

from __future__ import annotations

import pickle
import platform
import tempfile
import traceback
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from drakegait.errors import DrakegaitError
from drakegait.gait import Gait
from drakegait.solvers.options import SolverOptions
from drakegait.study import GaitStudy

if TYPE_CHECKING:
    from distributed import Client

RETRIES = 2
"""How often a study is tried again whose worker has died."""
NOT_CONVERGED, RAISED, DIED = "not converged", "raised", "worker died"


@dataclass(frozen=True)
class Task:
    """One solve: what `solve` is called with.

    Attributes:
        guess: bytes of the `gait.nc` to start from.
        solve: instead of `drakegait.solve`, for tests of the machinery.
    """

    study: GaitStudy
    options: SolverOptions
    refine: bool
    guess: bytes | None
    solve: Callable[..., Gait] | None = None


@dataclass(frozen=True)
class Answer:
    """What became of a task.

    Attributes:
        failure: empty if converged, else `NOT_CONVERGED`, `RAISED` or `DIED`.
        reason: of the failure, one sentence.
        details: of the failure.
        gait, summary: content of `gait.nc` and `summary.json`; None if the solve raised.
    """

    failure: str = ""
    reason: str = ""
    details: str = ""
    gait: bytes | None = None
    summary: dict[str, Any] | None = None


def versions() -> tuple[str, str]:
    """Versions that client and workers must share: of drakegait and, in short, of Python."""
    import drakegait

    return drakegait.__version__, ".".join(platform.python_version_tuple()[:2])


def run(task: bytes, name: str, topic: str, expected: tuple[str, str]) -> None:
    """Solve on a Dask worker and leave the answer with the scheduler, see `answer_of`.

    There it outlives the worker. Dask begins again by itself what a worker was busy with that
    died; by the scheduler's log a study knows how often it has been begun, and gives up after
    `RETRIES` times more.

    Args:
        task: a pickled `Task`.
        name: of the study.
        topic: name of the log, which is told of each beginning, and of the place of the answers.
        expected: the client's `versions()`.
    """
    from distributed import get_client, get_worker

    client, address, own_log = get_client(), get_worker().address, f"{topic}/{name}"
    if client.get_metadata([topic, name], None) is not None:
        return  # a worker died between its answer and the end of this function
    begun = len(client.get_events(own_log))
    if begun > RETRIES:
        answer = Answer(DIED, f"Its worker has died {begun} times.")
    else:
        # Comes back when the scheduler knows: a worker may die the next moment.
        client.log_event([topic, own_log], {"study": name, "worker": address})
        answer = attempt(task) if versions() == expected else _mismatch(address, expected)
    client.set_metadata([topic, name], pickle.dumps(answer))


def answer_of(client: Client, name: str, topic: str) -> Answer | None:
    """The answer that `run` has left, which is taken away; None if there is none."""
    content = client.get_metadata([topic, name], None)
    if content is None:
        return None
    client.set_metadata([topic, name], b"")
    return pickle.loads(content)


def _mismatch(address: str, expected: tuple[str, str]) -> Answer:
    theirs, ours = " on Python ".join(versions()), " on Python ".join(expected)
    return Answer(RAISED, f"The worker {address} has drakegait {theirs}, not {ours}.")


def attempt(task: bytes) -> Answer:
    """Solve, whatever happens."""
    try:
        return _solve(pickle.loads(task))
    except DrakegaitError as error:
        return Answer(RAISED, str(error), traceback.format_exc())
    except Exception as error:  # noqa: BLE001 - one study must not stop the others
        return Answer(RAISED, f"{type(error).__name__}: {error}", traceback.format_exc())


def _solve(task: Task) -> Answer:
    solve = task.solve
    if solve is None:
        from drakegait.solve import solve

    with tempfile.TemporaryDirectory(prefix="drakegait-") as folder:
        path = Path(folder) / "gait.nc"
        guess = None
        if task.guess is not None:
            path.write_bytes(task.guess)
            guess = Gait.load(path)
        gait = solve(task.study, guess=guess, options=task.options, refine=task.refine)
        gait.save(path)
        content = path.read_bytes()
    if gait.converged:
        return Answer(gait=content, summary=gait.summary())
    outcome = gait.outcome
    reason = f"Not converged ({outcome.status}): {outcome.message}"
    details = "\n".join([*(f"Holds least: {row}" for row in outcome.worst), outcome.advice])
    return Answer(NOT_CONVERGED, reason, details.strip(), content, gait.summary())
