"""What was measured in a chapter, as plain numbers: all that claims are judged by."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any

from drakegait.errors import DrakegaitError
from drakegait.gait import Gait


class Missing(DrakegaitError):
    """A gait or a number that is not there, because it was not solved or did not converge."""


@dataclass(frozen=True)
class Numbers:
    """The numbers of one chapter.

    Attributes:
        rows: name of a study -> column -> value, the columns of `drakegait.sweep.table`. A study
            that did not converge has its iterations and times, and no energy.
        found: measured on the gaits, by name.
    """

    rows: Mapping[str, Mapping[str, Any]] = field(default_factory=dict)
    found: Mapping[str, float] = field(default_factory=dict)

    def __getitem__(self, name: str) -> float:
        """A measured number; raises Missing."""
        if name not in self.found:
            raise Missing(f"{name} has not been measured.")
        return self.found[name]

    def of(self, study: str, column: str) -> Any:
        """A number of a study; raises Missing where it is not known."""
        value = self.rows.get(study, {}).get(column)
        if value is None:
            raise Missing(f"{column} of {study!r} is not known.")
        return value

    def energy(self, study: str) -> float:
        """E^t [J/m]."""
        return self.of(study, "cost_of_transport_J_per_m")

    def deviation(self, study: str) -> float:
        """J_dev [s]."""
        return self.of(study, "deviation_s")

    def cost(self, study: str) -> float:
        """f of eq. (13)."""
        return self.of(study, "cost")

    def solved(self, study: str) -> bool:
        """Whether a study has converged; False also where it was not run."""
        return self.rows.get(study, {}).get("status") == "done"


class Gaits(Mapping[str, Gait]):
    """Converged gaits by the name of their study; raises Missing for others."""

    def __init__(self, gaits: Mapping[str, Gait]):
        self._gaits = dict(gaits)

    def __getitem__(self, name: str) -> Gait:
        if name not in self._gaits:
            raise Missing(f"There is no gait of {name!r}.")
        return self._gaits[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._gaits)

    def __len__(self) -> int:
        return len(self._gaits)
