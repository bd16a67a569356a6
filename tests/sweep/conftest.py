from __future__ import annotations

import os
import shutil
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
import sweep_cases

TESTS = Path(__file__).resolve().parents[1]
sys.path.append(str(TESTS))  # of gait_cases

CLUSTER = """
import sys
from distributed import LocalCluster
if __name__ == "__main__":
    with LocalCluster(n_workers=2, threads_per_worker=1, memory_limit=0, dashboard_address=None,
                      scheduler_kwargs={"dashboard_address": "127.0.0.1:0"},
                      silence_logs=50) as cluster:
        print(cluster.scheduler_address, flush=True)
        sys.stdin.read()
"""


@pytest.fixture(scope="session")
def prepared_gait(tmp_path_factory) -> Path:
    """A folder with the gait that `sweep_cases.solve` answers."""
    from gait_cases import reference_gait

    folder = tmp_path_factory.mktemp("prepared")
    reference_gait("planar-symmetric").save(folder / "gait.nc")
    return folder / "gait.nc"


@pytest.fixture(scope="session")
def traces_link(tmp_path_factory) -> Path:
    """Where workers look for the folder of the test that runs now."""
    return tmp_path_factory.mktemp("link") / "traces"


@pytest.fixture
def traces(tmp_path, monkeypatch, prepared_gait, traces_link) -> Path:
    """The folder in which `sweep_cases.solve` leaves its trace, known to every worker."""
    folder = tmp_path / "traces"
    folder.mkdir()
    shutil.copy(prepared_gait, folder / "gait.nc")
    traces_link.unlink(missing_ok=True)
    traces_link.symlink_to(folder)
    monkeypatch.setenv(sweep_cases.TRACE, str(traces_link))
    return folder


@pytest.fixture(scope="session")
def start_cluster(tmp_path_factory, traces_link) -> Callable[[], tuple[str, subprocess.Popen]]:
    """Starts a Dask scheduler with two workers that knows nothing of us; ends with its input.

    Returns the address and the process.
    """
    pytest.importorskip("distributed")
    program = tmp_path_factory.mktemp("cluster") / "cluster.py"
    program.write_text(CLUSTER)
    paths = [str(TESTS.parent), str(TESTS / "sweep")]
    environment = os.environ | {"PYTHONPATH": os.pathsep.join(paths),
                                sweep_cases.TRACE: str(traces_link)}  # fmt: skip

    def start() -> tuple[str, subprocess.Popen]:
        process = subprocess.Popen(
            [sys.executable, program], env=environment, stdin=subprocess.PIPE,
            stdout=subprocess.PIPE, text=True,
        )  # fmt: skip
        return process.stdout.readline().strip(), process

    return start


@pytest.fixture(scope="session")
def scheduler(start_cluster) -> Iterator[str]:
    """Address of a scheduler that serves all tests."""
    address, process = start_cluster()
    with process:
        yield address
        process.stdin.close()
