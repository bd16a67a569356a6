"""Exported gaits: OpenSim reads all of it and computes the same joint moments from it."""

from __future__ import annotations

import csv

import numpy as np
import pytest
from gait_cases import reference_gait

from drakegait.errors import BadFile, InvalidInput
from drakegait.export import export_csv, export_opensim, export_sdf
from drakegait.loads import loads_along
from drakegait.program.variants import Variants
from drakegait.reference.csv_file import read_csv
from drakegait.sampling import LOADED
from drakegait.study import GaitStudy
from drakegait.walker import coordinates
from drakegait.walker.coordinates import TO_OPENSIM
from drakegait.walker.skeleton import Skeleton

NUM = 101


def read_storage(path) -> tuple[list[str], np.ndarray]:
    lines = path.read_text(encoding="utf-8").splitlines()
    start = lines.index("endheader") + 1
    rows = np.array([[float(x) for x in line.split("\t")] for line in lines[start + 1 :]])
    assert f"nRows={len(rows)}" in lines and f"nColumns={rows.shape[1]}" in lines
    return lines[start].split("\t"), rows


def all_loads(gait, tau):
    motion = gait.motion(tau)
    return motion, loads_along(gait.study.walker, motion, gait.phase_of(tau))


@pytest.mark.parametrize(
    ("model", "statements"),
    [("planar", {}), ("spatial", {}), ("spatial", {"variants": Variants(sequence="123")})],
)
def test_inverse_dynamics_of_opensim_finds_our_joint_moments(
    model, statements, tmp_path, ask_opensim
):
    """From files alone, with forces on the feet; OpenSim differentiates the motion itself.

    Its result is all that moves the joints: muscles, passive structures and the residual of our
    equations. The middle of three strides is compared: at the ends its splines are free.
    """
    gait = reference_gait(model, **statements)
    written = export_opensim(gait, tmp_path, num=NUM, strides=3)
    tables = [path.name for path in written if path.suffix in (".sto", ".mot")]
    answer = ask_opensim(what="files", tables=tables)
    for name in tables:
        rows, labels, old_rows = answer[name]
        assert rows == old_rows == 3 * (NUM - 1) + 1 and len(labels) == len(set(labels)) > 0
    middle = slice(NUM - 1, 2 * NUM - 1)
    motion, loads = all_loads(gait, np.linspace(1.0, 2.0, NUM))
    np.testing.assert_allclose(answer["time"][middle], motion.time, atol=1e-9)
    ours = coordinates.to_anatomical(model, loads.muscles + loads.passive + loads.residual)
    worst = 0.0
    for i, item in enumerate(coordinates.coordinates(model)):
        label = f"{item.name}_{'moment' if item.is_rotation else 'force'}"
        theirs = np.array(answer["moments"][label])[middle]
        worst = max(worst, float(np.max(np.abs(theirs - ours[:, i]))))
    assert worst < 0.05  # [N, N m]; moments reach 100 N m, forces of inertia more


@pytest.mark.parametrize("model", ["planar", "spatial"])
def test_ground_reactions_are_the_same_wrench(model, tmp_path):
    """Force and moment about the world's origin agree with those at heel and toe."""
    gait = reference_gait(model)
    export_opensim(gait, tmp_path, num=NUM)
    labels, rows = read_storage(tmp_path / "ground_reactions.mot")
    columns = dict(zip(labels, rows.T, strict=True))
    motion, loads = all_loads(gait, np.linspace(0.0, 1.0, NUM))
    points = gait.study.walker.skeleton.contact_points(motion.q).reshape(-1, 2, 2, 3)
    wanted = np.cross(points, loads.point_forces).sum(axis=2)
    wanted[..., 2] += loads.pivot_moments
    total = gait.study.walker.skeleton.total_mass * 9.81
    for i, side in enumerate("rl"):
        force, point, moment = (
            np.stack([columns[f"{prefix}{axis}"] for axis in "xyz"], axis=1)
            for prefix in (f"ground_force_{side}_v", f"ground_force_{side}_p",
                           f"ground_torque_{side}_")
        )  # fmt: skip
        np.testing.assert_allclose(
            force, loads.ground_reactions[:, i] @ TO_OPENSIM.T, rtol=1e-9, atol=1e-8
        )
        turned = moment + np.cross(point, force)
        np.testing.assert_allclose(turned, wanted[:, i] @ TO_OPENSIM.T, rtol=1e-8, atol=1e-6)
        assert np.all(point[:, 1] == 0.0)
        standing = force[:, 1] > LOADED * total
        assert standing.any() and np.abs(moment[standing][:, 1]).max() < 30.0


def test_files_hold_the_motion_in_degrees_and_anatomical_signs(tmp_path):
    gait = reference_gait("planar")
    export_opensim(gait, tmp_path, num=NUM)
    data = gait.sample(NUM)
    for file, variable in (("coordinates.mot", data.coordinates), ("speeds.sto", data.velocities)):
        assert "inDegrees=yes" in (tmp_path / file).read_text(encoding="utf-8")
        labels, rows = read_storage(tmp_path / file)
        assert labels == ["time", *gait.coordinate_names]
        np.testing.assert_allclose(rows[:, 1:], variable, rtol=1e-9, atol=1e-9)
        np.testing.assert_allclose(rows[:, 0], data.time, atol=1e-10)
    for file, variable in (("muscle_forces.sto", data.muscle_force),
                           ("activations.sto", data.activation),
                           ("excitations.sto", data.excitation)):  # fmt: skip
        labels, rows = read_storage(tmp_path / file)
        assert labels == ["time", *gait.muscle_names]
        np.testing.assert_allclose(rows[:, 1:], variable, rtol=1e-9, atol=1e-9)
    labels, rows = read_storage(tmp_path / "joint_moments.sto")
    assert labels[1:] == [f"{name}_moment" for name in data.joint.values]
    np.testing.assert_allclose(rows[:, 1:], data.joint_moment, rtol=1e-9, atol=1e-9)


def test_ideal_muscles_get_shares_of_their_force_as_controls(tmp_path):
    gait = reference_gait("planar")
    export_opensim(gait, tmp_path, num=NUM, muscles="actuators")
    labels, rows = read_storage(tmp_path / "controls.sto")
    forces = read_storage(tmp_path / "muscle_forces.sto")[1]
    np.testing.assert_allclose(
        rows[:, 1:] * gait.study.walker.muscles.f_max, forces[:, 1:], rtol=1e-9, atol=1e-9
    )
    assert labels[1] == f"/forceset/{gait.muscle_names[0]}"
    assert "activation" not in " ".join(read_storage(tmp_path / "states.sto")[0])


def test_strides_follow_each_other(tmp_path):
    gait = reference_gait("planar")
    export_opensim(gait, tmp_path, num=NUM, strides=2)
    _, rows = read_storage(tmp_path / "coordinates.mot")
    first, second = rows[:NUM], rows[NUM - 1 :]
    jump = second - first
    np.testing.assert_allclose(jump[:, 0], gait.stride_time, rtol=1e-9)
    np.testing.assert_allclose(jump[:, 1], gait.stride_length, rtol=1e-9)
    np.testing.assert_allclose(jump[:, 2:], 0.0, atol=1e-7)


@pytest.mark.parametrize("model", ["planar", "spatial"])
def test_tables_hold_what_sample_gives(model, tmp_path):
    gait = reference_gait(model)
    written = export_csv(gait, tmp_path / "new" / "tables", num=NUM)
    data = gait.sample(NUM)
    assert {path.stem for path in written} == {
        *(name for name, item in data.data_vars.items() if item.dims[0] == "time"), "events",
    }  # fmt: skip
    for path in written:
        if path.stem == "events":
            continue
        with path.open(encoding="utf-8") as file:
            head, *rows = csv.reader(file)
        values = np.array([[float(x) if x else np.nan for x in row] for row in rows])
        wanted = data[path.stem].values.reshape(NUM, -1)
        np.testing.assert_allclose(values[:, 0], data.percent, rtol=1e-8)
        np.testing.assert_allclose(values[:, 2:], wanted, rtol=1e-8, atol=1e-12)
        assert head[:2] == ["percent", "time [s]"] and len(head) == len(set(head))
    heading = read_csv(tmp_path / "new/tables/coordinates.csv")[0]
    assert "hip_flexion_r [deg]" in heading and "hat_x [m]" in heading
    residual = read_csv(tmp_path / "new/tables/equation_residual.csv")[0]
    assert "hat_x [N]" in residual and "hat_tilt [N m]" in residual
    forces = read_csv(tmp_path / "new/tables/ground_reaction_force.csv")[0]
    assert "right z [N]" in forces


def test_events_are_named(tmp_path):
    gait = reference_gait("planar")
    export_csv(gait, tmp_path, num=5)
    rows = (tmp_path / "events.csv").read_text(encoding="utf-8").splitlines()
    assert rows[0] == "event,percent,time [s]" and len(rows) == 9
    assert rows[1].startswith("right heel strike,0,")
    cells = [row.split(",") for row in rows[1:]]
    np.testing.assert_allclose(
        [float(time) for _, _, time in cells], gait.values.events * gait.stride_time, rtol=1e-8
    )


@pytest.mark.parametrize("model", ["planar", "spatial"])
def test_sdf_is_the_walker(model, tmp_path):
    from drakegait.walker.subject import Subject

    study = GaitStudy(model=model, subject=Subject(height=1.7, mass=62.0))
    study = study.with_added_mass("shank_l", 1.5)
    text = export_sdf(study, tmp_path / "sub" / "walker.sdf").read_text(encoding="utf-8")
    again, ours = Skeleton(text, model), study.walker.skeleton
    q = np.random.default_rng(5).uniform(-0.5, 0.5, ours.num_coordinates)
    np.testing.assert_allclose(again.mass_matrix(q), ours.mass_matrix(q), rtol=1e-12)


@pytest.mark.parametrize(
    ("options", "words"),
    [({"num": 1}, "num"), ({"num": 2.5}, "num"), ({"strides": 0}, "strides"),
     ({"muscles": "hill"}, "hill")],
)  # fmt: skip
def test_bad_options_are_refused_before_writing(options, words, tmp_path):
    with pytest.raises(InvalidInput, match=words):
        export_opensim(reference_gait("planar"), tmp_path / "out", **options)
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize("export", [export_opensim, export_csv])
def test_a_file_in_the_way_is_named(export, tmp_path):
    (tmp_path / "file").write_text("x")
    with pytest.raises(BadFile, match="file"):
        export(reference_gait("planar"), tmp_path / "file")
