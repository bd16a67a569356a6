"""What every number of a study does to its optimum: derivatives, for free.

    answers = gait.sensitivities()
    answers.table()             # a pandas DataFrame
    answers.plot("figures")     # tornado plots

At a solved optimum the derivative of the cost f by any parameter p of the study is that of the
Lagrangian at fixed unknowns and multipliers (`drakegait.program.optimum`), the derivative of
the cost of transport E^t takes one adjoint solve of the KKT conditions for all parameters
together (`drakegait.program.kkt_system`). Derivatives by p itself are central differences.
"""

from __future__ import annotations

import csv
from dataclasses import asdict, dataclass, fields
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from drakegait.errors import BadFile, InvalidInput
from drakegait.parameters import Parameter, parameters
from drakegait.program.gait_program import GaitProgram
from drakegait.program.kkt_system import KktSystem
from drakegait.program.optimum import Functions, Optimum
from drakegait.study import GaitStudy

if TYPE_CHECKING:
    import pandas as pd

    from drakegait.gait import Gait

EXACT = 1e-6
"""Relative KKT residual below which it is known which bounds are active."""
WIDE_BARRIER = 1e-4
"""Barrier parameter for dE^t/dp above it (measured: docs/sensitivities.md)."""
_NOTHING = 1e-8  # of cost and energy for a step: the walk does not depend on the parameter
_DIFFERENCE = 1e-4  # of a parameter's step: about 1e-5 of its value
# Weights of the differences at offsets of so many steps: central, or to the side that is allowed.
_SCHEMES = (
    ((-1.0, 1.0), (-0.5, 0.5)),
    ((0.0, 1.0, 2.0), (-1.5, 2.0, -0.5)),
    ((0.0, -1.0, -2.0), (1.5, -2.0, 0.5)),
)


@dataclass(frozen=True)
class Sensitivity:
    """The answer to one parameter.

    Attributes:
        parameter, group, unit, value: see `drakegait.parameters.Parameter`.
        cost: df/dp [1/unit], f of eq. (13).
        energy: dE^t/dp [J/m/unit] along the optimum; nan where it is not known.
        step: a change worth thinking about [unit].
        cost_change, energy_change: answers to that step, to first order [-], [J/m].
    """

    parameter: str
    group: str
    unit: str
    value: float
    cost: float
    energy: float
    step: float
    cost_change: float
    energy_change: float


@dataclass(frozen=True)
class Sensitivities:
    """Derivatives of an optimum by the parameters of its study.

    Attributes:
        entries: one for each parameter that the walk depends on, by the size of the answer of f.
        cost: f of eq. (13) [-].
        energy: E^t [J/m] with the solver's rounded corners.
        stationarity: what is left of the KKT conditions, relative to the gradient of the cost:
            about the relative error of df/dp times how far the solution moves.
        exact: whether the optimum was known to `EXACT`. Then dE^t/dp is the derivative there, else
            an estimate in which bounds that may come and go count in part.
        title: who walks.
    """

    entries: tuple[Sensitivity, ...]
    cost: float
    energy: float
    stationarity: float
    exact: bool
    title: str

    def __getitem__(self, parameter: str) -> Sensitivity:
        """The entry of a parameter; raises KeyError."""
        for entry in self.entries:
            if entry.parameter == parameter:
                return entry
        raise KeyError(parameter)

    def table(self) -> pd.DataFrame:
        """One row per parameter with the fields of `Sensitivity`, the largest answers first."""
        import pandas as pd

        return pd.DataFrame([asdict(entry) for entry in self.entries]).set_index("parameter")

    def save_csv(self, path: str | Path) -> None:
        """Write the table; raises BadFile if it cannot be written."""
        try:
            with Path(path).open("w", encoding="utf-8", newline="") as file:
                writer = csv.writer(file)
                writer.writerow([field.name for field in fields(Sensitivity)])
                writer.writerows(asdict(entry).values() for entry in self.entries)
        except OSError as error:
            raise BadFile(path, f"cannot be written ({error.strerror or error}).") from None

    def plot(self, folder: str | Path, count: int = 15) -> list[Path]:
        """Draw tornado plots of the `count` largest answers of f and of E^t; returns the files."""
        from drakegait.report.tornado import plot_tornado

        return plot_tornado(self, folder, count)


def sensitivities(gait: Gait) -> Sensitivities:
    """Derivatives of the optimum `gait` by all parameters of its study.

    Where the multipliers are not lifted, second derivatives are not known and dE^t/dp is nan, as
    it is where the cost curves downwards.

    Raises:
        InvalidInput: the gait has no multipliers: it was not solved to an optimum, or by an
            earlier drakegait, or its unknowns were changed since.
    """
    optimum = _optimum(gait)
    program = optimum.program
    exact = optimum.stationarity < EXACT
    adjoint = None
    if program.formulation.lifted:
        system = KktSystem(optimum, None if exact else WIDE_BARRIER)
        adjoint = system.energy_adjoint()
    here = optimum.functions(program)
    entries = []
    for parameter in parameters(gait.study):
        change = _change(optimum, parameter)
        if change is None:
            continue
        energy = np.nan
        if adjoint is not None:
            energy = float(change.energy + adjoint @ system.right_hand_side(change))
        cost, step = optimum.cost_answer(change), parameter.step
        shares = np.array([cost / here.cost, np.nan_to_num(energy) / here.energy])
        if np.all(np.abs(shares * step) < _NOTHING):
            continue
        entries.append(
            Sensitivity(
                parameter.name, parameter.group, parameter.unit, parameter.value,
                cost, energy, step, cost * step, energy * step,
            )  # fmt: skip
        )
    entries.sort(key=lambda entry: -abs(entry.cost_change))
    return Sensitivities(
        tuple(entries), float(here.cost), float(here.energy), optimum.stationarity, exact,
        _title(gait),
    )  # fmt: skip


def _optimum(gait: Gait) -> Optimum:
    kkt = gait.kkt
    missing = "a gait solved by condensed, ipopt-mumps or ipopt; solve again with it as the guess"
    if kkt is None:
        raise InvalidInput("multipliers of the gait", None, missing)
    program = GaitProgram(gait.study.formulation(kkt.event_centres))
    sizes = len(kkt.x), len(kkt.rows)
    if sizes != (program.num_variables, program.num_constraints):
        raise InvalidInput("sizes of the gait's multipliers", sizes, missing)
    return Optimum(program, kkt)


def _change(optimum: Optimum, parameter: Parameter) -> Functions | None:
    """Derivatives of the program's functions; None where the parameter cannot change at all."""
    difference = _DIFFERENCE * parameter.step
    for offsets, weights in _SCHEMES:
        try:
            studies = [parameter.study(parameter.value + k * difference) for k in offsets]
            programs = [_program(optimum, study) for study in studies]
        except InvalidInput:
            continue
        parts = [optimum.functions(program) for program in programs]
        return Functions.combined(np.array(weights) / difference, parts)
    return None


def _program(optimum: Optimum, study: GaitStudy) -> GaitProgram:
    return GaitProgram(study.formulation(optimum.multipliers.event_centres))


def _title(gait: Gait) -> str:
    subject = gait.study.subject
    return (
        f"{gait.study.model} walker, {subject.height:g} m, {subject.mass:g} kg, "
        f"{gait.study.speed:g} m/s, {gait.study.nodes} nodes"
    )
