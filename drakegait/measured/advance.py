"""How fast the walker goes over the ground: over the floor, or against a belt."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from drakegait.errors import InvalidInput
from drakegait.measured.contacts import Contact
from drakegait.measured.notes import Notes
from drakegait.measured.posture import Posture

SPEEDS = (0.2, 2.5)
"""Walking speeds that are believed [m/s]."""
_STILL = 0.15  # [m/s] feet that slide slower than this stand
_DISAGREE = 0.1  # of a given speed


def belt_speed(
    posture: Posture, contacts: Sequence[Contact], given: float | None, notes: Notes
) -> float:
    """Speed of the belt under the feet [m/s], 0 over ground.

    Standing feet that slide tell that there is a belt. Its speed is what the steps (from the
    trailing toe to the leading heel at heel strike, when both feet stand) add up to, less the
    advance of the hips, per time; with the model's leg lengths this is good to a few per cent.
    Where the file holds no position of the pelvis, its hips are at rest, and this is the
    walking speed.

    Args:
        given: by the user; None to find it from the feet.

    Raises:
        InvalidInput: a given speed that the feet contradict, or one that is no walking speed.
    """
    slide = _slide(posture, contacts)
    if given is not None:
        if abs(slide) < _STILL:
            raise InvalidInput("treadmill speed", given, "left out: the feet of this walk stand "
                               "still on the ground, it is not from a treadmill")  # fmt: skip
        if abs(slide - given) > _DISAGREE * given:
            notes.say(f"The standing feet slide backwards at {slide:.2f} m/s, not at the treadmill "
                      f"speed {given:g} m/s that was given; the given speed was used.")  # fmt: skip
        return given
    if abs(slide) < _STILL:
        return 0.0
    found = _stepping_speed(posture, contacts)
    found = slide if found is None else found
    if not SPEEDS[0] <= found <= SPEEDS[1]:
        raise InvalidInput("speed of the standing feet", round(found, 3),
                           "0 (over ground) or 0.2 to 2.5 m/s backwards (treadmill); give the "
                           "treadmill speed if this is one")  # fmt: skip
    what = "belt's speed" if posture.place[0] else "walking speed"
    notes.say(
        f"The {what} was estimated from the steps as {found:.3f} m/s, good to about 5 %; give "
        "the treadmill speed if it is known."
    )
    return found


def _slide(posture: Posture, contacts: Sequence[Contact]) -> float:
    """Backward speed of the flat feet in the file's axes [m/s]."""
    forward = posture.points[:, [0, 2], 0]
    if posture.place[0]:
        forward = forward + posture.hips[:, :1]
    speeds = []
    for contact in contacts:
        length = contact.end - contact.start
        inside = posture.time > contact.start + 0.15 * length
        inside &= posture.time < contact.start + 0.5 * length
        if inside.sum() > 5:
            foot = 0 if contact.side == "r" else 1
            speeds.append(-np.polyfit(posture.time[inside], forward[inside, foot], 1)[0])
    return float(np.median(speeds)) if speeds else 0.0


def _stepping_speed(posture: Posture, contacts: Sequence[Contact]) -> float | None:
    """Sum of two steps less the advance of the hips, over the time of the stride [m/s]."""
    strikes = [(c.start, c.side) for c in contacts if c.start > posture.time[0] + 0.02]
    forward = posture.points[:, :, 0]
    sole = float(np.median(np.linalg.norm(posture.points[:, 1] - posture.points[:, 0], axis=-1)))
    hips = posture.hips[:, 0] if posture.place[0] else np.zeros(posture.time.size)

    def step(time: float, side: str) -> float:
        # a little later than the strike, when the leading heel has come to rest
        heel, toe = (0, 3) if side == "r" else (2, 1)
        places = [np.interp(time + 0.02, posture.time, forward[:, k]) for k in (heel, toe)]
        return places[0] - (places[1] - sole)

    speeds = []
    for first, second, third in zip(strikes, strikes[1:], strikes[2:], strict=False):
        if first[1] != third[1] or first[1] == second[1] or third[0] > posture.time[-1] - 0.02:
            continue
        way = np.interp([first[0], third[0]], posture.time, hips)
        length = step(*second) + step(*third)
        speeds.append((length - (way[1] - way[0])) / (third[0] - first[0]))
    return float(np.median(speeds)) if speeds else None
