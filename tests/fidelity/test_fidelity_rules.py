"""Inside, outside and by how much, on numbers whose answer is known."""

from __future__ import annotations

import numpy as np
import pytest

from drakegait.errors import InvalidInput
from drakegait.fidelity import bursts, cost, worn
from drakegait.fidelity.anchor import Anchor
from drakegait.fidelity.published import Place, Range
from drakegait.fidelity.walking import WALK
from drakegait.paper.numbers import Numbers

INSIDE, OUTSIDE, NOT_KNOWN = Place.INSIDE, Place.OUTSIDE, Place.NOT_KNOWN


@pytest.mark.parametrize(
    ("value", "beyond"), [(2.0, 0.0), (2.5, 0.0), (3.0, 0.0), (3.5, 0.5), (1.0, -1.0)]
)
def test_both_ends_belong_to_a_range(value, beyond):
    found = Range(2.0, 3.0)
    assert found.beyond(value) == pytest.approx(beyond)
    assert found.place([value]) is (INSIDE if beyond == 0.0 else OUTSIDE)


def test_the_worse_leg_decides():
    found = Range(2.0, 3.0)
    assert found.place([2.5, 3.1]) is OUTSIDE
    assert found.farthest([1.5, 3.1]) == pytest.approx(-0.5)
    assert found.farthest([2.5, 3.1]) == pytest.approx(0.1)


def test_single_numbers_are_widened_on_both_sides():
    assert Range.around([-10.9, -17.5], allowance=5.0) == Range(-22.5, -10.9 + 5.0)
    widened = Range.around([-0.196, -0.15], share=0.2)  # away from its size, whatever its sign
    assert (widened.low, widened.high) == pytest.approx((-0.2352, -0.12))
    with pytest.raises(InvalidInput, match="low end"):
        Range(1.0, 0.0)


def test_an_anchor_reads_both_legs_and_says_how_far_outside():
    anchor = Anchor(name="knee", quantity="Knee", unit="degree",
                    published=((60.0, "A"), (64.0, "B")), allowance=5.0,
                    read=lambda leg: 0.0, why="stiff")  # fmt: skip
    row = anchor.line.on(Numbers({}, {"knee right": 62.0, "knee left": 52.0}))
    assert (row.place, row.by, row.why) == (OUTSIDE, "-3.0", "stiff")
    assert row.ours == "62.0 / 52.0" and row.published == "60, 64; range 55.0 to 69.0"
    row = anchor.line.on(Numbers({}, {"knee right": 62.0, "knee left": 57.0}))
    assert (row.place, row.by, row.why) == (INSIDE, "", "")
    assert anchor.line.on(Numbers()).place is NOT_KNOWN


def test_a_number_hardly_outside_is_not_said_to_be_outside_by_nothing():
    anchor = Anchor(name="x", quantity="x", unit="m", within=(0.0, 1.0, "A"), sides=False, digits=1,
                    read=lambda leg: 0.0, why="-")  # fmt: skip
    assert anchor.line.on(Numbers({}, {"x": 1.004})).by == "+0.004"


PERCENT = np.linspace(0.0, 100.0, 401)


def pulse(*times: tuple[float, float], height: float = 1.0) -> np.ndarray:
    within = [(a <= PERCENT) & (b >= PERCENT) for a, b in times]
    return height * np.any(within, axis=0)


def test_a_pulse_is_found_where_it_is():
    found = bursts.bursts(PERCENT, pulse((10.0, 30.0), (80.0, 100.0)))
    assert np.array(found) == pytest.approx(np.array([(10.0, 30.0), (80.0, 100.0)]), abs=0.51)


def test_the_threshold_is_a_share_of_the_peak_but_not_below_the_floor():
    both = pulse((10.0, 30.0)) + pulse((50.0, 60.0), height=0.19)
    assert len(bursts.bursts(PERCENT, both)) == 1
    assert len(bursts.bursts(PERCENT, both + pulse((50.0, 60.0), height=0.02))) == 2
    assert bursts.bursts(PERCENT, pulse((10.0, 30.0), height=0.04)) == []
    assert len(bursts.bursts(PERCENT, pulse((10.0, 30.0), height=0.06))) == 1


def test_agreement_with_itself_with_nothing_and_with_its_opposite():
    times = [(0.0, 20.0), (90.0, 100.0)]
    same = bursts.agreement(times, times)
    assert (same.covered, same.astray, same.alike) == (100.0, 0.0, 100.0) and same.inside
    silent = bursts.agreement([], times)
    assert (silent.covered, silent.astray) == (0.0, 0.0) and not silent.inside
    assert silent.alike == pytest.approx(70.0)
    opposite = bursts.agreement([(20.0, 90.0)], times)
    assert (opposite.covered, opposite.alike) == (0.0, 0.0) and not opposite.inside
    assert opposite.astray == pytest.approx(100.0 * 60.0 / 70.0)  # 5 % at each side are forgiven


def test_agreement_by_hand():
    # Published 15-50; ours 40-65: covers 10 of 35, and 10 of its 25 lie beyond 55.
    found = bursts.agreement([(40.0, 65.0)], [(15.0, 50.0)])
    assert found.covered == pytest.approx(100.0 * 10.0 / 35.0)
    assert found.astray == pytest.approx(40.0)
    assert found.alike == pytest.approx(100.0 - 25.0 - 15.0)


def test_what_is_forgiven_goes_round_the_end_of_the_cycle():
    assert bursts.agreement([(95.0, 100.0)], [(0.0, 10.0)]).astray == 0.0
    assert bursts.agreement([(90.0, 95.0)], [(0.0, 10.0)]).astray == 100.0


@pytest.mark.parametrize(
    ("covered", "astray", "inside"),
    [(50.0, 50.0, True), (49.9, 0.0, False), (100.0, 50.1, False)],
)
def test_half_and_half(covered, astray, inside):
    assert bursts.Agreement(covered, astray, 0.0).inside is inside


def energies(**values: float) -> Numbers:
    rows = {worn.BASE: {"cost_of_transport_J_per_m": 400.0}}
    rows |= {name.replace("_", " "): {"cost_of_transport_J_per_m": value}
             for name, value in values.items()}  # fmt: skip
    return Numbers(rows)


def test_changes_are_those_of_equal_speed():
    assert worn.percent_change(400.0, 500.0) == pytest.approx(25.0)
    base, *loaded = worn.studies().values()
    assert all(study.speed == base.speed == 1.25 for study in loaded)


def test_masses_are_shared_by_both_legs():
    for load in worn.LOADS:
        items = worn.studies()[load.name].added_masses
        assert sum(item.mass for item in items) == pytest.approx(load.mass)
        segments = {item.segment for item in items}
        pair = {f"{load.place}_r", f"{load.place}_l"}
        assert segments == ({"hat"} if load.place == "waist" else pair)
        assert len({item.mass for item in items}) == 1


def test_a_load_is_inside_within_the_scatter_of_optima():
    foot = worn.SECTION.lines[0]  # 4 kg, published +34.5 %
    assert foot.on(energies(**{"4_kg_foot": 400.0 * 1.39})).place is INSIDE
    row = foot.on(energies(**{"4_kg_foot": 400.0 * 1.45}))
    assert (row.place, row.by, row.ours) == (OUTSIDE, "+5.5", "+45.0")
    assert foot.on(energies()).place is NOT_KNOWN


def test_the_order_of_places_is_by_kilogram():
    trend = worn.SECTION.lines[-2]
    right = energies(**{"4_kg_foot": 500.0, "4_kg_shank": 450.0, "4_kg_waist": 420.0})
    assert trend.on(right).place is INSIDE
    wrong = energies(**{"4_kg_foot": 500.0, "4_kg_shank": 418.0, "4_kg_waist": 420.0})
    assert trend.on(wrong).place is OUTSIDE
    assert trend.published.startswith("foot +8.6, shank +4.")


def test_changes_in_joules_are_for_each_kilogram_of_the_body():
    numbers = energies(**{"4_kg_foot": 475.0})
    rows = {name: {**row, "status": "done"} for name, row in numbers.rows.items()}
    first, *others = worn.in_joules(Numbers(rows)).rows
    assert first == ("4 kg foot", "0.69 to 0.86", "1.00")  # 34.5 % of 2.0 and 2.5; 75 J/m, 75 kg
    assert all(row[2] == "-" for row in others)


def test_net_and_gross_differ_by_the_body_at_rest():
    numbers = Numbers({WALK: {"cost_of_transport_J_per_m": 225.0}})
    assert cost.net(numbers, WALK) == pytest.approx(3.0)  # 75 kg
    assert cost.gross(numbers, WALK) == pytest.approx(3.0 + 1.2 / 1.2)  # 1.2 W/kg at 1.2 m/s
