"""Each rule says yes, no and undecided where it should."""

from __future__ import annotations

import pytest

from drakegait.paper import (
    cost_front,
    formulation_claims,
    measures,
    speeds,
    verdict,
    worn_masses,
)
from drakegait.paper.bases import SMALL
from drakegait.paper.claim import change
from drakegait.paper.numbers import Missing, Numbers
from drakegait.paper.verdict import Verdict

YES, PARTLY, NO, UNCLEAR = Verdict.YES, Verdict.PARTLY, Verdict.NO, Verdict.UNCLEAR


@pytest.mark.parametrize(
    ("found", "expected"),
    [
        (verdict.rises(100.0, 102.0), YES),
        (verdict.rises(100.0, 100.5), UNCLEAR),
        (verdict.rises(100.0, 98.0), NO),
        (verdict.falls(100.0, 98.0), YES),
        (verdict.falls(100.0, 99.5), UNCLEAR),
        (verdict.falls(100.0, 102.0), NO),
        (verdict.falls(10.0, 9.7, 0.05), UNCLEAR),
        (verdict.grows(-3.0, -1.5, 1.0), YES),
        (verdict.grows(-3.0, -2.5, 1.0), UNCLEAR),
        (verdict.grows(-3.0, -5.0, 1.0), NO),
        (verdict.below(1.0, 2.0), YES),
        (verdict.below(2.0, 2.0), NO),
        (verdict.alike(100.0, 103.0, 0.03), YES),
        (verdict.alike(100.0, 96.0, 0.03), NO),
        (verdict.falls_always([3.0, 2.0, 1.0]), YES),
        (verdict.falls_always([3.0, 2.0, 2.01, 1.0], 0.01), PARTLY),
        (verdict.falls_always([3.0, 2.0, 2.1, 1.0], 0.01), NO),
        (verdict.falls_always([-1.0, -2.0, -3.0]), YES),
        (verdict.ever_less([10.0, 6.0, 5.0, 4.8, 4.7]), YES),
        (verdict.ever_less([10.0, 9.0, 8.0, 7.0, 6.0]), NO),
        (verdict.ever_less([5.0, 5.5, 6.0, 5.9, 5.8]), NO),
        (verdict.every(YES, YES), YES),
        (verdict.every(YES, NO), PARTLY),
        (verdict.every(NO, UNCLEAR), NO),
        (verdict.every(YES, Verdict.NOT_RUN), Verdict.NOT_RUN),
    ],
)
def test_rules(found, expected):
    assert found is expected


def test_the_papers_own_table_passes_our_rules():
    from drakegait.paper.convergence import PRINTED

    f, energy, deviation, _ = zip(*PRINTED.values(), strict=True)
    for column in (f, energy, deviation):
        assert verdict.falls_always(column, 0.01) is YES
        assert verdict.ever_less(column) is YES


def test_a_form_that_does_not_converge_takes_more_iterations_than_one_that_does():
    def numbers(one: tuple[str, int], other: tuple[str, int]) -> Numbers:
        return Numbers({"a": {"status": one[0], "iterations": one[1]},
                        "b": {"status": other[0], "iterations": other[1]}})  # fmt: skip

    fewer = formulation_claims.fewer
    assert fewer(numbers(("done", 50), ("done", 80)), "a", "b") is YES
    assert fewer(numbers(("done", 80), ("done", 50)), "a", "b") is NO
    assert fewer(numbers(("done", 80), ("failed", 50)), "a", "b") is YES
    assert fewer(numbers(("failed", 80), ("done", 50)), "a", "b") is NO
    assert fewer(numbers(("failed", 80), ("failed", 50)), "a", "b") is UNCLEAR


def test_the_price_of_a_kilogram_is_the_slope_over_the_masses_that_were_solved():
    energies = {"planar 18": 300.0, "1 kg waist": 303.0, "2 kg waist": 306.0, "4 kg waist": 312.0}
    key = "cost_of_transport_J_per_m"
    rows = {name: {"status": "done", key: energy} for name, energy in energies.items()}
    numbers = Numbers(rows | {"3 kg waist": {"status": "failed"}})
    assert worn_masses.price(numbers, "waist") == pytest.approx(3.0)
    with pytest.raises(Missing, match="right thigh"):
        worn_masses.price(numbers, "right thigh")


def test_masses_are_worn_where_their_names_say():
    found = worn_masses.studies()
    assert len(found) == 1 + 5 * 4
    for kg in (1.0, 2.0, 3.0, 4.0):
        for place, segments in (
            ("right foot", ["foot_r"]), ("each foot", ["foot_r", "foot_l"]), ("waist", ["hat"]),
            ("right shank", ["shank_r"]), ("right thigh", ["thigh_r"]),
        ):  # fmt: skip
            worn = found[f"{kg:g} kg {place}"].added_masses
            assert [(item.segment, item.mass) for item in worn] == [(s, kg) for s in segments]


def test_the_knee_is_farthest_from_the_line_between_the_ends():
    points = {"w_E 0": (5000.0, 0.0), "w_E 0.1": (500.0, 0.1), "w_E 0.2": (450.0, 0.12),
              "w_E 0.5": (330.0, 0.2), SMALL: (320.0, 0.5), "w_E 10": (300.0, 1.0)}  # fmt: skip
    rows = {name: {"status": "done", "cost_of_transport_J_per_m": e, "deviation_s": d}
            for name, (e, d) in points.items()}  # fmt: skip
    assert cost_front.knee(Numbers(rows)) == "w_E 0.5"
    with pytest.raises(Missing):
        cost_front.knee(Numbers())


@pytest.mark.parametrize(("best", "expected"), [(1.3, YES), (0.9, PARTLY), (0.8, NO), (1.8, NO)])
def test_the_cheapest_speed_must_be_inside(best, expected):
    rows = {
        speeds.name_of(v): {"status": "done", "cost_of_transport_J_per_m": 300.0 + abs(v - best)}
        for v in speeds.SPEEDS
    }
    (claim,) = speeds.CHAPTER.claims
    assert claim.on(Numbers(rows)).verdict is expected


def test_a_change_is_spread_over_as_many_coordinates_as_share_it():
    assert measures.spread([3.0, 0.0, 0.0, 0.0]) == pytest.approx(1.0)
    assert measures.spread([2.0, 2.0, 2.0, 2.0]) == pytest.approx(4.0)
    assert 1.0 < measures.spread([3.0, 1.0, 1.0]) < 2.0


def test_changes_in_words():
    assert change(569.56, 631.14, "J/m", 2) == "569.56 -> 631.14 J/m (+10.8 %)"
    assert change(3.06, 3.40, digits=2) == "3.06 -> 3.40 (+11.1 %)"
