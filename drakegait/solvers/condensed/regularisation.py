"""How K is made positive definite, so that a step is one of descent.

First as it is; then with a share of what the muscles lack to be convex (`convexity`), a few times
the least; then with all of it and a multiple of the identity besides (Waechter & Biegler 2006,
section 3.1).
"""

from __future__ import annotations

from drakegait.solvers.condensed.system import CondensedSystem

# First, smallest and largest multiple of the identity, and its growth.
_FIRST, _SMALLEST, _LARGEST = 1e-4, 1e-20, 1e40
_UP, _UP_FIRST, _DOWN = 8.0, 100.0, 1.0 / 3.0
_AFTER_SEARCH = 1e-2  # least multiple after a line search that found nothing
_MOST = 1e4  # beyond it a step is too short to serve
# A model that lies above the cost all along creeps, one that hardly bends goes too far: the share
# of convexity is so many times what K needs at the least, and a little.
_ABOVE, _A_LITTLE = 2.5, 0.02


class Regularisation:
    """Finds and keeps what has to be added to K.

    Args:
        system: whose matrix it is, linearised before each call of `factor`.
    """

    def __init__(self, system: CondensedSystem):
        self._system = system
        self._convexity = 0.0
        self._shift, self._last_shift = 0.0, 0.0

    def move_to(self, system: CondensedSystem) -> None:
        """Go on with the matrices of `system`, which is like the one before."""
        self._system = system

    def factor(self) -> bool:
        """Factorise K with as little as serves; False if nothing does."""
        self._convexity = self._shift = 0.0
        if self._try():
            return True
        self._convexity = 1.0
        if not self._try():
            return self._shifted(_FIRST if self._last_shift == 0.0 else 0.0)
        share = _ABOVE * self._system.least_convexity() + _A_LITTLE
        if share >= 1.0:
            return True
        self._convexity = share
        if self._try():
            return True
        self._convexity = 1.0
        return self._try()

    def more(self) -> bool:
        """Factorise with a larger multiple of the identity; False if there is no use in that."""
        if self._shift > _MOST:
            return False
        return self._shifted(max(_UP * self._shift, _AFTER_SEARCH))

    def _shifted(self, least: float) -> bool:
        up = _UP if self._last_shift > 0.0 else _UP_FIRST
        self._shift = max(least, _SMALLEST, _DOWN * self._last_shift if least < _FIRST else 0.0)
        while self._shift <= _LARGEST:
            if self._try():
                self._last_shift = self._shift
                return True
            self._shift *= up
        return False

    def _try(self) -> bool:
        return self._system.factor(self._shift, self._convexity)
