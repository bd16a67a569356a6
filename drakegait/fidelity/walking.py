"""The default walk in space: timing, angles, ground reactions, moments and powers."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from drakegait.fidelity import figures
from drakegait.fidelity.anchor import ANGLE, CYCLE, SHARE, SIDES, Anchor
from drakegait.fidelity.leg import Curve, Leg, largest, least, when
from drakegait.fidelity.section import Section
from drakegait.gait import Gait
from drakegait.paper.chapter import Studies
from drakegait.paper.numbers import Gaits
from drakegait.report.curves import GaitCurves
from drakegait.study import GaitStudy

WALK = "spatial"
"""The default study: 1.80 m, 75 kg, 1.2 m/s, 18 nodes."""
_SAMPLES = 401
_WINTER, _ADULT, _BOOKS = "Winter 1991", "one adult", "textbooks"

_SPEED = "Slower than the published walks, 1.2 against 1.33 m/s."
_REFERENCE = "Held close to the embedded stride, that of one adult."
_FOOT = "A rigid foot without a toe joint: it rolls over two points."
_ABDUCTORS = "Hip abductors are weak and saturate; the pelvis cannot drop beside the trunk."
_IMPACT = "Feet land without impact."
_COARSE = "18 nodes smooth short peaks away or overshoot."
_SHARING = "Only energy and the distance from the reference choose between joints."


def studies() -> Studies:
    """The default walk."""
    return {WALK: GaitStudy.spatial(nodes=18)}


def _angle(joint: str) -> Callable[[Leg], Curve]:
    return lambda leg: leg.angle(joint)


def _force(axis: str) -> Callable[[Leg], Curve]:
    return lambda leg: leg.force(axis)


def _moment(joint: str, sign: int) -> Callable[[Leg], Curve]:
    """Moment in the sense of the joint's name (sign 1) or against it."""

    def curve(leg: Leg) -> Curve:
        percent, values = leg.moment(joint)
        return percent, sign * values

    return curve


def _power(joint: str) -> Callable[[Leg], Curve]:
    return lambda leg: leg.power(joint)


def _double_support(leg: Leg) -> float:
    """From a leg's heel strike to the other foot's toe off [% of the cycle]."""
    other = "left" if leg.side == "right" else "right"
    curves = leg.curves
    end = curves.toe_off(other) + curves.heel_strike(other)
    return (end - curves.heel_strike(leg.side)) % 100.0


_HIP, _KNEE, _ANKLE = (_angle(name) for name in ("hip_flexion", "knee_flexion",
                                                 "ankle_dorsiflexion"))  # fmt: skip
_UP, _FORTH = _force("vertical"), _force("fore-aft")
_angles = partial(Anchor, unit="degree", allowance=ANGLE)
_times = partial(Anchor, unit="% of cycle", allowance=CYCLE, digits=0)
_forces = partial(Anchor, unit="body weight", share=SHARE, digits=2)
_moments = partial(Anchor, unit="N m/kg", share=SHARE, digits=2)
_powers = partial(Anchor, unit="W/kg", share=SHARE, digits=2)

ANCHORS = (
    Anchor(name="stride time", quantity="Stride time", unit="s", published=((1.14, _WINTER),),
           share=0.1, sides=False, digits=2, read=lambda leg: leg.curves.gait.stride_time,
           why=_SPEED),
    Anchor(name="stance", quantity="Stance", unit="% of cycle", within=(60.0, 62.0, _BOOKS),
           read=lambda leg: leg.curves.toe_off(leg.side), why=f"{_SPEED} {_REFERENCE}"),
    Anchor(name="double support", quantity="Double support, each", unit="% of cycle",
           within=(10.0, 12.0, _BOOKS), read=_double_support, why=f"{_SPEED} {_REFERENCE}"),
    Anchor(name="step width", quantity="Step width", unit="m", published=((0.088, _ADULT),),
           allowance=0.03, sides=False, digits=3,
           read=lambda leg: leg.curves.gait.placement.step_width,
           why=f"{_REFERENCE} A wider step asks less of weak hip abductors."),
    _angles(name="hip flexion", quantity="Hip, most flexion",
            published=((21.9, _WINTER), (27.5, _ADULT)), read=largest(_HIP), why=_REFERENCE),
    _angles(name="hip extension", quantity="Hip, least flexion",
            published=((-10.9, _WINTER), (-17.5, _ADULT)), read=least(_HIP), why=_REFERENCE),
    _angles(name="knee flexion", quantity="Knee, most flexion",
            published=((64.9, _WINTER), (66.2, _ADULT)), read=largest(_KNEE),
            why=f"{_SPEED} {_REFERENCE} Lifting the foot less is cheaper."),
    _times(name="time of knee flexion", quantity="Knee, time of most flexion",
           published=((72.0, _WINTER),), read=when(_KNEE, 1), why=_REFERENCE),
    _angles(name="knee extension", quantity="Knee, least flexion",
            published=((0.5, _WINTER), (11.5, _ADULT)), read=least(_KNEE), why=_REFERENCE),
    _angles(name="dorsiflexion", quantity="Ankle, most dorsiflexion",
            published=((9.6, _WINTER), (14.2, _ADULT)), read=largest(_ANKLE), why=_FOOT),
    _times(name="time of dorsiflexion", quantity="Ankle, time of most dorsiflexion",
           published=((44.0, _WINTER),), read=when(_ANKLE, 1, 20.0, 60.0), why=_FOOT),
    _angles(name="plantarflexion", quantity="Ankle, least dorsiflexion",
            published=((-19.8, _WINTER), (-18.6, _ADULT)), read=least(_ANKLE), why=_FOOT),
    _times(name="time of plantarflexion", quantity="Ankle, time of least dorsiflexion",
           published=((66.0, _WINTER),), read=when(_ANKLE, -1, 50.0, 80.0), why=_FOOT),
    _angles(name="adduction", quantity="Hip, most adduction", published=((10.8, _ADULT),),
            read=largest(_angle("hip_adduction")), why=_ABDUCTORS),
    _angles(name="abduction", quantity="Hip, least adduction", published=((-5.8, _ADULT),),
            read=least(_angle("hip_adduction")), why=_ABDUCTORS),
    _forces(name="first peak", quantity="Vertical force, first peak",
            published=((1.10, _WINTER), (1.01, _ADULT)), read=largest(_UP, 0.0, 30.0),
            why=f"{_IMPACT} {_COARSE}"),
    _forces(name="valley", quantity="Vertical force, valley", published=((0.68, _ADULT),),
            read=least(_UP, 20.0, 45.0), why=f"{_SPEED} {_COARSE}"),
    _forces(name="second peak", quantity="Vertical force, second peak",
            published=((1.02, _ADULT),), read=largest(_UP, 35.0, 65.0), why=f"{_FOOT} {_COARSE}"),
    _forces(name="braking", quantity="Fore-aft force, braking",
            published=((-0.196, _WINTER), (-0.15, _ADULT)), read=least(_FORTH, 0.0, 35.0),
            why=f"{_SPEED} {_IMPACT}"),
    _forces(name="propulsion", quantity="Fore-aft force, propulsion",
            published=((0.223, _WINTER), (0.20, _ADULT)), read=largest(_FORTH, 30.0, 70.0),
            why=f"{_SPEED} {_FOOT}"),
    _forces(name="medial", quantity="Medial force", published=((0.055, _ADULT),),
            digits=3,
            read=largest(_force("medial"), 0.0, 65.0), why=f"{_REFERENCE} {_ABDUCTORS}"),
    _moments(name="ankle moment", quantity="Ankle, plantarflexor moment",
             published=((1.46, _ADULT), (1.6, _WINTER)),
             read=largest(_moment("ankle_dorsiflexion", -1)), why=_FOOT),
    _times(name="time of ankle moment", quantity="Ankle, time of plantarflexor peak",
           published=((48.0, _ADULT),), read=when(_moment("ankle_dorsiflexion", -1), 1),
           why=_FOOT),
    _powers(name="push-off", quantity="Ankle, greatest power", published=((3.3, _ADULT),),
            read=largest(_power("ankle_dorsiflexion")), why=f"{_FOOT} {_SHARING}"),
    _powers(name="ankle absorbed", quantity="Ankle, least power", published=((-0.6, _ADULT),),
            read=least(_power("ankle_dorsiflexion"), 0.0, 65.0), why=f"{_FOOT} {_IMPACT}"),
    _moments(name="knee extensor", quantity="Knee, extensor moment in loading",
             published=((0.73, _ADULT), (0.6, _WINTER)),
             read=largest(_moment("knee_flexion", -1), 0.0, 30.0),
             why=f"{_SPEED} {_SHARING} A straighter knee in loading is cheaper."),
    _moments(name="knee flexor", quantity="Knee, flexor moment in late swing",
             published=((0.38, _ADULT),), read=largest(_moment("knee_flexion", 1), 75.0, 100.0),
             why=f"{_SPEED} {_COARSE}"),
    _powers(name="knee power", quantity="Knee, greatest power", published=((0.6, _ADULT),),
            read=largest(_power("knee_flexion")), why=f"{_COARSE} {_SHARING}"),
    _powers(name="knee absorbed", quantity="Knee, least power", published=((-1.4, _ADULT),),
            read=least(_power("knee_flexion")), why=f"{_COARSE} {_SHARING}"),
    _moments(name="hip extensor", quantity="Hip, extensor moment", published=((0.59, _ADULT),),
             read=largest(_moment("hip_flexion", -1)), why=f"{_IMPACT} {_SHARING}"),
    _moments(name="hip flexor", quantity="Hip, flexor moment",
             published=((0.47, _ADULT), (0.6, _WINTER), (0.9, _WINTER)),
             read=largest(_moment("hip_flexion", 1)), why=_SHARING),
    _powers(name="hip power", quantity="Hip, greatest power about the axis of flexion",
            published=((1.16, _ADULT),), read=largest(_power("hip_flexion")), why=_SHARING),
    _moments(name="hip abductor", quantity="Hip, abductor moment", published=((0.92, _ADULT),),
             read=largest(_moment("hip_adduction", -1)), why=_ABDUCTORS),
    _moments(name="hip rotator", quantity="Hip, internal rotator moment",
             published=((0.24, _ADULT),), read=largest(_moment("hip_rotation", 1)),
             why=f"{_ABDUCTORS} The table's arms about the long axis are small."),
)  # fmt: skip


def measure(gaits: Gaits) -> dict[str, float]:
    """All anchors of the default walk."""
    return anchors_of(gaits[WALK])


def anchors_of(gait: Gait) -> dict[str, float]:
    """All anchors of a gait in space, by their keys."""
    curves = GaitCurves(gait, samples=_SAMPLES)
    found = {}
    for anchor in ANCHORS:
        for key, side in zip(anchor.keys, SIDES, strict=False):
            found[key] = anchor.read(Leg(curves, side))
    return found


SECTION = Section(
    name="walking",
    title="The default walk",
    place="-",
    about="In space, 18 nodes, 1.80 m, 75 kg, 1.2 m/s, against the embedded stride. Where a leg "
    "has its own number, both are given: right / left.",
    studies=studies,
    measures=(measure,),
    rule="inside: the numbers of both legs lie in the range. A range that was published is taken "
    "as it is. Single numbers, which are those of one adult or of a mean, are widened on both "
    f"sides: angles by {ANGLE:g} degrees, times by {CYCLE:g} % of the cycle, forces, moments and "
    f"powers by {100 * SHARE:.0f} %, stride time by 10 %, step width by 3 cm. 5 degrees are the "
    "error between sessions that gait laboratories accept (McGinley 2009); the others "
    "are our choice",
    lines=tuple(anchor.line for anchor in ANCHORS),
    pictures={
        "fidelity_walk": (
            "Each number of the default walk, right (blue) and left (red), against its range "
            "(grey, drawn to equal width)",
            lambda n: figures.ranges(ANCHORS, n),
        ),
    },
)  # fmt: skip
