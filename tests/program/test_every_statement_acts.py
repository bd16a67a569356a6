"""Nothing that is stated is read and then ignored: all of it moves the program that is solved."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest
from program_cases import jiggled, program, study

from drakegait.program.formulation import JointLimit
from drakegait.program.gait_program import GaitProgram
from drakegait.reference.reference import Reference
from drakegait.study import SETTINGS_GROUPS, GaitStudy
from drakegait.walker.disorders import Weakness
from drakegait.walker.model_file import sdf_path
from drakegait.walker.subject import AddedMass, Subject

# What has to be chosen for a constant to mean something.
NEEDED = {
    "time_activation": {"time_constants": "fixed"},
    "time_deactivation": {"time_constants": "fixed"},
    "toe_torque_limit": {"toe_torque": True},
    "basal_rate": {"basal": True},
}
CONSTANTS = [
    (group, item.name) for group, kind in SETTINGS_GROUPS.items()
    for item in dataclasses.fields(kind)
]  # fmt: skip


def told(program: GaitProgram, x: np.ndarray) -> list[np.ndarray]:
    """All that a solver gets to see of a program at `x`."""
    design, costs = program.design, program.cost_parts(x)
    costs = np.array([costs[name] for name in sorted(costs)])
    return [costs, program.rows(x), program.lower, program.upper, design.lower, design.upper]


def acts(changed: GaitStudy, model: str, **statements) -> bool:
    """Whether a solver sees another program than that of `study(model, **statements)`."""
    before, x = program(model, **statements), jiggled(model, **statements)
    after = GaitProgram(changed.formulation())
    if after.num_variables != x.size:
        return True
    pairs = zip(told(before, x), told(after, x), strict=True)
    return not all(np.array_equal(one, other) for one, other in pairs)


def another(item: dataclasses.Field, value):
    """Another value that is allowed."""
    meta = item.metadata
    if "options" in meta:
        return next(option for option in meta["options"] if option != value)
    if meta.get("flag"):
        return not value
    return value + 0.1 * (meta["high"] - value if value < meta["high"] else meta["low"] - value)


@pytest.mark.parametrize("model", ["spatial", "planar"])
def test_the_same_study_is_the_same_program(model):
    assert not acts(study(model), model)


@pytest.mark.parametrize(("group", "name"), CONSTANTS)
def test_every_constant_acts(group, name):
    kind = SETTINGS_GROUPS[group]
    settings = kind(**NEEDED.get(name, {}))
    item = next(field for field in dataclasses.fields(kind) if field.name == name)
    changed = settings.replace(**{name: another(item, getattr(settings, name))})
    assert acts(study("spatial", **{group: changed}), "spatial", **{group: settings})


STATEMENTS = {
    "speed": {"speed": 1.21},
    "energy weight": {"energy_weight": 0.9},
    "deviation weight": {"deviation_weight": 0.9},
    "height": {"subject": Subject(height=1.81)},
    "mass": {"subject": Subject(mass=76.0)},
    "anthropometry": {"subject": Subject(anthropometry="deleva")},
    "added mass": {"added_masses": (AddedMass("shank_l", 0.1),)},
    "place of an added mass": {"added_masses": (AddedMass("shank_l", 0.1, (0.0, 0.0, -0.3)),)},
    "strength": {"strength": {"soleus_r": 0.99}},
    "limit": {"limits": (JointLimit("ankle_dorsiflexion_l", -0.3, 0.3),)},
    "multipliers": {"multipliers": "projected"},
    "control points": {"interior_points": (1,) * 8},
    "nodes": {"nodes": 12},
    "disorder": {"disorders": (Weakness("soleus", side="r", strength=0.9),)},
    **{f"{entry} of a muscle": {"muscle_changes": {"vasti_l": {entry: value}}}
       for entry, value in (("f_max", 5000.0), ("l_opt", 0.09), ("l_slack", 0.22), ("l0", 0.3),
                            ("width", 0.6))},
}  # fmt: skip


@pytest.mark.parametrize("model", ["spatial", "planar"])
@pytest.mark.parametrize("name", STATEMENTS)
def test_every_statement_acts(model, name):
    assert acts(study(model).replace(**STATEMENTS[name]), model)


def test_model_files_references_and_planar_muscles_act():
    plain = study("planar")
    assert acts(plain.replace(planar_muscles="gait2d"), "planar")
    assert acts(plain.replace(reference=Reference.embedded("planar", name="normal")), "planar")
    text = sdf_path("planar").read_text(encoding="utf-8")
    assert not acts(plain.replace(sdf=text), "planar")
    assert acts(plain.replace(sdf=text.replace("<mass>", "<mass>1", 1)), "planar")
