"""The muscle groups: strength, lengths and the paths that make them joint torques.

A muscle's path has constant moment arms r_i (Garcia-Vallejo & Schiehlen 2012, eqs. A.1, A.2),

    l = l_0 - sum_i r_i q_i,      torque_i = -f dl/dq_i = r_i f,

so one constant matrix A = `moment_arms` gives both: l = l0 - A q and torque = A^T f.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields

import numpy as np

from drakegait.errors import InvalidInput, UnknownName
from drakegait.quantities import is_number
from drakegait.walker import coordinates
from drakegait.walker.data_table import read_table
from drakegait.walker.subject import Subject

SPECIFIC_TENSION = 0.25e6
"""Maximal force per cross-section of muscle [N/m^2] (Umberger et al. 2003)."""

DENSITY = 1059.7
"""Density of muscle [kg/m^3] (Umberger et al. 2003)."""

PLANAR_SETS = ("table3", "gait2d")
"""The two tables of planar muscle groups."""

STRENGTH_LIMITS = (0.01, 10.0)
"""Allowed factors on a muscle's maximal force."""

ENTRY_FACTOR = 5.0
"""An entry of the table may be changed to so many times its value, or to its inverse."""
ENTRY_UNITS = {"f_max": "N", "l_opt": "m", "l_slack": "m", "l0": "m", "width": "-"}
_CHANGEABLE = {
    "f_max": "f_max_N",
    "l_opt": "l_opt_m",
    "l_slack": "l_slack_m",
    "l0": "l0_m",
    "width": "width",
}
# Reflection in the sagittal plane turns rotations about x and z over (eq. A.2).
_LATERAL = ("hip_adduction", "hip_rotation")


@dataclass(frozen=True, eq=False)
class MuscleSet:
    """Constants of all muscles of a walker; right leg first, then left, in table order.

    Attributes:
        kind: `"spatial"` (28 muscles) or `"planar"` (16).
        names: names with side, (`"soleus_r"`, ...).
        abbreviations: the paper's name of the group of each muscle (`"SOL"`), without side.
        f_max: (num_muscles,) maximal isometric force along the fibres [N].
        l_opt: (num_muscles,) optimal fibre length [m].
        l_slack: (num_muscles,) slack length of the tendon [m].
        pennation: (num_muscles,) pennation angle at optimal fibre length [rad].
        fast_twitch: (num_muscles,) fraction of fast-twitch fibres, 0..1.
        width: (num_muscles,) half width of the force-length parabola, in optimal lengths.
        l0: (num_muscles,) path length with all coordinates zero [m].
        moment_arms: (num_muscles, num_coordinates) in plant signs [m].
    """

    kind: str
    names: tuple[str, ...]
    abbreviations: tuple[str, ...]
    f_max: np.ndarray
    l_opt: np.ndarray
    l_slack: np.ndarray
    pennation: np.ndarray
    fast_twitch: np.ndarray
    width: np.ndarray
    l0: np.ndarray
    moment_arms: np.ndarray

    def __post_init__(self) -> None:
        for field in fields(self):
            value = getattr(self, field.name)
            if isinstance(value, np.ndarray):
                value.setflags(write=False)

    @classmethod
    def load(
        cls,
        kind: str,
        subject: Subject | None = None,
        planar_set: str = "table3",
        strength: Mapping[str, float] | None = None,
        changes: Mapping[str, Mapping[str, float]] | None = None,
    ) -> MuscleSet:
        """The muscles of a subject: lengths scale with height, forces with body mass.

        Args:
            kind: `"spatial"` or `"planar"` skeleton.
            subject: default 1.80 m, 75 kg.
            planar_set: which table of planar groups: `"table3"` (the paper's) or `"gait2d"`
                (Ackermann & van den Bogert 2010). No meaning for the spatial skeleton.
            strength: factor on the maximal force by muscle (`"soleus_r"`) or by group, both
                sides (`"soleus"` or `"SOL"`); factors that name one muscle multiply. A muscle's
                mass follows its force.
            changes: other values for table entries `f_max` [N], `l_opt`, `l_slack`, `l0` [m] or
                `width` of a muscle or group, for 1.80 m and 75 kg (scaled like the table). For
                example `{"SOL": {"l_slack": 0.245}}`, a likely misprint of the paper set right.

        Raises:
            UnknownName: for a skeleton, set, muscle or entry that does not exist.
            InvalidInput: for a factor or value out of range.
        """
        subject = Subject() if subject is None else subject
        columns = coordinates.index(kind)
        if planar_set not in PLANAR_SETS:
            raise UnknownName("planar muscle set", planar_set, PLANAR_SETS)
        rows = read_table(
            "muscles_spatial" if kind == "spatial" else f"muscles_planar_{planar_set}"
        )
        sided = [dict(row, side=side) for side in ("r", "l") for row in rows]
        names = tuple(f"{row['name']}_{row['side']}" for row in sided)
        groups = tuple(row["abbreviation"] for row in sided)

        for name, entries in (changes or {}).items():
            for i in select(name, names, groups):
                for entry, value in entries.items():
                    column_name = _table_column(entry)
                    usual = float(rows[i % len(rows)][column_name])
                    allowed = usual, ENTRY_UNITS[entry]
                    sided[i][column_name] = _entry(f"{entry} of {name}", value, *allowed)
        factor = np.ones(len(names))
        for name, value in (strength or {}).items():
            factor[select(name, names, groups)] *= _strength(name, value)

        def column(header: str) -> np.ndarray:
            return np.array([float(row[header]) for row in sided])

        arms = np.zeros((len(names), len(columns)))
        for i, row in enumerate(sided):
            for joint in ("hip_adduction", "hip_flexion", "hip_rotation", "knee_flexion",
                          "ankle_dorsiflexion"):  # fmt: skip
                if f"{joint}_m" in row:
                    sign = -1.0 if row["side"] == "l" and joint in _LATERAL else 1.0
                    arms[i, columns[f"{joint}_{row['side']}"]] = sign * float(row[f"{joint}_m"])
        return cls(
            kind=kind,
            names=names,
            abbreviations=groups,
            f_max=column("f_max_N") * factor * subject.mass_scale,
            l_opt=column("l_opt_m") * subject.length_scale,
            l_slack=column("l_slack_m") * subject.length_scale,
            pennation=np.deg2rad(column("pennation_deg")),
            fast_twitch=column("fast_twitch_fraction"),
            width=column("width"),
            l0=column("l0_m") * subject.length_scale,
            moment_arms=arms * subject.length_scale,
        )

    def find(self, group: str, side: str) -> list[int]:
        """Positions of a group (`"soleus"` or `"SOL"`) on a side (`"r"` or `"l"`).

        Raises:
            UnknownName: if there is no such group.
        """
        known = tuple(dict.fromkeys(name[:-2] for name in self.names))
        found = [
            i
            for i, (name, short) in enumerate(zip(self.names, self.abbreviations, strict=True))
            if group in (name[:-2], short) and name.endswith(f"_{side}")
        ]
        if not found:
            raise UnknownName("muscle group", group, known)
        return found

    def without(self, gone: np.ndarray) -> MuscleSet:
        """The set without the muscles of the mask `gone` (num_muscles,)."""
        kept = np.flatnonzero(~np.asarray(gone))
        values = {}
        for field in fields(self):
            value = getattr(self, field.name)
            if isinstance(value, np.ndarray):
                values[field.name] = value[kept]
            elif isinstance(value, tuple):
                values[field.name] = tuple(value[i] for i in kept)
            else:
                values[field.name] = value
        return MuscleSet(**values)

    @property
    def num_muscles(self) -> int:
        """Number of muscles of both legs."""
        return len(self.names)

    @property
    def mass(self) -> np.ndarray:
        """(num_muscles,) masses with Umberger's specific tension and density [kg]."""
        return self.masses()

    def masses(
        self, specific_tension: float = SPECIFIC_TENSION, density: float = DENSITY
    ) -> np.ndarray:
        """(num_muscles,) masses m = (f_max / sigma) rho l_opt [kg] (Umberger et al. 2003)."""
        return self.f_max / specific_tension * density * self.l_opt

    def lengths(self, q: np.ndarray) -> np.ndarray:
        """Path lengths l = l0 - A q [m] of muscle and tendon.

        Args:
            q: (..., num_coordinates) coordinates in plant signs [m, rad].

        Returns:
            (..., num_muscles).
        """
        return self.l0 - np.asarray(q) @ self.moment_arms.T

    def length_rates(self, rates: np.ndarray) -> np.ndarray:
        """Derivatives of the path lengths, l' = -A q' (or l'' = -A q'').

        Args:
            rates: (..., num_coordinates) velocities or accelerations.

        Returns:
            (..., num_muscles) [m/s] or [m/s^2].
        """
        return -(np.asarray(rates) @ self.moment_arms.T)

    def joint_torques(self, forces: np.ndarray) -> np.ndarray:
        """Generalised forces A^T f of the muscles [N m]; zero in the rows of the HAT.

        Args:
            forces: (..., num_muscles) tendon forces [N].

        Returns:
            (..., num_coordinates) in plant signs.
        """
        return np.asarray(forces) @ self.moment_arms


def select(name: str, names: tuple[str, ...], groups: tuple[str, ...]) -> list[int]:
    """Positions of the muscle `name`, or of both muscles of the group `name`."""
    found = [i for i, full in enumerate(names) if name in (full, full[:-2], groups[i])]
    if not found:
        raise UnknownName("muscle", name, names)
    return found


def _table_column(entry: str) -> str:
    if entry not in _CHANGEABLE:
        raise UnknownName("muscle entry", entry, _CHANGEABLE)
    return _CHANGEABLE[entry]


def _entry(name: str, value: float, usual: float, unit: str) -> float:
    """Refuse what is far from the table: most likely another unit."""
    low, high = usual / ENTRY_FACTOR, usual * ENTRY_FACTOR
    if not is_number(value) or not low <= value <= high:
        allowed = f"a number from {low:.3g} to {high:.3g} [{unit}]; the table has {usual:g}"
        raise InvalidInput(name, value, allowed)
    return value


def _strength(name: str, value: float) -> float:
    low, high = STRENGTH_LIMITS
    if not is_number(value) or not low <= value <= high:
        raise InvalidInput(f"strength of {name}", value, f"a factor from {low:g} to {high:g}")
    return value
