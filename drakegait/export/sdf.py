"""The skeleton of a walker as an SDF model, for Drake, Gazebo and others."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from drakegait.whole_file import new_folder, write_text

if TYPE_CHECKING:
    from drakegait.gait import Gait
    from drakegait.study import GaitStudy


def export_sdf(walks: Gait | GaitStudy, file: str | Path) -> Path:
    """Write the bodies, joints and contact points of a walker, scaled and with added masses.

    Muscles and passive joint moments have no place in SDF. Signs are plant signs
    (docs/conventions.md). `--sdf` expects a model for 1.80 m and 75 kg and scales it: to walk with
    this file, give it to a study of that size.

    Args:
        walks: a gait, or a study that has not been solved.

    Raises:
        BadFile: the file cannot be written.
    """
    study = getattr(walks, "study", walks)
    path = Path(file).expanduser()
    new_folder(path.parent)
    write_text(path, '<?xml version="1.0"?>\n' + study.walker.skeleton.sdf + "\n")
    return path
