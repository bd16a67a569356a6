"""The calling process ends in mid-run, by kill -9 or Ctrl-C; the next call goes on."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest
import sweep_cases as cases
from sweep_cases import alive, read, studies, trace, wait_for

from drakegait.gait import Gait
from drakegait.solve import solve
from drakegait.sweep import sweep, sweep_file
from drakegait.sweep.interrupt import Interrupt

pytest.importorskip("distributed")

ROOT = Path(__file__).resolve().parents[2]
CLIENT = """
import sys
import sweep_cases as cases
from drakegait.sweep import sweep
if __name__ == "__main__":
    sweep(cases.studies(1.0, 1.1, 1.2, 1.3), sys.argv[1], workers=2, _solve=cases.solve)
"""
TOML = """
[sweep]
warm = "speed"
refine = false
[base]
model = "planar-symmetric"
nodes = 13
interior_points = [1, 1, 3, 2]
[grid]
speed = [1.2, 1.25, 1.3]
"""


def start(*arguments, **options) -> subprocess.Popen:
    """A process group of its own, so that signals reach it and its workers alone."""
    paths = os.pathsep.join([str(ROOT), str(ROOT / "tests" / "sweep")])
    environment = os.environ | {"PYTHONPATH": paths, "OMP_NUM_THREADS": "1"}
    return subprocess.Popen(
        [sys.executable, *map(str, arguments)], env=environment, stdout=subprocess.PIPE,
        stderr=subprocess.PIPE, text=True, start_new_session=True, **options,
    )  # fmt: skip


def test_after_a_kill_the_next_call_goes_on_and_repeats_and_loses_none(tmp_path, traces):
    """kill -9 of the client while two studies run: the others are kept, no process is left."""
    for name in ("1.1", "1.3"):
        cases.tell(traces, name, "wait")
    program, out = tmp_path / "client.py", tmp_path / "out"
    program.write_text(CLIENT)
    client = start(program, out)
    with client:
        wait_for(lambda: len(trace(traces, "begin")) == 4, "the studies to begin")
        kept = [out / name / "summary.json" for name in ("1", "1.2")]
        wait_for(lambda: all(path.exists() for path in kept), "the first results")
        before = {path: path.stat().st_mtime_ns for path in kept}
        client.kill()
    wait_for(lambda: not any(map(alive, cases.processes(traces))), "the end of the workers")
    assert sorted(trace(traces, "end")) == ["1", "1.2"]
    assert {path.name for path in out.iterdir()} == {".lock", "1", "1.2"}

    (traces / "gate").touch()
    asked = studies(1.0, 1.1, 1.2, 1.3)
    result = sweep(asked, out, workers=2, _solve=cases.solve)
    assert result.failures == {} and set(result.table()["status"]) == {"done"}
    assert sorted(trace(traces, "end")) == ["1", "1.1", "1.2", "1.3"]
    assert {path: path.stat().st_mtime_ns for path in kept} == before
    assert not list(out.rglob("*.part"))


def test_ctrl_c_is_heard_wherever_python_is(tmp_path, traces, scheduler):
    """Here in a destructor, out of which no exception comes."""

    class Dying:
        def __del__(self):
            signal.raise_signal(signal.SIGINT)

    def report(progress):
        if progress.done == 1:
            Dying()

    cases.tell(traces, "1.1", "wait")
    asked, out = studies(1.0, 1.1), tmp_path / "out"
    with pytest.raises(KeyboardInterrupt):
        sweep(asked, out, scheduler=scheduler, report=report, _solve=cases.solve)
    (traces / "gate").touch()
    assert signal.getsignal(signal.SIGINT) is signal.default_int_handler
    assert (out / "1" / "summary.json").exists() and not (out / "1.1").exists()


def test_a_second_ctrl_c_does_not_wait():
    with pytest.raises(KeyboardInterrupt), Interrupt(lambda: None):
        signal.raise_signal(signal.SIGINT)
        with pytest.raises(KeyboardInterrupt):
            signal.raise_signal(signal.SIGINT)
        reached = True
    assert reached


@pytest.mark.solve
def test_ctrl_c_keeps_what_is_finished_and_the_same_command_goes_on(tmp_path):
    """Real solves on the command line, each started from the one before; the gait is `solve`'s."""
    file, out = tmp_path / "speeds.toml", tmp_path / "out"
    file.write_text(TOML)
    command = ("-m", "drakegait.cli", "sweep", file, "--out", out, "--workers", "1")
    names = [f"speed={speed}" for speed in ("1.2", "1.25", "1.3")]
    first = start(*command)
    with first:
        wait_for(lambda: (out / names[0] / "summary.json").exists(), "the first gait")
        os.killpg(first.pid, signal.SIGINT)  # as a terminal does: to the workers as well
        text, errors = first.communicate(timeout=cases.DEADLINE)
    assert first.returncode == 130, errors
    assert "finished studies are kept" in text and "same command goes on" in text
    assert "Traceback" not in errors and errors.count("\n") <= 1
    kept = (out / names[0] / "gait.nc").stat().st_mtime_ns

    second = start(*command)
    with second:
        text, errors = second.communicate(timeout=cases.DEADLINE)
    assert second.returncode == 0 and "Traceback" not in errors, errors
    assert "3 of 3 converged" in text
    assert (out / names[0] / "gait.nc").stat().st_mtime_ns == kept
    summaries = [read(out / name / "summary.json") for name in names]
    assert [each["sweep"]["guess"] for each in summaries] == [None, *names[:2]]
    assert (out / "sweep.nc").exists() and (out / "sweep.png").exists()

    asked = sweep_file.read(file)
    guess = Gait.load(out / names[0] / "gait.nc")
    here = solve(
        asked.studies[names[1]], guess=guess, options=asked.options[names[1]], refine=False
    )
    there = Gait.load(out / names[1] / "gait.nc")
    # The same but for the rounding of a BLAS that may use more threads here.
    assert there.cost["total"] == pytest.approx(here.cost["total"], rel=1e-3)
