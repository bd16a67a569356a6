"""The numbers of all chapters, which a JSON file can hold, and the gaits they were measured on."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from drakegait.errors import BadFile
from drakegait.gait import Gait
from drakegait.paper.chapter import Chapter
from drakegait.paper.claim import Finding
from drakegait.paper.numbers import Numbers
from drakegait.sweep.result import SweepResult
from drakegait.whole_file import write_bytes

FORMAT = "drakegait paper results"
_COLUMNS = (
    "status", "solver_status", "check_passed", "cost", "cost_of_transport_J_per_m", "deviation_s",
    "speed_m_per_s", "stride_time_s", "iterations", "wall_time_s", "control_points", "reason",
)  # fmt: skip
_DIGITS = 7


@dataclass(frozen=True, eq=False)
class Results:
    """What a run has brought.

    Attributes:
        numbers: of each chapter, by its name.
        gaits: converged gaits by study; empty if the numbers come from a file.
        made: versions and machine of the run.
    """

    numbers: Mapping[str, Numbers]
    gaits: Mapping[str, Gait] = field(default_factory=dict)
    made: Mapping[str, Any] = field(default_factory=dict)

    @classmethod
    def measure(
        cls, chapters: Sequence[Chapter], rows: Mapping[str, Mapping[str, Any]],
        gaits: Mapping[str, Gait],
    ) -> Results:  # fmt: skip
        """Numbers of each chapter from its studies and gaits."""
        numbers = {}
        for chapter in chapters:
            own = {name: rows[name] for name in chapter.all_names if name in rows}
            numbers[chapter.name] = Numbers(own, chapter.measure(gaits))
        return cls(numbers, gaits, _made())

    def findings(self, chapter: Chapter) -> list[Finding]:
        """A chapter's claims, judged; by nothing if it was not run."""
        return chapter.findings(self.numbers.get(chapter.name, Numbers()))

    def save(self, path: Path, format: str = FORMAT) -> None:
        """Write the numbers, and nothing else, as JSON; raises BadFile.

        Args:
            format: what the file says it is.
        """
        chapters = {
            name: {"rows": _rounded(item.rows), "found": _rounded(item.found)}
            for name, item in self.numbers.items()
        }
        content = {"format": format, "made": dict(self.made), "chapters": chapters}
        write_bytes(path, (json.dumps(content, indent=1, allow_nan=False) + "\n").encode())

    @classmethod
    def load(cls, path: Path, format: str = FORMAT) -> Results:
        """What `save` has written with this format; raises BadFile for any other file."""
        try:
            content = json.loads(path.read_text(encoding="utf-8"))
            if content["format"] != format:
                raise KeyError(format)
            numbers = {name: Numbers(item["rows"], item["found"])
                       for name, item in content["chapters"].items()}  # fmt: skip
        except (OSError, ValueError, KeyError, TypeError) as error:
            raise BadFile(path, f"holds no {format} ({error}).") from None
        return cls(numbers, {}, content.get("made", {}))


def number_rows(result: SweepResult) -> dict[str, dict[str, Any]]:
    """The columns of a sweep's table that chapters use, by study, and as `not_held` the law that
    the last gait of one that failed holds least; None where all hold, or there is no gait."""
    from drakegait.sweep.table import rows

    found = {row["study"]: {name: row[name] for name in _COLUMNS} for row in rows(result)}
    for name, row in found.items():
        row["not_held"] = _not_held(result, name)
    return found


def _not_held(result: SweepResult, name: str) -> str | None:
    if name not in result.failures:
        return None
    try:
        worst = result.gait(name).outcome.worst
    except BadFile:
        return None
    return worst[0] if worst else None


def _rounded(value: Any) -> Any:
    if isinstance(value, Mapping):
        return {name: _rounded(item) for name, item in value.items()}
    if isinstance(value, float):
        return float(f"{value:.{_DIGITS}g}") if math.isfinite(value) else None
    return value


def _made() -> dict[str, Any]:
    import datetime
    import os
    import platform

    from drakegait.summary import versions

    return {
        "date": datetime.date.today().isoformat(),
        "cores": os.cpu_count(),
        "system": f"{platform.system()} {platform.machine()}",
        "versions": versions(),
    }
