"""The numbers of a comparison as tables: one column for each gait, and the changes to the first."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from drakegait.report.comparison_curves import at_percent, quantities
from drakegait.report.cost_split import OWN_PHASES, PARTS, CostSplit
from drakegait.report.curves import SIDES, GaitCurves
from drakegait.report.measures import Measure, both_sides
from drakegait.report.powers import ground_impulses, joint_work, peaks
from drakegait.report.spatiotemporal import spatiotemporal
from drakegait.report.symmetry import UNIT, symmetry

if TYPE_CHECKING:
    import pandas as pd

    from drakegait.check import CheckReport

# A change in per cent says nothing about what has no natural zero or is a share already.
_NO_SHARES = ("°", UNIT, "% of cycle")


@dataclass(frozen=True)
class Row:
    """A quantity of all gaits.

    Attributes:
        name, label, unit, side, digits: as in `Measure`.
        values: one for each gait; nan where it has none.
    """

    name: str
    label: str
    unit: str
    side: str
    digits: int
    values: tuple[float, ...]

    @property
    def changes(self) -> tuple[float, ...]:
        """Later gaits minus the first, in the row's unit."""
        return tuple(value - self.values[0] for value in self.values[1:])

    @property
    def shares(self) -> tuple[float, ...]:
        """The changes in per cent of the first gait's amount; nan where that says nothing."""
        base = abs(self.values[0])
        if self.unit in _NO_SHARES or not base >= 0.5 * 10.0**-self.digits:
            return tuple(math.nan for _ in self.changes)
        return tuple(100.0 * change / base for change in self.changes)


@dataclass(frozen=True, eq=False)
class GaitNumbers:
    """Everything that is read from one gait.

    Attributes:
        curves: of the gait, with the instants of its energy (1001).
        report: its check.
    """

    curves: GaitCurves
    report: CheckReport

    @cached_property
    def split(self) -> CostSplit:
        """Cost of transport in parts."""
        return CostSplit.of(self.curves.gait)

    @cached_property
    def steps(self) -> tuple[Measure, ...]:
        """Speed, steps and times."""
        return spatiotemporal(self.curves)

    @cached_property
    def cost(self) -> tuple[Measure, ...]:
        """Cost of transport as a whole and of each leg, and the deviation."""
        split, mass = self.split, self.curves.mass
        right, left = split.by_side
        found = [
            Measure("cost_of_transport", "Cost of transport", "J/m", split.total, digits=1),
            Measure("cost_per_mass", "Cost of transport per body mass", "J/(kg m)",
                    split.total / mass),
            *both_sides("leg_cost", "Muscles of the leg", "J/m", right, left, 1),
            Measure("deviation", "Deviation from the reference", "s", self.report.deviation),
        ]  # fmt: skip
        if split.basal:
            found.append(
                Measure("basal_cost", "Body besides the muscles", "J/m", split.basal, digits=1)
            )
        return tuple(found)

    @cached_property
    def cost_by_part(self) -> tuple[Measure, ...]:
        """Cost in each part of each leg's own cycle."""
        return tuple(
            measure
            for number, (part, values) in enumerate(zip(PARTS, self.split.by_part, strict=True))
            for measure in both_sides(f"part_{number + 1}", part, "J/m", *values, 1)
        )

    def cost_by_muscle(self, groups: Sequence[str]) -> tuple[Measure, ...]:
        """Cost of each muscle group of each leg; a muscle that is not there takes none."""
        return tuple(
            measure
            for group in groups
            for measure in both_sides(
                group, group.replace("_", " ").capitalize(), "J/m",
                *(np.nan_to_num(self.split.of_group(group, side)) for side in SIDES), 1,
            )
        )  # fmt: skip

    @cached_property
    def ground(self) -> tuple[Measure, ...]:
        """Impulses and peaks of the ground reactions."""
        return ground_impulses(self.curves)

    @cached_property
    def work(self) -> tuple[Measure, ...]:
        """Work of the joints."""
        return joint_work(self.curves)

    @cached_property
    def peaks(self) -> tuple[Measure, ...]:
        """Extremes of angles, moments and powers."""
        return peaks(self.curves)

    @cached_property
    def symmetry(self) -> tuple[Measure, ...]:
        """Symmetry indices."""
        return symmetry(self.curves, (*self.steps, *self.ground, *self.work), self.split)


def rows(measured: Sequence[Sequence[Measure]]) -> list[Row]:
    """Measures of all gaits side by side; in the order of the first that has them."""
    known: dict[tuple[str, str], Measure] = {}
    for measures in measured:
        for measure in measures:
            known.setdefault(measure.key, measure)
    columns = [{measure.key: measure.value for measure in measures} for measures in measured]
    return [
        Row(
            first.name, first.label, first.unit, first.side, first.digits,
            tuple(float(column.get(key, math.nan)) for column in columns),
        )
        for key, first in known.items()
    ]  # fmt: skip


def data_frame(table: Sequence[Row], labels: Sequence[str]) -> pd.DataFrame:
    """Rows as a table: quantity, side, unit, a column for each gait, its change and in per cent."""
    import pandas as pd

    columns: dict[str, list] = {
        "quantity": [row.label for row in table],
        "side": [row.side for row in table],
        "unit": [row.unit for row in table],
    }
    for number, label in enumerate(labels):
        columns[label] = [row.values[number] for row in table]
    for number, label in enumerate(labels[1:]):
        columns[f"change: {label}"] = [row.changes[number] for row in table]
        columns[f"change in %: {label}"] = [row.shares[number] for row in table]
    return pd.DataFrame(columns)


def curve_frame(all_curves: Sequence[GaitCurves], labels: Sequence[str]) -> pd.DataFrame:
    """All curves at 0, 1, ..., 100 % of each leg's own cycle, with the edges of the band."""
    import pandas as pd

    frames = []
    for item in quantities(all_curves):
        for side in SIDES if item.sided else ("",):
            which = side or "right"
            band = item.band(all_curves[0], which)
            columns = {"quantity": item.name, "side": side, "unit": item.unit or "1",
                       "percent": np.arange(101)}  # fmt: skip
            for curves, label in zip(all_curves, labels, strict=True):
                columns[label] = at_percent(item, curves, which)
            line = item.line(all_curves[0], which)
            columns["reference, inverse dynamics"] = np.nan if line is None else line[1]
            columns["band low"] = np.nan if band is None else band[1]
            columns["band high"] = np.nan if band is None else band[2]
            frames.append(pd.DataFrame(columns))
    return pd.concat(frames, ignore_index=True)


def cost_frame(numbers: Sequence[GaitNumbers], labels: Sequence[str]) -> pd.DataFrame:
    """Cost of each muscle group of each leg in each contact phase of the leg's own cycle [J/m]."""
    import pandas as pd

    groups = tuple(dict.fromkeys(group for item in numbers for group in item.split.groups))
    found = []
    for group in groups:
        for number, side in enumerate(SIDES):
            for phase, name in enumerate(OWN_PHASES):
                row = {"muscle": group, "side": side, "phase": phase + 1, "phase_name": name}
                for item, label in zip(numbers, labels, strict=True):
                    split, there = item.split, f"{group}_{side[0]}" in item.split.muscles
                    row[label] = (
                        split.values[split.groups.index(group), number, phase]
                        if there else math.nan
                    )  # fmt: skip
                found.append(row)
    return pd.DataFrame(found)
