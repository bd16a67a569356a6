"""Table 2 and figure 5: does the answer settle as nodes are added?

All curves of the walker are splines through nodes; with more nodes they can bend more, and
nothing else changes. So the best walk with 21 nodes should cost no more than the best with 19,
and what another pair of nodes brings should shrink. The paper shows this for the symmetric
walker in the sagittal plane, from 19 to 35 nodes, in half an hour to 16 hours each. Here each
solve starts from the gait with two nodes less, as one would refine.

    python examples/paper/convergence.py [FOLDER]

The studies and the claims are in drakegait/paper/convergence.py; `drakegait paper` runs the
same.
"""

import sys
from pathlib import Path

from drakegait import plot
from drakegait.paper.convergence import CHAPTER, DRAWN, PRINTED
from drakegait.paper.run import run

if __name__ == "__main__":  # the workers are processes that import this file
    folder = Path(*(sys.argv[1:2] or ["out/paper"]))
    results = run([CHAPTER], folder / "solves")

    print(f"{'nodes':>5}{'f':>8}{'paper':>8}{'J/m':>8}{'paper':>8}{'J_dev':>8}{'paper':>8}")
    for nodes, (f, energy, deviation, _) in PRINTED.items():
        gait = results.gaits.get(f"nodes {nodes}")
        if gait is None:
            print(f"{nodes:5}  not converged")
            continue
        ours = gait.cost["total"], gait.metabolic.cost_of_transport, gait.report.deviation
        print(f"{nodes:5}{ours[0]:8.2f}{f:8.2f}{ours[1]:8.1f}{energy:8.1f}", end="")
        print(f"{ours[2]:8.3f}{deviation:8.2f}")

    for finding in results.findings(CHAPTER):
        print(f"{finding.verdict.value:16}{finding.claim.what}: {finding.ours}")

    if DRAWN in results.gaits:  # figure 5
        plot(results.gaits[DRAWN], folder / "figures_29_nodes")
