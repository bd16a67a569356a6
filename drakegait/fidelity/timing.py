"""When muscles are excited, against published on and off times."""

from __future__ import annotations

from collections.abc import Callable

from drakegait.fidelity import figures
from drakegait.fidelity.bursts import FLOOR, PEAK_SHARE, ROUNDING, Bursts, agreement, bursts
from drakegait.fidelity.published import Place
from drakegait.fidelity.section import Line, Section
from drakegait.fidelity.walking import WALK, studies
from drakegait.gait import Gait
from drakegait.paper.numbers import Gaits, Numbers
from drakegait.report.curves import SIDES, GaitCurves
from drakegait.report.excitations import bursts as published_bursts

_CLOSE = "Nothing in the cost rewards the stiffness and readiness for which people co-contract."
_HIP = "Hip abductors are weak: what helps them is on while one leg stands alone."
_SHARE = "Which part of the gluteal muscles works is decided by small differences of energy."
_SWING = "Swing is nearly passive in the cheapest walk; people hold the foot up all the time."
_PUSH = "Push-off is sharper and later: a rigid foot rolls over its toe point."

MUSCLES = {
    "tibialis_anterior": f"{_SWING} {_CLOSE}",
    "vasti": f"A knee that is nearly straight in loading needs less. {_CLOSE}",
    "rectus_femoris": "It flexes the hip where it is long, in late stance; in loading vasti alone "
    f"hold the knee. {_CLOSE}",
    "hamstrings": f"Ours brake the swinging leg and let go; gluteus maximus holds the hip in "
    f"loading. {_CLOSE}",
    "gluteus_maximus_lateral": f"{_HIP} {_SHARE}",
    "gluteus_maximus_medial": f"It brakes the leg with the hamstrings before heel strike. {_SHARE}",
    "gluteus_medius_anterior": f"Its posterior part and gluteus maximus take its load. {_SHARE}",
    "gluteus_medius_posterior": f"{_HIP} {_SHARE}",
    "iliopsoas": "Rectus femoris, tensor fasciae latae and the stretched tissues of the hip pull "
    "the leg through as well; where these suffice, iliopsoas stays silent.",
    "gastrocnemius": f"{_PUSH} {_CLOSE}",
    "soleus": f"{_PUSH} {_CLOSE}",
}
"""Groups with published times -> what may put ours outside. Tensor fasciae latae and the adductors
have no times in the table."""


def measure(gaits: Gaits) -> dict[str, float]:
    """On and off times of all compared muscles of the default walk."""
    return times_of(gaits[WALK])


def times_of(gait: Gait) -> dict[str, float]:
    """On and off times of all compared muscles of a gait, by the names that `ours` reads."""
    curves = GaitCurves(gait, samples=401)
    found = {}
    for group in MUSCLES:
        for side in SIDES:
            percent, excitation = curves.own_cycle(side, curves.muscle(f"{group}_{side[0]}"))
            times = bursts(percent, excitation)
            found[f"{group} {side} bursts"] = len(times)
            for number, (begin, end) in enumerate(times, 1):
                found[f"{group} {side} on {number}"] = begin
                found[f"{group} {side} off {number}"] = end
    return found


def ours(numbers: Numbers, group: str, side: str) -> list[tuple[float, float]]:
    """Bursts of a muscle; raises Missing where they were not measured."""
    name = f"{group} {side}"
    count = int(numbers[f"{name} bursts"])
    return [(numbers[f"{name} on {k}"], numbers[f"{name} off {k}"]) for k in range(1, count + 1)]


def _judge(group: str) -> Callable[[Numbers], tuple[str, Place, str]]:
    def read(numbers: Numbers) -> tuple[str, Place, str]:
        mine = {side: ours(numbers, group, side) for side in SIDES}
        found = [agreement(times, published_bursts(group)) for times in mine.values()]
        text = "; ".join(f"{side} {burst_text(times)}" for side, times in mine.items())
        inside = all(item.inside for item in found)
        by = " / ".join(f"covers {item.covered:.0f} %, astray {item.astray:.0f} %, "
                        f"alike {item.alike:.0f} %" for item in found)  # fmt: skip
        return text, Place.INSIDE if inside else Place.OUTSIDE, by

    return read


def burst_text(times: Bursts) -> str:
    """`0-12, 58-100`; a dash if there is none."""
    return ", ".join(f"{begin:.0f}-{end:.0f}" for begin, end in times) or "never on"


SECTION = Section(
    name="timing",
    title="When muscles are excited",
    place="-",
    about="The same walk. Published times are rounded values of electromyography in level walking; "
    "ours are those of the neural excitation, which is what electromyography shows, not of the "
    "activation, which lags behind. Percentages of each leg's own cycle.",
    studies=studies,
    measures=(measure,),
    rule=f"a muscle is on where its excitation is at least {100 * PEAK_SHARE:.0f} % of its "
    f"greatest in the stride and at least {FLOOR:g}; inside: on both sides it covers at least "
    "half of the published time, and at most half of its own time lies astray, more than "
    f"{ROUNDING:g} % of the cycle away from a published burst; alike: the share of the cycle "
    "in which both say on or both say off",
    lines=tuple(
        Line(
            quantity=f"{group.replace('_', ' ')} [% of cycle]",
            published=burst_text(published_bursts(group)),
            source="textbooks", read=_judge(group), why=why,
        )
        for group, why in MUSCLES.items()
    ),
    pictures={
        "fidelity_timing": (
            "When muscles are on: published (grey), ours right (blue) and left (red)",
            lambda n: figures.timing(
                {group: {side: ours(n, group, side) for side in SIDES} for group in MUSCLES},
                {group: published_bursts(group) for group in MUSCLES},
            ),
        ),
    },
)  # fmt: skip
