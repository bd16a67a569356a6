"""Gaits beside each other: one page that a clinician reads, and the same numbers as tables.

    from drakegait import compare

    report = compare(normal, heavy, labels=["no weight", "2 kg on the right foot"])
    report.save("heavy_foot.html")  # one file, opens without a network
    report.save_csv("heavy_foot")
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING

from drakegait.check import check
from drakegait.errors import BadFile, InvalidInput
from drakegait.gait import Gait
from drakegait.report import study_words as words
from drakegait.report.comparison_curves import muscle_groups
from drakegait.report.comparison_style import GAIT_COLOURS
from drakegait.report.comparison_tables import (
    GaitNumbers,
    Row,
    cost_frame,
    curve_frame,
    data_frame,
    rows,
)
from drakegait.report.curves import GaitCurves
from drakegait.whole_file import new_folder, write_text

if TYPE_CHECKING:
    import pandas as pd

MOST_GAITS = len(GAIT_COLOURS)
LONGEST_LABEL = 60
_INSTANTS = 1001  # those of the energy, both ends of the stride counted
_TOPICS = {
    "steps": lambda item: item.steps,
    "cost": lambda item: item.cost,
    "cost_by_phase": lambda item: item.cost_by_part,
    "symmetry": lambda item: item.symmetry,
    "ground": lambda item: item.ground,
    "work": lambda item: item.work,
    "peaks": lambda item: item.peaks,
}


@dataclass(frozen=True, eq=False)
class Comparison:
    """Gaits beside each other; the first is what the others are compared with.

    Attributes:
        gaits: one to six.
        labels: a name for each.
        reference: whether the reference walk is drawn behind the curves.
    """

    gaits: tuple[Gait, ...]
    labels: tuple[str, ...]
    reference: bool = True

    @cached_property
    def numbers(self) -> tuple[GaitNumbers, ...]:
        """What is read from each gait; one without a check is checked now."""
        return tuple(
            GaitNumbers(GaitCurves(gait, label, _INSTANTS), gait.report or check(gait))
            for gait, label in zip(self.gaits, self.labels, strict=True)
        )

    @property
    def trusted(self) -> bool:
        """Whether every gait has converged and passed its check."""
        return all(item.curves.gait.converged and item.report.passed for item in self.numbers)

    @cached_property
    def rows(self) -> dict[str, list[Row]]:
        """The numbers by topic, a row for each quantity and side."""
        found = {
            topic: rows([read(item) for item in self.numbers]) for topic, read in _TOPICS.items()
        }
        groups = muscle_groups([item.curves for item in self.numbers])
        found["cost_by_muscle"] = rows([item.cost_by_muscle(groups) for item in self.numbers])
        return found

    def tables(self) -> dict[str, pd.DataFrame]:
        """All numbers, by name of the table.

        `steps`, `cost`, `cost_by_muscle`, `cost_by_phase`, `symmetry`, `ground`, `work`, `peaks`:
        quantity, side, unit, a column for each gait, then for each later one its change and the
        change in per cent. `cost_detail`: muscle, side and contact phase of the leg's own cycle.
        `curves`: quantity, side, percent (0 to 100 of the leg's own cycle), gaits, edges of the
        reference band. `check`: each item of the check. `walkers`: who walks and how it ended.
        """
        import pandas as pd

        labels = list(self.labels)
        found = {topic: data_frame(table, labels) for topic, table in self.rows.items()}
        found["cost_detail"] = cost_frame(self.numbers, labels)
        found["curves"] = curve_frame([item.curves for item in self.numbers], labels)
        found["check"] = pd.DataFrame([
            {"gait": item.curves.label, "quantity": entry.label, "value": entry.value,
             "unit": entry.unit, "allowed": entry.limit, "passed": entry.passed,
             "where": entry.where}
            for item in self.numbers
            for entry in item.report.items
        ])  # fmt: skip
        first = self.gaits[0].study
        found["walkers"] = pd.DataFrame([
            {"gait": item.curves.label, "walker": words.who(item.curves.gait.study),
             "differs in": "; ".join(words.differences(first, item.curves.gait.study)),
             "nodes": item.curves.gait.study.nodes, "solver": item.curves.gait.outcome.solver,
             "status": item.curves.gait.outcome.status, "check passed": item.report.passed}
            for item in self.numbers
        ])  # fmt: skip
        return found

    def html(self) -> str:
        """The page."""
        from drakegait.report.comparison_page import render

        return render(self)

    def save(self, path: str | Path) -> Path:
        """Write the page: one file that opens in any browser, also without a network, and prints.

        Raises:
            BadFile: it cannot be written.
        """
        path = Path(path)
        if path.is_dir() or not path.parent.is_dir():
            raise BadFile(path, "is a folder." if path.is_dir() else "its folder does not exist.")
        write_text(path, self.html())
        return path

    def save_csv(self, folder: str | Path) -> list[Path]:
        """Write each of `tables` as a CSV file into a folder, made if it is not there.

        Raises:
            BadFile: the folder cannot be made or written.
        """
        folder, paths = new_folder(folder), []
        for name, table in self.tables().items():
            paths.append(folder / f"{name}.csv")
            write_text(paths[-1], table.to_csv(index=False, float_format="%.6g"))
        return paths


def compare(
    *gaits: Gait, labels: Sequence[str] | None = None, reference: bool = True
) -> Comparison:
    """Put gaits beside each other.

    Args:
        gaits: one (a report of it) to six; the first is what the others are compared with. All
            spatial or all planar. A gait that has not converged or fails its check is shown and
            marked.
        labels: a name for each; default what makes them differ.
        reference: whether to draw the reference walk of the first gait behind the curves.

    Raises:
        InvalidInput: too few or too many gaits, spatial with planar ones, labels that do not fit.
    """
    if not 1 <= len(gaits) <= MOST_GAITS:
        raise InvalidInput("number of gaits", len(gaits), f"1 to {MOST_GAITS}")
    for gait in gaits:
        if not isinstance(gait, Gait):
            raise InvalidInput("gait", gait, "a Gait, as `solve` and `Gait.load` return it")
    kinds = {gait.study.skeleton_kind for gait in gaits}
    if len(kinds) > 1:
        allowed = (
            "all spatial or all planar: a planar walker has other muscles and no sideways motion, "
            "so that neither cost nor curves compare"
        )
        raise InvalidInput("walkers", tuple(gait.study.skeleton_kind for gait in gaits), allowed)
    given = default_labels(gaits) if labels is None else tuple(str(label) for label in labels)
    if len(given) != len(gaits):
        raise InvalidInput("labels", given, f"{len(gaits)} names, one for each gait")
    if len({label.strip() for label in given}) < len(given):
        raise InvalidInput("labels", given, "different from each other")
    for label in given:
        if not 1 <= len(label.strip()) <= LONGEST_LABEL:
            raise InvalidInput("label", label, f"1 to {LONGEST_LABEL} characters")
    return Comparison(tuple(gaits), tuple(label.strip() for label in given), reference)


def default_labels(gaits: Sequence[Gait]) -> tuple[str, ...]:
    """Names by what makes the later gaits differ from the first."""
    first = gaits[0].study
    found = [", ".join(words.peculiar(first)) or "baseline"]
    found += [", ".join(words.differences(first, gait.study)) for gait in gaits[1:]]
    named = []
    for number, label in enumerate(found):
        # In a name the first words of a difference do.
        short = words.brief(label)
        if not 1 <= len(short) <= LONGEST_LABEL - 4:
            short = f"gait {number + 1}"
        named.append(short if short not in named else f"{short} ({number + 1})")
    return tuple(named)
