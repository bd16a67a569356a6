"""Figures 9 to 13: 2 kg on the right foot of a walker in three dimensions.

In the plane a weight on one foot can be answered by flexing and extending only. In space there
are seven more coordinates, and the paper finds that the answer is spread over them: each changes
less, the ground reactions hardly at all, while energy rises by 11 % (569.56 to 631.14 J/m) and
deviation from the measured stride from 3.06 to 3.40.

    python examples/paper/heavy_foot_spatial.py [FOLDER]

Also solves the planar pair, with which it is compared. The studies and the claims are in
drakegait/paper/heavy_foot_spatial.py.
"""

import sys
from pathlib import Path

from drakegait import compare, replay
from drakegait.paper.heavy_foot_spatial import CHAPTER, HEAVY, NORMAL
from drakegait.paper.measures import angle_changes, angle_names
from drakegait.paper.run import run

if __name__ == "__main__":  # the workers are processes that import this file
    folder = Path(*(sys.argv[1:2] or ["out/paper"]))
    results = run([CHAPTER], folder / "solves")

    normal, heavy = results.gaits[NORMAL], results.gaits[HEAVY]
    names = angle_names(normal)
    changes = angle_changes(normal, heavy, names)
    print("root mean square change over the stride [degree]")
    for name, change in sorted(zip(names, changes, strict=True), key=lambda item: -item[1]):
        print(f"  {name:24}{change:6.2f}  {'#' * round(10 * change)}")

    for finding in results.findings(CHAPTER):
        print(f"{finding.verdict.value:16}{finding.claim.what}: {finding.ours}")

    compare(normal, heavy, labels=["no weight", "2 kg"]).save(folder / "heavy_foot_spatial.html")
    replay(heavy, html=folder / "heavy_foot_spatial_replay.html")
