"""A known walk goes through the files and comes back; files from elsewhere vary."""

from __future__ import annotations

import numpy as np
import pytest
from measured_cases import SUBJECT, Lab, write_mot

from drakegait.measured import ImportedWalk, import_walk
from drakegait.reference.reference import Reference
from drakegait.walker.coordinates import index

AT = index("spatial")
TAU = np.arange(100) / 100


def take(files, **options) -> ImportedWalk:
    return import_walk(*files, height=SUBJECT.height, mass=SUBJECT.mass, **options)


def said(walk: ImportedWalk, *words: str) -> bool:
    return any(all(word in sentence for word in words) for sentence in walk.warnings)


def errors(walk: ImportedWalk, truth: Reference) -> dict[str, float]:
    """Root mean square differences: angles [deg], hips and footprints [m], events, force.

    The cycle of an import begins where the vertical force exceeds 20 N, a little later than the
    embedded stride, whose forces grow from zero.
    """
    fine = np.arange(2000) / 2e4
    delay = fine[np.argmax(truth.ground_reactions(fine)[:, 0, 2] > 20.0)]
    ours, theirs = walk.reference.coordinate_values(TAU), truth.coordinate_values(TAU + delay)
    theirs[:, 0] += delay * truth.foot_placement.stride_length
    lean = theirs[:, AT["hat_tilt"]].mean()  # a static lean is taken out of the HAT
    theirs[:, AT["hat_tilt"]] -= lean
    for side in "rl":
        theirs[:, AT[f"hip_flexion_{side}"]] += lean
    angles = np.degrees((ours - theirs)[:, 3:])
    place = np.array(
        [getattr(walk.reference.foot_placement, name) - getattr(truth.foot_placement, name)
         for name in ("step_length_right", "step_length_left", "step_width")]
    )  # fmt: skip
    events = [np.cumsum(x.phase_fractions) for x in (walk.reference, truth)]
    force = walk.reference.ground_reactions(TAU) - truth.ground_reactions(TAU + delay)
    return {
        "angle": float(np.sqrt((angles**2).mean(axis=0)).max()),
        "hips": float(np.abs((ours - theirs)[:, :3]).max()),
        "place": float(np.abs(place).max()),
        "event": float(np.abs(events[0] - events[1])[[0, 1, 3, 4, 5]].max()),
        "heel off": float(np.abs(events[0] - events[1])[[2, 6]].max()),
        "force": float(np.sqrt((force**2).mean()) / (9.81 * SUBJECT.mass)),
        "period": abs(walk.reference.stride_time - truth.stride_time),
    }


def close(walk: ImportedWalk, truth: Reference) -> None:
    """Within 1 degree, 1 cm, 3 % of the stride, 1 % of body weight and 5 ms of the truth."""
    found = errors(walk, truth)
    assert found["angle"] < 1.0
    assert found["hips"] < 0.01
    assert found["place"] < 0.01
    assert found["event"] < 0.03
    assert found["heel off"] < 0.1  # in the embedded stride the heel rests long after its event
    assert found["force"] < 0.01
    assert found["period"] < 0.005


@pytest.fixture(scope="module")
def plain(tmp_path_factory):
    lab = Lab()
    return lab, take(lab.write(tmp_path_factory.mktemp("plain")))


def test_a_known_walk_comes_back(plain):
    lab, walk = plain
    close(walk, lab.reference)
    assert walk.subject == SUBJECT
    assert walk.reference.kind == "spatial" and walk.planar_reference.kind == "planar"
    assert walk.reference.speed == pytest.approx(lab.reference.speed, rel=0.01)


def test_feet_stand_on_their_prints_and_not_in_the_ground(plain):
    _, walk = plain
    assert max(row["after_mm"] for row in walk.quality.contacts) < 4.0
    assert walk.quality.penetration[1] > -1.5
    assert {row["phase"] for row in walk.quality.contacts} == set(range(1, 9))


def test_motion_agrees_with_forces(plain):
    _, walk = plain
    for row in walk.quality.forces:
        assert row["after"] < 0.05


LABS = {
    "radians": Lab(unit="rad"),
    "old header, flexion negative": Lab(header="old", knee=-1),
    "no unit": Lab(header="none"),
    "millimetres": Lab(metre=1000.0),
    "left start": Lab(begin=0.42, strides=2.8),
    "slow camera": Lab(rate=50.0, force_rate=1000.0),
}


@pytest.mark.parametrize("lab", LABS.values(), ids=LABS.keys())
def test_the_way_of_writing_does_not_matter(lab, tmp_path):
    close(take(lab.write(tmp_path)), lab.reference)


def test_noise_of_markers_is_filtered(tmp_path):
    """0.3 degrees and 5 mm in every sample leave less than a degree and 2 cm."""
    lab = Lab(noise=0.005)
    found = errors(take(lab.write(tmp_path)), lab.reference)
    assert found["angle"] < 1.0 and found["place"] < 0.02 and found["force"] < 0.01


def test_treadmill_is_made_overground(tmp_path):
    lab = Lab(belt=Lab().reference.speed)
    files = lab.write(tmp_path)
    right = take(files, treadmill_speed=lab.belt)
    close(right, lab.reference)
    assert not said(right, "slide backwards")
    found = take(files)
    assert found.reference.speed == pytest.approx(lab.belt, rel=0.03)
    assert said(found, "belt", "estimated")
    faster = take(files, treadmill_speed=1.15 * lab.belt)
    assert said(faster, "slide backwards", f"{1.15 * lab.belt:g} m/s that was given")


def test_the_clock_may_start_anywhere(tmp_path):
    lab = Lab(noise=0.002)  # filtered by a rate that is told from the clock
    walks = []
    for start in (0.0, 100.0):
        files = tmp_path / "motion.mot", tmp_path / "forces.mot"
        for file, columns in zip(files, (lab.motion(), lab.forces()), strict=True):
            write_mot(file, {**columns, "time": columns["time"] + start})
        walks.append(take(files))
    one, other = (walk.reference.coordinate_values(np.arange(50) / 50) for walk in walks)
    np.testing.assert_allclose(other, one, atol=1e-7)


def test_swapped_feet_are_found_and_said(tmp_path, plain):
    lab = Lab(heads=("ground_force_l_", "ground_force_r_"))
    walk = take(lab.write(tmp_path))
    close(walk, lab.reference)
    assert said(walk, "swapped")
    assert not said(plain[1], "swapped")


def test_unnamed_plates_are_given_to_the_foot_that_stands_there(tmp_path):
    lab = Lab(heads=("2_ground_force_", "1_ground_force_"))
    close(take(lab.write(tmp_path)), lab.reference)


def test_without_centre_of_pressure_time_tells_the_feet(tmp_path):
    lab = Lab(heads=("1_ground_force_", "2_ground_force_"))
    motion, forces = lab.write(tmp_path)
    columns = {k: v for k, v in lab.forces().items() if not k[:-1].endswith("_p")}
    write_mot(forces, columns)
    close(take((motion, forces)), lab.reference)


@pytest.mark.parametrize("swapped", [False, True])
@pytest.mark.parametrize("begin", [-0.3, 0.4, 0.55])
def test_a_stance_that_is_cut_off_is_not_taken_for_the_other_foots(tmp_path, begin, swapped):
    heads = ("ground_force_r_", "ground_force_l_")
    lab = Lab(begin=begin, heads=heads[::-1] if swapped else heads)
    motion, forces = lab.write(tmp_path)
    write_mot(forces, {k: v for k, v in lab.forces().items() if not k[:-1].endswith("_p")})
    walk = take((motion, forces))
    assert not said(walk, "other foot at times")
    assert said(walk, "swapped") == swapped
    close(walk, lab.reference)


def test_two_plates_of_an_overground_walk(tmp_path):
    """One contact per foot: the second right heel strike is on the bare floor."""
    lab = Lab(strides=2.6)
    motion, forces = lab.write(tmp_path)
    columns = lab.forces()
    tau = lab.begin + columns["time"] / lab.reference.stride_time
    for k, head in enumerate(lab.heads):
        keep = (tau > -0.1 + 0.5 * k) & (tau < 0.85 + 0.5 * k)
        for name in columns:
            if name.startswith(head):
                columns[name] = np.where(keep, columns[name], 0.0)
    write_mot(forces, columns)
    walk = take((motion, forces))
    found = errors(walk, lab.reference)
    assert found["angle"] < 1.5 and found["force"] < 0.03 and found["period"] < 0.02


def test_a_missing_step_is_mirrored_and_said(tmp_path):
    lab = Lab(reference=Reference.embedded("spatial", SUBJECT, "normal"))
    motion, forces = lab.write(tmp_path)
    columns = {k: v for k, v in lab.forces().items() if "_l_" not in k}
    write_mot(forces, columns)
    walk = take((motion, forces))
    assert said(walk, "left foot", "mirrored")
    assert errors(walk, lab.reference)["force"] < 0.01
    push = walk.reference.ground_reactions(TAU)[..., 1].mean(axis=0)  # both feet push inwards
    assert push[0] > 5.0 and push[1] == pytest.approx(-push[0], rel=0.05)


def test_stride_by_number(tmp_path):
    files = Lab().write(tmp_path)
    walks = [take(files, stride=number) for number in (1, 2)]
    starts = [next(s for s in w.quality.strides if s["chosen"])["start_s"] for w in walks]
    assert starts[1] - starts[0] == pytest.approx(Lab().reference.stride_time, abs=0.01)


def test_a_stride_of_the_left_foot_is_turned_to_begin_with_the_right(tmp_path):
    """One heel strike of the right foot between two of the left."""
    lab = Lab(begin=0.42, strides=1.4)
    walk = take(lab.write(tmp_path))
    assert said(walk, "left foot", "turned")
    found = errors(walk, lab.reference)
    assert found["angle"] < 1.0 and found["period"] < 0.005 and found["force"] < 0.01


def test_walking_the_other_way(tmp_path):
    lab = Lab()
    motion, forces = lab.write(tmp_path)
    turn = {"x": -1.0, "z": -1.0}
    columns = lab.motion()
    columns["pelvis_rotation"] = columns["pelvis_rotation"] + 180.0
    for name in ("pelvis_tilt", "pelvis_list"):  # turned after the half turn, they lean back
        columns[name] = -columns[name]
    for axis in "xz":
        columns[f"pelvis_t{axis}"] = -columns[f"pelvis_t{axis}"]
    write_mot(motion, columns)
    loads = {k: turn.get(k[-1], 1.0) * v if k != "time" else v for k, v in lab.forces().items()}
    write_mot(forces, loads)
    walk = take((motion, forces))
    close(walk, lab.reference)
    assert said(walk, "turned into it")


def test_sagittal_files_give_a_planar_reference_and_say_what_is_not_measured(tmp_path):
    lab = Lab()
    motion, forces = lab.write(tmp_path)
    lateral = ("list", "rotation", "adduction", "tz")
    columns = {k: v for k, v in lab.motion().items() if not any(x in k for x in lateral)}
    write_mot(motion, columns)
    walk = take((motion, forces))
    assert said(walk, "NOT this person's")
    truth = Reference.embedded("spatial", SUBJECT).coordinate_values(TAU)
    given = walk.target.coordinates[:, AT["hip_adduction_r"]]
    assert given == pytest.approx(truth[:, AT["hip_adduction_r"]])
    knee = index("planar")["knee_flexion_r"]
    truth = lab.reference.coordinate_values(TAU)[:, AT["knee_flexion_r"]]
    ours = walk.planar_reference.coordinate_values(TAU)[:, knee]
    assert np.degrees(np.abs(ours - truth)).max() < 4.0


def test_mass_that_does_not_fit_the_forces_is_said(tmp_path):
    files = Lab().write(tmp_path)
    walk = import_walk(*files, height=SUBJECT.height, mass=80.0)
    assert said(walk, "80 kg", "check the mass")
