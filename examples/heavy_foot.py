"""A heavy foot: what do 2 kg on the right foot change?

The paper's disorder. A person who wears a weight on one foot walks asymmetrically, spends more
energy and deviates more from normal walking. We solve for the normal walk, put the weight on and
solve again from there; both legs are free to move in their own way.

Two three-dimensional solves take some minutes. For a quick look in the sagittal plane:

    python examples/heavy_foot.py [FOLDER] --planar
"""

import sys
from pathlib import Path

from drakegait import GaitStudy, plot, solve

words = [word for word in sys.argv[1:] if word != "--planar"]
folder = Path(words[0] if words else "out/heavy_foot")
folder.mkdir(parents=True, exist_ok=True)

normal = GaitStudy.planar() if "--planar" in sys.argv else GaitStudy.spatial(nodes=18)
heavy = normal.with_added_mass("foot_r", 2.0)  # [kg], at the foot's centre of mass


def show(now):
    print(f"\riteration {now.iteration}, cost {now.cost:.4g}   ", end="", flush=True)


gaits = {"normal": solve(normal, report=show)}
gaits["2 kg on the right foot"] = solve(heavy, guess=gaits["normal"], report=show)
print()

# Both gaits are judged by the same reference stride, at the same speed.
answers = {
    "status": lambda gait: gait.outcome.status,
    "cost of transport [J/m]": lambda gait: f"{gait.metabolic.cost_of_transport:.1f}",
    "deviation [s]": lambda gait: f"{gait.report.deviation:.3f}",
    "stride time [s]": lambda gait: f"{gait.stride_time:.3f}",
    "step length right [m]": lambda gait: f"{gait.placement.step_length_right:.3f}",
    "step length left [m]": lambda gait: f"{gait.placement.step_length_left:.3f}",
    "iliopsoas right [J/m]": lambda gait: f"{gait.metabolic.by_muscle['iliopsoas_r']:.1f}",
    "iliopsoas left [J/m]": lambda gait: f"{gait.metabolic.by_muscle['iliopsoas_l']:.1f}",
    "check passed": lambda gait: "yes" if gait.report.passed else "no",
}
print(f"{'':26}" + "".join(f"{name:>24}" for name in gaits))
for name, read in answers.items():
    print(f"{name:26}" + "".join(f"{read(gait):>24}" for gait in gaits.values()))

# Where does the energy go? The muscles whose share changed most.
shares = [gait.metabolic.by_muscle for gait in gaits.values()]
change = {name: shares[1][name] - shares[0][name] for name in shares[0]}
print("\nlargest changes [J/m]:")
for name in sorted(change, key=lambda name: -abs(change[name]))[:5]:
    print(f"  {name:28}{change[name]:+.1f}")

for name, gait in gaits.items():
    gait.save(folder / f"{name.split()[0].replace('2', 'heavy')}.nc")
plot(gaits["2 kg on the right foot"], folder / "figures", others=[gaits["normal"]])
print(f"\nfigures and gaits are in {folder}")
