"""What a sweep has brought: gaits by name, failures with their reason, one table, one picture."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

from drakegait.errors import BadFile, UnknownName
from drakegait.gait import Gait
from drakegait.study import GaitStudy
from drakegait.sweep import axes as sweep_axes
from drakegait.sweep.store import State, Store

if TYPE_CHECKING:
    import pandas as pd
    import xarray as xr


@dataclass(frozen=True, eq=False)
class SweepResult:
    """The results in the folder of a sweep, read when asked for.

    Attributes:
        folder: where they are.
        studies: by name.
        axes: name of a study -> its place in the grid, {axis: value}.
        states: name of a study -> done, or failed with a reason.
        notes: sentences about what was found, skipped or failed.
    """

    folder: Path
    studies: Mapping[str, GaitStudy]
    axes: Mapping[str, Mapping[str, Any]]
    states: Mapping[str, State]
    notes: tuple[str, ...] = ()

    @property
    def failures(self) -> dict[str, str]:
        """Why studies failed, by name."""
        return {name: state.reason for name, state in self.states.items()
                if state.status == "failed"}  # fmt: skip

    def gait(self, name: str) -> Gait:
        """The gait of a study; of one that did not converge, the nearest one found.

        Raises:
            UnknownName: no such study.
            BadFile: it failed without a gait.
        """
        if name not in self.studies:
            raise UnknownName("study", name, self.studies)
        path = Store(self.folder).path(name)
        if name in self.failures and not path.exists():
            raise BadFile(path, f"is missing, for the study failed: {self.failures[name]}")
        return Gait.load(path)

    def summary(self, name: str) -> dict[str, Any]:
        """Content of a study's `summary.json`; empty if it failed without a gait."""
        return self._summaries[name]

    @cached_property
    def _summaries(self) -> dict[str, dict[str, Any]]:
        store = Store(self.folder)
        return {name: store.summary(name) for name in self.studies}

    def table(self) -> pd.DataFrame:
        """One row for each study: its place in the grid, status, energy, deviation, ...

        Columns in `drakegait.sweep.table`; units are in their names.
        """
        from drakegait.sweep.table import data_frame

        return data_frame(self)

    def dataset(self) -> xr.Dataset:
        """The same over the axes of the grid, labelled, with units."""
        from drakegait.sweep.table import dataset

        return dataset(self)

    def save(self, folder: str | Path | None = None) -> list[Path]:
        """Write `sweep.csv` and `sweep.nc`, by default beside the studies; raises BadFile."""
        from drakegait.sweep.table import save

        return save(self, self.folder if folder is None else Path(folder))

    def plot(self, folder: str | Path | None = None) -> list[Path]:
        """Draw energy and deviation over the grid: `sweep.svg` and `sweep.png`; raises BadFile."""
        from drakegait.sweep.picture import draw

        return draw(self, self.folder if folder is None else Path(folder))


def places(
    axes: Mapping[str, Mapping[str, Any]] | None, studies: Mapping[str, GaitStudy]
) -> sweep_axes.Places:
    """The axes as given, or what differs; raises InvalidInput, UnknownName."""
    return sweep_axes.differences(studies) if axes is None else sweep_axes.checked(axes, studies)
