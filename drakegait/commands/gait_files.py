"""Gaits and folders as they are named on the command line."""

from __future__ import annotations

import tempfile
from pathlib import Path

from drakegait.errors import BadFile, InvalidInput
from drakegait.gait import Gait

GAIT_FILE = "gait.nc"
SUMMARY_FILE = "summary.json"
FIGURES_FOLDER = "figures"
REPLAY_FILE = "replay.html"
REPORT_FILE = "report.html"
SENSITIVITIES_FILE = "sensitivities.csv"  # in the folder of figures


def gait_path(name: str) -> Path:
    """The file of a gait that is given as a file or as the folder that `walk` wrote."""
    path = Path(name).expanduser()
    return path / GAIT_FILE if path.is_dir() else path


def load_gait(name: str) -> Gait:
    """The gait in a file or folder; raises BadFile."""
    return Gait.load(gait_path(name))


def output_file(option: str, name: str, suffix: str) -> Path:
    """Where to write a file: its suffix keeps a gait from being named by mistake.

    Raises:
        InvalidInput: another suffix, or no name.
        BadFile: it is a folder.
    """
    path = Path(name).expanduser()
    if path.suffix.lower() != suffix:
        raise InvalidInput(option, name, f"the name of a file that ends in {suffix}")
    if path.is_dir():
        raise BadFile(path, "is a folder.")
    return path


def output_folder(option: str, name: str) -> Path:
    """A folder to write to, not made yet; raises InvalidInput for an empty name, BadFile."""
    if not name.strip():
        raise InvalidInput(option, name, "the name of a folder; this one is called .")
    path = Path(name).expanduser()
    if path.exists() and not path.is_dir():
        raise BadFile(path, "is a file, but a folder is needed.")
    return path


def writable_folder(name: str | Path) -> Path:
    """A folder that exists and takes files, made if need be.

    Raises:
        BadFile: it cannot be made or written to, or holds a folder where a file must go.
    """
    folder = output_folder("--out", str(name))
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
