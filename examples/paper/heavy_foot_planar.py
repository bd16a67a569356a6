"""Figures 6 to 8: 2 kg on the right foot of a walker in the sagittal plane.

A walker whose legs move independently could be asymmetric because its reference is. So the paper
takes as reference a walk that is symmetric by construction, the one with 35 nodes of Table 2,
and puts the weight on: what is asymmetric now comes from the weight. It finds that energy and
deviation rise, that the heavy foot is lifted less, that the *other* leg adapts, that muscles of
the heavy side work wider and higher, and that it pushes harder at the end of its stance.

    python examples/paper/heavy_foot_planar.py [FOLDER]

Needs the gaits of convergence.py and solves them first if they are not there. The studies and
the claims are in drakegait/paper/heavy_foot_planar.py.
"""

import sys
from pathlib import Path

from drakegait import compare
from drakegait.paper.heavy_foot_planar import CHAPTER, HEAVY, NORMAL
from drakegait.paper.run import run

if __name__ == "__main__":  # the workers are processes that import this file
    folder = Path(*(sys.argv[1:2] or ["out/paper"]))
    results = run([CHAPTER], folder / "solves")

    normal, heavy = results.gaits[NORMAL], results.gaits[HEAVY]
    # Where does the energy go? The muscles that change most.
    before, after = normal.metabolic.by_muscle, heavy.metabolic.by_muscle
    for name in sorted(before, key=lambda name: -abs(after[name] - before[name]))[:5]:
        print(f"{name:28}{before[name]:7.1f} J/m{after[name] - before[name]:+7.1f}")

    for finding in results.findings(CHAPTER):
        print(f"{finding.verdict.value:16}{finding.claim.what}: {finding.ours}")

    compare(normal, heavy, labels=["no weight", "2 kg"]).save(folder / "heavy_foot_planar.html")
