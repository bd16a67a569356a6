"""A person's own walk: read from files, laid on the model, judged.

    walk = import_walk("ik.mot", "grf.mot", height=1.80, mass=72.6)
    study = GaitStudy.spatial(reference=walk.reference, subject=walk.subject)
"""

from drakegait.measured.imported import ImportedWalk
from drakegait.measured.quality import Quality
from drakegait.measured.walk import import_walk

__all__ = ["ImportedWalk", "Quality", "import_walk"]
