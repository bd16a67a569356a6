"""Files that are read and written whole or not at all, and folders for them."""

from __future__ import annotations

import contextlib
import json
import math
import os
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from drakegait.errors import BadFile


@contextmanager
def beside(path: str | Path) -> Iterator[Path]:
    """A place beside `path` to write to: renamed to it when the block ends, removed if it fails.

    Raises:
        BadFile: the place cannot be written to.
    """
    path = Path(path)
    part = path.with_name(f".{path.name}.{os.getpid()}.part")
    try:
        yield part
        part.replace(path)
    except OSError as error:
        reason = error.strerror or str(error).splitlines()[0]
        raise BadFile(path, f"cannot be written ({reason}).") from None
    finally:
        with contextlib.suppress(OSError):
            part.unlink(missing_ok=True)


def new_folder(name: str | Path) -> Path:
    """A folder that exists, made if need be; raises BadFile."""
    folder = Path(name).expanduser()
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise BadFile(folder, f"cannot be made ({error.strerror or error}).") from None
    return folder


def write_bytes(path: str | Path, content: bytes) -> None:
    """Write a file that outlasts a loss of power; raises BadFile."""
    path = Path(path)
    with beside(path) as part, part.open("wb") as file:
        file.write(content)
        file.flush()
        os.fsync(file.fileno())
    _sync_folder(path.parent)


def read_text(path: str | Path) -> str:
    """A text in UTF-8; raises BadFile."""
    try:
        return Path(path).read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        reason = getattr(error, "strerror", None) or "not text"
        raise BadFile(path, f"cannot be read ({reason}).") from None


def write_text(path: str | Path, text: str) -> None:
    """Write a text in UTF-8; raises BadFile."""
    write_bytes(path, text.encode())


def write_json(path: str | Path, content: Mapping[str, Any]) -> None:
    """Write JSON, which knows no number that is not finite: null; raises BadFile."""
    text = json.dumps(_finite(content), indent=2, allow_nan=False)
    write_bytes(path, (text + "\n").encode())


def _finite(value: Any) -> Any:
    if isinstance(value, Mapping):
        return {name: _finite(item) for name, item in value.items()}
    if isinstance(value, (list, tuple)):
        return [_finite(item) for item in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value


def _sync_folder(folder: Path) -> None:
    """Make a rename last, where the system can open folders."""
    if os.name != "posix":
        return
    handle = os.open(folder, os.O_RDONLY)
    try:
        os.fsync(handle)
    finally:
        os.close(handle)
