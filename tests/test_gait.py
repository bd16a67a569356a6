"""The answer of a solve: derivatives, signs, balance of forces, files."""

from __future__ import annotations

import dataclasses
import json

import numpy as np
import pytest
import xarray as xr
from gait_cases import changed, reference_gait, restated

from drakegait.errors import BadFile, InvalidInput, UnknownName
from drakegait.gait import Gait
from drakegait.loads import loads_along
from drakegait.reference.reference import Reference
from drakegait.sampling import centre_of_pressure
from drakegait.summary import CHECKED
from drakegait.walker import coordinates

MODELS = ("spatial", "planar", "spatial-symmetric", "planar-symmetric")
GRAVITY = 9.81


@pytest.fixture(scope="module")
def gait() -> Gait:
    return reference_gait("spatial")


@pytest.fixture(scope="module")
def planar() -> Gait:
    return reference_gait("planar")


@pytest.fixture(scope="module")
def sampled(gait) -> xr.Dataset:
    return gait.sample(401)


# Motion ------------------------------------------------------------------------------------


@pytest.mark.parametrize("model", MODELS)
def test_rates_are_derivatives_by_time(model):
    gait = reference_gait(model)
    tau, step = np.linspace(0.02, 0.93, 23), 1e-5
    here, before, after = gait.motion(tau), gait.motion(tau - step), gait.motion(tau + step)
    span = (after.time - before.time)[:, None]
    for value, rate in (("q", "v"), ("v", "a"), ("forces", "force_rates"),
                        ("force_rates", "force_accelerations")):  # fmt: skip
        slope = (getattr(after, value) - getattr(before, value)) / span
        expected = getattr(here, rate)
        np.testing.assert_allclose(slope, expected, atol=1e-6 * np.abs(expected).max())


def test_next_stride_is_the_same_further_on(gait):
    tau = np.linspace(0.0, 0.9, 10)
    now, later = gait.motion(tau), gait.motion(tau + 1.0)
    advance = np.zeros_like(now.q)
    advance[:, 0] = gait.stride_length
    np.testing.assert_allclose(later.q, now.q + advance, atol=1e-12)
    np.testing.assert_allclose(later.v, now.v, atol=1e-10)
    np.testing.assert_allclose(later.time - now.time, gait.stride_time)


def test_speed_is_stride_length_over_time(gait):
    assert gait.speed == pytest.approx(1.2, abs=1e-6)
    assert gait.phase_durations.sum() == pytest.approx(gait.stride_time)


def test_an_event_opens_its_phase(gait):
    events = gait.values.events
    np.testing.assert_array_equal(gait.phase_of(events), range(8))
    np.testing.assert_array_equal(gait.phase_of(events[1:] - 1e-9), range(7))
    assert gait.phase_of(1.0 - 1e-9) == 7 and gait.phase_of(1.0) == 0
    np.testing.assert_array_equal(gait.phase_of(events + 2.0 + 1e-9), range(8))


@pytest.mark.parametrize("field", ["coordinate_coefficients", "events", "placement", "multipliers"])
def test_arrays_of_another_study_are_refused(gait, field):
    with pytest.raises(InvalidInput, match=f"shape of {field}"):
        changed(gait, **{field: getattr(gait.values, field)[..., :-1]})


# Nodal values ------------------------------------------------------------------------------


def test_nodal_values_are_the_motion_at_the_nodes(gait):
    nodal = gait.nodal_values
    motion = gait.motion(gait.splines.node_times)
    hip = gait.coordinate_names.index("hip_flexion_r")
    np.testing.assert_allclose(nodal["hip_flexion_r"], -motion.q[:, hip], atol=1e-12)
    soleus = gait.muscle_names.index("soleus_l")
    np.testing.assert_allclose(nodal["soleus_l"], motion.forces[:, soleus], atol=1e-7)


def test_setting_nodal_values_changes_only_those(gait):
    knee = gait.nodal_values["knee_flexion_l"] + 0.1
    hip = gait.nodal_values["hip_flexion_r"] - 0.2
    edited = gait.with_nodal_values(knee_flexion_l=knee, hip_flexion_r=hip)
    for name, values in edited.nodal_values.items():
        expected = {"knee_flexion_l": knee, "hip_flexion_r": hip}.get(name)
        before = gait.nodal_values[name] if expected is None else expected
        np.testing.assert_allclose(values, before, atol=1e-9 * max(1.0, np.abs(before).max()))
    assert not edited.converged and edited.report is None and not edited.cost


@pytest.mark.parametrize("model", ["spatial-symmetric", "planar-symmetric"])
def test_in_a_symmetric_study_the_mirror_image_changes_too(model):
    gait = reference_gait(model)
    half = (gait.study.nodes - 1) // 2
    bump = np.sin(np.arange(2 * half))
    edited = gait.with_nodal_values(
        knee_flexion_r=gait.nodal_values["knee_flexion_r"] + 0.01 * bump,
        hat_z=gait.nodal_values["hat_z"] + 0.01 * bump,
        soleus_l=gait.nodal_values["soleus_l"] + bump,
    )
    tau = np.linspace(0.0, 0.45, 12)
    first, second = edited.motion(tau), edited.motion(tau + 0.5)
    mirrored = coordinates.mirror(gait.study.skeleton_kind, first.a)
    np.testing.assert_allclose(second.a, mirrored, atol=1e-9 * np.abs(mirrored).max())
    legs = np.roll(first.forces, first.forces.shape[1] // 2, axis=1)
    np.testing.assert_allclose(second.forces, legs, atol=1e-7)


def test_bad_nodal_values_are_refused(gait):
    with pytest.raises(UnknownName, match="soleus_r"):
        gait.with_nodal_values(soleus=np.zeros(17))
    with pytest.raises(InvalidInput, match="17 finite numbers"):
        gait.with_nodal_values(soleus_r=np.zeros(18))
    with pytest.raises(InvalidInput, match="17 finite numbers"):
        gait.with_nodal_values(soleus_r=np.full(17, np.nan))


# Labelled arrays ---------------------------------------------------------------------------


@pytest.mark.parametrize("model", MODELS)
def test_every_variable_has_a_unit_and_a_name(model):
    for variable in reference_gait(model).sample(5).data_vars.values():
        assert variable.attrs["units"] and variable.attrs["long_name"]


def test_coordinates_are_anatomical_and_in_degrees(gait, sampled):
    motion = gait.motion(np.linspace(0.0, 1.0, 401))
    for name, sign in (("hip_flexion_r", -1), ("ankle_dorsiflexion_l", -1), ("knee_flexion_l", 1),
                       ("hip_adduction_r", 1), ("hip_adduction_l", -1)):  # fmt: skip
        shown = sampled.coordinates.sel(coordinate=name)
        q = motion.q[:, gait.coordinate_names.index(name)]
        np.testing.assert_allclose(shown, sign * np.degrees(q))
    assert str(sampled.coordinate_unit.sel(coordinate="hat_z").values) == "m"
    np.testing.assert_allclose(sampled.coordinates.sel(coordinate="hat_z"), motion.q[:, 2])
    # The reference walks: the hip flexes and the ankle pushes off before the knee bends most.
    assert 15 < float(sampled.coordinates.sel(coordinate="hip_flexion_r")[0]) < 45
    assert float(sampled.coordinates.sel(coordinate="knee_flexion_r").max()) > 45


def test_phases_are_counted_from_one(gait, sampled):
    percent, phase = sampled.percent.values[:-1], sampled.phase.values[:-1]
    begun = (percent[:, None] >= sampled.event_percent.values).sum(axis=1)
    np.testing.assert_array_equal(phase, begun)
    assert set(phase) == set(range(1, 9)) and sampled.phase.values[-1] == 1


def test_velocities_are_slopes_of_the_coordinates(sampled):
    slope = sampled.coordinates.differentiate("time").values[5:-5]
    np.testing.assert_allclose(slope, sampled.velocities.values[5:-5], atol=2.0)


def test_moment_times_velocity_is_power(sampled):
    velocity = np.radians(sampled.velocities.sel(coordinate=sampled.joint.values)).values
    np.testing.assert_allclose(sampled.joint_moment * velocity, sampled.joint_power, atol=1e-9)
    total = sampled.joint_moment_muscle + sampled.joint_moment_passive
    np.testing.assert_allclose(total, sampled.joint_moment, atol=1e-10)


def test_muscles_pull_in_the_sense_of_their_name(gait):
    """A plantarflexor makes a negative dorsiflexion moment; hip flexors flex, on both sides."""
    strong = gait.nodal_values
    sides = {}
    for side in "rl":
        edited = gait.with_nodal_values(
            **{f"soleus_{side}": strong[f"soleus_{side}"] + 100.0,
               f"iliopsoas_{side}": strong[f"iliopsoas_{side}"] + 100.0,
               f"gluteus_medius_posterior_{side}":
                   strong[f"gluteus_medius_posterior_{side}"] + 100.0}
        )  # fmt: skip
        added = edited.sample(5).joint_moment_muscle - gait.sample(5).joint_moment_muscle
        sides[side] = [
            float(added.sel(joint=f"{joint}_{side}").mean())
            for joint in ("ankle_dorsiflexion", "hip_flexion", "hip_adduction", "hip_rotation")
        ]
    assert sides["r"][0] < 0 < sides["r"][1] and sides["r"][2] < 0
    np.testing.assert_allclose(sides["r"], sides["l"])


def test_muscle_and_joint_work_agree(sampled):
    """The tendon forces work along their paths what their moments work at the joints."""
    velocity = np.radians(sampled.velocities.sel(coordinate=sampled.joint.values)).values
    at_joints = (sampled.joint_moment_muscle * velocity).sum("joint")
    np.testing.assert_allclose(sampled.muscle_work_rate.sum("muscle"), at_joints, atol=1e-8)


@pytest.mark.parametrize("model", ["spatial", "planar"])
def test_ground_forces_carry_the_centre_of_mass(model):
    """Newton: ground reactions + weight + residual of the translations = m a of the mass centre."""
    gait = reference_gait(model)
    sampled, mass = gait.sample(801), gait.study.walker.skeleton.total_mass
    time = sampled.time.values
    path = sampled.centre_of_mass.values
    acceleration = np.gradient(np.gradient(path, time, axis=0), time, axis=0)
    force = sampled.ground_reaction_force.sum("foot").values
    force[:, 2] -= mass * GRAVITY
    names = list(gait.coordinate_names)
    for axis, name in enumerate(("hat_x", "hat_y", "hat_z")):
        if name in names:
            force[:, axis] += sampled.equation_residual.values[:, names.index(name)]
            np.testing.assert_allclose(
                force[4:-4, axis], mass * acceleration[4:-4, axis], atol=2e-2 * mass
            )


def test_contact_rows_do_not_work_with_the_residual(gait):
    """C e = 0: the residual is what no contact force could explain."""
    tau = np.linspace(0.0, 0.99, 50)
    motion = gait.motion(tau)
    loads = loads_along(gait.study.walker, motion, gait.phase_of(tau))
    jacobian = gait.study.walker.skeleton.contact_jacobian(motion.q)
    product = np.einsum("kri,ki->kr", jacobian, loads.residual)
    assert np.abs(product[loads.active]).max() < 1e-9 * np.abs(loads.residual).max()
    assert np.abs(loads.multipliers[~loads.active]).max() == 0.0
    total = loads.gravity + loads.passive + loads.muscles + loads.contact + loads.residual
    np.testing.assert_allclose(loads.inertia, total, atol=1e-9)


def test_centre_of_pressure_carries_the_same_moment(gait):
    tau = np.linspace(0.0, 0.99, 50)
    motion = gait.motion(tau)
    loads = loads_along(gait.study.walker, motion, gait.phase_of(tau))
    points = gait.study.walker.skeleton.contact_points(motion.q).reshape(-1, 2, 2, 3)
    centre, free = centre_of_pressure(points, loads, 15.0)
    force, forces = loads.ground_reactions, loads.point_forces
    loaded = force[..., 2] > 15.0
    np.testing.assert_array_equal(np.isfinite(centre).all(axis=-1), loaded)
    vertical = np.cross(points, forces).sum(axis=2)[..., 2] + loads.pivot_moments
    expected = centre[..., 0] * force[..., 1] - centre[..., 1] * force[..., 0] + free
    np.testing.assert_allclose(expected[loaded], vertical[loaded], atol=1e-9)
    tilting = np.einsum("kfp,kfp->kf", forces[..., 2], points[..., 0])  # -M_y but for F_x z
    np.testing.assert_allclose((centre[..., 0] * force[..., 2])[loaded], tilting[loaded])
    assert np.all(free[~loaded] == 0.0)


def test_the_reference_is_shown_beside(gait, sampled):
    reference = gait.study.reference_walk
    tau = np.linspace(0.0, 1.0, 401)
    knee = list(reference.coordinates).index("knee_flexion_r")
    np.testing.assert_allclose(
        sampled.reference_coordinates.sel(coordinate="knee_flexion_r"),
        np.degrees(reference.coordinate_values(tau)[:, knee]),
    )
    np.testing.assert_allclose(
        sampled.reference_ground_reaction_force, reference.ground_reactions(tau)
    )


@pytest.mark.parametrize("num", [1, 0, -3, 2.5, True, "many"])
def test_too_few_samples_are_refused(gait, num):
    with pytest.raises(InvalidInput, match="num"):
        gait.sample(num)


# Energy and summary ------------------------------------------------------------------------


def test_cost_of_transport_is_power_over_speed(gait, sampled):
    mean_power = float(sampled.muscle_power.isel(time=slice(0, -1)).mean("time").sum())
    assert gait.metabolic.cost_of_transport == pytest.approx(mean_power / gait.speed, rel=2e-3)
    assert set(gait.metabolic.by_muscle) == set(gait.muscle_names)
    assert sum(gait.metabolic.by_muscle.values()) == pytest.approx(
        gait.metabolic.cost_of_transport
    )


def test_basal_rate_counts(planar):
    resting = restated(planar, planar.study.with_settings(basal=True))
    added = resting.metabolic.cost_of_transport - planar.metabolic.cost_of_transport
    assert added == pytest.approx(1.2 * 75.0 / planar.speed) == resting.metabolic.basal


SUMMARY_KEYS = {
    "model": None, "nodes": None, "control_points": None, "subject": {"height_m", "mass_kg"},
    "solver": {"name", "status", "iterations", "wall_time_s", "setup_time_s", "starts"},
    "problem": {"num_variables", "num_constraints", "jacobian_nonzeros"},
    "cost": {"total", "metabolic_cost_of_transport_J_per_m", "deviation"},
    "gait": {"speed_m_per_s", "stride_time_s", "step_length_right_m", "step_length_left_m",
             "step_width_m", "phase_durations_s"},
    "check": set(CHECKED),
    "versions": {"drakegait", "drake", "numpy", "casadi", "python"},
}  # fmt: skip


def test_summary_has_the_stable_keys(planar):
    for gait in (planar, dataclasses.replace(planar, report=planar_report(planar))):
        summary = json.loads(json.dumps(gait.summary()))
        assert set(summary) == set(SUMMARY_KEYS)
        for key, inner in SUMMARY_KEYS.items():
            assert inner is None or set(summary[key]) == inner
    assert summary["check"]["passed"] is False
    assert summary["cost"]["deviation"] > 0.0
    assert planar.summary()["check"]["passed"] is None
    assert len(summary["gait"]["phase_durations_s"]) == 8


def planar_report(planar):
    from drakegait.check import check

    return check(planar, 200)


# Files -------------------------------------------------------------------------------------


def assert_same(one: Gait, other: Gait) -> None:
    for field in dataclasses.fields(one.values):
        np.testing.assert_array_equal(
            getattr(one.values, field.name), getattr(other.values, field.name)
        )
    assert one.study.to_dict() == other.study.to_dict()
    assert one.outcome == other.outcome and one.cost == other.cost and one.report == other.report


@pytest.mark.parametrize("model", MODELS)
def test_a_file_holds_the_whole_gait(model, tmp_path):
    gait = reference_gait(model)
    gait = dataclasses.replace(gait, report=planar_report(gait))
    gait.save(tmp_path / "gait.nc")
    assert_same(gait, Gait.load(tmp_path / "gait.nc"))
    assert [path.name for path in tmp_path.iterdir()] == ["gait.nc"]


def test_a_changed_study_survives(planar, tmp_path):
    study = (
        planar.study.with_added_mass("foot_r", 2.0)
        .with_added_mass("hat", 1.0, (0.1, 0.0, 0.3))
        .with_limit("knee_flexion_r", high=1.2)
        .with_settings(friction=0.5, basal=True)
        .replace(strength={"soleus_l": 0.7}, interior_points=(1, 2, 3, 4, 5, 6, 7, 8))
    )
    gait = restated(planar, study)
    gait.save(tmp_path / "gait.nc")
    again = Gait.load(tmp_path / "gait.nc")
    assert_same(gait, again)
    assert again.study == study
    assert again.metabolic.cost_of_transport == pytest.approx(gait.metabolic.cost_of_transport)


@pytest.mark.parametrize("source", ["embedded", "table"])
def test_an_own_reference_travels_along(gait, source, tmp_path):
    reference = Reference.embedded("spatial", name="asymmetric")
    if source == "table":
        reference.save(tmp_path / "walk.csv")
        reference = Reference.from_table(tmp_path / "walk.csv", kind="spatial")
        (tmp_path / "walk.csv").unlink()
    own = restated(gait, gait.study.replace(reference=reference))
    own.save(tmp_path / "gait.nc")
    again = Gait.load(tmp_path / "gait.nc").study.reference
    tau = np.linspace(0.0, 1.0, 333)
    for order in range(3):
        expected = reference.coordinate_values(tau, order)
        found = again.coordinate_values(tau, order)
        np.testing.assert_allclose(found, expected, atol=1e-5 * np.abs(expected).max())
    forces = reference.ground_reactions(tau)
    np.testing.assert_allclose(again.ground_reactions(tau), forces, atol=1e-3)
    np.testing.assert_allclose(again.coordinate_sigma, reference.coordinate_sigma, rtol=1e-6)
    np.testing.assert_allclose(again.force_weight, reference.force_weight, rtol=1e-6)
    for field in ("kind", "name", "stride_time", "phase_fractions", "foot_placement", "deviation"):
        assert getattr(again, field) == getattr(reference, field)


def test_the_default_reference_is_not_frozen_in(planar, tmp_path):
    planar.save(tmp_path / "gait.nc")
    assert Gait.load(tmp_path / "gait.nc").study.reference is None


def test_other_programs_can_read_the_file(planar, tmp_path):
    planar.save(tmp_path / "gait.nc")
    with xr.open_dataset(tmp_path / "gait.nc", engine="h5netcdf") as dataset:
        xr.testing.assert_allclose(dataset, planar.sample())
        assert dataset.activation.attrs["units"] == "1" and dataset.time.attrs["units"] == "s"
        assert dataset.sizes["time"] == 201 and dataset.time.dtype == float


def test_the_file_is_the_one_that_xarray_would_write(planar, tmp_path):
    """Names, order, types, attributes, labels and missing values, down to the encoding."""
    planar.save(tmp_path / "gait.nc")
    planar.sample().to_netcdf(tmp_path / "its.nc", engine="h5netcdf")
    with (
        xr.open_dataset(tmp_path / "gait.nc", engine="h5netcdf") as ours,
        xr.open_dataset(tmp_path / "its.nc", engine="h5netcdf") as its,
    ):
        xr.testing.assert_identical(ours.drop_attrs(deep=False), its)
        assert set(ours.coords) == set(its.coords)
        for name, variable in its.variables.items():
            encodings = [x.encoding | {"source": None} for x in (ours[name], variable)]
            np.testing.assert_equal(*encodings)
    with xr.open_dataset(tmp_path / "gait.nc", group="design", engine="h5netcdf") as design:
        assert design.coordinate_coefficients.dims == ("coordinate", "coefficient")
        assert not design.coords and design.stride_time.dims == ()


def saved(gait: Gait, path, **attributes) -> None:
    """A file of `gait` with other attributes of the root; None removes one."""
    import h5netcdf

    gait.save(path)
    with h5netcdf.File(path, "a") as file:
        for name, value in attributes.items():
            if value is None:
                del file.attrs[name]
            else:
                file.attrs[name] = value


@pytest.mark.parametrize(
    ("attributes", "words"),
    [
        ({"format": "other"}, "not a gait"),
        ({"format": None}, "not a gait"),
        ({"format_version": 2}, "has format 2"),
        ({"format_version": "new"}, "has format new"),
        ({"study": None}, "'study' is missing"),
        ({"study": "{"}, "damaged"),
        ({"study": "[1]"}, "damaged"),
        ({"study": '{"nodes": 18, "colour": 1}'}, "colour"),
        ({"study": '{"nodes": 22}'}, "coordinate_coefficients"),
        ({"study": '{"model": "planar", "nodes": 18, "subject": {"height": 9}}'}, "height"),
        ({"outcome": '{"solver": "x"}'}, "damaged"),
        ({"check": '{"instants": 5}'}, "'items' is missing"),
        ({"cost": "nothing"}, "damaged"),
    ],
)
def test_damaged_attributes_give_one_sentence(planar, tmp_path, attributes, words):
    path = tmp_path / "gait.nc"
    saved(planar, path, **attributes)
    with pytest.raises(BadFile, match=words) as caught:
        Gait.load(path)
    assert "gait.nc" in str(caught.value) and "\n" not in str(caught.value)


def test_damaged_arrays_give_one_sentence(planar, tmp_path):
    import h5netcdf

    path = tmp_path / "gait.nc"
    planar.save(path)
    with h5netcdf.File(path, "a") as file:
        file["design"]["events"][3] = np.nan
    with pytest.raises(BadFile, match="not finite"):
        Gait.load(path)


def test_foreign_and_broken_files_give_one_sentence(planar, tmp_path):
    path = tmp_path / "gait.nc"
    with pytest.raises(BadFile, match="does not exist"):
        Gait.load(path)
    with pytest.raises(BadFile, match="is a folder"):
        Gait.load(tmp_path)
    path.write_text("a walk in the park")
    with pytest.raises(BadFile, match="not a netCDF file"):
        Gait.load(path)
    xr.Dataset({"x": ("t", np.arange(3.0))}).to_netcdf(path, engine="h5netcdf")
    with pytest.raises(BadFile, match="not a gait"):
        Gait.load(path)
    planar.save(path)
    whole = path.read_bytes()
    for share in (0.1, 0.5, 0.95):
        path.write_bytes(whole[: int(share * len(whole))])
        with pytest.raises(BadFile):
            Gait.load(path)


def test_a_file_that_cannot_be_written_leaves_nothing(planar, tmp_path, monkeypatch):
    with pytest.raises(BadFile, match="cannot be written") as caught:
        planar.save(tmp_path / "no folder" / "gait.nc")
    assert "\n" not in str(caught.value)
    with pytest.raises(BadFile, match="is a folder"):
        planar.save(tmp_path)
    planar.save(tmp_path / "gait.nc")
    before = (tmp_path / "gait.nc").read_bytes()

    def full(*_):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("os.replace", full)
    with pytest.raises(BadFile, match="No space left"):
        planar.save(tmp_path / "gait.nc")
    assert [path.name for path in tmp_path.iterdir()] == ["gait.nc"]
    assert (tmp_path / "gait.nc").read_bytes() == before


def test_a_gait_needs_no_solver():
    """The answer, its file and its check import neither solvers nor (check) the program."""
    import ast
    from pathlib import Path

    import drakegait.gait

    folder = Path(drakegait.gait.__file__).parent
    files = ("gait", "gait_file", "summary", "sampling", "motion", "loads", "check", "judgement")
    for name in files:
        tree = ast.parse((folder / f"{name}.py").read_text(encoding="utf-8"))
        modules = {node.module for node in ast.walk(tree) if isinstance(node, ast.ImportFrom)}
        solvers = {m for m in modules if m.startswith("drakegait.solvers")}
        assert solvers <= {"drakegait.solvers.outcome"}
        if name not in ("gait", "gait_file"):
            assert not any(m.startswith("drakegait.program") for m in modules)
