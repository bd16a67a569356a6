"""The conclusions' symmetric walker in space: how much does its trunk move aside?

People turn the pelvis one way and the trunk the other. A walker whose pelvis and trunk are one
body cannot, and the paper reports that such a walker, made symmetric, hardly leaves the sagittal
plane. It gives no number. We look at list, rotation and sway of that body beside those of the
reference, which has the motion of a measured pelvis.

    python examples/paper/spatial_symmetric.py [FOLDER]

The study and the claim are in drakegait/paper/spatial_symmetric.py.
"""

import sys
from pathlib import Path

from drakegait import plot
from drakegait.paper.run import run
from drakegait.paper.spatial_symmetric import CHAPTER, SYMMETRIC

if __name__ == "__main__":  # the workers are processes that import this file
    folder = Path(*(sys.argv[1:2] or ["out/paper"]))
    results = run([CHAPTER], folder / "solves")

    gait = results.gaits[SYMMETRIC]
    curves = gait.sample()
    print(f"{'range over the stride':24}{'ours':>9}{'reference':>11}")
    for name in curves.coordinate.values[1:]:  # without the advance
        ours, reference = (curves[kind].sel(coordinate=name).values
                           for kind in ("coordinates", "reference_coordinates"))  # fmt: skip
        print(f"{name:24}{ours.max() - ours.min():9.3f}{reference.max() - reference.min():11.3f}")

    for finding in results.findings(CHAPTER):
        print(f"{finding.verdict.value:16}{finding.claim.what}: {finding.ours}")

    plot(gait, folder / "figures_spatial_symmetric")
