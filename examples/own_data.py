"""Your own data: from a laboratory's files to a walk of that person.

Nobody's measurement can be shipped along, so this program first plays the laboratory: it writes a
motion file and a force file as they could come from one, three and a half strides of the embedded
walk on a subject of 1.75 m and 68 kg, with noise of half a degree. Replace `record` by your files
and the rest stays as it is; docs/your_own_data.md says which files are understood.

    python examples/own_data.py [FOLDER]
"""

import sys
from pathlib import Path

import numpy as np
import pandas as pd

from drakegait import GaitStudy, Reference, Subject, solve
from drakegait.measured import import_walk
from drakegait.walker.coordinates import to_anatomical

folder = Path(sys.argv[1] if len(sys.argv) > 1 else "out/own_data")
folder.mkdir(parents=True, exist_ok=True)
person = Subject(height=1.75, mass=68.0)  # [m], [kg]


def record(motion: Path, forces: Path) -> None:
    """Write what a laboratory would: angles at 100 Hz, force plates at 1000 Hz."""
    walk = Reference.embedded("spatial", person)
    length = walk.foot_placement.stride_length
    for path, rate in ((motion, 100.0), (forces, 1000.0)):
        time = np.arange(round(3.5 * walk.stride_time * rate)) / rate
        tau = time / walk.stride_time - 0.3  # recording begins before a right heel strike
        if path == motion:
            values = to_anatomical("spatial", walk.coordinate_values(tau))
            values[:, 0] += length * tau  # hat_x advances
            noise = np.random.default_rng(1).normal(size=values.shape)
            turns = np.array([not name.startswith(("hat_x", "hat_y", "hat_z"))
                              for name in walk.coordinates])  # fmt: skip
            values = np.where(turns, np.degrees(values) + 0.5 * noise, values + 0.002 * noise)
            table = pd.DataFrame(values, columns=list(walk.coordinates))
        else:
            feet = walk.ground_reactions(tau)  # forward, left, up
            for foot in (0, 1):  # whole steps, with room before and after
                feet[(tau < 0.3 * foot) | (tau > 3.0 - 0.8 * foot), foot] = 0.0
            table = pd.DataFrame({
                f"ground_force_{side}_v{axis}": sign * feet[:, foot, row]
                for foot, side in enumerate("rl")
                for axis, row, sign in (("x", 0, 1.0), ("y", 2, 1.0), ("z", 1, -1.0))
            })  # fmt: skip
        table.insert(0, "time", time)
        table.to_csv(path, index=False)


files = folder / "motion.csv", folder / "forces.csv"
record(*files)

# 1. The measurement becomes a reference. Read the quality page before you believe the rest.
walk = import_walk(*files, height=person.height, mass=person.mass)
walk.save(folder / "subject.nc")
print(f"speed         {walk.reference.speed:.2f} m/s")
print("remarks")
for sentence in walk.warnings:
    print(f"  - {sentence}")

# 2. A walk of this person, held to this stride. In the plane, for a quick look.
gait = solve(GaitStudy.planar(reference=walk.planar_reference, subject=walk.subject,
                              speed=walk.reference.speed))  # fmt: skip
print(f"solve         {gait.outcome.status}")
print(f"deviation     {gait.report.deviation:.2f} s")
print(f"check         {'passed' if gait.report.passed else 'NOT passed'}")
gait.save(folder / "gait.nc")
