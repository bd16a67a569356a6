"""Where the solves run: processes of this machine, or the workers of a running Dask scheduler."""

from __future__ import annotations

import contextlib
import logging
import multiprocessing
import os
import signal
import sys
from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Any

from drakegait.errors import DrakegaitError, InvalidInput
from drakegait.quantities import check_count
from drakegait.sweep.worker import versions

if TYPE_CHECKING:
    from distributed import Client, LocalCluster

CONNECT_SECONDS = 10.0
"""How long a scheduler has to answer."""
ONE_THREAD = {
    "OMP_NUM_THREADS": "1",
    "OPENBLAS_NUM_THREADS": "1",
    "MKL_NUM_THREADS": "1",
    "OMP_CANCELLATION": "TRUE",  # SPRAL in Drake's IPOPT asks for it before the first import
}
"""Environment of a worker: a solve keeps one core busy, and BLAS must not take others."""
_LOCAL = {
    # Not the variables that Dask sets: those of the user would come first, and its
    # MALLOC_TRIM_THRESHOLD_ costs a solve a quarter of its time.
    "distributed.nanny.pre-spawn-environ": {},
    "distributed.worker.profile.enabled": False,  # a twentieth
    "distributed.worker.multiprocessing-method": "spawn",
    "distributed.scheduler.worker-saturation": 1.0,  # a worker that dies takes only its own study
    "distributed.deploy.lost-worker-timeout": "1 day",  # starting can take long, see Place.revive
}
_ENDED = ("closed", "failed")
_NO_WORD = logging.CRITICAL + 1
"""Level of Dask's loggers. Its scheduler calls a client that has left before it was told that its
studies are taken back, as after Ctrl-C, critical."""


class ClusterLost(DrakegaitError):
    """The scheduler has gone away, or its workers cannot be used."""


def check_place(workers: int | None, scheduler: str | None) -> None:
    """Refuse a number of workers or an address that cannot be.

    Raises:
        InvalidInput: naming it.
        DrakegaitError: Dask is not installed.
    """
    if workers is not None:
        check_count("workers", workers, 1, 1024)
    if workers is not None and scheduler is not None:
        raise InvalidInput("workers", workers, "left out with a scheduler, which has its own")
    if scheduler is not None and "://" not in str(scheduler):
        raise InvalidInput("scheduler", scheduler, "an address such as tcp://host:8786")
    try:
        import distributed  # noqa: F401
    except ImportError:
        raise DrakegaitError(
            "A sweep needs the package distributed: pip install distributed."
        ) from None


class Place:
    """The workers, through their client."""

    def __init__(self, client: Client, cluster: LocalCluster | None = None):
        self.client, self._cluster = client, cluster
        self._number = 0 if cluster is None else len(cluster.workers)
        self._stuck: set[Any] = set()

    @property
    def cores(self) -> int:
        """How many solves run at once."""
        # Here also those count that are being started again.
        return self._number or sum(self.client.nthreads().values())

    @property
    def room(self) -> int:
        """How many studies to hand over at once.

        Not all, for each takes its reference and guess along; more than there are cores, for a
        cluster that grows with its work must see it.
        """
        return 2 * self.cores + 8

    def revive(self) -> None:
        """Start again what Dask has not; to be called now and then.

        Dask starts a worker again whose process has ended, but not one that ended while it was
        being started, which on a busy machine can last until its first study, and not one whose
        keeper (nanny) has given up.
        """
        if self._cluster is not None:
            self._cluster.loop.add_callback(self._revive)

    async def _revive(self) -> None:
        cluster, nannies = self._cluster, self._cluster.workers
        for name in [name for name, nanny in nannies.items() if nanny.status.name in _ENDED]:
            del nannies[name]
        if len(nannies) < self._number and cluster.status.name == "running":
            cluster.scale(self._number)
        dead = {nanny for nanny in nannies.values() if _is_dead(nanny)}
        again = dead & self._stuck  # twice in a row: nobody else is about to start it
        self._stuck = dead - again
        for nanny in again:
            with contextlib.suppress(Exception):  # then it has given up: see above
                await nanny.instantiate()


def _is_dead(nanny: Any) -> bool:
    process = getattr(nanny, "process", None)
    return process is not None and process.status.name in ("stopped", "failed")


@contextlib.contextmanager
def connected(workers: int | None, scheduler: str | None, studies: int) -> Iterator[Place]:
    """Workers for `studies` solves.

    Without `scheduler` the workers are processes of this machine, one for each core, and end with
    the `with` block whatever they are doing then; they also end if this process is killed.

    Raises:
        InvalidInput: no scheduler answers.
        ClusterLost: its workers have another version of drakegait or of Python.
    """
    if scheduler is not None:
        with _joined(str(scheduler)) as client:
            yield Place(client)
        return
    from dask.system import CPU_COUNT

    number = min(workers or CPU_COUNT, studies)
    with _started(number) as place:
        yield place


@contextlib.contextmanager
def _started(number: int) -> Iterator[Place]:
    import dask
    from distributed import Client, LocalCluster

    with dask.config.set(_LOCAL), _environment(ONE_THREAD), _silence(), _deaf_loop() as loop:
        try:
            cluster = LocalCluster(
                loop=loop,
                n_workers=number,
                threads_per_worker=1,
                processes=True,
                memory_limit=0,  # the system's limit is enough
                dashboard_address=None,
                scheduler_kwargs={"dashboard_address": "127.0.0.1:0"},  # not 8787 for all to see
                silence_logs=_NO_WORD,
            )
        except RuntimeError:
            raise ClusterLost(
                "The workers do not start. They import the program that calls sweep: the call "
                'must stand below if __name__ == "__main__".'
            ) from None
        with cluster:
            try:
                with Client(cluster, set_as_default=False) as client:
                    yield Place(client, cluster)
            finally:
                _kill(cluster)


def leave_if_imported() -> None:
    """End a worker that comes to a call of `sweep` while it imports the calling program.

    It has nothing to say: the program itself then learns that its workers do not start.
    """
    if getattr(multiprocessing.current_process(), "_inheriting", False):
        sys.exit(1)


@contextlib.contextmanager
def _deaf_loop() -> Iterator[Any]:
    """Dask's event loop, in a thread that Ctrl-C does not reach, nor the processes it starts.

    A terminal sends Ctrl-C to the workers, too. They are ended by `_kill`; one that was just being
    started would say, before Dask or we could tell it otherwise, where it was interrupted.
    """
    from multiprocessing import resource_tracker

    from distributed.utils import LoopRunner

    resource_tracker.ensure_running()  # later it would make that thread hear again
    runner = LoopRunner()
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        runner.start()  # threads and processes inherit the mask
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)
    try:
        yield runner.loop
    finally:
        runner.stop()


@contextlib.contextmanager
def _environment(variables: Mapping[str, str]) -> Iterator[None]:
    """What processes inherit that are started meanwhile."""
    before = {name: os.environ.get(name) for name in variables}
    os.environ.update(variables)
    try:
        yield
    finally:
        for name, value in before.items():
            if value is None:
                del os.environ[name]
            else:
                os.environ[name] = value


@contextlib.contextmanager
def _silence() -> Iterator[None]:
    """No word of Dask about connections that end: we end them, or say it ourselves."""
    names = [name for name in logging.root.manager.loggerDict if name.startswith("distributed.")]
    levels = {
        logger: logger.level
        for logger in map(logging.getLogger, ["distributed", *names])
        if logger.level or logger.name == "distributed"  # others do as the one above them
    }
    for logger in levels:
        logger.setLevel(_NO_WORD)
    try:
        yield
    finally:
        for logger, level in levels.items():
            logger.setLevel(level)


def _kill(cluster: LocalCluster) -> None:
    """End the workers at once; asked politely they would finish their solve first."""
    for nanny in cluster.workers.values():
        nanny.close_gracefully()  # so that it starts no other
        process = getattr(getattr(nanny, "process", None), "process", None)
        pid = getattr(process, "pid", None)
        if pid:
            with contextlib.suppress(OSError):
                os.kill(pid, getattr(signal, "SIGKILL", signal.SIGTERM))


@contextlib.contextmanager
def _joined(address: str) -> Iterator[Client]:
    from distributed import Client

    allowed = f"the address of a running Dask scheduler (no answer in {CONNECT_SECONDS:g} s)"
    try:
        client = Client(address, timeout=CONNECT_SECONDS, set_as_default=False)
    except (OSError, ValueError, TypeError):  # time-outs are OSErrors
        raise InvalidInput("scheduler", address, allowed) from None
    with _silence():
        try:
            _compare_versions(client)
            yield client
        finally:
            # If the scheduler has gone away Dask closes the client, too, and trips over ours.
            with contextlib.suppress(RuntimeError, OSError):
                client.close()


def _compare_versions(client: Client) -> None:
    """Ask the workers that are there; those that come later are asked before each study."""
    ours = versions()
    theirs: dict[str, Any] = client.run(versions, on_error="return")
    for worker, found in theirs.items():
        if isinstance(found, ModuleNotFoundError):
            raise ClusterLost(f"The worker {worker} lacks a package: {found}.") from None
        if isinstance(found, BaseException):
            raise ClusterLost(f"The worker {worker} cannot run drakegait: {found}.") from None
        if tuple(found) != ours:
            there, here = " on Python ".join(found), " on Python ".join(ours)
            raise ClusterLost(f"The worker {worker} has drakegait {there}, not {here}.")
