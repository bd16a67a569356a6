"""The folder of a sweep: a folder for each study, written so that a kill leaves no half result.

    FOLDER/<study>/gait.nc        the gait; of a study that did not converge, the nearest one
    FOLDER/<study>/summary.json   its main numbers, and which study it answers: written last
    FOLDER/<study>/failed.json    why there is no converged gait

One process writes: the one that called `sweep`. A study counts as finished when its summary names
the study's key and the digest of the gait that lies beside it; the rename of the summary is the
moment at which it does.
"""

from __future__ import annotations

import hashlib
import json
import os
import socket
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from drakegait.errors import BadFile
from drakegait.whole_file import new_folder, write_bytes, write_json

GAIT, SUMMARY, FAILED, LOCK = "gait.nc", "summary.json", "failed.json", ".lock"


@dataclass(frozen=True)
class State:
    """What the folder knows of a study.

    Attributes:
        status: `"done"`, `"failed"` or `"open"`.
        reason: why it failed.
        note: a sentence about something found that has to be done again; empty if nothing is odd.
    """

    status: str
    reason: str = ""
    note: str = ""


class Store:
    """The results in a folder."""

    def __init__(self, folder: str | Path):
        self.folder = Path(folder).expanduser()

    @contextmanager
    def locked(self) -> Iterator[None]:
        """Make the folder and keep other sweeps out of it; a killed process gives it back.

        Raises:
            BadFile: it cannot be made or written, or another sweep is at work in it.
        """
        path, new = self.folder / LOCK, not self.folder.exists()
        try:
            self.folder.mkdir(parents=True, exist_ok=True)
            file = path.open("a+", encoding="utf-8")
        except OSError as error:
            reason = error.strerror or error
            raise BadFile(self.folder, f"cannot hold the results ({reason}).") from None
        with file:
            if not _lock(file):
                file.seek(0)
                raise BadFile(self.folder, f"another sweep works here ({file.read().strip()}).")
            file.seek(0)
            file.truncate()
            file.write(f"process {os.getpid()} on {socket.gethostname()}\n")
            file.flush()
            try:
                yield
            finally:
                if new and list(self.folder.iterdir()) == [path]:  # nothing came of it
                    path.unlink()
                    self.folder.rmdir()

    def path(self, name: str, file: str = GAIT) -> Path:
        """Where a file of a study is."""
        return self.folder / name / file

    def state(self, name: str, key: str) -> State:
        """Whether a study has been finished, judged by what lies in its folder."""
        failed, summary = self.failure(name), self.summary(name)
        record = summary.get("sweep", {})
        if record.get("key") == key and summary.get("solver", {}).get("status") == "converged":
            if record.get("sha256") == self._digest(name):
                return State("done")
            return State("open", note=f"{name}: {GAIT} is damaged or missing; solved again.")
        if failed.get("key") == key:
            return State("failed", reason=str(failed.get("reason", "")))
        if "key" in record or "key" in failed:
            return State("open", note=f"{name}: {self._changed(summary, failed)}; solved again.")
        if any(self.path(name, file).exists() for file in (GAIT, SUMMARY, FAILED)):
            return State("open", note=f"{name}: its record is damaged or missing; solved again.")
        return State("open")

    def gait(self, name: str) -> bytes:
        """Content of a study's `gait.nc`; raises BadFile."""
        path = self.path(name)
        try:
            return path.read_bytes()
        except OSError as error:
            raise BadFile(path, f"cannot be read ({error.strerror}).") from None

    def summary(self, name: str) -> dict[str, Any]:
        """`summary.json` of a study; empty if there is none that can be read."""
        return _read_json(self.path(name, SUMMARY))

    def failure(self, name: str) -> dict[str, Any]:
        """`failed.json` of a study; empty if there is none that can be read."""
        return _read_json(self.path(name, FAILED))

    def write_done(
        self, name: str, key: str, gait: bytes, summary: Mapping[str, Any], guess: str | None
    ) -> None:
        """Record a converged gait; raises BadFile."""
        self._write_gait(name, key, gait, summary, guess)
        self.path(name, FAILED).unlink(missing_ok=True)

    def write_failed(
        self,
        name: str,
        key: str,
        kind: str,
        reason: str,
        details: str = "",
        gait: bytes | None = None,
        summary: Mapping[str, Any] | None = None,
        guess: str | None = None,
    ) -> None:
        """Record a failure with its reason, and the nearest gait if there is one.

        Args:
            kind: `"not converged"`, `"raised"` or `"worker died"`.
            reason: one sentence.
            details: traceback, worst rows.

        Raises:
            BadFile: the folder cannot be written.
        """
        import drakegait

        if gait is not None and summary is not None:
            self._write_gait(name, key, gait, summary, guess)
        else:  # what is there belongs to another study or attempt
            for file in (SUMMARY, GAIT):
                self.path(name, file).unlink(missing_ok=True)
            new_folder(self.path(name).parent)
        record = {
            "key": key,
            "kind": kind,
            "reason": reason,
            "details": details,
            "guess": guess,
            "drakegait": drakegait.__version__,
        }
        write_json(self.path(name, FAILED), record)

    def _write_gait(
        self, name: str, key: str, gait: bytes, summary: Mapping[str, Any], guess: str | None
    ) -> None:
        digest = hashlib.sha256(gait).hexdigest()
        new_folder(self.path(name).parent)
        write_bytes(self.path(name), gait)
        record = {"study": name, "key": key, "guess": guess, "sha256": digest}
        write_json(self.path(name, SUMMARY), {**summary, "sweep": record})

    def _digest(self, name: str) -> str | None:
        try:
            return hashlib.sha256(self.path(name).read_bytes()).hexdigest()
        except OSError:
            return None

    @staticmethod
    def _changed(summary: Mapping[str, Any], failed: Mapping[str, Any]) -> str:
        import drakegait

        was = summary.get("versions", {}).get("drakegait") or failed.get("drakegait")
        if was != drakegait.__version__:
            return f"the result is of drakegait {was}, this is {drakegait.__version__}"
        return "the study has changed since it was solved"


def _read_json(path: Path) -> dict[str, Any]:
    try:
        content = json.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return {}
    return content if isinstance(content, dict) else {}


def _lock(file: Any) -> bool:
    """Whether the file is ours; true as well where the file system knows no locks."""
    try:
        import fcntl
    except ImportError:
        return True
    try:
        fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        return False
    except OSError:
        return True
    return True
