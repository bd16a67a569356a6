"""A weak muscle: what does walking cost with half a soleus, and what does an orthosis give back?

Soleus is the strongest muscle of push-off. We take half, then four fifths of the strength of the
left calf, and then put an ankle-foot orthosis on that leg: a spring that is wound up while the
body rolls over the foot and gives back what it took. Each walk starts from the one before.

In the sagittal plane this takes some minutes; `--spatial` takes longer.

    python examples/weak_muscle.py [FOLDER] [--spatial]
"""

import sys
from pathlib import Path

import numpy as np

from drakegait import GaitStudy, plot, solve
from drakegait.walker import disorders as dis

words = [word for word in sys.argv[1:] if word != "--spatial"]
folder = Path(words[0] if words else "out/weak_muscle")
folder.mkdir(parents=True, exist_ok=True)

normal = GaitStudy.spatial(nodes=18) if "--spatial" in sys.argv else GaitStudy.planar()
half = normal.with_disorder(dis.Weakness("soleus", "l", 0.5))
paresis = normal.with_disorder(
    dis.Weakness("soleus", "l", 0.2), dis.Weakness("gastrocnemius", "l", 0.2)
)
braced = paresis.with_disorder(dis.Orthosis("l", 200.0, mass=0.4))  # [N m/rad], [kg]

studies = {"normal": normal, "half a soleus": half, "weak calf": paresis, "with orthosis": braced}
gaits, last = {}, None
for name, study in studies.items():
    print(f"solving {name} ...", flush=True)
    gaits[name] = last = solve(study, guess=last)


def muscle_work(gait, names):
    """Positive work of muscles with their tendons in a stride [J]."""
    power = gait.sample().muscle_work_rate.sel(muscle=names).values[:-1]
    return float(np.maximum(power, 0.0).mean(axis=0).sum() * gait.stride_time)


def push_off(gait, side):
    """Largest power of an ankle, orthosis included [W/kg]."""
    power = gait.sample().joint_power.sel(joint=f"ankle_dorsiflexion_{side}")
    return float(power.max()) / gait.study.subject.mass


calf = ["soleus_l", "gastrocnemius_l"]
answers = {
    "status": lambda gait: gait.outcome.status,
    "cost of transport [J/m]": lambda gait: f"{gait.metabolic.cost_of_transport:.1f}",
    "deviation [s]": lambda gait: f"{gait.report.deviation:.3f}",
    "work of left calf [J]": lambda gait: f"{muscle_work(gait, calf):.1f}",
    "push-off left [W/kg]": lambda gait: f"{push_off(gait, 'l'):.2f}",
    "push-off right [W/kg]": lambda gait: f"{push_off(gait, 'r'):.2f}",
    "check passed": lambda gait: "yes" if gait.report.passed else "no",
}
print(f"{'':26}" + "".join(f"{name:>16}" for name in gaits))
for name, read in answers.items():
    print(f"{name:26}" + "".join(f"{read(gait):>16}" for gait in gaits.values()))

for name, gait in gaits.items():
    gait.save(folder / f"{name.replace(' ', '_')}.nc")
plot(gaits["weak calf"], folder / "figures", others=[gaits["normal"], gaits["with orthosis"]])
print(f"\nfigures and gaits are in {folder}")
