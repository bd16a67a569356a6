"""What the paper leaves open, taken one way and the other: which unknown matters?

A paper of 25 pages cannot print every constant, and some of its formulas have slips. Wherever we
had to decide, docs/formulation.md 10 says what and why. Here each decision is turned over, one
at a time, from the same gait (symmetric in the plane, 19 nodes), and the table tells how much
energy and deviation hang on it. A decision under which nobody can walk shows as one that does
not converge.

    python examples/paper/rulings.py [FOLDER]

The decisions are listed in drakegait/paper/rulings.py: `SETTINGS` and `STATEMENTS`.
"""

import sys
from pathlib import Path

from drakegait.paper.bases import SMALL
from drakegait.paper.rulings import CHAPTER, NAMES, changes
from drakegait.paper.run import run

if __name__ == "__main__":  # the workers are processes that import this file
    folder = Path(*(sys.argv[1:2] or ["out/paper"]))
    results = run([CHAPTER], folder / "solves")

    numbers = results.numbers[CHAPTER.name]
    print(f"base: {numbers.energy(SMALL):.1f} J/m, {numbers.deviation(SMALL):.3f} s")
    found = changes(numbers)
    for name, (energy, deviation) in found.items():  # the largest change first
        print(f"{name:28}{energy:+8.1f} % of E^t{deviation:+8.1f} % of J_dev")
    for name in NAMES:
        if name not in found:
            print(f"{name:28}    not converged")

    for finding in results.findings(CHAPTER):
        print(f"{finding.verdict.value:16}{finding.claim.what}: {finding.ours}")
