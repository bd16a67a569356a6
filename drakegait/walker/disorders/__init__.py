"""What makes a walker differ: disorders to be composed in a `GaitStudy`.

    from drakegait.walker import disorders as dis

    study = GaitStudy.planar().with_disorder(dis.Weakness("soleus", "l", 0.5))
    study = study.with_disorder(dis.Prosthesis("r", category=4), dis.Pain("foot", "r", 2.0))

All angles are in degrees and anatomical signs. docs/disorders.md has the table of all.
"""

from drakegait.walker.disorders.base import Disorder, to_plain
from drakegait.walker.disorders.composition import KINDS, check_disorders, check_walker, from_plain
from drakegait.walker.disorders.habits import Asymmetry, Pain
from drakegait.walker.disorders.joints import JointStiffness, LimitedRange, Orthosis
from drakegait.walker.disorders.limbs import LegLength, Prosthesis
from drakegait.walker.disorders.muscles import Contracture, Spasticity, Weakness
from drakegait.walker.subject import AddedMass

__all__ = [
    "KINDS", "AddedMass", "Asymmetry", "Contracture", "Disorder", "JointStiffness", "LegLength",
    "LimitedRange", "Orthosis", "Pain", "Prosthesis", "Spasticity", "Weakness", "check_disorders",
    "check_walker", "from_plain", "to_plain",
]  # fmt: skip
