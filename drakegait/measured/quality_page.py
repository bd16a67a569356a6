"""`subject_quality.html`: what an import did, on one page that opens without network."""

from __future__ import annotations

import io
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from drakegait.errors import BadFile
from drakegait.measured.quality import spoken
from drakegait.quantities import GRAVITY
from drakegait.walker.coordinates import SPATIAL, to_anatomical
from drakegait.walker.feet import NUM_PHASES
from drakegait.whole_file import write_text

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from drakegait.measured.imported import ImportedWalk

_MEASURED, _RIGHT, _LEFT, _BODY = "#b9b9b9", "#1b62a5", "#c0311f", "#333333"
_PANELS = (
    ("hat_tilt",), ("hat_list",), ("hat_rotation",), ("hat_z",),
    ("hip_flexion_r", "hip_flexion_l"), ("hip_adduction_r", "hip_adduction_l"),
    ("hip_rotation_r", "hip_rotation_l"), ("hat_y",),
    ("knee_flexion_r", "knee_flexion_l"), ("ankle_dorsiflexion_r", "ankle_dorsiflexion_l"),
)  # fmt: skip
_TITLES = {
    "hat_tilt": "Trunk tilt [°], + forward",
    "hat_list": "Trunk list [°], + to the right",
    "hat_rotation": "Trunk rotation [°], + to the left",
    "hat_z": "Height of the hips [cm]",
    "hat_y": "Hips sideways [cm], + left",
    "hip_flexion_r": "Hip flexion [°], − extension",
    "hip_adduction_r": "Hip adduction [°], − abduction",
    "hip_rotation_r": "Hip rotation [°], + internal",
    "knee_flexion_r": "Knee flexion [°], − extension",
    "ankle_dorsiflexion_r": "Ankle dorsiflexion [°], − plantar",
}
_FORCE_TITLES = (
    "Fore-aft [body weights], + forward", "Sideways [body weights], + to the left",
    "Vertical [body weights]",
)  # fmt: skip
_CYCLE = "% of the stride from right heel strike"


def write_page(walk: ImportedWalk, path: str | Path) -> None:
    """Write the page, beside its place first and renamed when complete.

    Raises:
        BadFile: jinja2 is missing, or the file cannot be written.
    """
    path = Path(path)
    try:
        import jinja2
        from markupsafe import Markup
    except ImportError:
        raise BadFile(path, "needs the package jinja2 to be written: pip install jinja2.") from None
    environment = jinja2.Environment(
        loader=jinja2.PackageLoader("drakegait.measured"), autoescape=True,
        undefined=jinja2.StrictUndefined, trim_blocks=True, lstrip_blocks=True,
    )  # fmt: skip
    quality = walk.quality
    text = environment.get_template("quality.html").render(
        name=walk.reference.name, subject=walk.subject,
        warnings=quality.warnings, facts=quality.facts, strides=quality.strides,
        angles=Markup(_svg(coordinate_figure(walk))), forces=Markup(_svg(force_figure(walk))),
        force_rows=quality.forces, penetration=quality.penetration, contacts=quality.contacts,
        changes=quality.changes, spoken=spoken,
    )  # fmt: skip
    write_text(path, text)


def coordinate_figure(walk: ImportedWalk) -> Figure:
    """Measured and fitted coordinates over the stride, in anatomical signs."""
    figure, panels = _panels(3, 4, (11.0, 7.0))
    tau = np.arange(len(walk.target.coordinates)) / len(walk.target.coordinates)
    fitted = to_anatomical("spatial", walk.reference.coordinate_values(tau))
    measured = to_anatomical("spatial", walk.target.coordinates)
    where = {c.name: k for k, c in enumerate(SPATIAL)}
    for axes, names in zip(panels, _PANELS, strict=False):
        for name in names:
            k = where[name]
            factor = 180.0 / np.pi if SPATIAL[k].is_rotation else 100.0
            colour = {"_r": _RIGHT, "_l": _LEFT}.get(name[-2:], _BODY)
            axes.plot(100 * tau, factor * measured[:, k], color=_MEASURED, lw=3.0)
            axes.plot(100 * tau, factor * fitted[:, k], color=colour, lw=1.3)
        axes.set_title(_TITLES[names[0]])
        _phases(axes, walk)
    for axes in panels[len(_PANELS) :]:
        axes.axis("off")
    _legend(figure, {"right": _RIGHT, "left": _LEFT, "trunk": _BODY, "measured": _MEASURED})
    return figure


def force_figure(walk: ImportedWalk) -> Figure:
    """Measured forces, and what the fitted motion needs."""
    figure, panels = _panels(1, 3, (11.0, 3.1))
    tau = np.linspace(0.0, 1.0, 201)
    weight = walk.subject.mass * GRAVITY
    forces = walk.reference.ground_reactions(tau) / weight
    needed = walk.needed_force / weight
    instants = np.arange(len(needed)) / len(needed)
    for k, (axes, name) in enumerate(zip(panels, _FORCE_TITLES, strict=True)):
        axes.plot(100 * tau, forces[:, :, k].sum(axis=1), color=_MEASURED, lw=3.0)
        axes.plot(100 * tau, forces[:, 0, k], color=_RIGHT, lw=1.3)
        axes.plot(100 * tau, forces[:, 1, k], color=_LEFT, lw=1.3)
        axes.plot(100 * instants, needed[:, k], color="#111111", lw=1.0, ls="--")
        axes.set_title(name)
        _phases(axes, walk)
    _legend(figure, {"right": _RIGHT, "left": _LEFT, "both feet": _MEASURED,
                     "needed by the motion": "#111111"})  # fmt: skip
    return figure


def _panels(rows: int, columns: int, size: tuple[float, float]) -> tuple[Figure, list[Axes]]:
    from matplotlib.figure import Figure

    figure = Figure(figsize=size, facecolor="white", layout="constrained")
    return figure, list(np.ravel(figure.subplots(rows, columns)))


def _phases(axes: Axes, walk: ImportedWalk) -> None:
    """Shade every other phase and number them."""
    edges = 100.0 * np.concatenate([[0.0], np.cumsum(walk.reference.phase_fractions)])
    for phase in range(NUM_PHASES):
        if phase % 2 == 0:
            axes.axvspan(edges[phase], edges[phase + 1], color="#eef2f6", lw=0, zorder=-2)
        middle = 0.5 * (edges[phase] + edges[phase + 1])
        axes.text(middle, 0.99, str(phase + 1), transform=axes.get_xaxis_transform(), fontsize=5.5,
                  color="#7a8796", ha="center", va="top")  # fmt: skip
    axes.set_xlim(0.0, 100.0)
    axes.set_xticks(range(0, 101, 25))
    axes.set_xlabel(_CYCLE, fontsize=7, labelpad=1)


def _legend(figure: Figure, colours: dict[str, str]) -> None:
    from matplotlib.lines import Line2D

    handles = [Line2D([], [], color=colour, label=name) for name, colour in colours.items()]
    figure.legend(handles=handles, loc="outside lower right", ncols=len(handles), frameon=False,
                  fontsize=8)  # fmt: skip


def _svg(figure: Figure) -> str:
    from matplotlib import rc_context

    look = {
        "svg.fonttype": "none", "svg.hashsalt": "drakegait", "font.size": 8.0,
        "font.family": "sans-serif", "axes.titlesize": 7.5,
    }  # fmt: skip
    with rc_context(look):
        text = io.StringIO()
        figure.savefig(text, format="svg", metadata={"Date": None})
    svg = text.getvalue()
    return svg[svg.index("<svg") :]
