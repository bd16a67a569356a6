"""The feet on the ground: eight contact phases, footprints, and who is loaded when.

Each foot is rigid with two contact points, the heel A and the toe B
(metatarsal line). The paper (Garcia-Vallejo & Schiehlen 2012, section 2,
figure 2) divides the stride, from one right heel strike to the next, into
eight phases with different bilateral contacts; a foot on the ground may pivot
about the vertical only with a reaction moment.

A variant of the model (`ContactSettings.toe_torque`) lets the ground also hold the foot that stands
alone by torques about horizontal axes, as if it acted through the metatarsophalangeal joint: about
x (roll) in phases 3, 4, 7, 8 and about y (pitch) in 4 and 8, where nothing else can. They come as
four more rows after the fourteen.

All contact quantities are listed in one fixed order of 14 *contact rows*:
right foot heel x, y, z, toe x, y, z, yaw, then the left foot likewise. The
planar walker uses the same list and leaves the y and yaw rows inactive.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from drakegait.settings import Settings, flag, quantity

ROWS_PER_FOOT = 7
NUM_ROWS = 2 * ROWS_PER_FOOT
POINT_NAMES = ("heel_r", "toe_r", "heel_l", "toe_l")
ROW_NAMES = tuple(
    name
    for side in "rl"
    for name in (*(f"heel_{side} {axis}" for axis in "xyz"),
                 *(f"toe_{side} {axis}" for axis in "xyz"), f"foot_{side} yaw")
)  # fmt: skip
VERTICAL_ROWS = (2, 5, 9, 12)  # z of the four points, in the order of POINT_NAMES
YAW_ROWS = (6, 13)
SIDE_ROWS = (1, 4, 6, 8, 11, 13)  # rows that a planar walker cannot have
TORQUE_NAMES = tuple(f"foot_{side} {axis}" for side in "rl" for axis in ("roll", "pitch"))
ROLL_ROWS, PITCH_ROWS = (14, 16), (15, 17)
NUM_ROWS_WITH_TORQUES = NUM_ROWS + len(TORQUE_NAMES)

PHASE_NAMES = (
    "right loading",
    "right foot flat in double support",
    "right single support",
    "right heel rise",
    "left loading",
    "left foot flat in double support",
    "left single support",
    "left heel rise",
)
EVENT_NAMES = (
    "right heel strike",
    "right toe down",
    "left toe off",
    "right heel off",
    "left heel strike",
    "left toe down",
    "right toe off",
    "left heel off",
)
NUM_PHASES = 8

_HEEL, _TOE, _FLAT = (0, 1, 2, 6), (3, 4, 5, 6), (0, 1, 2, 5, 6)
_CONTACTS = (  # (right foot, left foot) in each phase, docs/formulation.md 6.1
    (_HEEL, _TOE),
    (_FLAT, _TOE),
    (_FLAT, ()),
    (_TOE, ()),
    (_TOE, _HEEL),
    (_TOE, _FLAT),
    ((), _FLAT),
    ((), _TOE),
)


_ALONE = (None, None, 0, 0, None, None, 1, 1)  # the foot that stands alone, by phase
_TOE_ONLY = (3, 7)


@dataclass(frozen=True, kw_only=True)
class ContactSettings(Settings):
    """What the ground bears.

    The friction and patch values are engineering estimates: shoes on a
    laboratory floor have 0.5 to 0.9, level walking needs about 0.25.
    """

    friction: float = quantity(0.6, "-", 0.02, 2.0, "Coulomb coefficient of the ground")
    patch_radius: float = quantity(
        0.03, "m", 0.0, 0.1, "radius of a contact patch, bounds the free moment of one point"
    )
    toe_torque: bool = flag(
        False, "whether the ground holds a foot that stands alone by torques at the toe as well"
    )
    toe_torque_limit: float = quantity(
        20.0, "N m", 0.1, 1000.0, "largest of these torques, each way; toes: about 20 in walking"
    )


def active_rows(phase: int, planar: bool = False, torques: bool = False) -> np.ndarray:
    """Contact rows that bear load in `phase` (0..7), as a mask of shape (14,), or (18,) `torques`.
    """
    if torques:
        return np.append(active_rows(phase, planar), _torques(phase, planar))
    mask = np.zeros(NUM_ROWS, dtype=bool)
    right, left = _CONTACTS[phase % NUM_PHASES]
    mask[list(right)] = True
    mask[[ROWS_PER_FOOT + row for row in left]] = True
    if planar:
        mask[list(SIDE_ROWS)] = False
    return mask


def _torques(phase: int, planar: bool) -> np.ndarray:
    """Torques on the foot that stands alone, as a mask of shape (4,)."""
    mask = np.zeros(len(TORQUE_NAMES), dtype=bool)
    foot = _ALONE[phase % NUM_PHASES]
    if foot is not None:
        mask[2 * foot] = not planar
        mask[2 * foot + 1] = phase % NUM_PHASES in _TOE_ONLY
    return mask


def loaded_rows_at_start(
    phase: int, planar: bool = False, torques: bool = False
) -> np.ndarray:
    """Contact rows that can bear load at the instant when `phase` begins.

    With continuous accelerations the reaction lies in the range of the
    contacts before *and* after the event, which is the smaller of the two
    sets; so every multiplier of the contact that comes or goes is zero there:
    no impact. (A heel that lifts hands its horizontal force to the toe, an
    equivalent load while the foot is flat.) A torque needs the foot to stand alone on both sides
    of the event.
    """
    if torques:
        same = _ALONE[(phase - 1) % NUM_PHASES] == _ALONE[phase % NUM_PHASES]
        return np.append(
            loaded_rows_at_start(phase, planar), same & _torques(phase, planar)
        )
    before, after = active_rows(phase - 1, planar), active_rows(phase, planar)
    return before if before.sum() < after.sum() else after


def placed_rows_at_start(phase: int, planar: bool = False) -> np.ndarray:
    """Contact rows whose position is prescribed when `phase` begins: both sets."""
    return active_rows(phase - 1, planar) | active_rows(phase, planar)


def foot_forces(multipliers: np.ndarray) -> np.ndarray:
    """Force on each foot (..., 2, 3) [N], heel and toe together, of multipliers (..., 14)."""
    multipliers = multipliers[..., :NUM_ROWS]
    by_foot = multipliers.reshape(*multipliers.shape[:-1], 2, ROWS_PER_FOOT)
    return by_foot[..., 0:3] + by_foot[..., 3:6]


def left_print(phase: int, on_event: bool = False) -> int:
    """Which footprint the left foot uses: 0 the previous one, 1 the next.

    It leaves the previous one at left toe off, the end of the second phase.
    """
    last = 2 if on_event else 1
    return 0 if phase % NUM_PHASES <= last else 1


@dataclass(frozen=True)
class FootGeometry:
    """Positions of heel and toe along the sole, from the ankle's projection [m]."""

    heel: float
    toe: float

    @property
    def length(self) -> float:
        """Distance of heel and toe points [m]."""
        return self.toe - self.heel


def footprints(
    placement: np.ndarray, print_of_left: np.ndarray, geometry: FootGeometry
) -> tuple[np.ndarray, np.ndarray]:
    """Prescribed values of the contact rows, docs/formulation.md 6.5.

    Args:
        placement: step length right and left, toe angle right and left, step
            width, p_g of eq. (5), shape (num, 5) [m, m, rad, rad, m].
        print_of_left: 0 or 1 for each, see `left_print`, shape (num,).
        geometry: heel and toe along the sole.

    Returns:
        Targets (num, 14) [m, rad] and their derivatives by placement (num, 14, 5).
    """
    num = len(placement)
    targets = np.zeros((num, NUM_ROWS))
    slopes = np.zeros((num, NUM_ROWS, 5))
    step_right, step_left, width = placement[:, 0], placement[:, 1], placement[:, 4]
    for foot, side in ((0, -1.0), (1, 1.0)):
        base = ROWS_PER_FOOT * foot
        angle = placement[:, 2 + foot]
        cos, sin = np.cos(angle), np.sin(angle)
        for offset, arm in ((0, geometry.heel), (3, geometry.toe)):
            targets[:, base + offset] = cos * arm
            targets[:, base + offset + 1] = side * 0.5 * width + sin * arm
            slopes[:, base + offset, 2 + foot] = -sin * arm
            slopes[:, base + offset + 1, 2 + foot] = cos * arm
            slopes[:, base + offset + 1, 4] = side * 0.5
            if foot == 1:
                targets[:, base + offset] += np.where(print_of_left == 0, -step_right, step_left)
                slopes[:, base + offset, 0] = np.where(print_of_left == 0, -1.0, 0.0)
                slopes[:, base + offset, 1] = np.where(print_of_left == 0, 0.0, 1.0)
        targets[:, base + 6] = angle
        slopes[:, base + 6, 2 + foot] = 1.0
    return targets, slopes
