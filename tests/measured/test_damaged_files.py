"""What is wrong with a file is repaired and said, or refused in one sentence."""

from __future__ import annotations

import time

import numpy as np
import pytest
from measured_cases import SUBJECT, Lab, write_csv, write_mot

from drakegait.errors import BadFile, DrakegaitError, InvalidInput, UnknownName
from drakegait.measured import import_walk

LAB = Lab()
TAU = np.arange(100) / 100


def take(files, **options):
    return import_walk(*files, height=SUBJECT.height, mass=SUBJECT.mass, **options)


def refused(files, error: type[DrakegaitError], *words: str, **options) -> None:
    with pytest.raises(error) as caught:
        take(files, **options)
    sentence = str(caught.value)
    assert all(word in sentence for word in words), sentence
    assert "\n" not in sentence


def knee_error(walk) -> float:
    """Largest difference of the right knee from the truth [deg]."""
    ours = walk.reference.coordinate_values(TAU)[:, 9]
    return float(np.degrees(np.abs(ours - LAB.reference.coordinate_values(TAU)[:, 9])).max())


@pytest.fixture
def files(tmp_path):
    return LAB.write(tmp_path)


def rewrite(files, **changes) -> None:
    """The motion file with some columns replaced; None leaves one out."""
    columns = LAB.motion() | changes
    write_mot(files[0], {name: values for name, values in columns.items() if values is not None})


@pytest.mark.parametrize("name", ["hip_flexion_l", "knee_angle_r", "pelvis_tilt", "ankle_angle_l"])
def test_a_missing_joint_is_refused_by_name(files, name):
    rewrite(files, **{name: None})
    refused(files, BadFile, "ik.mot", name)


def test_no_time(files):
    columns = LAB.motion()
    del columns["time"]
    path = files[0]
    path.write_text("endheader\n" + "\t".join(columns) + "\n" + "1\t" * 17 + "1\n")
    refused(files, BadFile, "time")


def test_short_gaps_are_closed_and_long_ones_avoided(files):
    knee = LAB.motion()["knee_angle_r"]
    knee[100:105] = np.nan
    rewrite(files, knee_angle_r=knee)
    walk = take(files)
    assert any("interpolated" in x and "knee_angle_r" in x for x in walk.warnings)
    assert knee_error(walk) < 4.0
    knee[150:220] = np.nan  # in the second of the strides that begin at 0.32 and 1.38 s
    rewrite(files, knee_angle_r=knee)
    walk = take(files)
    assert any("cannot be interpolated" in x and "knee_angle_r" in x for x in walk.warnings)
    assert all(row["end_s"] < 1.5 or row["start_s"] > 2.2 for row in walk.quality.strides)


def test_a_gap_is_told_from_the_last_row_before_it_to_the_first_behind(files):
    columns = LAB.motion()
    first = 70
    columns["knee_angle_r"][first : first + 20] = np.nan
    write_mot(files[0], columns)
    said = " ".join(take(files).warnings)
    ends = columns["time"][[first - 1, first + 20]]
    assert f"from {ends[0]:.3f} to {ends[1]:.3f} s" in said


def test_a_time_in_milliseconds_is_refused(files):
    columns = LAB.motion()
    columns["time"] = 1000.0 * columns["time"]
    write_mot(files[0], columns)
    refused(files, BadFile, files[0].name, "a row every", "in ms?")


def test_gaps_everywhere_are_refused(files):
    knee = LAB.motion()["knee_angle_r"]
    knee[::1] = np.where(np.arange(knee.size) % 60 < 30, knee, np.nan)
    rewrite(files, knee_angle_r=knee)
    refused(files, BadFile, "no whole stride")


def test_rows_out_of_order_are_sorted_and_said(files):
    columns = LAB.motion()
    order = np.roll(np.arange(columns["time"].size), 30)
    write_mot(files[0], {name: values[order] for name, values in columns.items()})
    walk = take(files)
    assert any("order of time" in x for x in walk.warnings)
    assert knee_error(walk) < 4.0


def test_two_rows_of_one_instant_are_refused(files):
    columns = LAB.motion()
    write_mot(files[0], {n: np.insert(v, 40, v[40]) for n, v in columns.items()})
    refused(files, BadFile, "ik.mot", "one instant")


def test_files_without_common_time_are_refused(files):
    columns = LAB.forces()
    columns["time"] = columns["time"] + 100.0
    write_mot(files[1], columns)
    refused(files, BadFile, "shares no time")


def test_a_shift_between_the_files_is_said(files):
    columns = LAB.forces()
    columns["time"] = columns["time"] + 0.15
    write_mot(files[1], columns)
    assert any("on one clock" in x for x in take(files).warnings)


def test_both_feet_on_one_plate_are_refused(files):
    columns = LAB.forces()
    one = {"time": columns["time"]}
    for axis in "xyz":
        one[f"force_v{axis}"] = sum(columns[f"{head}v{axis}"] for head in LAB.heads)
    write_mot(files[1], one)
    refused(files, BadFile, "no contact of one foot")


def test_no_forces(files):
    write_mot(files[1], {"time": LAB.forces()["time"], "knee": LAB.forces()["time"]})
    refused(files, BadFile, "no ground forces", "ground_force_vx")


def test_force_on_the_plate_is_turned(files):
    columns = LAB.forces()
    write_mot(files[1], {n: -v if n[:-1].endswith("_v") else v for n, v in columns.items()})
    walk = take(files)
    assert any("sign was turned" in x for x in walk.warnings)
    assert walk.reference.ground_reactions(np.array([0.2]))[0, 0, 2] > 300.0


def test_too_short_a_recording_is_refused(tmp_path):
    refused(Lab(strides=0.8).write(tmp_path), BadFile, "no whole stride")


def test_header_that_contradicts_the_knee_is_doubted(files):
    write_mot(files[0], LAB.motion(), unit="rad")  # degrees called radians
    walk = take(files)
    assert any("says that angles are in radians" in x for x in walk.warnings)
    assert knee_error(walk) < 4.0


def test_wrong_options_are_refused(files, tmp_path):
    refused(files, InvalidInput, "treadmill speed", "20", treadmill_speed=20.0)
    refused(files, InvalidInput, "treadmill speed", "stand still", treadmill_speed=1.2)
    refused(files, InvalidInput, "stride", "7", stride=7)
    refused(files, UnknownName, "knee", "flexion-positive", knee="up")
    refused(files, InvalidInput, "cut-off", motion_cutoff=60.0)
    refused((tmp_path / "nothing.mot", files[1]), BadFile, "cannot be read")
    refused((files[0], tmp_path / "grf.xlsx"), BadFile, ".xlsx", ".mot")
    with pytest.raises(InvalidInput, match="height"):
        import_walk(*files, height=180.0, mass=70.0)


def test_text_that_is_no_table(tmp_path, files):
    files[0].write_text("hello\nworld\n")
    refused(files, BadFile, "endheader")
    rows = ["endheader", "time\tknee_angle_r", *(f"{k}\tx" for k in range(30))]
    files[0].write_text("\n".join(rows))
    refused(files, BadFile, "line 3", "'x'")


def test_csv_with_a_map_of_columns(tmp_path):
    motion, forces = LAB.motion(), LAB.forces()
    motion["Zeit"] = 1000.0 * motion.pop("time")
    motion["RKnie"] = -motion.pop("knee_angle_r")
    write_csv(tmp_path / "m.csv", motion, ";")
    write_csv(tmp_path / "f.csv", forces)
    (tmp_path / "map.toml").write_text(
        'angle_unit = "deg"\n[columns]\ntime = { column = "Zeit", factor = 0.001 }\n'
        'knee_angle_r = { column = "RKnie", factor = -1 }\n'
    )
    with pytest.raises(DrakegaitError, match="Zeit"):
        take((tmp_path / "m.csv", tmp_path / "f.csv"))  # without the map
    walk = take((tmp_path / "m.csv", tmp_path / "f.csv"), columns=tmp_path / "map.toml")
    assert knee_error(walk) < 4.0


def test_maps_that_mean_nothing_are_refused(tmp_path):
    write_csv(tmp_path / "m.csv", LAB.motion())
    write_csv(tmp_path / "f.csv", LAB.forces())
    files = (tmp_path / "m.csv", tmp_path / "f.csv")
    for text, error, word in (
        ("colums = 3", UnknownName, "colums"),
        ('angle_unit = "grad"', UnknownName, "angle_unit"),
        ('[axes]\nforward = "x"\nup = "-x"', InvalidInput, "right angles"),
        ("[columns]\nknee_angle_r = 3", InvalidInput, "knee_angle_r"),
        ('[columns]\nknee_angle_r = "KneeR"', UnknownName, "KneeR"),
        ('[columns]\nkne_angle_r = "hip_flexion_r"', UnknownName, "did you mean 'knee_angle_r'"),
        ('[columns]\nground_force_r_vx = "Fx"', UnknownName, "'Fx'"),
        ("not toml", BadFile, "TOML"),
    ):
        (tmp_path / "map.toml").write_text(text)
        refused(files, error, word, columns=tmp_path / "map.toml")


def test_a_minute_at_1_kHz_takes_seconds(tmp_path):
    lab = Lab(strides=57.0, rate=100.0, force_rate=1000.0)
    files = lab.write(tmp_path)
    start = time.process_time()
    walk = take(files)
    assert time.process_time() - start < 20.0
    assert len(walk.quality.strides) > 50
