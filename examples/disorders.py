"""Every kind of disorder in one table: what does each do to energy, push-off, load and timing?

Each walk is found from the normal one. Push-off is the positive work of the ankle, of muscles and
of what replaces them; optima are local, so that differences of a few per cent of the energy say
nothing (docs/disorders.md).

    python examples/disorders.py [FOLDER] [--spatial]
"""

import sys
from pathlib import Path

import numpy as np

from drakegait import GaitStudy, solve
from drakegait.walker import disorders as dis

words = [word for word in sys.argv[1:] if word != "--spatial"]
folder = Path(words[0] if words else "out/disorders")
folder.mkdir(parents=True, exist_ok=True)

normal = GaitStudy.spatial(nodes=18) if "--spatial" in sys.argv else GaitStudy.planar()
calf = [dis.Weakness("soleus", "l", 0.2), dis.Weakness("gastrocnemius", "l", 0.2)]
short = [dis.Contracture("soleus", "l", 0.8), dis.Contracture("gastrocnemius", "l", 0.8)]
studies = {
    "normal": normal,
    "2 kg on the right foot": normal.with_added_mass("foot_r", 2.0),
    "soleus left 50 %": normal.with_disorder(dis.Weakness("soleus", "l", 0.5)),
    "calf left 20 %": normal.with_disorder(*calf),
    "  with orthosis 200 N m/rad": normal.with_disorder(*calf, dis.Orthosis("l", 200.0)),
    "orthosis left 150 N m/rad": normal.with_disorder(dis.Orthosis("l", 150.0)),
    "prosthesis right 4": normal.with_disorder(dis.Prosthesis("r", 4)),
    "prosthesis right 1": normal.with_disorder(dis.Prosthesis("r", 1)),
    "prosthesis right 9": normal.with_disorder(dis.Prosthesis("r", 9)),
    "calf left shortened 80 %": normal.with_disorder(*short),
    "hamstrings left >= 10 %": normal.with_disorder(dis.Spasticity("hamstrings", "l", 0.1)),
    "knee left + 40 N m/rad": normal.with_disorder(dis.JointStiffness("knee", "l", 40.0, 5.0)),
    "knee left <= 40 degrees": normal.with_disorder(dis.LimitedRange("knee", "l", high=40.0)),
    "shank left 20 mm shorter": normal.with_disorder(dis.LegLength("shank", "l", -0.02)),
    "pain right foot 3": normal.with_disorder(dis.Pain("foot", "r", 3.0)),
    "pain right knee 5": normal.with_disorder(dis.Pain("knee", "r", 5.0)),
    "step ratio r/l 1.15": normal.with_disorder(dis.Asymmetry("step_length", 1.15)),
    "stance ratio r/l 1.08": normal.with_disorder(dis.Asymmetry("stance_time", 1.08)),
}


def push_off(gait, side):
    """Positive work of an ankle in a stride [J/kg]."""
    power = gait.sample().joint_power.sel(joint=f"ankle_dorsiflexion_{side}").values[:-1]
    return gait.stride_time / gait.study.subject.mass * np.maximum(power, 0.0).mean()


def peak_force(gait, foot):
    """Largest vertical force on a foot [% of body weight]."""
    force = gait.sample().ground_reaction_force.sel(foot=foot, axis="z")
    return 100.0 * float(force.max()) / (9.81 * gait.study.subject.mass)


def stance(gait, side):
    """Stance of a foot [% of the stride]."""
    events = gait.values.events
    return 100.0 * (events[6] - events[0] if side == "r" else 1.0 + events[2] - events[4])


head = "energy J/m  deviation s  push-off J/kg   peak force % bw   stance %       steps m"
print(f"{'':28}{head}\n{'':53}right  left     right  left    right  left   right  left")
first = None
for name, study in studies.items():
    print(f"solving {name.strip()} ...", end="\r", flush=True)
    gait = solve(study, guess=first)
    first = first or gait
    steps = gait.placement
    passed = gait.converged and gait.report.passed
    print(
        f"{name:28}{gait.metabolic.cost_of_transport:10.1f}{gait.report.deviation:13.3f}"
        f"{push_off(gait, 'r'):7.2f}{push_off(gait, 'l'):6.2f}"
        f"{peak_force(gait, 'right'):10.0f}{peak_force(gait, 'left'):6.0f}"
        f"{stance(gait, 'r'):9.1f}{stance(gait, 'l'):6.1f}"
        f"{steps.step_length_right:8.3f}{steps.step_length_left:6.3f}"
        f"{'' if passed else '   NOT PASSED'}"
    )
    gait.save(folder / f"{name.strip().replace(' ', '_').replace('/', '_')}.nc")
print(f"\nfigures and gaits are in {folder}")
