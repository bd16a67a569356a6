"""Sections 2 to 5: what does each choice in the formulation bring?

The paper argues for bounds on every residual (28) instead of one on the largest (29), for
analytic derivatives instead of differences, for spline matrices that are prepared beforehand,
and against an external torque at the toe joint. Each pair is solved here on the same small
problem: symmetric in the plane, 19 nodes, from the reference, without added control points, by
IPOPT with MUMPS. "lm" says that second derivatives are approximated with limited memory, as an
SQP method does.

    python examples/paper/formulation.py [FOLDER]

The forms and the claims are in drakegait/paper/formulation_claims.py; how each form is written
is in docs/formulation.md 13.
"""

import sys
from pathlib import Path

from drakegait.paper.formulation_claims import CHAPTER, studies
from drakegait.paper.run import run

if __name__ == "__main__":  # the workers are processes that import this file
    folder = Path(*(sys.argv[1:2] or ["out/paper"]))
    results = run([CHAPTER], folder / "solves")

    numbers = results.numbers[CHAPTER.name]
    for name in studies():
        row = numbers.rows.get(name, {})
        print(
            f"{name:26}{row['solver_status'] or row['status']:18}{row['iterations'] or 0:6.0f}",
            end="",
        )
        print(f" iterations{row['wall_time_s'] or 0.0:8.1f} s")
    for name in ("exact", "coloured", "one_by_one"):
        time = next(value for key, value in numbers.found.items() if key.startswith(f"{name}_ms"))
        print(f"first derivatives, {name:12}{time:9.1f} ms")

    for finding in results.findings(CHAPTER):
        print(f"{finding.verdict.value:16}{finding.claim.what}: {finding.ours}")
