"""From studies to a folder of gaits."""

from __future__ import annotations

import contextlib
import pickle
import queue
import uuid
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from drakegait.gait import Gait
from drakegait.solvers.options import SolverOptions
from drakegait.study import GaitStudy
from drakegait.sweep import worker
from drakegait.sweep.cluster import ClusterLost, Place, check_place, connected, leave_if_imported
from drakegait.sweep.interrupt import Interrupt
from drakegait.sweep.plan import Plan
from drakegait.sweep.progress import Stopwatch, SweepProgress
from drakegait.sweep.result import SweepResult, places
from drakegait.sweep.store import Store

if TYPE_CHECKING:
    from distributed import Client, Future

_TICK = 0.5  # [s] between reports when nothing happens


def sweep(
    studies: Mapping[str, GaitStudy],
    folder: str | Path,
    *,
    warm: Mapping[str, str] | None = None,
    options: SolverOptions | Mapping[str, SolverOptions] | None = None,
    refine: bool = True,
    workers: int | None = None,
    scheduler: str | None = None,
    retry_failed: bool = False,
    axes: Mapping[str, Mapping[str, Any]] | None = None,
    report: Callable[[SweepProgress], None] | None = None,
    _solve: Callable[..., Gait] | None = None,
) -> SweepResult:
    """Solve many studies, each on a core of its own, and keep every one that is finished.

    What the folder already holds is not solved again; a study that has changed, or whose file is
    damaged, is. Workers are processes that import the calling program: put the call below
    `if __name__ == "__main__":`.

    Args:
        studies: by name, which is also the name of the study's folder.
        folder: for the results, see `drakegait.sweep.store`.
        warm: name of a study -> name of the study whose gait it starts from, for which it waits.
            Where that one failed, its own guess serves, or else the usual start.
        options: of the solver, for all studies or by name.
        refine: add control points where the check fails, as `solve` does.
        workers: processes on this machine; default one for each core.
        scheduler: address of a running Dask scheduler, `"tcp://host:8786"`, to use its workers.
        retry_failed: solve again what has failed in an earlier call.
        axes: name of a study -> its place in the grid, {axis: value}; default what differs.
        report: called with the progress, at least twice a second.

    Returns:
        All studies, failed ones with their reason; `sweep.nc` and `sweep.csv` are written.

    Raises:
        InvalidInput, UnknownName, BadFile: something that cannot be used, before anything runs.
        ClusterLost: workers do not start, or the scheduler went away; what was finished is kept.
        KeyboardInterrupt: Ctrl-C; running solves are ended, what was finished is kept.
    """
    leave_if_imported()
    check_place(workers, scheduler)
    plan = Plan.make(studies, warm, options, refine)
    found = places(axes, plan.studies)
    store = Store(folder)
    with store.locked():
        run = _Run(plan, store, retry_failed, report, _solve)
        if run.open:
            with run.interrupt:
                run.check()
                with connected(workers, scheduler, len(run.open)) as place:
                    run.solve(place)
        states = {name: store.state(name, key) for name, key in plan.keys.items()}
        result = SweepResult(store.folder, plan.studies, found, states, tuple(run.notes))
        result.save()
    return result


class _Run:
    """The studies that are open, running, and ended."""

    def __init__(
        self,
        plan: Plan,
        store: Store,
        retry_failed: bool,
        report: Callable[[SweepProgress], None] | None,
        solve: Callable[..., Gait] | None,
    ):
        self.plan, self.store = plan, store
        self._report, self._solve = report, solve
        self.notes: list[str] = []
        self.status: dict[str, str] = {}
        earlier = []
        for name, key in plan.keys.items():
            state = store.state(name, key)
            again = state.status == "failed" and retry_failed
            self.status[name] = "open" if again else state.status
            if state.note:
                self.notes.append(state.note)
            if state.status == "done":
                solver = store.summary(name).get("solver", {})
                earlier.append(solver.get("wall_time_s", 0.0) + solver.get("setup_time_s", 0.0))
            elif state.status == "failed" and not again:
                self.notes.append(f"{name}: failed earlier and is left so: {state.reason}")
        self._watch = Stopwatch(earlier)
        self._futures: dict[str, Future] = {}
        self._guesses: dict[str, str | None] = {}
        self._submitted = 0
        self._messages: queue.SimpleQueue[tuple[str, str, str]] = queue.SimpleQueue()
        self._topic = f"drakegait-sweep-{uuid.uuid4().hex}"
        self.interrupt = Interrupt(lambda: self._messages.put(("interrupted", "", "")))

    @property
    def open(self) -> list[str]:
        """Names of the studies to be solved."""
        return [name for name, status in self.status.items() if status == "open"]

    def check(self) -> None:
        """Build what the studies ask for, so that wrong names of muscles show before solving."""
        for name in self.open:
            self.plan.studies[name].replace().formulation()  # the copy takes its walker along
            self.interrupt.check()

    def solve(self, place: Place) -> None:
        """Solve all that is open."""
        client = place.client
        client.subscribe_topic(
            self._topic, lambda event: self._messages.put(("begun", event[1]["study"], ""))
        )
        try:
            self._submit(place)
            while self._futures:
                self._tell(place.cores)
                self._wait(place)
                self.interrupt.check()
            self._tell(place.cores)
        except OSError:  # of the connection: files raise BadFile
            raise _lost() from None
        except RuntimeError:
            if client.status == "running":
                raise
            raise _lost() from None
        finally:
            self._let_go(client)

    def _wait(self, place: Place) -> None:
        """Do what the next message asks for, if anything, or look around if there is none."""
        try:
            kind, name, key = self._messages.get(timeout=_TICK)
        except queue.Empty:
            if place.client.status not in ("running", "connecting"):
                raise _lost() from None
            place.revive()
            self._submit(place)  # to workers that have come
            return
        if kind == "begun" and name in self._futures:
            self._watch.begin(name)
        elif kind == "ended" and name in self._futures and self._futures[name].key == key:
            answer = self._answer(place.client, name, self._futures.pop(name))
            if answer is not None:
                self._finish(name, answer)
            self._submit(place)

    def _let_go(self, client: Client) -> None:
        """Take back what still runs, and the answers that nobody has fetched."""
        futures = list(self._futures.values())
        self._futures.clear()
        if client.status == "running":
            with contextlib.suppress(OSError, RuntimeError):
                client.cancel(futures)
                client.set_metadata([self._topic], {})

    def _submit(self, place: Place) -> None:
        """Hand over studies that wait for nothing, as many as there is room for."""
        room = place.room
        for name in self.open:
            if len(self._futures) >= room:
                return
            if name in self._futures or self.status.get(self.plan.warm.get(name)) == "open":
                continue
            guess = self._guesses[name] = self._guess(name)
            content = None if guess is None else self.store.gait(guess)
            self._submitted += 1
            task = worker.Task(
                study=self.plan.studies[name].replace(),
                options=self.plan.options[name],
                refine=self.plan.refine,
                guess=content,
                solve=self._solve,
            )
            future = place.client.submit(
                worker.run,
                pickle.dumps(task),
                name,
                self._topic,
                worker.versions(),
                key=f"{self._topic}-{self._submitted}",
                pure=False,
            )
            self._futures[name] = future
            future.add_done_callback(
                lambda future, name=name: self._messages.put(("ended", name, future.key))
            )

    def _guess(self, name: str) -> str | None:
        """The nearest finished study up the chain of guesses."""
        guess = self.plan.warm.get(name)
        while guess is not None and self.status[guess] != "done":
            guess = self.plan.warm.get(guess)
        return guess

    def _answer(self, client: Client, name: str, future: Future) -> worker.Answer | None:
        """What has become of a study; None if it has the right to another try.

        Raises:
            ClusterLost: there is no scheduler any more.
        """
        from distributed import KilledWorker

        answer = worker.answer_of(client, name, self._topic)
        if answer is not None:  # even if the worker, and with it the future, is lost by now
            return answer
        if future.status != "error":
            raise _lost()
        error = future.exception()
        if not isinstance(error, KilledWorker):
            reason = f"The worker could not run it: {type(error).__name__}: {error}"
            return worker.Answer(worker.RAISED, reason)
        # Dask blames every study that was handed to a worker for its death, begun or not.
        begun = len(client.get_events(f"{self._topic}/{name}"))
        if begun <= worker.RETRIES:
            return None
        return worker.Answer(worker.DIED, f"Its worker has died {begun} times.")

    def _finish(self, name: str, answer: worker.Answer) -> None:
        """Write down how a study has ended."""
        self._watch.end(name)
        key, guess = self.plan.keys[name], self._guesses[name]
        if answer.failure:
            self.store.write_failed(
                name, key, answer.failure, answer.reason, answer.details, answer.gait,
                answer.summary, guess,
            )  # fmt: skip
            self.notes.append(f"{name}: failed. {answer.reason}")
            self.status[name] = "failed"
        else:
            self.store.write_done(name, key, answer.gait, answer.summary, guess)
            self.status[name] = "done"

    def _tell(self, cores: int) -> None:
        if self._report is None:
            return
        statuses = list(self.status.values())
        self._report(
            SweepProgress(
                total=len(statuses),
                done=statuses.count("done"),
                failed=statuses.count("failed"),
                running=self._watch.running,
                elapsed=self._watch.elapsed,
                expected=self._watch.expected(len(self.open), cores),
                notes=tuple(self.notes),
            )
        )


def _lost() -> ClusterLost:
    return ClusterLost(
        "The Dask scheduler has gone away; finished studies are kept, the same call goes on."
    )
