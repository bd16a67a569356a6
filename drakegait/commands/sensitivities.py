"""`drakegait sensitivities`: compute, print the largest, save all."""

from __future__ import annotations

import math

from rich.console import Console
from rich.table import Table

from drakegait.commands.gait_files import (
    FIGURES_FOLDER,
    SENSITIVITIES_FILE,
    gait_path,
    load_gait,
    output_folder,
)
from drakegait.commands.screen import console
from drakegait.errors import InvalidInput
from drakegait.exact import solve_exactly
from drakegait.gait import Gait
from drakegait.sensitivities import Sensitivities
from drakegait.whole_file import new_folder


def print_sensitivities(name: str, folder: str | None, count: int, exact: bool = False) -> None:
    """Print the `count` largest answers and write table and picture; at the optimum if `exact`."""
    if not 1 <= count <= 60:
        raise InvalidInput("--count", count, "from 1 to 60")
    default = str(gait_path(name).parent / FIGURES_FOLDER)
    target = output_folder("--out", default if folder is None else folder)
    gait = load_gait(name)
    new_folder(target)
    screen = console()
    if exact:
        gait = _solved_on(gait, screen)
    with screen.status("differentiating ..."):
        answers = gait.sensitivities()
    screen.print(
        f"f = {answers.cost:.4g}, cost of transport {answers.energy:.1f} J/m; what is left of the "
        f"optimality conditions: {answers.stationarity:.1g} of the gradient"
        + ("." if answers.exact else "; dE/dp are estimates (docs/sensitivities.md)."),
        markup=False, soft_wrap=True,
    )  # fmt: skip
    screen.print(_table(answers, count))
    answers.save_csv(target / SENSITIVITIES_FILE)
    answers.plot(target, count)
    screen.print(
        f"Files in {target}: {SENSITIVITIES_FILE}, sensitivities.svg, sensitivities.png.",
        markup=False, soft_wrap=True,
    )  # fmt: skip


def _solved_on(gait: Gait, screen: Console) -> Gait:
    """The exact optimum, or the gait as it was where none is found."""
    with screen.status("solving on to the very optimum ..."):
        found = solve_exactly(gait)
    outcome = found.outcome
    if outcome.status == "interrupted":
        raise KeyboardInterrupt
    if outcome.status != "converged":
        screen.print(
            f"The optimum itself was not found; answers are those of the gait. {outcome.message}",
            markup=False, soft_wrap=True,
        )  # fmt: skip
        return gait
    screen.print(
        f"Solved on to the optimum in {outcome.iterations} iterations: f {gait.cost['total']:.5g}, "
        f"now {found.cost['total']:.5g}.",
        markup=False, soft_wrap=True,
    )  # fmt: skip
    return found


def _table(answers: Sensitivities, count: int) -> Table:
    table = Table(title="Answers to a step of each parameter, to first order", box=None)
    table.add_column("parameter")
    for heading in ("value", "step", "unit", "f [%]", "E [J/m]", "df/dp", "dE/dp"):
        table.add_column(heading, justify="left" if heading == "unit" else "right")
    for entry in answers.entries[:count]:
        unknown = math.isnan(entry.energy)
        table.add_row(
            entry.parameter, f"{entry.value:.4g}", f"{entry.step:.2g}", entry.unit,
            f"{100.0 * entry.cost_change / answers.cost:+.2f}",
            "" if unknown else f"{entry.energy_change:+.2f}",
            f"{entry.cost:+.4g}",
            "" if unknown else f"{entry.energy:+.4g}",
        )  # fmt: skip
    return table
