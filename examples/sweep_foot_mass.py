"""Many studies at once: from 0 to 4 kg on the right foot, each walk started from the one before.

    drakegait sweep examples/sweep_foot_mass.py

or, as a program of its own, `python examples/sweep_foot_mass.py [FOLDER]`.
"""

import sys

from drakegait import GaitStudy, sweep

normal = GaitStudy.planar(nodes=18, speed=1.2)  # [m/s]
studies = {"0 kg": normal}
for kilograms in (1.0, 2.0, 3.0, 4.0):
    studies[f"{kilograms:g} kg"] = normal.with_added_mass("foot_r", kilograms)

names = list(studies)
warm = dict(zip(names[1:], names, strict=False))  # 1 kg from 0 kg, 2 kg from 1 kg, ...

if __name__ == "__main__":  # the workers import this file, too
    result = sweep(studies, *(sys.argv[1:2] or ["out/foot_mass"]), warm=warm)
    print(result.table()[["status", "cost_of_transport_J_per_m", "deviation_s"]])
    result.plot()
