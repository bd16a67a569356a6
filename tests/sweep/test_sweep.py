"""Sweeps on real workers: each study once, nothing lost, failures kept apart.

Where it does not matter whose workers they are, those of one scheduler serve all tests.
"""

from __future__ import annotations

import os
import signal

import pytest
import sweep_cases as cases
from sweep_cases import read, studies, trace

from drakegait.errors import BadFile
from drakegait.solvers.options import SolverOptions
from drakegait.sweep import sweep

pytest.importorskip("distributed")
xr = pytest.importorskip("xarray")


@pytest.fixture
def run(scheduler, traces):
    def run(asked, folder, **choices):
        return sweep(asked, folder, **{"scheduler": scheduler, "_solve": cases.solve} | choices)

    return run


def run_here(asked, folder, **choices):
    return sweep(asked, folder, workers=2, _solve=cases.solve, **choices)


def test_every_study_is_solved_once_in_other_processes_and_kept(tmp_path, traces):
    seen = []
    result = run_here(studies(1.0, 1.1, 1.2), tmp_path / "out", report=seen.append)
    assert sorted(trace(traces, "end")) == ["1", "1.1", "1.2"] == sorted(trace(traces, "begin"))
    assert os.getpid() not in cases.processes(traces)
    for name in ("1", "1.1", "1.2"):
        assert result.gait(name).study.speed == float(name)
        assert read(tmp_path / "out" / name / "summary.json")["sweep"]["study"] == name
    assert result.failures == {} and result.notes == ()
    assert (seen[0].done, seen[0].waiting, seen[-1].done, seen[-1].running) == (0, 3, 3, ())
    assert all(item.total == 3 for item in seen)

    again = run_here(studies(1.0, 1.1, 1.2), tmp_path / "out")
    assert len(trace(traces, "begin")) == 3  # nothing was begun anew
    assert again.table()["status"].tolist() == 3 * ["done"]
    assert not list((tmp_path / "out").rglob("*.part"))


def test_the_table_comes_back_from_its_files_with_axes_and_units(tmp_path, traces, run):
    cases.tell(traces, "1.1", "stop")
    result = run(studies(1.2, 1.0, 1.1), tmp_path / "out")
    frame = result.table()
    assert list(frame.index) == ["1.2", "1", "1.1"] and list(frame.columns)[0] == "speed"
    with xr.open_dataset(tmp_path / "out" / "sweep.nc", engine="h5netcdf") as data:
        assert data["speed"].values.tolist() == [1.0, 1.1, 1.2]
        assert data["speed"].attrs["units"] == "m/s"
        energy = data["cost_of_transport_J_per_m"]
        assert energy.attrs["units"] == "J/m" and float(energy.sel(speed=1.2)) == 301.2
        assert energy.isnull().values.tolist() == [False, True, False]  # no answer, no number
        assert data["status"].values.tolist() == ["done", "failed", "done"]
        assert data["study"].values.tolist() == ["1", "1.1", "1.2"]
    pandas = pytest.importorskip("pandas")
    table = pandas.read_csv(tmp_path / "out" / "sweep.csv", index_col="study")
    assert table["cost_of_transport_J_per_m"].notna().tolist() == [True, True, False]
    assert [path.name for path in result.plot()] == ["sweep.svg", "sweep.png"]
    assert all(path.stat().st_size > 1000 for path in result.plot())


def test_one_failure_stops_no_other_and_is_tried_again_only_when_asked(tmp_path, traces, run):
    for name, deed in (("1", "refuse"), ("1.1", "raise"), ("1.2", "stop")):
        cases.tell(traces, name, deed)
    asked, out = studies(1.0, 1.1, 1.2, 1.3), tmp_path / "out"
    result = run(asked, out)
    assert set(result.failures) == {"1", "1.1", "1.2"}
    assert result.failures["1"] == "friction is 7, but must be less."
    assert result.failures["1.1"] == "ZeroDivisionError: of a test"
    assert "infeasible" in result.failures["1.2"] and "As told." in result.failures["1.2"]
    assert "Traceback" in read(out / "1.1" / "failed.json")["details"]
    assert "Try less." in read(out / "1.2" / "failed.json")["details"]
    assert (out / "1.2" / "gait.nc").exists()  # the nearest gait
    assert (out / "1.3" / "gait.nc").exists() and not (out / "1.3" / "failed.json").exists()
    with pytest.raises(BadFile, match="friction is 7"):
        result.gait("1")

    for name in ("1", "1.1", "1.2"):
        cases.tell(traces, name, "")
    kept = run(asked, out)
    assert len(trace(traces, "begin")) == 4 and kept.failures == result.failures
    assert all("failed earlier" in note for note in kept.notes) and len(kept.notes) == 3
    mended = run(asked, out, retry_failed=True)
    assert mended.failures == {} and len(trace(traces, "begin")) == 7
    assert not list(out.rglob("failed.json"))


def test_a_changed_study_is_solved_anew_and_others_are_not(tmp_path, traces, run):
    asked, out = studies(1.0, 1.1), tmp_path / "out"
    run(asked, out)
    asked["1.1"] = asked["1.1"].replace(energy_weight=2.0)
    result = run(asked, out, options=SolverOptions(time_limit=9.0))  # no change of the study
    assert trace(traces, "begin")[2:] == ["1.1"]
    assert result.notes == ("1.1: the study has changed since it was solved; solved again.",)


@pytest.mark.parametrize("harm", ["truncated", "altered", "lost", "summary"])
def test_a_damaged_result_is_noticed_and_solved_anew(tmp_path, traces, run, harm):
    asked, out = studies(1.0, 1.1), tmp_path / "out"
    run(asked, out)
    gait = out / "1" / "gait.nc"
    if harm == "truncated":
        gait.write_bytes(gait.read_bytes()[:5])
    elif harm == "altered":
        gait.write_bytes(gait.read_bytes()[:-1] + b"2")
    elif harm == "lost":
        gait.unlink()
    else:
        (out / "1" / "summary.json").write_text("{")
    result = run(asked, out)
    assert trace(traces, "end")[2:] == ["1"]
    assert len(result.notes) == 1 and result.notes[0].startswith("1: ")
    assert "damaged or missing; solved again." in result.notes[0]
    assert result.gait("1").study.speed == 1.0


def test_neighbours_wait_for_their_guess_or_for_the_next_one_up(tmp_path, traces, run):
    cases.tell(traces, "1.1", "stop")
    asked, chain = studies(1.3, 1.2, 1.1, 1.0), {"1.3": "1.2", "1.2": "1.1", "1.1": "1"}
    result = run(asked, tmp_path / "out", warm=chain)
    assert trace(traces, "end") == ["1", "1.1", "1.2", "1.3"]
    assert cases.guesses(traces) == {"1": None, "1.1": "1", "1.2": "1", "1.3": "1.2"}
    assert result.table()["guess"].to_dict() | {"1": None} == cases.guesses(traces)


def test_a_worker_killed_in_mid_run_costs_one_more_try(tmp_path, traces):
    cases.tell(traces, "1.1", "wait")

    def kill_it_once(_):
        begun = cases.processes(traces, "1.1")
        if begun and not (traces / "gate").exists():
            os.kill(begun[0], signal.SIGKILL)
            cases.wait_for(lambda: not cases.alive(begun[0]), "the end of the worker")
            (traces / "gate").touch()

    result = run_here(studies(1.0, 1.1, 1.2), tmp_path / "out", report=kill_it_once)
    assert result.failures == {}
    assert trace(traces, "begin").count("1.1") == 2
    assert sorted(trace(traces, "end")) == ["1", "1.1", "1.2"]


def test_a_study_that_kills_its_workers_is_given_up_after_two_more_tries(tmp_path, traces):
    cases.tell(traces, "1.1", "die")
    result = run_here(studies(1.0, 1.1, 1.2, 1.3), tmp_path / "out")
    assert result.failures == {"1.1": "Its worker has died 3 times."}
    assert trace(traces, "begin").count("1.1") == 3
    assert sorted(trace(traces, "end")) == ["1", "1.2", "1.3"]
    assert read(tmp_path / "out" / "1.1" / "failed.json")["kind"] == "worker died"


def test_two_sweeps_do_not_write_into_one_folder(tmp_path, traces, run):
    out = tmp_path / "out"

    def second(_):
        if not refused:
            with pytest.raises(BadFile, match="another sweep works here") as error:
                run(studies(1.0), out)
            refused.append(str(error.value))

    refused: list[str] = []
    run(studies(1.0), out, report=second)
    assert f"process {os.getpid()}" in refused[0]
    run(studies(1.0), out)  # and now it is free
