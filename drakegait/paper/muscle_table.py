"""Table 1: which muscles count."""

from __future__ import annotations

from drakegait.paper import verdict
from drakegait.paper.chapter import Chapter
from drakegait.paper.claim import Claim
from drakegait.paper.numbers import Gaits, Numbers
from drakegait.paper.tables import Table
from drakegait.walker import muscle_grouping
from drakegait.walker.muscles import MuscleSet

CLOSE = 5e-4
"""Difference of two shares that rounding explains: the printed ones have four decimals."""


def _measure(gaits: Gaits) -> dict[str, float]:
    table = muscle_grouping.printed_contributions()
    shares = muscle_grouping.printed_shares()
    apart = [
        abs(share - printed)
        for row in table
        for share, printed in zip(row.shares, shares[row.muscle], strict=True)
    ]
    differences = muscle_grouping.compare(MuscleSet.load("spatial"))
    known = [item for item in differences if item.computed is not None]
    return {
        "largest difference of a printed share": max(apart),
        "muscles": len(table),
        "muscles kept": sum(row.kept for row in table),
        "muscles that count": sum(row.counts for row in table),
        "dropped although they count": sum(row.counts and not row.kept for row in table),
        "kept although they do not count": sum(row.kept and not row.counts for row in table),
        "moments": len(known),
        "moments that are capacities": sum(not item.remark for item in known),
        "hip moments": sum(item.joint == "hip" for item in known),
        "hip moments that are capacities": sum(
            item.joint == "hip" and not item.remark for item in known
        ),
    }


def _tables(numbers: Numbers) -> list[Table]:
    heads = ("muscle", "joint", "paper [N m]", "share", "Table 3: f_max x arm [N m]", "remark")
    printed = {row.muscle: row for row in muscle_grouping.printed_contributions()}
    rows = []
    for item in muscle_grouping.compare(MuscleSet.load("spatial")):
        share = printed[item.muscle].shares[muscle_grouping.JOINTS.index(item.joint)]
        computed = "-" if item.computed is None else f"{item.computed:.2f}"
        rows.append((item.muscle, item.joint, f"{item.printed:.2f}", f"{100.0 * share:.2f} %",
                     computed, item.remark))  # fmt: skip
    note = "Inconsistencies are rows 8 and 9 of docs/formulation.md 10."
    return [Table("Table 1 beside Table 3", heads, tuple(rows), note)]


def _same(one: str, other: str):
    return lambda n: verdict.Verdict.YES if n[one] == n[other] else verdict.Verdict.NO


CHAPTER = Chapter(
    name="muscle-table",
    title="Which muscles count",
    place="2.1, Table 1",
    about="Peak moment of each muscle about hip, knee and ankle; a muscle that reaches a tenth of "
    "the largest about no joint is neglected. The criterion is a function of any muscle table; "
    "here it is applied to Table 1 and to Table 3.",
    measures=(_measure,),
    claims=(
        Claim(
            "The shares of Table 1 follow from its moments",
            "Table 1", "57 shares",
            lambda n: f"largest difference {100.0 * n['largest difference of a printed share']:.3f}"
            " percentage points",
            lambda n: verdict.below(n["largest difference of a printed share"], CLOSE),
            "yes: within 0.05 percentage points",
        ),
        Claim(
            "Muscles below 10 % of the largest moment about every joint are neglected, others kept",
            "2.1, Table 1", "19 muscles, 14 kept",
            lambda n: f"the rule keeps {n['muscles that count']:.0f} of {n['muscles']:.0f}; "
            f"{n['dropped although they count']:.0f} of them are dropped in the paper",
            _same("muscles that count", "muscles kept"),
            "yes: the rule keeps exactly the groups of Table 3",
            "GRA (10.28 %) and PIRI (10.73 %) exceed a tenth at the hip and are dropped "
            "nevertheless. We keep the 14 groups of Table 3.",
        ),
        Claim(
            "The moments are those of the peak forces in walking",
            "2.1, Table 1", "after Brand et al.",
            lambda n: f"{n['moments that are capacities']:.0f} of {n['moments']:.0f} moments are "
            "f_max of Table 3 times its arm, "
            f"{n['hip moments that are capacities']:.0f} of {n['hip moments']:.0f} at the hip",
            lambda n: verdict.below(n["hip moments that are capacities"], 0.5 * n["hip moments"]),
            "yes: fewer than half of the hip moments equal f_max times arm to three digits",
            "f_max of Table 3 is the strength of a muscle and not its peak force in walking; or "
            "Table 3 prints as strength what was a peak force. SOL, TA, GAS, VAS follow from "
            "other forces than those of Table 3.",
        ),
    ),
    tables=_tables,
)  # fmt: skip
