"""Where solves run: a scheduler by its address, and what is refused before anything runs."""

from __future__ import annotations

import logging
import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest
import sweep_cases as cases
from sweep_cases import studies

from drakegait.errors import DrakegaitError, InvalidInput, UnknownName
from drakegait.solvers.options import SolverOptions
from drakegait.study import GaitStudy
from drakegait.sweep import cluster, run, sweep

ROOT = Path(__file__).resolve().parents[2]


def test_a_scheduler_by_address_solves_on_its_own_workers(tmp_path, traces, scheduler):
    result = sweep(studies(1.0, 1.1), tmp_path / "out", scheduler=scheduler, _solve=cases.solve)
    assert result.failures == {} and len(cases.trace(traces, "end")) == 2
    from distributed import Client

    with Client(scheduler, set_as_default=False) as client:  # it is still there, as it was
        theirs = set(client.run(os.getpid).values())
        assert not client.futures and len(theirs) == 2
    assert set(cases.processes(traces)) <= theirs


def test_a_scheduler_that_goes_away_ends_the_sweep_and_costs_nothing(
    tmp_path, traces, start_cluster, monkeypatch
):
    monkeypatch.setattr(cluster, "CONNECT_SECONDS", 3.0)  # also how long it is looked for
    cases.tell(traces, "1.1", "wait")
    address, process = start_cluster()

    def kill_it(progress):
        if progress.done == 1:
            process.kill()

    asked, out = studies(1.0, 1.1), tmp_path / "out"
    with process, pytest.raises(cluster.ClusterLost, match="finished studies are kept"):
        sweep(asked, out, scheduler=address, report=kill_it, _solve=cases.solve)
    (traces / "gate").touch()
    result = sweep(asked, out, workers=1, _solve=cases.solve)
    assert result.failures == {} and cases.trace(traces, "end") == ["1", "1.1"]


def test_a_client_that_dask_cannot_close_hides_nothing(scheduler, monkeypatch):
    """Dask itself closes one whose scheduler has gone away, and fails if we do at the same time."""
    from distributed import Client

    close = Client.close

    def trip(client, *args, **kwargs):
        close(client, *args, **kwargs)
        raise RuntimeError("Cannot change state of expiring Timeout")

    monkeypatch.setattr(Client, "close", trip)
    lost = pytest.raises(cluster.ClusterLost, match="as before")
    with lost, cluster.connected(None, scheduler, 1):
        raise cluster.ClusterLost("as before")


def test_a_worker_keeps_to_one_core_and_is_replaced_when_its_keeper_gives_up(monkeypatch):
    """Neither the first nor its successor hears Ctrl-C; we do."""

    def hears() -> bool:
        return signal.SIGINT not in signal.pthread_sigmask(signal.SIG_BLOCK, ())

    pytest.importorskip("distributed")
    monkeypatch.setenv("OMP_NUM_THREADS", "4")
    monkeypatch.delenv("OMP_CANCELLATION", raising=False)
    with cluster.connected(1, None, 1) as place:
        assert hears() and set(place.client.run(hears).values()) == {False}
        local = place.client.cluster
        local.sync(next(iter(local.workers.values())).close)

        def is_back():
            place.revive()
            return sum(place.client.nthreads().values()) == 1

        cases.wait_for(is_back, "another worker")
        assert place.cores == 1
        assert hears() and set(place.client.run(hears).values()) == {False}
        (found,) = place.client.run(lambda: dict(os.environ)).values()
    assert found.items() >= cluster.ONE_THREAD.items()
    assert "MALLOC_TRIM_THRESHOLD_" not in found
    assert os.environ["OMP_NUM_THREADS"] == "4" and "OMP_CANCELLATION" not in os.environ


def test_dask_says_nothing_while_we_work_and_speaks_again_afterwards(scheduler, caplog):
    """After Ctrl-C its scheduler finds the client gone, which it calls critical."""
    log = logging.getLogger("distributed.scheduler")
    for place in ((1, None), (None, scheduler)):
        with cluster.connected(*place, 1):
            log.critical("Closed comm")
        assert caplog.messages == []
    log.critical("as before")
    assert caplog.messages == ["as before"]


def test_workers_of_another_version_are_refused(tmp_path, traces, scheduler, monkeypatch):
    monkeypatch.setattr("drakegait.__version__", "9.9")  # here, not there
    with pytest.raises(cluster.ClusterLost, match=r"has drakegait .* on Python .*, not 9\.9 on"):
        sweep(studies(1.0), tmp_path / "out", scheduler=scheduler, _solve=cases.solve)
    assert not (tmp_path / "out").exists()
    # One that comes later is met by the study.
    monkeypatch.setattr(cluster, "_compare_versions", lambda client: None)
    result = sweep(studies(1.0), tmp_path / "out", scheduler=scheduler, _solve=cases.solve)
    assert ", not 9.9 on Python" in result.failures["1"] and not cases.processes(traces)


def test_nobody_at_the_address_is_said_in_a_sentence(tmp_path, monkeypatch):
    pytest.importorskip("distributed")
    monkeypatch.setattr(cluster, "CONNECT_SECONDS", 0.5)
    with pytest.raises(InvalidInput, match="scheduler is 'tcp://127.0.0.1:9'.*no answer"):
        sweep(studies(1.0), tmp_path / "out", scheduler="tcp://127.0.0.1:9")
    assert not (tmp_path / "out").exists()


def test_a_call_without_the_main_guard_is_explained(tmp_path):
    pytest.importorskip("distributed")
    program = tmp_path / "program.py"
    program.write_text(
        "from drakegait import GaitStudy, sweep\n"
        f"sweep({{'a': GaitStudy.planar()}}, {str(tmp_path / 'out')!r}, workers=1)\n"
    )
    ended = subprocess.run(
        [sys.executable, program], env=os.environ | {"PYTHONPATH": str(ROOT)},
        capture_output=True, text=True, timeout=cases.DEADLINE,
    )  # fmt: skip
    assert ended.returncode == 1 and 'below if __name__ == "__main__"' in ended.stderr
    assert ended.stderr.count("Traceback") == 1  # ours; the workers say nothing


PLANAR, SPATIAL = GaitStudy.planar(), GaitStudy.spatial()
REFUSED = [
    (dict(studies={}), ["studies", "at least one"]),
    (dict(studies={"a": 3}), ["study 'a'", "3", "a GaitStudy"]),
    (dict(studies={"a/b": PLANAR}), ["name of a study", "'a/b'", "folder"]),
    (dict(studies={"..": PLANAR}), ["name of a study", "'..'"]),
    (dict(studies={".a": PLANAR}), ["name of a study", "no dot first"]),
    (dict(studies={"sweep.nc": PLANAR}), ["name of a study", "'sweep.nc'"]),
    (dict(studies={"a": PLANAR, "A": PLANAR}), ["name of a study", "'A'", "capitals"]),
    (dict(warm={"b": "c"}), ["guess in warm", "'c'", "one of a, b"]),
    (dict(warm={"c": "b"}), ["study in warm", "'c'"]),
    (dict(warm={"a": "b", "b": "a"}), ["warm", "a <- b <- a", "circle"]),
    (dict(warm={"a": "a"}), ["warm", "circle"]),
    (dict(studies={"a": PLANAR, "b": SPATIAL}, warm={"a": "b"}), ["guess of 'a'", "planar"]),
    (dict(options={"a": SolverOptions()}), ["options of 'b'", "SolverOptions"]),
    (dict(workers=0), ["workers", "0", "from 1"]),
    (dict(workers=2, scheduler="tcp://h:1"), ["workers", "left out"]),
    (dict(scheduler="host"), ["scheduler", "'host'", "tcp://host:8786"]),
    (dict(axes={"a": {"x": 1}}), ["axes of 'b'"]),
    (dict(axes={"a": {"x": 1}, "b": {"y": 1}}), ["axes of 'b'", "same axes"]),
    (dict(studies={"a": PLANAR.replace(strength={"bicepss": 2.0})}), ["muscle", "'bicepss'"]),
]


@pytest.mark.parametrize(("changes", "words"), REFUSED, ids=lambda x: str(x)[:50])
def test_what_cannot_be_is_refused_before_anything_runs(tmp_path, monkeypatch, changes, words):
    pytest.importorskip("distributed")
    monkeypatch.setattr(run, "connected", None)  # would be the start
    arguments = {"studies": {"a": PLANAR, "b": PLANAR}} | changes
    asked = arguments.pop("studies")
    with pytest.raises((InvalidInput, UnknownName)) as error:
        sweep(asked, tmp_path / "out", **arguments)
    assert [word for word in words if word not in str(error.value)] == []
    assert list(tmp_path.iterdir()) == []


def test_without_dask_one_sentence_says_what_to_install(tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "distributed", None)
    with pytest.raises(DrakegaitError, match="pip install distributed"):
        sweep({"a": PLANAR}, tmp_path / "out")
