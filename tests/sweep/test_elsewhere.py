"""Workers of others: `dask scheduler` and `dask worker`, started as docs/sweep.md has it."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest
import sweep_cases as cases
from sweep_cases import alive, studies, trace, wait_for

from drakegait.gait import Gait
from drakegait.sweep import sweep

pytest.importorskip("distributed")

ROOT = Path(__file__).resolve().parents[2]
CLIENT = """
import sys
import sweep_cases as cases
from drakegait.sweep import sweep
if __name__ == "__main__":
    sweep(cases.studies(1.0, 1.1, 1.2), sys.argv[1], scheduler=sys.argv[2], _solve=cases.solve)
"""
TOML = """
[sweep]
refine = false
[base]
model = "planar-symmetric"
nodes = 13
interior_points = [1, 1, 3, 2]
[grid]
speed = [1.2, 1.25]
"""


def start(*words, **options) -> subprocess.Popen:
    paths = os.pathsep.join([str(ROOT), str(ROOT / "tests" / "sweep")])
    environment = os.environ | {"PYTHONPATH": paths, "OMP_NUM_THREADS": "1",
                                "OMP_CANCELLATION": "TRUE"}  # fmt: skip
    return subprocess.Popen([sys.executable, *map(str, words)], env=environment, **options)


@pytest.fixture(scope="module")
def address(tmp_path_factory, traces_link) -> Iterator[str]:
    """A scheduler and two workers, three programs that know nothing of us."""
    file = tmp_path_factory.mktemp("dask") / "scheduler.json"
    silent = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL, "cwd": file.parent}
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv(cases.TRACE, str(traces_link))
        scheduler = start(
            "-m", "distributed.cli.dask_scheduler", "--host", "127.0.0.1", "--port", "0",
            "--no-dashboard", "--dashboard-address", "127.0.0.1:0", "--scheduler-file", file,
            **silent,
        )  # fmt: skip
        workers = start(
            "-m", "distributed.cli.dask_worker", "--scheduler-file", file, "--nworkers", "2",
            "--nthreads", "1", "--no-dashboard", **silent,
        )  # fmt: skip
    try:
        wait_for(lambda: file.exists() and file.read_text().endswith("}"), "the scheduler")
        yield json.loads(file.read_text())["address"]
    finally:
        for process in (workers, scheduler):
            process.terminate()
        for process in (workers, scheduler):
            process.wait(cases.DEADLINE)


def test_a_worker_killed_in_mid_run_costs_one_more_try(tmp_path, traces, address):
    """kill -9; its keeper starts another, which joins the scheduler again."""
    cases.tell(traces, "1.1", "wait")

    def kill_it_once(_):
        begun = cases.processes(traces, "1.1")
        if begun and not (traces / "gate").exists():
            os.kill(begun[0], signal.SIGKILL)
            wait_for(lambda: not alive(begun[0]), "the end of the worker")
            (traces / "gate").touch()

    asked, out = studies(1.0, 1.1, 1.2), tmp_path / "out"
    result = sweep(asked, out, scheduler=address, report=kill_it_once, _solve=cases.solve)
    assert result.failures == {} and address.startswith("tcp://")
    assert trace(traces, "begin").count("1.1") == 2
    assert sorted(trace(traces, "end")) == ["1", "1.1", "1.2"]


def test_a_client_killed_in_mid_run_loses_and_repeats_nothing(tmp_path, traces, address):
    """kill -9; the workers live on, what was finished is on disk, the next call does the rest."""
    cases.tell(traces, "1.1", "wait")
    program, out = tmp_path / "client.py", tmp_path / "out"
    program.write_text(CLIENT)
    with start(program, out, address) as client:
        wait_for(lambda: len(trace(traces, "begin")) == 3, "the studies to begin")
        kept = [out / name / "summary.json" for name in ("1", "1.2")]
        wait_for(lambda: all(path.exists() for path in kept), "the first results")
        before = {path: path.stat().st_mtime_ns for path in kept}
        client.kill()
    workers = cases.processes(traces)
    (traces / "gate").touch()
    result = sweep(studies(1.0, 1.1, 1.2), out, scheduler=address, _solve=cases.solve)
    assert result.failures == {} and all(map(alive, workers))
    assert {path: path.stat().st_mtime_ns for path in kept} == before
    assert [trace(traces, "begin").count(name) for name in ("1", "1.2")] == [1, 1]
    assert not list(out.rglob("*.part"))


@pytest.mark.solve
def test_the_command_solves_there(tmp_path, traces, address):
    file, out = tmp_path / "speeds.toml", tmp_path / "out"
    file.write_text(TOML)
    command = ("-m", "drakegait.cli", "sweep", file, "--out", out, "--scheduler", address)
    with start(*command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as ended:
        text, errors = ended.communicate(timeout=cases.DEADLINE)
    assert ended.returncode == 0 and errors == "", errors
    assert "2 of 2 converged" in text
    for speed in (1.2, 1.25):
        assert Gait.load(out / f"speed={speed}" / "gait.nc").study.speed == speed
