"""The options that say in what a walker differs, for the commands that take them."""

from __future__ import annotations

from typing import Annotated, Any

from drakegait.cli.app import option

_PANEL = "The disorder"
_SIDES = "_r or _l for one side, without for both"


def _disorder(name: str, metavar: str, help: str) -> Any:
    return option(name, panel=_PANEL, metavar=metavar, help=f"{help} Repeatable.")


Weakness = Annotated[list[str] | None, _disorder(
    "--weakness", "MUSCLE=SHARE",
    f"Share of its strength that a muscle has left, 0.01 to 1 ({_SIDES}). Example: "
    "soleus_l=0.5.")]  # fmt: skip
Contracture = Annotated[list[str] | None, _disorder(
    "--contracture", "MUSCLE=LENGTH",
    "Fibre length of a shortened muscle relative to normal, 0.5 to 1; it becomes taut earlier. "
    "Example: gastrocnemius_r=0.9.")]  # fmt: skip
Spasticity = Annotated[list[str] | None, _disorder(
    "--spasticity", "MUSCLE=EXCITATION",
    "Smallest excitation of a muscle that cannot be switched off, 0 to 0.5. Example: "
    "hamstrings_l=0.1.")]  # fmt: skip
Stiffness = Annotated[list[str] | None, _disorder(
    "--stiffness", "JOINT=K[@DEGREES][:DAMPING]",
    "Spring of K N m/rad about an angle in degrees (default 0) and damper in N m s/rad at hip, "
    "knee, ankle, hip_adduction or hip_rotation. Example: ankle_r=40@-5:0.5.")]  # fmt: skip
Range = Annotated[list[str] | None, _disorder(
    "--range", "JOINT=LOW:HIGH",
    "Range of a joint in degrees; one end may be left out. Example: knee_l=5:45.")]  # fmt: skip
LegLength = Annotated[list[str] | None, _disorder(
    "--leg-length", "SEGMENT=M",
    "Thigh or shank longer (or, if negative, shorter) by so many m, -0.08 to 0.08. Example: "
    "shank_l=-0.02.")]  # fmt: skip
Prosthesis = Annotated[list[str] | None, _disorder(
    "--prosthesis", "transtibial_SIDE=CATEGORY[@DEGREES]",
    "Leg that ends below the knee, with a passive foot of stiffness category 1 (soft) to 9 "
    "(stiff), 290 N m/rad at 4, and its dorsiflexion without load. Example: "
    "transtibial_r=4.")]  # fmt: skip
Orthosis = Annotated[list[str] | None, _disorder(
    "--orthosis", "ankle_SIDE=K[@DEGREES][+KG]",
    "Ankle-foot orthosis: spring of K N m/rad about a dorsiflexion in degrees (default 0), and "
    "its mass. Example: ankle_l=60@5+0.4.")]  # fmt: skip
Asymmetry = Annotated[list[str] | None, _disorder(
    "--asymmetry", "QUANTITY=RATIO",
    "Ratio right over left that step_length or stance_time must have. Example: "
    "step_length=1.1.")]  # fmt: skip
Pain = Annotated[list[str] | None, _disorder(
    "--pain", "PLACE=WEIGHT",
    "Weight in the cost of the load on a foot (its ground force) or on hip, knee or ankle (its "
    "muscles' moment), 0 to 100. Example: foot_r=2.")]  # fmt: skip
