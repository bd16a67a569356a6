"""All figures of a gait, written to a folder."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from drakegait.errors import BadFile
from drakegait.report import style
from drakegait.report.curves import curves_of
from drakegait.report.excitations import excitations
from drakegait.report.ground_reactions import ground_reactions
from drakegait.report.joint_angles import joint_angles
from drakegait.report.joint_moments import joint_moments
from drakegait.report.stick_figure import stick_figure

if TYPE_CHECKING:
    from drakegait.gait import Gait

FIGURES = {
    "joint_angles": joint_angles,
    "ground_reactions": ground_reactions,
    "excitations": excitations,
    "joint_moments": joint_moments,
    "stick_figure": stick_figure,
}


def plot(gait: Gait, folder: str | Path, others: Sequence[Gait] = ()) -> list[Path]:
    """Write the figures of a gait as SVG and PNG.

    Each leg is drawn over its own cycle, from its heel strike to the next, in anatomical signs and
    degrees, with the reference walk and the eight contact phases of the right leg behind.

    Args:
        gait: the gait, converged or not.
        folder: where the files go; made if it is not there.
        others: gaits to compare with, drawn dashed, dotted, ...

    Returns:
        Paths of the files.

    Raises:
        BadFile: the folder cannot be written.
    """
    folder = Path(folder)
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise BadFile(folder, f"cannot be made ({error.strerror or error}).") from None
    all_curves = curves_of(gait, tuple(others))
    with style.look():
        return [
            path
            for name, draw in FIGURES.items()
            for path in style.save(draw(all_curves), folder, name)
        ]
