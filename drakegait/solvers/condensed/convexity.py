"""What muscles lack to a convex problem.

Energy grows with less than the first power of activation (A^0.6), and so does the weighted
curvature of the muscles bend downwards along many directions. Where K is not positive definite, the
sure remedy, a multiple of the identity, slows all other directions down, too. Cutting off the
negative curvature muscle by muscle does not: what remains is a model that lies above the concave
part, as in methods of majorisation and minimisation (Hunter & Lange, Am. Stat. 58, 2004).
"""

from __future__ import annotations

import numpy as np

from drakegait.walker.muscles import MuscleSet

# Typical changes of a tendon force and its derivatives, in f_max, f_max/s, f_max/s^2, and of
# the muscle's length, in l_opt: what "curved" means for quantities of different unit.
_FORCE_SCALES = np.array([0.3, 3.0, 50.0])
_LENGTH_SCALES = np.array([0.2, 2.0, 30.0])


def convex_excess(hessian: np.ndarray, muscles: MuscleSet) -> np.ndarray:
    """What makes the nearest positive semidefinite matrix of a muscle's Hessian.

    Args:
        hessian: by f, f', f'', l, l', l'' (num, num_muscles, 6, 6) [SI units].

    Returns:
        (num, num_muscles, 6, 6), positive semidefinite; nearest in typical units.
    """
    scale = np.concatenate(
        [muscles.f_max[:, None] * _FORCE_SCALES, muscles.l_opt[:, None] * _LENGTH_SCALES], axis=1
    )
    both = scale[:, :, None] * scale[:, None, :]
    values, vectors = np.linalg.eigh(hessian * both)
    lack = np.maximum(-values, 0.0)
    return (vectors * lack[..., None, :]) @ np.swapaxes(vectors, -1, -2) / both
