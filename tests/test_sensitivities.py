"""Derivatives of an optimum: identities, exact cases, re-solves, the table and the picture."""

from __future__ import annotations

import copy
import csv
import dataclasses

import numpy as np
import pytest
from gait_cases import reference_gait

from drakegait.errors import BadFile, InvalidInput
from drakegait.gait import Gait
from drakegait.parameters import parameters
from drakegait.program.gait_program import GaitProgram
from drakegait.program.kkt import KktMultipliers
from drakegait.program.kkt_system import KktSystem
from drakegait.program.optimum import Functions, Optimum
from drakegait.report.tornado import tornado
from drakegait.sensitivities import Sensitivities, Sensitivity, sensitivities
from drakegait.solve import solve
from drakegait.study import GaitStudy
from drakegait.walker import disorders as dis

STUDY = GaitStudy.planar_symmetric(11, interior_points=(3, 2, 6, 5))
# Near the optimum that one starts from, and so exactly that differences of solves mean something.
EXACT = {
    "optimality": 1e-7, "cost_change": 0.0, "refine": False, "time_limit": 60.0,
    "barrier_start": 1e-8,
}  # fmt: skip


@pytest.fixture(scope="module")
def gait():
    """An optimum, found exactly."""
    first = solve(STUDY, refine=False, optimality=1e-6, cost_change=0.0, time_limit=60.0)
    return solve(STUDY, guess=first, **EXACT)


@pytest.fixture(scope="module")
def answers(gait):
    return gait.sensitivities()


@pytest.fixture(scope="module")
def optimum(gait):
    return Optimum(GaitProgram(gait.study.formulation(gait.kkt.event_centres)), gait.kkt)


# Identities at an optimum -----------------------------------------------------------------------


@pytest.mark.solve
def test_the_multipliers_are_those_of_the_gait_that_is_handed_back(gait, optimum, answers):
    program = optimum.program
    np.testing.assert_allclose(program.design.pack(gait.values), gait.kkt.x, atol=1e-9)
    assert answers.stationarity < 1e-6
    assert answers.cost == pytest.approx(gait.cost["total"], rel=1e-9)
    assert answers.energy == pytest.approx(
        100.0 * gait.cost["metabolic cost of transport"], rel=1e-9
    )


@pytest.mark.solve
def test_the_derivative_by_a_weight_is_the_term_that_it_weighs(gait, answers):
    for name, term in (
        ("energy_weight", "metabolic cost of transport"), ("deviation_weight", "deviation"),
    ):  # fmt: skip
        assert answers[name].cost == pytest.approx(gait.cost[term], rel=1e-6)


@pytest.mark.solve
def test_only_the_ratio_of_the_weights_moves_the_optimum(answers):
    """Both twice as large: the same walk. So their derivatives of E^t cancel."""
    energy, deviation = answers["energy_weight"].energy, answers["deviation_weight"].energy
    assert energy < 0.0 < deviation  # who weighs energy more spends less
    assert energy == pytest.approx(-deviation, rel=1e-3)


@pytest.mark.solve
def test_muscle_mass_enters_by_density_over_specific_tension(answers):
    density, tension = answers["energy.density"], answers["energy.specific_tension"]
    for what in ("cost", "energy"):
        mass = getattr(density, what) * density.value
        assert mass > 0.0
        assert getattr(tension, what) * tension.value == pytest.approx(-mass, rel=1e-4)


@pytest.mark.solve
def test_looser_laws_cannot_cost_more(answers):
    """A wider bound contains the walks of the narrower one."""
    looser = [e for e in answers.entries if e.group == "tolerances"]
    assert {e.parameter for e in looser} >= {"tolerances.moment_tolerance"}
    assert all(e.cost <= 1e-9 for e in looser)
    assert answers["tolerances.moment_tolerance"].cost < -1.0
    assert answers["muscles.min_force"].cost > 0.0  # a bound that is raised


@pytest.mark.solve
def test_the_adjoint_of_the_cost_is_the_envelope_theorem(gait, optimum):
    """Two ways to one number, with nothing in common but the differences."""
    system = KktSystem(optimum)
    adjoint = system.adjoint(optimum.program.gradient(gait.kkt.x))
    found = parameters(gait.study)
    chosen = [p for p in found if p.group in ("body", "walk", "muscle")][::4]
    chosen += [p for p in found if p.group == "tolerances"]
    for parameter in chosen:
        change = difference(optimum, parameter)
        by_adjoint = change.cost + adjoint @ system.right_hand_side(change)
        assert by_adjoint == pytest.approx(optimum.cost_answer(change), rel=2e-3, abs=1e-3)


class Rescaled:
    """The same program with variables in units twice and rows in units three times as large."""

    def __init__(self, program: GaitProgram):
        self._program, self.points = program, program.points
        self.formulation, self.row_scale = program.formulation, 3.0 * program.row_scale
        self.lower, self.upper = program.lower / 3.0, program.upper / 3.0
        self.num_variables, self.num_constraints = program.num_variables, program.num_constraints
        self.jacobian_rows, self.jacobian_columns = program.jacobian_rows, program.jacobian_columns
        self.design = copy.copy(program.design)
        self.design.scale = 2.0 * program.design.scale
        self.design.lower = program.design.lower / 2.0
        self.design.upper = program.design.upper / 2.0

    def rows(self, x):
        return self._program.rows(2.0 * x) / 3.0

    def jacobian(self, x):
        return 2.0 * self._program.jacobian(2.0 * x) / 3.0

    def cost(self, x):
        return self._program.cost(2.0 * x)

    def gradient(self, x):
        return 2.0 * self._program.gradient(2.0 * x)

    def state(self, x):
        return self._program.state(2.0 * x)


@pytest.mark.solve
def test_how_rows_and_variables_are_scaled_changes_nothing(optimum):
    there, here = optimum.functions(Rescaled(optimum.program)), optimum.functions(optimum.program)
    for field in dataclasses.fields(Functions):
        np.testing.assert_allclose(
            getattr(there, field.name), getattr(here, field.name), rtol=1e-9, atol=1e-9
        )


def difference(optimum: Optimum, parameter) -> Functions:
    step = 1e-4 * parameter.step
    centres = optimum.multipliers.event_centres
    parts = [
        optimum.functions(GaitProgram(parameter.study(value).formulation(centres)))
        for value in (parameter.value + step, parameter.value - step)
    ]
    return Functions.combined([0.5 / step, -0.5 / step], parts)


# Against solves ---------------------------------------------------------------------------------


@pytest.mark.solve
@pytest.mark.parametrize(
    "name",
    ["speed", "strength soleus", "added mass shank", "tolerances.contact_tolerance", "body height"],
)
def test_it_is_what_solving_again_gives(gait, answers, name):
    parameter = next(p for p in parameters(gait.study) if p.name == name)
    step = 2e-3 * parameter.step
    ends = []
    for value in (parameter.value + step, parameter.value - step):
        solved = solve(parameter.study(value), guess=gait, **EXACT)
        assert solved.converged
        ends.append([solved.cost["total"], 100.0 * solved.cost["metabolic cost of transport"]])
    cost, energy = (np.subtract(*ends)) / (2.0 * step)
    assert answers[name].cost == pytest.approx(cost, rel=3e-3)
    assert answers[name].energy == pytest.approx(energy, rel=3e-2)


@pytest.mark.solve
@pytest.mark.parametrize("solver", ["ipopt", "snopt"])
def test_drake_s_solvers_give_multipliers_too(gait, solver):
    found = solve(STUDY, guess=gait, solver=solver, refine=False, time_limit=60.0)
    assert found.converged
    program = GaitProgram(found.study.formulation(found.kkt.event_centres))
    assert Optimum(program, found.kkt).stationarity < 3e-3


# Parameters -------------------------------------------------------------------------------------

CASES = {
    "planar": GaitStudy.planar(12).with_added_mass("foot_r", 1.5),
    "planar-symmetric": STUDY,
    "spatial": GaitStudy.spatial(12).with_limit("knee_flexion_r", 0.0, 1.0),
    "mirrored statements": GaitStudy.planar_symmetric(11)
    .with_limit("knee_flexion_r", -0.1, 1.3)
    .with_limit("knee_flexion_l", -0.1, 1.3)
    .with_disorder(dis.Weakness("soleus", "r", 0.6), dis.Weakness("soleus", "l", 0.6))
    .with_disorder(dis.Orthosis("both", 200, neutral=5), dis.Pain("foot", "both", 2))
    .with_added_mass("foot_r", 1.0, (0.1, 0.0, 0.0))
    .with_added_mass("foot_l", 1.0, (0.1, 0.0, 0.0)),
    "one-sided": GaitStudy.planar(11)
    .with_added_mass("foot_r", 1.0)
    .with_added_mass("foot_r", 1.0, (0.1, 0.0, 0.0))
    .with_added_mass("foot_r", 1.0, (0.1, 0.0, 0.0))
    .with_disorder(dis.Prosthesis("l"), dis.LimitedRange("knee", "r", high=60)),
}


@pytest.mark.parametrize("study", CASES.values(), ids=CASES)
def test_a_parameter_at_its_value_is_the_study_itself(study):
    """Wherever one looks: the same rows, cost and bounds at a point that is no optimum."""
    program = GaitProgram(study.formulation())
    design, generator = program.design, np.random.default_rng(3)
    low, high = np.maximum(design.lower, -1.0), np.minimum(design.upper, 1.0)
    x = low + generator.uniform(0.2, 0.4, len(low)) * (high - low)
    rows, cost = program.rows(x), program.cost(x)
    all_of_them = parameters(study)
    assert len({p.name for p in all_of_them}) == len(all_of_them)
    for parameter in all_of_them[:: 1 if study.symmetric else 7]:
        same = GaitProgram(parameter.study(parameter.value).formulation())
        np.testing.assert_allclose(same.rows(x), rows, atol=1e-7, err_msg=parameter.name)
        assert same.cost(x) == pytest.approx(cost, rel=1e-9), parameter.name
        np.testing.assert_allclose(same.design.lower, design.lower, rtol=1e-9)
        assert parameter.step > 0.0


def test_what_a_parameter_changes():
    study = CASES["planar"]
    by_name = {p.name: p for p in parameters(study)}
    weight = study.walker.skeleton.total_mass
    for name, more in (("added mass shank_r", 1.0), ("mass hat", 1.0), ("mass worn on foot_r", 1.0),
                       ("mass centre hat", 0.0), ("inertia hat", 0.0)):  # fmt: skip
        heavier = by_name[name].study(by_name[name].value + 1.0 * (more or 0.01))
        assert heavier.walker.skeleton.total_mass == pytest.approx(weight + more), name
    assert by_name["added mass foot_r"].value == by_name["mass worn on foot_r"].value == 1.5
    stronger = by_name["strength soleus_l"].study(1.2).walker.muscles
    ratio = stronger.f_max / study.walker.muscles.f_max
    assert {n for n, r in zip(stronger.names, ratio, strict=True) if r != 1.0} == {"soleus_l"}
    assert ratio.max() == pytest.approx(1.2)
    longer = by_name["fibre length soleus_l"]
    assert longer.study(0.05).walker.muscles.l_opt.min() <= 0.05
    assert longer.study(0.05).walker.muscle_functions.constants.inverse_l_opt[
        stronger.names.index("soleus_l")
    ] == pytest.approx(20.0)
    assert by_name["contact.friction"].study(0.5).contact.friction == 0.5


def test_both_sides_of_a_mirror_change_together():
    by_name = {p.name: p for p in parameters(STUDY)}
    assert "strength soleus_l" not in by_name
    assert "added mass foot_r" not in by_name
    weight = STUDY.walker.skeleton.total_mass
    heavier = by_name["added mass foot"].study(1.0)
    assert heavier.walker.skeleton.total_mass == pytest.approx(weight + 2.0)
    ratio = by_name["strength soleus"].study(1.2).walker.muscles.f_max / STUDY.walker.muscles.f_max
    assert np.count_nonzero(ratio != 1.0) == 2


def test_statements_of_both_sides_change_together_whatever_they_are():
    study = CASES["mirrored statements"]
    by_name = {p.name: p for p in parameters(study)}
    for name, unit, value in (
        ("high limit knee_flexion", "rad", 1.2), ("low limit knee_flexion", "rad", -0.05),
        ("weakness soleus strength", "-", 0.7), ("orthosis both stiffness", "N m/rad", 210.0),
        ("orthosis both neutral", "degrees", 4.0), ("pain foot both weight", "-", 3.0),
        ("mass worn on foot at 0.1, 0, 0 m", "kg", 2.0),
    ):  # fmt: skip
        assert by_name[name].unit == unit
        by_name[name].study(value).formulation()  # which refuses what is not the same on both sides
    weaker = by_name["weakness soleus strength"].study(0.3).walker.muscles.f_max
    ratio = weaker / study.walker.muscles.f_max
    assert np.count_nonzero(np.isclose(ratio, 0.5)) == 2
    assert not any("range" in p.name or not np.isfinite(p.value) for p in parameters(study))


def test_each_thing_that_one_wears_or_has_is_a_number_of_its_own():
    study = CASES["one-sided"]
    by_name = {p.name: p for p in parameters(study)}
    masses = [n for n in by_name if n.startswith("mass worn")]
    assert masses == [
        "mass worn on foot_r", "mass worn on foot_r at 0.1, 0, 0 m",
        "mass worn on foot_r at 0.1, 0, 0 m (2)",
    ]  # fmt: skip
    for position, name in enumerate(masses):
        changed = by_name[name].study(2.0).added_masses
        assert [item.mass for item in changed] == [2.0 if k == position else 1.0 for k in range(3)]
    assert "range knee_flexion r high" in by_name
    assert "range knee_flexion r low" not in by_name  # open
    stiffness = by_name["prosthesis l stiffness"]  # that of its category
    assert stiffness.value == dis.Prosthesis("l").forefoot_stiffness
    assert stiffness.study(300.0).disorders[0].forefoot_stiffness == 300.0


def test_what_does_not_touch_the_body_shares_it():
    by_name = {p.name: p for p in parameters(STUDY)}
    assert by_name["speed"].study(1.3).walker is STUDY.walker
    assert by_name["body mass"].study(80.0).walker is not STUDY.walker


# Refusals, files, table, picture ----------------------------------------------------------------


def test_a_gait_without_multipliers_is_refused():
    with pytest.raises(InvalidInput, match="solve again"):
        reference_gait("planar").sensitivities()


def test_multipliers_of_another_program_are_refused():
    gait = reference_gait("planar")
    foreign = KktMultipliers(np.ones(3), np.ones(2), np.ones(3), np.ones(3), gait.values.events)
    with pytest.raises(InvalidInput, match="sizes"):
        sensitivities(dataclasses.replace(gait, kkt=foreign))


def test_multipliers_of_unequal_length_are_refused():
    with pytest.raises(InvalidInput, match="upper"):
        KktMultipliers(np.ones(3), np.ones(2), np.ones(3), np.ones(4), np.ones(8))
    with pytest.raises(InvalidInput, match="finite"):
        KktMultipliers(np.ones(3), np.array([np.nan]), np.ones(3), np.ones(3), np.ones(8))


def test_multipliers_survive_the_file(tmp_path):
    gait = reference_gait("planar-symmetric")
    generator = np.random.default_rng(0)
    kkt = KktMultipliers(*(generator.normal(size=n) for n in (7, 4, 7, 7, 8)))
    dataclasses.replace(gait, kkt=kkt).save(tmp_path / "with.nc")
    gait.save(tmp_path / "without.nc")  # as an earlier drakegait wrote it
    found = Gait.load(tmp_path / "with.nc").kkt
    for field in dataclasses.fields(kkt):
        np.testing.assert_array_equal(getattr(found, field.name), getattr(kkt, field.name))
    assert Gait.load(tmp_path / "without.nc").kkt is None


def test_nodal_values_set_by_hand_have_no_multipliers():
    gait = reference_gait("planar-symmetric")
    kkt = KktMultipliers(*(np.ones(n) for n in (7, 4, 7, 7, 8)))
    name = gait.coordinate_names[2]
    edited = dataclasses.replace(gait, kkt=kkt).with_nodal_values(
        **{name: gait.nodal_values[name]}
    )
    assert edited.kkt is None


def made_up(energies=(1.0, -30.0, 2.0)) -> Sensitivities:
    changes = (0.3, -0.2, 0.1)
    entries = tuple(
        Sensitivity(f"thing {k}", "walk", "m", 2.0, 10 * cost, 10 * energy, 0.1, cost, energy)
        for k, (cost, energy) in enumerate(zip(changes, energies, strict=True))
    )
    return Sensitivities(entries, 4.0, 350.0, 1e-5, True, "somebody")


def test_the_longest_bars_are_on_top_and_both_panels_have_their_own_order():
    figure = tornado(made_up(), count=2)
    first, second = figure.axes
    words = [[label.get_text().split(":")[0] for label in axes.get_yticklabels()]
             for axes in (first, second)]  # fmt: skip
    assert words == [["thing 0", "thing 1"], ["thing 1", "thing 2"]]
    widths = [abs(bar.get_width()) for bar in second.patches]
    assert sorted(widths) == [2.0, 2.0, 30.0, 30.0]
    assert second.get_yticks()[0] > second.get_yticks()[1]


def test_where_the_energy_is_not_known_it_is_not_drawn():
    assert len(tornado(made_up((np.nan,) * 3)).axes) == 1


def test_table_and_files_hold_every_parameter(tmp_path):
    answers = made_up()
    answers.save_csv(tmp_path / "all.csv")
    with (tmp_path / "all.csv").open(newline="") as file:
        rows = list(csv.DictReader(file))
    assert [row["parameter"] for row in rows] == ["thing 0", "thing 1", "thing 2"]
    assert float(rows[1]["energy_change"]) == -30.0
    assert {p.name for p in answers.plot(tmp_path)} == {"sensitivities.svg", "sensitivities.png"}
    pytest.importorskip("pandas")
    table = answers.table()
    assert table.loc["thing 1", "cost"] == -2.0
    with pytest.raises(KeyError):
        answers["thing 3"]
    with pytest.raises(BadFile):
        answers.save_csv(tmp_path)
