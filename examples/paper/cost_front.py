"""Energy against deviation: what does it cost to walk like the reference?

The cost function (13) adds energy and deviation with weights, and the paper sets both to 1.
Other weights are other compromises; drawn against each other they make a front, and its knee is
where a little more of one starts to cost much of the other. w_J = 1 and w_E from 0, where energy
has no price, to 10.

    python examples/paper/cost_front.py [FOLDER]

The weights and the rule for the knee are in drakegait/paper/cost_front.py.
"""

import sys
from pathlib import Path

from drakegait.paper.cost_front import CHAPTER, NAMES, knee
from drakegait.paper.run import run

if __name__ == "__main__":  # the workers are processes that import this file
    folder = Path(*(sys.argv[1:2] or ["out/paper"]))
    results = run([CHAPTER], folder / "solves")

    numbers = results.numbers[CHAPTER.name]
    best = knee(numbers)
    for name in NAMES:
        gait = results.gaits.get(name)
        if gait is not None:
            mark = "  <- knee" if name == best else ""
            weight, energy = gait.study.energy_weight, gait.metabolic.cost_of_transport
            print(f"w_E {weight:5g}{energy:9.1f} J/m{gait.report.deviation:8.3f} s{mark}")

    for finding in results.findings(CHAPTER):
        print(f"{finding.verdict.value:16}{finding.claim.what}: {finding.ours}")
