"""Many studies at once: on the cores of this machine, or on a Dask cluster by its address.

    from drakegait import GaitStudy, sweep

    normal = GaitStudy.spatial(nodes=18)
    studies = {f"{kg} kg": normal.with_added_mass("foot_r", kg) for kg in (1.0, 2.0, 3.0)}
    if __name__ == "__main__":  # the workers are processes that import this file
        result = sweep({"normal": normal} | studies, "out/foot_mass")
        print(result.table()[["status", "cost_of_transport_J_per_m"]])
        result.plot()

Finished studies are in the folder at once; the same call goes on where an earlier one was ended.
"""

from drakegait.sweep.progress import SweepProgress
from drakegait.sweep.result import SweepResult
from drakegait.sweep.run import sweep

__all__ = ["SweepProgress", "SweepResult", "sweep"]
