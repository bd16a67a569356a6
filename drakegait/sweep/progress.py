"""How far a sweep is."""

from __future__ import annotations

import time
from dataclasses import dataclass


@dataclass(frozen=True)
class SweepProgress:
    """State of a sweep, for a line on the screen.

    Attributes:
        total: studies asked for.
        done, failed: studies that are finished, earlier or now.
        running: names of the studies being solved.
        elapsed: since the call [s].
        expected: until the end, by the mean time of the solves so far [s]; None if not known.
        notes: sentences about what was found, skipped or failed, all so far.
    """

    total: int
    done: int
    failed: int
    running: tuple[str, ...]
    elapsed: float
    expected: float | None
    notes: tuple[str, ...]

    @property
    def waiting(self) -> int:
        """Studies that have not begun."""
        return self.total - self.done - self.failed - len(self.running)


class Stopwatch:
    """Times solves and guesses the rest.

    Args:
        earlier: duration of solves of the same sweep in earlier calls [s].
    """

    def __init__(self, earlier: list[float]):
        self._start = time.monotonic()
        self._times = list(earlier)
        self._begun: dict[str, float] = {}

    @property
    def elapsed(self) -> float:
        """Since the start [s]."""
        return time.monotonic() - self._start

    @property
    def running(self) -> tuple[str, ...]:
        """Names of what has begun and not ended."""
        return tuple(self._begun)

    def begin(self, name: str) -> None:
        """A solve begins, or begins again."""
        self._begun[name] = time.monotonic()

    def end(self, name: str) -> None:
        """A solve has ended."""
        begun = self._begun.pop(name, None)
        if begun is not None:
            self._times.append(time.monotonic() - begun)

    def expected(self, open_studies: int, cores: int) -> float | None:
        """Time until `open_studies`, those that run among them, are solved on `cores` [s]."""
        if not self._times or not cores:
            return None
        mean = sum(self._times) / len(self._times)
        now = time.monotonic()
        spent = sum(min(now - begun, mean) for begun in self._begun.values())
        return (open_studies * mean - spent) / min(cores, max(open_studies, 1))
