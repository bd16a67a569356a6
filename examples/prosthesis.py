"""A transtibial prosthesis: how does the other leg pay, and what does a stiffer foot change?

The right leg ends below the knee. Soleus, gastrocnemius and tibialis anterior are gone; a passive
foot of some stiffness category takes their place. A passive foot cannot do more work than it has
taken, so push-off has to come from the other leg and from the hips.

Cost of transport has to be read with care: this walker feels no socket, needs no balance and has
no fear, and an ideal spring that replaces muscles is cheap (docs/disorders.md).

    python examples/prosthesis.py [FOLDER] [--spatial]
"""

import sys
from pathlib import Path

import numpy as np

from drakegait import GaitStudy, plot, solve
from drakegait.walker import disorders as dis

words = [word for word in sys.argv[1:] if word != "--spatial"]
folder = Path(words[0] if words else "out/prosthesis")
folder.mkdir(parents=True, exist_ok=True)

normal = GaitStudy.spatial(nodes=18) if "--spatial" in sys.argv else GaitStudy.planar()
studies = {"normal": normal}
for category in (2, 4, 8):
    studies[f"category {category}"] = normal.with_disorder(dis.Prosthesis("r", category))

gaits, last = {}, None
for name, study in studies.items():
    print(f"solving {name} ...", flush=True)
    gaits[name] = last = solve(study, guess=last)


def ankle(gait, side):
    """Positive and negative work of an ankle in a stride [J/kg]."""
    power = gait.sample().joint_power.sel(joint=f"ankle_dorsiflexion_{side}").values[:-1]
    scale = gait.stride_time / gait.study.subject.mass
    return scale * np.maximum(power, 0.0).mean(), scale * np.minimum(power, 0.0).mean()


def stance(gait, side):
    """Stance of a foot [% of the stride]."""
    events = gait.values.events
    return 100.0 * (events[6] - events[0] if side == "r" else 1.0 + events[2] - events[4])


def peak_force(gait, foot):
    """Largest vertical force on a foot [% of body weight]."""
    force = gait.sample().ground_reaction_force.sel(foot=foot, axis="z")
    return 100.0 * float(force.max()) / (9.81 * gait.study.subject.mass)


answers = {"status": lambda gait: gait.outcome.status}
for side, word in (("r", "right"), ("l", "left")):
    answers |= {
        f"push-off {word} [J/kg]": lambda gait, s=side: f"{ankle(gait, s)[0]:.3f}",
        f"taken up {word} [J/kg]": lambda gait, s=side: f"{ankle(gait, s)[1]:.3f}",
        f"stance {word} [%]": lambda gait, s=side: f"{stance(gait, s):.1f}",
        f"peak force {word} [% bw]": lambda gait, w=word: f"{peak_force(gait, w):.0f}",
    }
answers["cost of transport [J/m]"] = lambda gait: f"{gait.metabolic.cost_of_transport:.1f}"
answers["check passed"] = lambda gait: "yes" if gait.report.passed else "no"
print(f"{'':26}" + "".join(f"{name:>14}" for name in gaits))
for name, read in answers.items():
    print(f"{name:26}" + "".join(f"{read(gait):>14}" for gait in gaits.values()))

for name, gait in gaits.items():
    gait.save(folder / f"{name.replace(' ', '_')}.nc")
plot(gaits["category 4"], folder / "figures", others=[gaits["normal"]])
print(f"\nfigures and gaits are in {folder}")
