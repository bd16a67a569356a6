"""Sensitivity to the rulings: what the paper leaves open, taken one way and the other."""

from __future__ import annotations

from drakegait.paper import charts, tables
from drakegait.paper.bases import SMALL, small
from drakegait.paper.chapter import Chapter, Studies
from drakegait.paper.claim import Claim
from drakegait.paper.numbers import Gaits, Numbers
from drakegait.solvers.options import SolverOptions

LIMITS = SolverOptions(max_iterations=300, time_limit=600.0)
"""A ruling under which nobody can walk would be tried for an hour."""
APART = ("B.2 as printed", "full width")
"""Muscles so different that the forces of the base are no start: from the reference, by IPOPT with
MUMPS, which finds a way where `condensed` gives up."""

SETTINGS = {
    "B.2 as printed": {"force_length": "printed"},
    "C.1 as printed": {"activation_dynamics": "printed"},
    "full width": {"width": "full"},
    "least force 0.002": {"min_force": 0.002},
    "least force 5e-5": {"min_force": 0.00005},
    "force-velocity floor 0.05": {"force_velocity_floor": 0.05},
    "energy of 2010": {"energy.model": "umberger2010"},
    "heat floor before S": {"heat_floor": "activation"},
    "anaerobic scaling 1": {"aerobic_scaling": 1.0},
    "fast speed by Hill": {"fast_speed": "hill"},
    "orderly recruitment": {"recruitment": "orderly"},
    "basal rate": {"basal": True},
    "time constants 50, 65 ms": {"time_constants": "fixed"},
    "time constants 15, 30 ms": {
        "time_constants": "fixed", "time_activation": 0.015, "time_deactivation": 0.030,
    },
    "no damping": {"damping_hip": 0.0, "damping_knee": 0.0},
    "damping x3": {"damping_hip": 3.0, "damping_knee": 1.2},
    "no passive moments": {"scale": 0.0},
    "other passive moments": {"passive.model": "double_exponential"},
    "friction 0.4": {"friction": 0.4},
    "friction 0.8": {"friction": 0.8},
    "slope factor 2": {"slope_factor": 2.0},
    "eccentric limit 1.4": {"f_asympt": 1.4},
    "tendon strain 0.05": {"tendon_strain": 0.05},
    "constant pennation": {"pennation_model": "constant_angle"},
    "sigma as printed": {"sigma_rule": "printed"},
    "one sigma_max": {"groups": "single"},
    "2 N for translations": {"force_tolerance": 2.0},
}  # fmt: skip
"""Name -> settings. Each changes one ruling of docs/formulation.md 10, 11."""
STATEMENTS = {
    "SOL slack 0.245 m": {"muscle_changes": {"SOL": {"l_slack": 0.245}}},
    "TA l_0 38.1 cm": {"muscle_changes": {"TA": {"l0": 0.381}}},
    "forces of Table 1": {"muscle_changes": {
        "SOL": {"f_max": 3016.0}, "TA": {"f_max": 1003.0}, "GAS": {"f_max": 1651.0},
        "VAS": {"f_max": 6865.0},
    }},
    "muscles of gait2d": {"planar_muscles": "gait2d"},
}  # fmt: skip
"""Name -> statements of the study."""
NAMES = (*SETTINGS, *STATEMENTS)


def studies() -> Studies:
    """The base and one study for each ruling."""
    base = small()
    found = {SMALL: base}
    found |= {name: base.with_settings(**values) for name, values in SETTINGS.items()}
    return found | {name: base.replace(**values) for name, values in STATEMENTS.items()}


def changes(n: Numbers) -> dict[str, tuple[float, float]]:
    """Change of energy and deviation by each ruling [%], the largest change of energy first."""
    energy, deviation = n.energy(SMALL), n.deviation(SMALL)
    found = {
        name: (100.0 * (n.energy(name) / energy - 1.0),
               100.0 * (n.deviation(name) / deviation - 1.0))
        for name in NAMES if n.solved(name)
    }  # fmt: skip
    return dict(sorted(found.items(), key=lambda item: -abs(item[1][0])))


def _most(n: Numbers) -> str:
    found = changes(n)
    most = [f"{name} {energy:+.0f} %" for name, (energy, _) in list(found.items())[:5]]
    little = sum(abs(energy) < 2.0 for energy, _ in found.values())
    failed = [f"{name} (does not hold: {n.rows[name].get('not_held') or 'not recorded'})"
              for name in NAMES if name in n.rows and not n.solved(name)]  # fmt: skip
    text = f"most: {', '.join(most)}; below 2 %: {little} of {len(found)}"
    return text + (f"; not converged: {', '.join(failed)}" if failed else "")


CHAPTER = Chapter(
    name="rulings",
    title="What the paper leaves open",
    place="Appendices A to C, formulation 10 and 11",
    about="Symmetric in the plane, 19 nodes. One ruling at a time is taken the other way, from the "
    "gait of the base, so that a reader sees which unknown matters; "
    f"{' and '.join(APART)} from the reference, by IPOPT with MUMPS. Where there is no answer, the "
    "table says which law the last gait holds least.",
    studies=studies,
    warm=dict.fromkeys((name for name in NAMES if name not in APART), SMALL),
    options=dict.fromkeys(NAMES, LIMITS)
    | dict.fromkeys(APART, LIMITS.replace(solver="ipopt-mumps")),
    claims=(
        Claim("Which unknown of the paper changes E^t most?", "-", "", _most, None,
              why="The paper does not give these constants or prints them with slips. A reading "
              "under which no walk is found is no proof that there is none."),
    ),
    tables=lambda n: [tables.studies(n, [SMALL, *NAMES], "One ruling at a time", base=SMALL)],
    figures={
        "Change of energy and deviation": lambda gaits, n: _figure(gaits, n),
    },
)  # fmt: skip


def _figure(gaits: Gaits, n: Numbers) -> str:
    return charts.bars(changes(n), ("E^t [% of base]", "J_dev [% of base]"), "rulings")
