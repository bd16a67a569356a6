"""Table 1: which muscles count?

A muscle's peak moment about a joint is its arm times the largest force it has in walking.
Muscles whose moment stays below a tenth of the largest one, about hip, knee and ankle, are
neglected. The paper lists 19 muscles and keeps 14. Two things in its table do not fit: two
muscles above a tenth are dropped, and most of its moments are the arm times the *strength* that
Table 3 prints.

    python examples/paper/muscle_table.py

The criterion is drakegait/walker/muscle_grouping.py; it takes any muscle table and any peak
forces.
"""

from drakegait.paper.muscle_table import CHAPTER
from drakegait.paper.numbers import Numbers
from drakegait.walker.muscle_grouping import JOINTS, compare, contributions, printed_contributions
from drakegait.walker.muscles import MuscleSet

table_3 = MuscleSet.load("spatial")

print(f"{'':8}" + "".join(f"{joint + ' [%]':>11}" for joint in JOINTS) + "   rule   paper")
for row in printed_contributions():
    shares = "".join(f"{100.0 * share:11.2f}" for share in row.shares)
    rule, paper = ("keeps" if flag else "drops" for flag in (row.counts, row.kept))
    print(f"{row.muscle:8}{shares}   {rule}  {paper}{'   <-' if rule != paper else ''}")

print("\nTable 1 beside f_max x arm of Table 3, where they differ:")
for item in compare(table_3):
    if item.remark and item.computed is not None:
        moments = f"{item.printed:8.1f}{item.computed:8.1f} N m"
        print(f"{item.muscle:8}{item.joint:6}{moments}  {item.remark}")

few = [row.muscle for row in contributions(table_3, threshold=0.3) if row.counts]
print(f"\nWith 30 % instead of 10 % Table 3 would keep {', '.join(few)}.\n")

for finding in CHAPTER.findings(Numbers(found=CHAPTER.measure({}))):
    print(f"{finding.verdict.value:16}{finding.claim.what}: {finding.ours}")
