"""A gait for other programs: OpenSim, tables, SDF.

    from drakegait.export import export_csv, export_opensim, export_sdf

    export_opensim(gait, "opensim")  # model, motion, forces: OpenSim 4.5 or later opens it
    export_csv(gait, "tables")
    export_sdf(gait, "walker.sdf")
"""

from drakegait.export.opensim import export_opensim
from drakegait.export.osim_model import osim_model
from drakegait.export.sdf import export_sdf
from drakegait.export.tables import export_csv

__all__ = ["export_csv", "export_opensim", "export_sdf", "osim_model"]
