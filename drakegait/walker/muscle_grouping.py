"""Which muscles count: the criterion behind Table 1 of Garcia-Vallejo & Schiehlen (2012), 2.1.

A muscle's contribution to a joint is the product of its moment arm and of the largest force that it
has in walking; about the hip, which has three arms, of the length of their vector. A muscle whose
contribution to every joint stays below a tenth of the largest one there is neglected.

    rows = contributions(MuscleSet.load("spatial"))   # of any table
    rows = printed_contributions()                    # Table 1
    for row in compare(MuscleSet.load("spatial")): print(row)
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from drakegait.errors import InvalidInput, UnknownName
from drakegait.walker import coordinates
from drakegait.walker.data_table import read_table
from drakegait.walker.muscles import MuscleSet

JOINTS = ("hip", "knee", "ankle")
"""The joints that are judged, in the order of all arrays here."""

THRESHOLD = 0.10
"""Least share of the largest contribution to a joint that lets a muscle count."""

_COORDINATES = {
    "hip": ("hip_adduction_r", "hip_flexion_r", "hip_rotation_r"),
    "knee": ("knee_flexion_r",),
    "ankle": ("ankle_dorsiflexion_r",),
}
_SAME = 5e-3  # relative: three digits


@dataclass(frozen=True)
class Contribution:
    """What one muscle (or group) does at most about the three joints.

    Attributes:
        muscle: the paper's abbreviation.
        moments: (hip, knee, ankle) [N m].
        shares: of the largest moment of all muscles about that joint, 0..1.
        counts: whether one share reaches the threshold.
        kept: whether the muscle is in the model.
    """

    muscle: str
    moments: tuple[float, float, float]
    shares: tuple[float, float, float]
    counts: bool
    kept: bool


@dataclass(frozen=True)
class Difference:
    """One muscle about one joint: Table 1 beside a muscle table.

    Attributes:
        muscle, joint: which.
        printed: peak moment of Table 1 [N m].
        computed: arm times largest force of the muscle table [N m]; None if it lacks the muscle.
        arm: of the muscle table [m].
        implied_force: the force by which `printed` would follow from `arm` [N].
        largest_force: f_max of the muscle table [N].
        remark: what this says, in words; empty if both agree to three digits.
    """

    muscle: str
    joint: str
    printed: float
    computed: float | None
    arm: float | None
    implied_force: float | None
    largest_force: float | None
    remark: str


def joint_arms(muscles: MuscleSet) -> tuple[tuple[str, ...], np.ndarray]:
    """Groups of one leg and the sizes (num_groups, 3) of their arms about the joints [m]."""
    where = coordinates.index(muscles.kind)
    half = muscles.num_muscles // 2
    arms = []
    for joint in JOINTS:
        columns = [where[name] for name in _COORDINATES[joint] if name in where]
        arms.append(np.linalg.norm(muscles.moment_arms[:half, columns], axis=1))
    return muscles.abbreviations[:half], np.stack(arms, axis=1)


def contributions(
    muscles: MuscleSet,
    peak_forces: Mapping[str, float] | None = None,
    threshold: float = THRESHOLD,
) -> tuple[Contribution, ...]:
    """The criterion applied to a muscle table.

    Args:
        muscles: right leg of this table.
        peak_forces: largest force in walking of each group by abbreviation [N], say from a solved
            gait or from the literature. Default: f_max, so that moments are capacities.
        threshold: least share that counts.

    Raises:
        UnknownName, InvalidInput: a muscle that the table lacks, a force that is none, or a
            group without a force.
    """
    names, arms = joint_arms(muscles)
    forces = dict(zip(names, muscles.f_max[: len(names)], strict=True))
    if peak_forces is not None:
        for name, force in peak_forces.items():
            if name not in forces:
                raise UnknownName("muscle group", name, names)
            if not (np.isfinite(force) and force >= 0.0):
                raise InvalidInput(f"peak force of {name}", force, "a number of at least 0 [N]")
        for name in names:
            if name not in peak_forces:
                raise InvalidInput(f"peak force of {name}", None, "given, like those of the others")
        forces = dict(peak_forces)
    moments = arms * np.array([forces[name] for name in names])[:, None]
    return judge(names, moments, threshold=threshold)


def judge(
    names: Sequence[str],
    moments: np.ndarray,
    kept: Iterable[str] | None = None,
    threshold: float = THRESHOLD,
) -> tuple[Contribution, ...]:
    """Shares and verdicts of any set of muscles.

    Args:
        names: of the muscles.
        moments: largest moments about hip, knee, ankle (num_muscles, 3) [N m].
        kept: muscles that are in the model; default those that count.
        threshold: least share that counts.

    Raises:
        InvalidInput: shapes that do not fit, or a joint about which nothing acts.
    """
    moments = np.asarray(moments, dtype=float)
    if moments.shape != (len(names), len(JOINTS)):
        raise InvalidInput("shape of the moments", moments.shape, f"({len(names)}, {len(JOINTS)})")
    largest = moments.max(axis=0)
    if not (largest > 0.0).all():
        joint = JOINTS[int(np.argmin(largest))]
        raise InvalidInput(f"largest moment about the {joint}", largest.min(), "above 0 [N m]")
    shares = moments / largest
    counts = (shares >= threshold).any(axis=1)
    kept = set(np.array(names)[counts] if kept is None else kept)
    return tuple(
        Contribution(name, tuple(moment.tolist()), tuple(share.tolist()), bool(c), name in kept)
        for name, moment, share, c in zip(names, moments, shares, counts, strict=True)
    )


def printed_contributions(threshold: float = THRESHOLD) -> tuple[Contribution, ...]:
    """Table 1 of the paper; `kept` tells what Table 3 has, `counts` what the rule says."""
    rows = read_table("muscle_contributions")
    moments = [[float(row[f"{joint}_Nm"]) for joint in JOINTS] for row in rows]
    names = [row["muscle"] for row in rows]
    kept = [row["muscle"] for row in rows if row["kept"] == "yes"]
    return judge(names, np.array(moments), kept, threshold)


def printed_shares() -> dict[str, tuple[float, float, float]]:
    """The shares as Table 1 prints them, 0..1, by muscle."""
    return {
        row["muscle"]: tuple(float(row[f"{joint}_percent"]) / 100.0 for joint in JOINTS)
        for row in read_table("muscle_contributions")
    }


def compare(muscles: MuscleSet) -> tuple[Difference, ...]:
    """Table 1 beside a muscle table, muscle by muscle and joint by joint where either has a moment.

    Two things come out with Table 3 (docs/formulation.md 10, rows 8 and 9): the moments about the
    hip and most others are f_max times the arm, capacities and not the peaks of walking, while
    some belong to other forces than those printed; and two muscles pass the rule yet are dropped.
    """
    ours = {row.muscle: row for row in contributions(muscles)}
    names, arms = joint_arms(muscles)
    places = {name: i for i, name in enumerate(names)}
    found = []
    for row in printed_contributions():
        for k, joint in enumerate(JOINTS):
            printed = row.moments[k]
            if row.muscle not in places:
                if printed > 0.0:
                    remark = _remark_of_dropped(row, k)
                    found.append(
                        Difference(row.muscle, joint, printed, None, None, None, None, remark)
                    )
                continue
            place = places[row.muscle]
            arm, computed = float(arms[place, k]), ours[row.muscle].moments[k]
            if printed == 0.0 and computed == 0.0:
                continue
            implied = printed / arm if arm > 0.0 else None
            strongest = float(muscles.f_max[place])
            remark = ""
            if abs(computed - printed) > _SAME * printed:
                remark = f"implies {implied:.0f} N" if implied else "no such arm"
            found.append(
                Difference(row.muscle, joint, printed, computed, arm, implied, strongest, remark)
            )
    return tuple(found)


def _remark_of_dropped(row: Contribution, joint: int) -> str:
    if row.shares[joint] < THRESHOLD:
        return "neglected"
    return f"neglected, although {100.0 * row.shares[joint]:.2f} % of the largest"
