"""What can go wrong, as exceptions that say it in one sentence.

Every error that a user can cause derives from `DrakegaitError`; the command
line prints its sentence and exits with 2. Anything else is our mistake.
"""

from __future__ import annotations

import difflib
from collections.abc import Iterable


class DrakegaitError(Exception):
    """Base class of every error that drakegait raises on purpose."""


class InvalidInput(DrakegaitError):
    """A value that cannot be used.

    Args:
        name: what was set, in the user's words (`"speed"`, `"--height"`).
        value: the value that was given.
        allowed: what would have been accepted, with its unit.
    """

    def __init__(self, name: str, value: object, allowed: str):
        self.name, self.value, self.allowed = name, value, allowed
        super().__init__(f"{name} is {value!r}, but must be {allowed}.")


class UnknownName(InvalidInput):
    """A name that is not among the known ones; the message lists them.

    Args:
        kind: what the name stands for (`"segment"`, `"muscle"`, `"setting"`).
        value: the name that was given.
        known: the valid names.
    """

    def __init__(self, kind: str, value: str, known: Iterable[str]):
        self.known = tuple(known)
        close = difflib.get_close_matches(str(value), self.known, n=1)
        hint = f" (did you mean {close[0]!r}?)" if close else ""
        super().__init__(kind, value, f"one of {', '.join(self.known)}{hint}")


class BadFile(DrakegaitError):
    """A file that is missing, damaged, foreign or cannot be written."""

    def __init__(self, path: object, problem: str):
        self.path, self.problem = path, problem
        super().__init__(f"{path}: {problem}")
