"""What the paper claims about its formulation, each claim on one problem."""

from __future__ import annotations

from drakegait.paper import measures, tables, timings, verdict
from drakegait.paper.bases import small
from drakegait.paper.chapter import Chapter, Studies
from drakegait.paper.claim import Claim
from drakegait.paper.numbers import Gaits, Numbers
from drakegait.solvers.options import SolverOptions
from drakegait.study import GaitStudy

_EXACT = SolverOptions(solver="ipopt-mumps", max_iterations=300, time_limit=300.0)
_LM = _EXACT.replace(second_derivatives="limited-memory")
BASE, BASE_LM = "form (28)", "form (28), lm"
MAXIMUM, MAXIMUM_LM = "form (29)", "form (29), lm"
PROJECTED, PROJECTED_MAXIMUM = "projected (28), lm", "projected (29), lm"
DIFFERENCES = "finite differences, lm"
EQ14 = "ends by (14)"
TOE, FREE_TOE = "toe torque", "toe torque without limit"
IN_213, IN_123 = "sequence 213", "sequence 123"
OPTIONS = {
    **dict.fromkeys((BASE, MAXIMUM, EQ14, TOE, FREE_TOE, IN_213, IN_123), _EXACT),
    **dict.fromkeys((BASE_LM, MAXIMUM_LM, PROJECTED, PROJECTED_MAXIMUM), _LM),
    DIFFERENCES: _LM.replace(derivatives="finite-differences"),
}
SAME = 0.03
"""Share within which two costs count as nearly the same."""


def studies() -> Studies:
    """Every form of the problem that a claim is about."""
    base = small()
    maximum = base.with_settings(eom_form="maximum")
    spatial = GaitStudy.spatial_symmetric(nodes=19)
    return {
        BASE: base, BASE_LM: base, DIFFERENCES: base,
        MAXIMUM: maximum, MAXIMUM_LM: maximum,
        PROJECTED: base.replace(multipliers="projected"),
        PROJECTED_MAXIMUM: maximum.replace(multipliers="projected"),
        EQ14: base.with_settings(periodicity="eq14"),
        TOE: base.with_settings(toe_torque=True),
        FREE_TOE: base.with_settings(toe_torque=True, toe_torque_limit=1000.0),
        IN_213: spatial, IN_123: spatial.with_settings(sequence="123"),
    }  # fmt: skip


def _times(gaits: Gaits) -> dict[str, float]:
    base = small()
    return timings.derivatives(base) | timings.splines(base)


def _toe(gaits: Gaits) -> dict[str, float]:
    names = measures.angle_names(gaits[BASE])
    return {"largest change of an angle by toe torque":
            measures.angle_changes(gaits[BASE], gaits[FREE_TOE], names).max()}  # fmt: skip


def _ended(n: Numbers, name: str) -> str:
    count, seconds = n.of(name, "iterations"), n.of(name, "wall_time_s")
    how = "" if n.solved(name) else ", " + str(n.of(name, "solver_status")).replace("_", " ")
    return f"{name}: {count:.0f} in {seconds:.0f} s{how}"


def fewer(n: Numbers, one: str, other: str) -> verdict.Verdict:
    """Whether one form converges, and the other takes more iterations or does not."""
    counts = n.of(one, "iterations"), n.of(other, "iterations")
    if not n.solved(one):
        return verdict.Verdict.NO if n.solved(other) else verdict.Verdict.UNCLEAR
    return verdict.Verdict.YES if not n.solved(other) or counts[0] < counts[1] else (
        verdict.Verdict.NO)  # fmt: skip


def _pairs(*pairs: tuple[str, str]):
    return (
        lambda n: "; ".join(f"{_ended(n, a)}, {_ended(n, b)}" for a, b in pairs),
        lambda n: verdict.every(*(fewer(n, a, b) for a, b in pairs)),
    )


def _costs(*names: str):
    return lambda n: ", ".join(f"{name}: f {n.cost(name):.3f}, {n.energy(name):.0f} J/m"
                               for name in names)  # fmt: skip


def _faster(one: str, other: str):
    return (
        lambda n: f"{n[one]:.3g} ms against {n[other]:.3g} ms",
        lambda n: verdict.falls(n[other], n[one], 0.5),
    )


_BOTH_TOES = (BASE, TOE, FREE_TOE)

CHAPTER = Chapter(
    name="formulation",
    title="Claims about the formulation",
    place="2, 3 and 5",
    about="Symmetric in the plane, 19 nodes (the sequence: in space), IPOPT with MUMPS from the "
    "reference, no control points added, at most 300 iterations and 300 s each. lm: second "
    "derivatives from limited memory, as the paper's SQP had them. Times hang on what else the "
    "machine did.",
    studies=studies,
    options=OPTIONS,
    refine=False,
    measures=(_times, _toe),
    claims=(
        Claim(
            "Bounds on each residual, (28), take fewer iterations than one on the largest, (29)",
            "3.3 and 5", "fewer iterations",
            *_pairs((BASE, MAXIMUM), (BASE_LM, MAXIMUM_LM), (PROJECTED, PROJECTED_MAXIMUM)),
            "yes: in all three pairs (28) converges and (29) takes more iterations or does not",
            "Both have the same feasible walks. But a row of (29) has the derivatives of the one "
            "instant that is worst: they jump where another takes its place, and a step that mends "
            "one instant says nothing about the others. The table names the law that the last gait "
            "of each holds least.",
        ),
        Claim(
            "Analytic derivatives save the time of finite differences",
            "4.1 and 5", "less time", *_faster("exact_ms", "coloured_ms"),
            "yes: one set of first derivatives takes less than half as long; differences move "
            "variables together where they can",
        ),
        Claim(
            "Matrices of the splines prepared beforehand save time",
            "4.1 and 5", "less time",
            *_faster("polynomials_prepared_ms", "polynomials_solved_ms"),
            "yes: from nodal values to polynomials, for all curves, in less than half of the time",
            "The saving is real and small: an evaluation of all laws takes some 10 ms.",
        ),
        Claim(
            "Without external torque at the metatarsophalangeal joint the solution is very similar",
            "5", "very similar",
            lambda n: _costs(*_BOTH_TOES)(n) + "; largest change of an angle "
            f"{n['largest change of an angle by toe torque']:.1f} degrees",
            lambda n: verdict.every(*(verdict.alike(n.cost(BASE), n.cost(name), SAME)
                                      for name in _BOTH_TOES[1:])),
            "yes: f differs by no more than 3 %, with torques of up to 20 N m and without limit",
        ),
        Claim(
            "Contact forces by the pseudo-inverse (17), or as variables: do both find one walk?",
            "-", "(17)",
            lambda n: f"{_costs(BASE_LM, PROJECTED)(n)}; {_ended(n, BASE_LM)}, "
            f"{_ended(n, PROJECTED)}",
            lambda n: verdict.alike(n.cost(BASE_LM), n.cost(PROJECTED), SAME),
            "yes: f differs by no more than 3 %",
        ),
        Claim(
            "What do ends forced by (14) cost, beside periodic splines?",
            "3.1", "(14)", _costs(BASE, EQ14), None,
            why="With few nodes (14) takes three of 18 freedoms from every curve. It explains much "
            "of the paper's high values at 19 nodes.",
        ),
        Claim(
            "Do the orders of rotation 213 and 123 lead to nearly the same walk?",
            "-", "text: 213, list of angles: 123", _costs(IN_213, IN_123),
            lambda n: verdict.alike(n.cost(IN_213), n.cost(IN_123), SAME),
            "yes: f differs by no more than 3 %",
        ),
    ),
    tables=lambda n: [tables.studies(n, list(studies()))],
)  # fmt: skip
