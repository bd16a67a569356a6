"""Has a solve stopped to come nearer to obeying all laws?"""

from __future__ import annotations

_LENGTH, _LEFT = 40, 0.6  # iterations, and what they leave of the violation: then it is no way
_NEARLY_HELD = 0.1  # tolerances: below, optimality may take its time


class Stalled:
    """Notices that violated rows get no better.

    Attributes:
        reached: the last iterations hardly brought the violation down.
    """

    def __init__(self) -> None:
        self._violations: list[float] = []
        self._barrier = 0.0
        self.reached = False

    def after(self, violation: float, barrier: float) -> None:
        """Take note of an iteration; another barrier parameter may break laws again for a while."""
        if barrier != self._barrier:
            self._violations.clear()
        self._barrier = barrier
        self._violations = [*self._violations[-_LENGTH:], violation]
        # Where rows were nearly held on the way, a long step has bent them: no sign of conflict.
        full = len(self._violations) > _LENGTH and min(self._violations) > _NEARLY_HELD
        self.reached = full and violation > _LEFT * self._violations[0]
