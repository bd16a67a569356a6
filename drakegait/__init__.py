"""Muscle-driven human walking in three dimensions, found by parameter optimisation on Drake.

    from drakegait import GaitStudy, check, plot, replay, solve

    gait = solve(GaitStudy.spatial(nodes=18))
    print(gait.outcome.status, gait.metabolic.cost_of_transport)  # [J/m]
    plot(gait, "figures")
    replay(gait, html="replay.html")

The names are loaded when first asked for, so that `import drakegait` costs nothing.
"""

from __future__ import annotations

import importlib
import sys
import types
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from drakegait.check import check
    from drakegait.gait import Gait
    from drakegait.infeasibility.explain import explain
    from drakegait.reference.reference import Reference
    from drakegait.replay import replay
    from drakegait.report.compare import compare
    from drakegait.report.figures import plot
    from drakegait.solve import solve
    from drakegait.solvers.options import SolverOptions
    from drakegait.study import GaitStudy
    from drakegait.sweep.run import sweep
    from drakegait.walker.subject import AddedMass, Subject

__all__ = [
    "AddedMass",
    "Gait",
    "GaitStudy",
    "Reference",
    "SolverOptions",
    "Subject",
    "check",
    "compare",
    "explain",
    "plot",
    "replay",
    "solve",
    "sweep",
]

_HOMES = {
    "AddedMass": "drakegait.walker.subject",
    "Gait": "drakegait.gait",
    "GaitStudy": "drakegait.study",
    "Reference": "drakegait.reference.reference",
    "SolverOptions": "drakegait.solvers.options",
    "Subject": "drakegait.walker.subject",
    "check": "drakegait.check",
    "compare": "drakegait.report.compare",
    "explain": "drakegait.infeasibility.explain",
    "plot": "drakegait.report.figures",
    "replay": "drakegait.replay",
    "solve": "drakegait.solve",
    "sweep": "drakegait.sweep",
}


def _version() -> str:
    from importlib import metadata

    try:
        return metadata.version("drakegait")
    except metadata.PackageNotFoundError:  # run from a checkout that is not installed
        return "unknown"


class _Package(types.ModuleType):
    """Loads public names late, and keeps `solve` the function when its file is imported.

    Python binds an imported file to its name in the package; for `check`, `replay`, `solve` and
    `sweep` that would hide the function of the same name, depending on who imported what before.
    """

    def __setattr__(self, name: str, value: Any) -> None:
        if name in _HOMES and isinstance(value, types.ModuleType):
            return
        super().__setattr__(name, value)

    def __getattr__(self, name: str) -> Any:
        if name == "__version__":
            value = _version()
        elif name in _HOMES:
            value = getattr(importlib.import_module(_HOMES[name]), name)
        else:
            raise AttributeError(f"module {self.__name__!r} has no attribute {name!r}")
        setattr(self, name, value)
        return value

    def __dir__(self) -> list[str]:
        return sorted({*super().__dir__(), *__all__, "__version__"})


sys.modules[__name__].__class__ = _Package
