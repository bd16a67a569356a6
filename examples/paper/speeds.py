"""Speed from 0.8 to 1.8 m/s: does the model walk cheapest where people do?

The paper fixes the average speed and does not say at which value. People who may choose walk at
about 1.3 m/s, near the speed at which a metre costs least. That speed is no part of our model:
if there is a cheapest one, it comes out of mechanics and muscles, and of the one reference
stride.

    python examples/paper/speeds.py [FOLDER]

The speeds and the rule are in drakegait/paper/speeds.py.
"""

import sys
from pathlib import Path

from drakegait.paper.run import run
from drakegait.paper.speeds import CHAPTER, NAMES

if __name__ == "__main__":  # the workers are processes that import this file
    folder = Path(*(sys.argv[1:2] or ["out/paper"]))
    results = run([CHAPTER], folder / "solves")

    found = {gait.speed: gait for name, gait in results.gaits.items() if name in NAMES}
    for speed, gait in sorted(found.items()):
        energy, steps = gait.metabolic.cost_of_transport, 120.0 / gait.stride_time
        print(f"{speed:5.2f} m/s{energy:8.1f} J/m{steps:8.1f} steps/min", end="")
        print(f"{0.5 * gait.stride_length:7.3f} m  {'#' * round(energy / 10.0)}")

    for finding in results.findings(CHAPTER):
        print(f"{finding.verdict.value:16}{finding.claim.what}: {finding.ours}")
