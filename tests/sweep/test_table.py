"""Axes, tables, pictures and expected time, from results that are made up."""

from __future__ import annotations

import itertools
import math

import pytest

from drakegait.study import GaitStudy
from drakegait.sweep import axes, progress
from drakegait.sweep.result import SweepResult
from drakegait.sweep.store import State
from drakegait.whole_file import new_folder, write_json

xr = pytest.importorskip("xarray")


def made_up(folder, grid: dict, failed=(), leave_out=()) -> SweepResult:
    """A result in which energy and deviation are sums of the numbers in a study's place."""
    places = {}
    for values in itertools.product(*grid.values()):
        places[" ".join(map(str, values))] = dict(zip(grid, values, strict=True))
    for name in leave_out:
        del places[name]
    states = {}
    for name, place in places.items():
        total = sum(x for x in place.values() if not isinstance(x, str))
        cost = {"metabolic_cost_of_transport_J_per_m": 300.0 + total, "deviation": 0.1 * total}
        summary = new_folder(folder / name) / "summary.json"
        write_json(summary, {"cost": cost, "check": {"passed": False}})
        states[name] = State("failed", "of a test") if name in failed else State("done")
    return SweepResult(folder, dict.fromkeys(places, GaitStudy.planar()), places, states)


def test_a_full_grid_is_labelled_by_its_axes(tmp_path):
    grid = {"speed": [1.2, 0.8], "model": ["spatial", "planar"]}
    data = made_up(tmp_path, grid, failed=["1.2 planar"]).dataset()
    energy = data["cost_of_transport_J_per_m"]
    assert energy.dims == ("speed", "model") and energy.shape == (2, 2)
    assert data["speed"].values.tolist() == [0.8, 1.2]
    assert data["model"].values.tolist() == ["spatial", "planar"]
    assert float(energy.sel(speed=1.2, model="spatial")) == 301.2
    assert math.isnan(energy.sel(speed=1.2, model="planar"))
    assert str(data["reason"].sel(speed=1.2, model="planar").item()) == "of a test"
    assert str(data["check_passed"].sel(speed=0.8, model="planar").item()) == "no"
    assert str(data["study"].sel(speed=0.8, model="planar").item()) == "0.8 planar"


def test_with_a_gap_in_the_grid_studies_are_listed_with_their_place(tmp_path):
    grid = {"speed": [0.8, 1.2], "added_mass.foot_r": [0, 2]}
    result = made_up(tmp_path, grid, leave_out=["1.2 0"])
    data = result.dataset()
    assert data["cost"].dims == ("study",) and data.sizes["study"] == 3
    assert data["speed"].values.tolist() == [0.8, 0.8, 1.2]
    assert data["added_mass.foot_r"].attrs["units"] == "kg"
    assert list(result.table()["added_mass.foot_r"]) == [0, 2, 2]


def test_files_hold_what_the_result_holds(tmp_path):
    result = made_up(tmp_path, {"speed": [0.8, 1.2], "set.friction": [0.5, 0.6]}, ["0.8 0.5"])
    written = result.save(tmp_path)
    with xr.open_dataset(written[1], engine="h5netcdf") as data:
        xr.testing.assert_identical(data.load(), result.dataset())


@pytest.mark.parametrize(("grid", "failed"), [
    ({"speed": [0.8, 1.0, 1.2], "added_mass.foot_r": [0, 1]}, ["1.0 1"]),  # lines
    ({"speed": [0.8 + k / 10 for k in range(9)], "mass": [60.0 + k for k in range(9)]}, []),  # map
    ({"model": ["planar", "spatial"], "solver": ["a", "b"]}, ["planar a"]),  # names
    ({"speed": [1.0]}, ["1.0"]),  # nothing to compare, nothing found
], ids=["lines", "map", "names", "nothing"])  # fmt: skip
def test_there_is_a_picture_for_every_kind_of_grid(tmp_path, grid, failed):
    svg, png = made_up(tmp_path, grid, failed).plot(tmp_path)
    text = svg.read_text()
    assert "cost of transport" in text and "deviation" in text
    assert (f"{len(failed)} failed" in text) == bool(failed)
    assert png.stat().st_size > 5000


def test_differences_name_only_what_differs_and_fill_what_is_absent():
    bare = GaitStudy.planar()
    found = axes.differences({
        "bare": bare,
        "heavy": bare.with_added_mass("foot_r", 1.0).with_added_mass("foot_r", 0.5),
        "placed": bare.with_added_mass("hat", 5.0, (0.0, 0.0, 0.3)),
        "weak": bare.replace(strength={"SOL": 0.5}).with_settings(friction=0.4),
        "stiff": bare.with_limit("knee_flexion_r", high=math.radians(60.0)),
    })  # fmt: skip
    plain = {
        "strength.SOL": 1.0,
        "added_mass.foot_r": 0.0,
        "added_mass.hat": 0.0,
        "limit.knee_flexion_r": "default",
        "contact.friction": bare.contact.friction,
    }
    assert found["bare"] == plain
    assert found["heavy"] == plain | {"added_mass.foot_r": 1.5}
    assert found["placed"] == plain | {"added_mass.hat": "5@0,0,0.3"}
    assert found["weak"] == plain | {"strength.SOL": 0.5, "contact.friction": 0.4}
    assert found["stiff"] == plain | {"limit.knee_flexion_r": ":60"}


def test_units_of_axes():
    names = ("speed", "added_mass.hat", "height", "set.friction", "contact.friction", "model")
    assert [axes.unit(name) for name in names] == ["m/s", "kg", "m", "-", "-", ""]
    assert axes.unit("limit.knee_flexion_r") == "deg"
    assert axes.unit("limit.hat_z") == "m"


def test_the_expected_time_is_the_mean_over_the_cores(monkeypatch):
    now = [100.0]
    monkeypatch.setattr(progress.time, "monotonic", lambda: now[0])
    watch = progress.Stopwatch([])
    assert watch.expected(4, 2) is None  # nothing is known
    watch.begin("a")
    now[0] += 10.0
    watch.end("a")
    assert watch.expected(4, 2) == 20.0 and watch.expected(1, 2) == 10.0
    watch.begin("b")
    now[0] += 4.0
    assert watch.expected(1, 2) == 6.0 and watch.running == ("b",)
    assert progress.Stopwatch([30.0]).expected(2, 1) == 60.0  # by an earlier call
