"""Which studies count as one: all that decides the answer, and nothing else."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest

from drakegait.reference.reference import Reference
from drakegait.solvers.options import SolverOptions
from drakegait.study import SETTINGS_GROUPS, GaitStudy
from drakegait.sweep import identity
from drakegait.sweep.store import Store

STUDY = GaitStudy.planar(speed=1.0)


def key(study=STUDY, options=None, refine=True):
    return identity.study_key(study, options or SolverOptions(), refine)


def test_equal_content_has_one_key():
    assert key(GaitStudy.planar(speed=np.float64(1.0))) == key(GaitStudy.planar(speed=1)) == key()
    assert key(GaitStudy.from_dict(STUDY.to_dict())) == key()
    STUDY.formulation()  # builds what the study keeps for itself
    assert key() == key(STUDY.replace())


CHANGES = {
    "model": dict(model="planar-symmetric", nodes=19),
    "nodes": dict(nodes=20),
    "speed": dict(speed=1.0 + 1e-12),
    "mass": dict(subject=STUDY.subject.replace(mass=76.0)),
    "energy_weight": dict(energy_weight=0.5),
    "strength": dict(strength={"SOL": 0.5}),
    "interior_points": dict(interior_points=(2,) * 8),
    "multipliers": dict(multipliers="projected"),
    "reference": dict(reference=Reference.embedded("planar", STUDY.subject)),
}


@pytest.mark.parametrize("name", CHANGES)
def test_every_other_statement_has_another_key(name):
    assert key(STUDY.replace(**CHANGES[name])) != key()


@pytest.mark.parametrize("group", SETTINGS_GROUPS)
def test_every_constant_counts(group):
    settings = getattr(STUDY, group)
    for item in dataclasses.fields(settings):
        meta, value = item.metadata, getattr(settings, item.name)
        if "unit" in meta:
            new = value + 1e-9 * ((meta["low"] + meta["high"]) / 2.0 - value or 1.0)
        elif "options" in meta:
            new = next(option for option in meta["options"] if option != value)
        else:
            new = not value
        changed = STUDY.replace(**{group: settings.replace(**{item.name: new})})
        assert key(changed) != key(), item.name


def test_the_way_to_the_answer_counts_but_not_its_limits(monkeypatch):
    assert key(options=SolverOptions(optimality=1e-4)) != key() != key(refine=False)
    assert key(options=SolverOptions(time_limit=5.0, max_iterations=3)) == key()
    monkeypatch.setattr("drakegait.__version__", "9.9")
    changed = key()
    monkeypatch.undo()
    assert changed != key()


def test_a_reference_counts_by_its_curves():
    reference = Reference.embedded("planar", STUDY.subject)
    same = Reference.embedded("planar", STUDY.subject)
    normal = Reference.embedded("planar", STUDY.subject, "normal")
    named = dataclasses.replace(reference, name="another name")
    keys = [key(STUDY.replace(reference=each)) for each in (reference, same, named, normal)]
    assert keys[0] == keys[1] == keys[2] != keys[3]


def test_results_of_another_version_are_solved_anew_and_it_is_said(tmp_path):
    store = Store(tmp_path)
    summary = {"solver": {"status": "converged"}, "versions": {"drakegait": "0.0.1"}}
    store.write_done("a", "old key", b"gait", summary, None)
    assert store.state("a", "old key").status == "done"
    state = store.state("a", "new key")
    assert state.status == "open" and "of drakegait 0.0.1, this is" in state.note


def test_a_failure_is_that_of_one_study_and_no_longer_when_it_has_changed(tmp_path):
    store = Store(tmp_path)
    store.write_failed("a", "old key", "raised", "It was too much.")
    assert store.state("a", "old key").status == "failed"
    state = store.state("a", "new key")
    assert state.status == "open" and "has changed since" in state.note
