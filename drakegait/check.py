"""The finished gait judged at many instants, by a path of its own.

Nothing is asked of the program that found the gait: the splines are evaluated by
Drake's `BsplineTrajectory`, the equations of motion by its mass matrix, bias and gravity, the
contact forces by the pseudo-inverse of eq. (17) and the muscles by their exact laws. A gait passes
if nothing exceeds twice its tolerance between the control points.
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from drakegait.motion import MOST_INSTANTS
from drakegait.quantities import check_count
from drakegait.walker import feet

if TYPE_CHECKING:
    from rich.table import Table

    from drakegait.gait import Gait

FEWEST_INSTANTS = 100


@dataclass(frozen=True)
class CheckItem:
    """One quantity that was judged.

    Attributes:
        name: its key in `summary.json`.
        label: what it is.
        value: the worst found.
        unit: of value and limits.
        low, high: what passes; infinite where not limited.
        where: phase, percent of the stride and joint, foot or muscle of the worst; for what has no
            instant a remark, or nothing.
        phases: 0-based phases in which it fails somewhere.
    """

    name: str
    label: str
    value: float
    unit: str
    low: float = -math.inf
    high: float = math.inf
    where: str = ""
    phases: tuple[int, ...] = ()

    @property
    def judged(self) -> bool:
        """Whether there is a limit; else it is only reported."""
        return math.isfinite(self.low) or math.isfinite(self.high)

    @property
    def passed(self) -> bool:
        """Whether the value is within its limits; a nan is not."""
        return self.low <= self.value <= self.high or (not self.judged)

    @property
    def limit(self) -> str:
        """The limits in words."""
        if math.isfinite(self.low):
            return f">= {self.low:.4g}"
        return f"<= {self.high:.4g}" if math.isfinite(self.high) else ""


@dataclass(frozen=True)
class CheckReport:
    """What `check` found.

    Attributes:
        instants: how many were judged.
        items: each quantity with its limit and where it is worst.

    Every item's value is also an attribute of its name.
    """

    instants: int
    items: tuple[CheckItem, ...]

    def item(self, name: str) -> CheckItem:
        """The item called `name`; raises KeyError if it was not judged."""
        for item in self.items:
            if item.name == name:
                return item
        raise KeyError(name)

    def _value(self, name: str) -> float:
        return self.item(name).value

    @property
    def passed(self) -> bool:
        """Whether every item is within its limits."""
        return all(item.passed for item in self.items)

    @property
    def equations_of_motion_max_N(self) -> float:  # noqa: N802 - the unit
        """Largest residual of a translation [N]."""
        return self._value("equations_of_motion_max_N")

    @property
    def equations_of_motion_max_Nm(self) -> float:  # noqa: N802
        """Largest residual of a rotation [N m]."""
        return self._value("equations_of_motion_max_Nm")

    @property
    def foot_contact_max_mm(self) -> float:
        """Largest distance of a standing heel or toe from its footprint [mm]."""
        return self._value("foot_contact_max_mm")

    @property
    def penetration_max_mm(self) -> float:
        """Largest depth of heel or toe in the ground [mm]; < 0 if none enters it."""
        return self._value("penetration_max_mm")

    @property
    def excitation_min(self) -> float:
        """Smallest excitation."""
        return self._value("excitation_min")

    @property
    def excitation_max(self) -> float:
        """Largest excitation."""
        return self._value("excitation_max")

    @property
    def friction_ratio_max(self) -> float:
        """Largest horizontal force of a foot relative to what the ground can hold."""
        return self._value("friction_ratio_max")

    @property
    def free_moment_excess_Nm(self) -> float:  # noqa: N802
        """Largest pivot moment beyond what the ground can hold [N m]; not above 0 if planar."""
        return self._value("free_moment_excess_Nm")

    @property
    def normal_force_min_N(self) -> float:  # noqa: N802
        """Smallest vertical force of a standing heel or toe [N]."""
        return self._value("normal_force_min_N")

    @property
    def energy_balance_relative_error(self) -> float:
        """Work of all forces minus change of energy, relative to the work of the muscles.

        The residual is among the forces: see `residual_work_J` for what it gave the walker.
        """
        return self._value("energy_balance_relative_error")

    @property
    def residual_work_J(self) -> float:  # noqa: N802
        """Net work over the stride of the residual, which no muscle does [J]."""
        return self._value("residual_work_J")

    @property
    def contact_work_J(self) -> float:  # noqa: N802
        """Net work over the stride of the ground on feet that move within the tolerance [J]."""
        return self._value("contact_work_J")

    @property
    def speed_error(self) -> float:
        """Average velocity minus that of the study [m/s], absolute."""
        return self._value("speed_error")

    @property
    def periodicity_error(self) -> float:
        """Largest jump of coordinates and velocities from stride to stride [m, rad, per s]."""
        return self._value("periodicity_error")

    @property
    def metabolic_cost_of_transport(self) -> float:
        """E^t of eq. (8) by the exact laws [J/m]."""
        return self._value("metabolic_cost_of_transport")

    @property
    def deviation(self) -> float:
        """J_dev of eq. (11) [s]."""
        return self._value("deviation")

    def worst_phases(self) -> set[int]:
        """0-based phases in which something fails: where control points are missing."""
        return {phase for item in self.items for phase in item.phases}

    def rows(self) -> list[tuple[str, str, str, str, str]]:
        """Quantity, worst value, limit, verdict and place of each item, as text."""
        words = {True: "ok", False: "FAILS"}
        return [
            (
                item.label,
                f"{item.value:.4g} {item.unit}".rstrip(),
                item.limit,
                words[item.passed] if item.judged else "",
                item.where,
            )
            for item in self.items
        ]

    def table(self) -> Table:
        """The rows as a table that `rich` prints."""
        from rich.table import Table

        verdict = "passed" if self.passed else "NOT passed"
        table = Table(title=f"check at {self.instants} instants: {verdict}")
        for heading in ("quantity", "worst", "allowed", "", "where"):
            table.add_column(heading, justify="right" if heading == "worst" else "left")
        for row in self.rows():
            style = "bold red" if row[3] == "FAILS" else None
            table.add_row(*row, style=style)
        return table

    def to_dict(self) -> dict[str, Any]:
        """As plain types that JSON can hold."""
        return dataclasses.asdict(self)

    @classmethod
    def from_dict(cls, plain: Mapping[str, Any]) -> CheckReport:
        """Inverse of `to_dict`."""
        items = (
            CheckItem(**{**item, "phases": tuple(item["phases"])}) for item in plain["items"]
        )
        return cls(int(plain["instants"]), tuple(items))


def check(gait: Gait, instants: int = 1000) -> CheckReport:
    """Judge `gait` at `instants` uniform instants and on both sides of each event.

    Args:
        gait: converged or not.
        instants: 100 to 100 001.

    Raises:
        InvalidInput: too few or too many instants.
    """
    from drakegait.judgement import judge

    check_count("instants", instants, FEWEST_INSTANTS, MOST_INSTANTS)
    return CheckReport(instants + 2 * feet.NUM_PHASES, judge(gait, instants))
