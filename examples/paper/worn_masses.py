"""Masses on one foot, both feet, shank, thigh and waist.

The paper puts 2 kg on one foot. How does the answer grow with the mass, is a second heavy foot a
relief because the walk is even again, and is a mass dearer the farther from the trunk it is
worn, as people find? The planar walker against the embedded stride.

    python examples/paper/worn_masses.py [FOLDER]

The masses, places and rules are in drakegait/paper/worn_masses.py.
"""

import sys
from pathlib import Path

from drakegait.paper.run import run
from drakegait.paper.worn_masses import BASE, CHAPTER

if __name__ == "__main__":  # the workers are processes that import this file
    folder = Path(*(sys.argv[1:2] or ["out/paper"]))
    results = run([CHAPTER], folder / "solves")

    base = results.gaits[BASE].metabolic.cost_of_transport
    print(f"nothing worn: {base:.1f} J/m")
    for name in CHAPTER.own_names:
        gait = results.gaits.get(name)
        if gait is not None and name != BASE:
            worn = sum(item.mass for item in gait.study.added_masses)
            more = gait.metabolic.cost_of_transport - base
            print(f"{name:20}{more:+8.1f} J/m,{more / worn:+7.1f} for each kilogram")

    for finding in results.findings(CHAPTER):
        print(f"{finding.verdict.value:16}{finding.claim.what}: {finding.ours}")
