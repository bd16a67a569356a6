"""Own measurements: a saved reference comes back, and doubtful tables are refused in a sentence."""

from __future__ import annotations

import numpy as np
import pytest

from drakegait.errors import BadFile, InvalidInput
from drakegait.reference import Reference
from drakegait.reference.export import table_columns
from drakegait.reference.tables import FORCE_COLUMNS
from drakegait.walker.coordinates import SPATIAL, coordinates
from drakegait.walker.subject import Subject

TAU = np.arange(200) / 200


def _table(reference: Reference, rows: int = 101) -> tuple[dict, dict]:
    """Columns in SI units without units in the headings, and the facts beside them."""
    columns = {}
    for heading, values in table_columns(reference, rows, FORCE_COLUMNS).items():
        name, _, unit = heading.partition(" [")
        columns[name] = np.radians(values) if unit == "deg]" else values
    facts = {
        "stride_time": reference.stride_time,
        "phase_fractions": reference.phase_fractions,
        "foot_placement": reference.foot_placement,
    }
    return columns, facts


@pytest.fixture
def planar():
    return _table(Reference.embedded("planar"))


def _same(ours: Reference, original: Reference) -> None:
    angle = np.array([c.is_rotation for c in coordinates(original.kind)])
    error = np.abs(ours.coordinate_values(TAU) - original.coordinate_values(TAU)).max(axis=0)
    assert error[angle].max() < np.radians(0.1) and error[~angle].max() < 2e-4
    forces = np.abs(ours.ground_reactions(TAU) - original.ground_reactions(TAU))
    assert forces.max() < 1.0
    assert ours.stride_time == pytest.approx(original.stride_time)
    assert ours.phase_fractions == pytest.approx(original.phase_fractions)
    assert ours.foot_placement == original.foot_placement


@pytest.mark.parametrize(
    ("kind", "name"), [("spatial", "asymmetric"), ("spatial", "measured"), ("planar", "planar")]
)
def test_saved_file_reads_back(tmp_path, kind, name):
    subject = Subject(height=1.6, mass=60.0)
    original = Reference.embedded(kind, subject, name)
    original.save(tmp_path / "mine.csv")
    ours = Reference.from_table(tmp_path / "mine.csv", kind=kind, subject=subject)
    _same(ours, original)
    assert ours.name == "mine.csv"
    derivative = ours.coordinate_values(TAU, 1) - original.coordinate_values(TAU, 1)
    assert np.abs(derivative).max() < 0.1
    # the spatial file also serves the planar walker: lateral columns are left out
    flat = Reference.from_table(tmp_path / "mine.csv", kind="planar", subject=subject)
    assert flat.foot_placement.step_width == 0.0 and len(flat.coordinates) == 9


def test_paper_names_have_plant_signs_and_any_order():
    original = Reference.embedded("spatial", name="asymmetric")
    columns, facts = _table(original)
    renamed = {"percent": columns["percent"]}
    for c in reversed(SPATIAL):
        renamed[c.paper_name] = c.anatomical_sign * columns[c.name]
    ours = Reference.from_table(renamed, kind="spatial", **facts)
    assert ours.forces is None and (ours.force_weight == 0).all()
    assert (ours.ground_reactions(TAU) == 0).all() and np.isfinite(ours.force_sigma).all()
    error = ours.coordinate_values(TAU) - original.coordinate_values(TAU)
    assert np.abs(error).max() < np.radians(0.1)


def test_units_of_headings_and_of_arguments():
    original = Reference.embedded("planar")
    columns, facts = _table(original)
    units = {"percent": {}, "hat_x": {"mm": 1e3}, "hat_z": {"cm": 100.0}, "left_z": {"kN": 1e-3}}
    mixed = {}
    for name, values in columns.items():
        for unit, factor in units.get(name, {}).items():
            mixed[f"{name} [{unit}]"] = factor * values
        if not units.get(name):
            mixed[name] = values
    _same(Reference.from_table(mixed, kind="planar", **facts), original)
    body_weights = dict(columns)
    for name in columns:
        if name in FORCE_COLUMNS:
            body_weights[name] = columns[name] / (75 * 9.81)
        elif any(c.name == name and c.is_rotation for c in SPATIAL):
            body_weights[name] = np.degrees(columns[name])
    facts |= {"angle_unit": "deg", "force_unit": "BW"}
    _same(Reference.from_table(body_weights, kind="planar", **facts), original)


def test_time_column_gives_the_stride_time(planar):
    columns, facts = planar
    time = 3.0 + columns.pop("percent") / 100 * facts.pop("stride_time")
    ours = Reference.from_table({"time [s]": time, **columns}, kind="planar", **facts)
    _same(ours, Reference.embedded("planar"))
    with pytest.raises(InvalidInput, match="stride_time"):
        Reference.from_table({"time": time, **columns}, kind="planar", stride_time=1.2, **facts)


def test_advance_may_be_removed_before(planar):
    columns, facts = planar
    columns["hat_x"] = columns["hat_x"] - facts["foot_placement"].stride_length * np.linspace(
        0, 1, 101
    )
    _same(Reference.from_table(columns, kind="planar", **facts), Reference.embedded("planar"))


def test_steady_advance_of_the_table_is_removed_whatever_the_placement(planar):
    columns, facts = planar
    columns["hat_x"] = columns["hat_x"] + 0.03 * columns["percent"] / 100
    _same(Reference.from_table(columns, kind="planar", **facts), Reference.embedded("planar"))
    columns["hat_x"] = columns["hat_x"] + 0.2 * columns["percent"] / 100
    with pytest.raises(InvalidInput, match="advance of hat_x.*within 5 %"):
        Reference.from_table(columns, kind="planar", **facts)


def test_drift_is_closed_smoothly(planar):
    columns, facts = planar
    original = Reference.embedded("planar")
    columns["knee_flexion_r"] = columns["knee_flexion_r"] + 0.03 * (columns["percent"] / 100 - 0.5)
    ours = Reference.from_table(columns, kind="planar", **facts)
    k = original.coordinates.index("knee_flexion_r")
    error = ours.coordinate_values(TAU)[:, k] - original.coordinate_values(TAU)[:, k]
    assert np.abs(error).max() < 0.03
    jerk = [np.abs(r.coordinate_values(TAU, 3)[:, k]).max() for r in (ours, original)]
    assert jerk[0] < 2.0 * jerk[1]
    others = np.delete(ours.coordinate_values(TAU) - original.coordinate_values(TAU), k, axis=1)
    assert np.abs(others).max() < np.radians(0.1)


def _without(name):
    return lambda c, f: ({k: v for k, v in c.items() if k != name}, f)


def _times(name, factor):
    return lambda c, f: ({**c, name: factor * c[name]}, f)


def _put(name, row, value):
    def spoil(columns, facts):
        values = columns[name].copy()
        values[row] = value
        return {**columns, name: values}, facts

    return spoil


def _fact(**changes):
    return lambda c, f: (c, {**f, **changes})


def _angles(factor):
    def spoil(columns, facts):
        angles = [c.name for c in SPATIAL if c.is_rotation and c.name in columns]
        return {**columns, **{k: factor * columns[k] for k in angles}}, facts

    return spoil


def _rows(keep):
    return lambda c, f: ({k: v[keep] for k, v in c.items()}, f)


@pytest.mark.parametrize(
    ("spoil", "sentence"),
    [
        (_put("hat_z", 6, np.nan), r"row 7 of column hat_z is nan"),
        (_put("percent", 6, 3.0), r"row 7 of percent is 3.0.*larger than the row before"),
        (_put("knee_flexion_r", slice(3, 4), np.inf), r"row 4 of column knee_flexion_r is inf"),
        (_rows(np.r_[0:40, 55:101]), r"gap in percent after row 40"),
        (_rows(slice(0, 100)), r"first and last row is \(0.0, 99.0\)"),
        (_rows(slice(None, None, 5)), r"number of rows is 21"),
        (_without("hat_tilt"), r"column hat_tilt is None.*b_I1"),
        (_without("left_x"), r"column left_x"),
        (_without("percent"), r"first column is 'hat_x'"),
        (_angles(57.3), r"hip_flexion_r|knee.*degrees stated as radians"),
        (_angles(0.0175), r"radians stated as degrees"),
        (_times("hat_z", 1000.0), r"mean hat_z in m is .*1000 times too large"),
        (_times("hat_z", 0.01), r"mean hat_z in m is .*100 times too small"),
        (_times("hat_x", 1000.0), r"advance of hat_x in m is .*1000 times too large"),
        (_times("right_z", 5.0), r"largest vertical force in N"),
        (_fact(phase_fractions=None), r"phase_fractions is None.*eight durations"),
        (_fact(phase_fractions=(0.25,) * 4), r"phase_fractions"),
        (_fact(phase_fractions=(12.5,) * 8), r"phase_fractions.*sum 1"),
        (_fact(phase_fractions=(0.0, *(1 / 7,) * 7)), r"phase_fractions"),
        (_fact(phase_fractions="abc"), r"phase_fractions"),
        (_fact(stride_time=None), r"stride_time is None.*\[s\]"),
        (_fact(stride_time=1070.0), r"stride_time is 1070"),
        (_fact(foot_placement=None), r"foot_placement is None"),
        (_fact(angle_unit="grad"), r"unit of hat_tilt is 'grad'.*rad, deg"),
        (_fact(speed=1.3), r"fact is 'speed'"),
        (_fact(kind_of=1), r"fact"),
        (lambda c, f: ({**c, "knee_r": c["hat_z"]}, f), r"column is 'knee_r'.*one of"),
        (lambda c, f: ({**c, "b_34": c["knee_flexion_r"]}, f), r"column is 'b_34'.*once"),
        (lambda c, f: ({**c, "hat_x": c["hat_x"][1:]}, f), r"shape of column hat_x"),
        (lambda c, f: ({**c, "hat_x": ["a"] * 101}, f), r"column hat_x is 'not numeric'"),
        (_put("hat_tilt", -1, 0.4), r"difference of hat_tilt between first and last row"),
    ],
)
def test_doubtful_tables_are_refused(planar, spoil, sentence):
    columns, facts = spoil(*planar)
    with pytest.raises(InvalidInput, match=sentence):
        Reference.from_table(columns, kind="planar", **facts)


def test_forces_called_newtons_that_are_body_weights_or_downward(planar):
    columns, facts = planar
    for factor, hint in ((1 / (75 * 9.81), "body weights stated as newtons"), (-1.0, "reversed")):
        spoiled = {k: factor * v if k in FORCE_COLUMNS else v for k, v in columns.items()}
        with pytest.raises(InvalidInput, match=hint):
            Reference.from_table(spoiled, kind="planar", **facts)


def test_sideways_millimetres():
    columns, facts = _table(Reference.embedded("spatial"))
    with pytest.raises(InvalidInput, match="range of hat_y.*1000 times too large"):
        Reference.from_table({**columns, "hat_y": 1000 * columns["hat_y"]}, kind="spatial", **facts)


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("", "no heading"),
        ("percent,hat_x\n", "no heading"),
        ("percent,hat_x\n0,1\n1\n", "line 3 has 1 cells, but 2 columns"),
        ("# note\npercent,hat_x\n0,\n", "line 3, column 'hat_x' is empty"),
        ("percent,hat_x\n0,one\n", "line 2, column 'hat_x' is 'one'"),
        ("percent,hat_x,hat_x\n0,1,1\n", "'hat_x' more than once"),
    ],
)
def test_damaged_files_name_line_and_column(tmp_path, text, sentence):
    path = tmp_path / "gait.csv"
    path.write_text(text)
    with pytest.raises(BadFile, match=sentence):
        Reference.from_table(path, kind="planar")


def test_files_that_are_no_tables(tmp_path):
    with pytest.raises(BadFile, match="No such file"):
        Reference.from_table(tmp_path / "none.csv", kind="planar")
    (tmp_path / "binary.csv").write_bytes(b"\xff\xfe\x00\x80")
    with pytest.raises(BadFile, match="not a text file"):
        Reference.from_table(tmp_path / "binary.csv", kind="planar")
    with pytest.raises(BadFile, match="cannot be written"):
        Reference.embedded("planar").save(tmp_path / "no" / "such.csv")


@pytest.mark.parametrize(
    ("line", "sentence"),
    [
        ("# stride_tim = 1.0", "did you mean 'stride_time'"),
        ("# stride_time = one", "stride_time is 'one'"),
        ("# stride_time = 1, 2", "one number"),
        ("# step_length_left = 0.7", "step_length_right"),
    ],
)
def test_leading_lines_are_checked(tmp_path, line, sentence):
    path = tmp_path / "gait.csv"
    path.write_text(line + "\npercent,hat_x\n0,0\n100,1\n")
    with pytest.raises(InvalidInput, match=sentence):
        Reference.from_table(path, kind="planar")
