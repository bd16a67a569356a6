"""Derivatives of optima against solving again: how far can `drakegait sensitivities` be trusted?

For each case a gait is found with default options ("usual"), then solved on to the very optimum
("exact", `drakegait.exact`), with a few small steps to and fro that find a better one where the
first is shallow. Derivatives come from both. Then the study is solved again with each
parameter changed to either side by a fiftieth, a fifth (in the plane) and a whole step, each solve
from the one before with its multipliers and to the same tolerance, so that it follows its optimum
as far as it can; central differences of those stand beside the derivatives. Where f falls to one
side otherwise than it rises to the other, even over a fiftieth of a step, a solve has gone on to
another optimum close by: such differences are marked with a star.

    python benchmarks/sensitivities_check.py                        # all cases
    python benchmarks/sensitivities_check.py --case spatial
    python benchmarks/sensitivities_check.py --print                # tables from the file, no runs

Results go to `benchmarks/sensitivities.json` after every parameter.
"""

from __future__ import annotations

import argparse
import datetime
import json
from pathlib import Path
from typing import Any

import numpy as np

from drakegait.errors import InvalidInput
from drakegait.exact import OPTIONS, solve_exactly
from drakegait.gait import Gait
from drakegait.parameters import Parameter, parameters
from drakegait.sensitivities import sensitivities
from drakegait.solve import solve
from drakegait.study import GaitStudy
from drakegait.summary import versions
from drakegait.walker.disorders import Orthosis, Prosthesis

RESULTS = Path(__file__).resolve().parent / "sensitivities.json"
TIME_LIMIT = 900.0  # of a solve [s]
SMALL = 0.02  # of a step
ONE_OPTIMUM = 0.02  # differences of f to the two sides of a small step agree to this part of them
NUDGES = 3  # parameters by which the optimum is settled
# Far from the gait before it a solve needs a larger barrier parameter than beside it.
BARRIERS = {SMALL: OPTIONS["barrier_start"], 0.2: 1e-6, 1.0: 1e-6}
ANKLE = Orthosis("both", stiffness=100.0, mass=0.4)
IN_PLANE, IN_SPACE = (SMALL, 0.2, 1.0), (SMALL, 1.0)
CASES: dict[str, tuple[GaitStudy, tuple[float, ...], tuple[str, ...]]] = {
    "planar-symmetric": (
        GaitStudy.planar_symmetric(19),
        IN_PLANE,
        ("added mass foot", "added mass shank", "mass centre shank", "inertia thigh",
         "strength soleus", "strength tibialis_anterior", "strength vasti", "fibre length vasti",
         "passive.damping_knee", "body mass", "body height", "speed", "tolerances.moment_tolerance",
         "tolerances.contact_tolerance", "contact.friction"),
    ),
    "planar-symmetric with orthoses": (
        GaitStudy.planar_symmetric(19).with_disorder(ANKLE),
        IN_PLANE,
        ("orthosis both stiffness", "orthosis both neutral", "orthosis both mass", "speed",
         "added mass foot"),
    ),
    "spatial": (
        GaitStudy.spatial(18),
        IN_SPACE,
        ("added mass foot_r", "added mass foot_l", "speed", "tolerances.moment_tolerance",
         "strength soleus_r", "strength soleus_l", "mass centre shank_r", "body height",
         "tolerances.contact_tolerance", "strength tibialis_anterior_l", "passive.damping_knee"),
    ),
    "spatial with a prosthesis": (
        GaitStudy.spatial(18).with_disorder(Prosthesis("r", stiffness=290.0)),
        IN_SPACE,
        ("prosthesis r stiffness", "prosthesis r alignment", "prosthesis r foot_mass", "speed",
         "added mass foot_l"),
    ),
}  # fmt: skip


def cost_and_energy(gait: Gait) -> list[float]:
    """f [-] and E^t [J/m] as the solver sees them."""
    return [gait.cost["total"], 100.0 * gait.cost["metabolic cost of transport"]]


def solved(parameter: Parameter, share: float, guess: Gait) -> Gait | None:
    """The optimum with so many steps added to a parameter; None where there is none."""
    try:
        study = parameter.study(parameter.value + share * parameter.step)
    except InvalidInput:  # beyond the end of its range
        return None
    return solved_from(guess, study, BARRIERS[abs(share)])


def solved_from(guess: Gait, study: GaitStudy, barrier: float) -> Gait | None:
    """The optimum of a study that is found from another's; None where none is."""
    choices = {**OPTIONS, "barrier_start": barrier, "time_limit": TIME_LIMIT}
    gait = solve(study, guess=guess, refine=False, **choices)
    return gait if gait.outcome.status == "converged" else None


def settled(gait: Gait, nudges: list[Parameter]) -> Gait:
    """The best optimum that is found by small steps of parameters, to and fro.

    Optima lie close to each other, and from a shallow one the least change leads to the next.
    """
    for parameter in nudges:
        for share in (SMALL, -SMALL):
            other = solved(parameter, share, gait)
            back = other and solved_from(other, gait.study, BARRIERS[SMALL])
            if back and back.cost["total"] < gait.cost["total"]:
                gait = back
    return gait


def solves(parameter: Parameter, exact: Gait, shares: tuple[float, ...]) -> list[dict[str, Any]]:
    """Central and one-sided differences of solves, for each share of a step."""
    here, sides = cost_and_energy(exact), {}
    for sign in (1.0, -1.0):
        found, guess = [], exact
        for share in shares:
            gait = solved(parameter, sign * share, guess)
            if gait is None:
                break
            found.append(cost_and_energy(gait))
            guess = gait
        sides[sign] = found + [None] * (len(shares) - len(found))
    records = []
    for k, share in enumerate(shares):
        up, down, step = sides[1.0][k], sides[-1.0][k], share * parameter.step
        record: dict[str, Any] = {"share_of_step": share}
        for i, name in enumerate(("cost", "energy")):
            above = None if up is None else (up[i] - here[i]) / step
            below = None if down is None else (here[i] - down[i]) / step
            both = above is not None and below is not None
            record[name] = 0.5 * (above + below) if both else None
            record[f"{name}_above"], record[f"{name}_below"] = above, below
        records.append(record)
    return records


def run(name: str) -> None:
    """One case; saved after every parameter."""
    study, shares, chosen = CASES[name]
    usual = solve(study)
    by_name = {parameter.name: parameter for parameter in parameters(usual.study)}
    nudges = [by_name[key] for key in chosen[:NUDGES]]
    exact = settled(solve_exactly(usual, time_limit=TIME_LIMIT), nudges)
    found: dict[str, Any] = {
        "date": datetime.date.today().isoformat(), "versions": versions(), "nodes": study.nodes,
    }  # fmt: skip
    answers = {}
    for word, gait in (("usual", usual), ("exact", exact)):
        answers[word] = sensitivities(gait)
        found[word] = {
            "status": gait.outcome.status, "iterations": gait.outcome.iterations,
            "cost": answers[word].cost, "energy_J_per_m": answers[word].energy,
            "kkt_residual": answers[word].stationarity,
        }  # fmt: skip
    found["parameters"] = []
    for key in chosen:
        parameter = by_name[key]
        record: dict[str, Any] = {
            "parameter": key, "unit": parameter.unit, "value": parameter.value,
            "step": parameter.step,
        }  # fmt: skip
        for word, answer in answers.items():
            entry = answer[key]
            record[word] = {"cost": entry.cost, "energy": entry.energy}
        record["solves"] = solves(parameter, exact, shares)
        found["parameters"].append(record)
        save(name, found)
        print(row(record), flush=True)


def load() -> dict[str, Any]:
    """What was found so far."""
    return json.loads(RESULTS.read_text("utf-8")) if RESULTS.exists() else {}


def save(name: str, found: dict[str, Any]) -> None:
    """Write one case, beside the file and then renamed."""
    results = load() | {name: found}
    beside = RESULTS.with_suffix(".part")
    beside.write_text(json.dumps(results, indent=1) + "\n", encoding="utf-8")
    beside.replace(RESULTS)


def row(record: dict[str, Any]) -> str:
    """Of the table: derivatives and differences of f, then of E^t."""
    cells = []
    for what in ("cost", "energy"):
        cells += [number(record[word][what]) for word in ("usual", "exact")]
        cells += [
            number(found[what]) + ("" if follows(found, record["exact"]["cost"]) else "*")
            for found in record["solves"]
        ]
    unit = "" if record["unit"] in ("", "-") else f" [{record['unit']}]"
    words = record["parameter"].replace("_", " ").replace("tolerances.", "")
    return f"| {words}{unit} | " + " | ".join(cells) + " |"


def number(value: float | None) -> str:
    """Four digits, a dash for what is not known."""
    return "-" if value is None or np.isnan(value) else f"{value:.4g}"


def follows(found: dict[str, Any], derivative: float) -> bool:
    """Whether small steps to both sides stay at the optimum that they started from."""
    sides = found["cost_above"], found["cost_below"]
    if found["share_of_step"] != SMALL or None in sides:
        return True
    return abs(sides[0] - sides[1]) <= ONE_OPTIMUM * max(abs(derivative), *map(abs, sides))


def table(found: dict[str, Any]) -> str:
    """In Markdown."""
    names = {SMALL: "1/50", 0.2: "1/5", 1.0: "whole"}
    shares = [names[each["share_of_step"]] for each in found["parameters"][0]["solves"]]
    heads = ["as usual", "exact", f"solves, {shares[0]}", *shares[1:]]
    head = " | ".join([f"df/dp {heads[0]}", *heads[1:], f"dE/dp {heads[0]}", *heads[1:]])
    lines = [f"| parameter | {head} |", "|---|" + "---:|" * 2 * len(heads)]
    return "\n".join([*lines, *(row(record) for record in found["parameters"])])


def main() -> None:
    """See the top of this file."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--case", action="append", choices=CASES)
    parser.add_argument("--print", action="store_true", help="tables from the file, no runs")
    given = parser.parse_args()
    if not given.print:
        for name in given.case or CASES:
            print(f"\n{name}", flush=True)
            run(name)
    for name, found in load().items():
        print(f"\n{name}\n\n{table(found)}")


if __name__ == "__main__":
    main()
