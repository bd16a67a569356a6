"""Gaits and folders as they are named on the command line."""

from __future__ import annotations

import tempfile
from pathlib import Path

from drakegait.errors import BadFile
from drakegait.gait import Gait

GAIT_FILE = "gait.nc"
SUMMARY_FILE = "summary.json"
FIGURES_FOLDER = "figures"
REPLAY_FILE = "replay.html"
REPORT_FILE = "report.html"


def gait_path(name: str) -> Path:
    """The file of a gait that is given as a file or as the folder that `walk` wrote."""
    path = Path(name).expanduser()
    return path / GAIT_FILE if path.is_dir() else path


def load_gait(name: str) -> Gait:
    """The gait in a file or folder; raises BadFile."""
    return Gait.load(gait_path(name))


def writable_folder(name: str | Path) -> Path:
    """A folder that exists and takes files, made if need be.

    Raises:
        BadFile: it cannot be made or written to, or holds a folder where a file must go.
    """
    folder = Path(name).expanduser()
    if folder.exists() and not folder.is_dir():
        raise BadFile(folder, "is a file, but a folder for the results is needed.")
    try:
        folder.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryFile(dir=folder):
            pass
    except OSError as error:
        reason = error.strerror or error
        raise BadFile(folder, f"cannot be used as folder for the results ({reason}).") from None
    for file in (GAIT_FILE, SUMMARY_FILE, REPLAY_FILE, REPORT_FILE):
        if (folder / file).is_dir():
            raise BadFile(folder / file, "is a folder, but a file must go there.")
    figures = folder / FIGURES_FOLDER
    if figures.exists() and not figures.is_dir():
        raise BadFile(figures, "is a file, but the folder of figures must go there.")
    return folder
