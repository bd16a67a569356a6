"""Ctrl-C, kept until a sweep can be left in order."""

from __future__ import annotations

import signal
import threading
from collections.abc import Callable
from types import FrameType, TracebackType


class Interrupt:
    """Notes Ctrl-C inside a `with` block; `check` raises it.

    Python raises KeyboardInterrupt wherever it happens to be: in a callback of the garbage
    collector it is swallowed, while Dask starts its workers it leaves them half started. A second
    Ctrl-C is raised at once. Handlers of others, and threads other than the main one, are left as
    they are.

    Args:
        wake: called when Ctrl-C comes, in a signal handler.
    """

    def __init__(self, wake: Callable[[], None]):
        self._wake = wake
        self._asked = self._listens = False

    def __enter__(self) -> Interrupt:
        ours = threading.current_thread() is threading.main_thread()
        if ours and signal.getsignal(signal.SIGINT) is signal.default_int_handler:
            signal.signal(signal.SIGINT, self._note)
            self._listens = True
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        if self._listens:
            signal.signal(signal.SIGINT, signal.default_int_handler)
        if kind is None:
            self.check()

    def check(self) -> None:
        """Raise KeyboardInterrupt if Ctrl-C has come."""
        if self._asked:
            raise KeyboardInterrupt

    def _note(self, number: int, frame: FrameType | None) -> None:
        if self._asked:
            signal.default_int_handler(number, frame)
        self._asked = True
        self._wake()
