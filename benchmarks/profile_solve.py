"""Where the time of a solve goes, part by part.

    python benchmarks/profile_solve.py                      # spatial 18 and planar 18
    python benchmarks/profile_solve.py planar-symmetric 35

Times are shares of one solve by the default solver without added control points, from cProfile;
the profiler makes many small calls look dearer than they are. Parts are nested where they are
indented: what is inside is counted in what is around it.
"""

from __future__ import annotations

import cProfile
import os
import pstats
import sys

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # as on the command line

from drakegait.solve import solve  # noqa: E402
from drakegait.study import GaitStudy  # noqa: E402

PARTS = (  # depth, words, file and function
    (0, "guess: static optimisation along the reference", "program/starts.py", "point"),
    (0, "structure of the second derivatives", "program/lagrangian_hessian.py", "__init__"),
    (0, "iterations", "condensed/interior_point.py", "step"),
    (1, "second derivatives and condensed matrix", "condensed/system.py", "linearise"),
    (2, "curvature of all laws", "program/lagrangian_hessian.py", "local_curvature"),
    (3, "muscles", "walker/muscle_dynamics.py", "hessian"),
    (3, "skeleton", "walker/dynamics_curvature.py", "evaluate"),
    (2, "elimination of contact forces and residuals", "condensed/local_elimination.py", "at"),
    (2, "assembly, that of convexity included", "condensed/assembly.py", "matrix"),
    (1, "factors, with what is added", "condensed/system.py", "factor"),
    (2, "the muscles' lack of convexity", "condensed/system.py", "_lack"),
    (1, "directions, corrections included", "condensed/interior_point.py", "_direction"),
    (1, "trial points", "condensed/barrier_problem.py", "measure"),
    (1, "cost, rows and first derivatives", "condensed/barrier_problem.py", "evaluate"),
    (0, "check", "drakegait/check.py", "check"),
)


def main() -> None:
    """Profile the studies that are asked for."""
    words = sys.argv[1:] or ["spatial", "18", "planar", "18"]
    for model, nodes in zip(words[::2], words[1::2], strict=True):
        profile = cProfile.Profile()
        gait = profile.runcall(solve, GaitStudy(model=model, nodes=int(nodes)), refine=False)
        times = pstats.Stats(profile).get_stats_profile()
        raw = pstats.Stats(profile).stats
        total, iterations = times.total_tt, gait.outcome.iterations
        print(f"\n{model}, {nodes} nodes: {total:.1f} s profiled, {iterations} iterations")
        for depth, text, file, function in PARTS:
            spent = sum(
                entry[3]
                for (path, _, name), entry in raw.items()
                if path.endswith(file) and name == function
            )
            print(f"  {'  ' * depth + text:<56} {100.0 * spent / total:5.1f} %")


if __name__ == "__main__":
    main()
