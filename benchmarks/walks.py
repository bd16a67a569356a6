"""How long walks take, from the shell prompt and back to it.

Every row of `ROWS` is a command that a user could type, run as a process of its own that has
nothing in memory: start of Python, imports, the starting guess, the solve, the check and the files
are all in the time. Results go to `benchmarks/results.json`; README files get their tables from
there.

    python benchmarks/walks.py                          # the quick rows, some minutes
    python benchmarks/walks.py --all --repeats 3        # everything, medians of three
    python benchmarks/walks.py --rows planar-symmetric-19
    python benchmarks/walks.py --readme                 # tables into the README files, no runs

Time it on a machine that does nothing else.
"""

from __future__ import annotations

import argparse
import datetime
import json
import os
import platform
import shlex
import statistics
import string
import subprocess
import sys
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from drakegait.summary import versions

ROOT = Path(__file__).resolve().parents[1]
RESULTS = ROOT / "benchmarks" / "results.json"
FOLDER = ROOT / "out" / "bench"  # a folder for each row
NOT_PASSED = 3  # exit code of a gait that was found, but does not pass or has not converged
BEGIN, END = "<!-- figures:begin -->", "<!-- figures:end -->"
Columns = dict[str, Callable[[dict[str, Any]], str]]  # heading -> text of a record


@dataclass(frozen=True)
class Row:
    """A command to be timed.

    Attributes:
        name: its key in the results.
        command: what follows `drakegait`; `{row}` is the folder of another row, which runs first,
            `{out}` that of this one.
        quick: whether it runs when no rows are asked for.
        goal: wall time that it should take on two cores at most [s]; None: there is no goal.
        third_of: the row of which it should take a third at most.
        pictures: whether a walk draws figures and replay, too.
    """

    name: str
    command: str
    quick: bool = False
    goal: float | None = None
    third_of: str | None = None
    pictures: bool = False

    @property
    def needs(self) -> list[str]:
        """Rows whose gaits this one reads."""
        fields = [field for _, field, _, _ in string.Formatter().parse(self.command) if field]
        return [field for field in fields if field != "out"]

    @property
    def walks(self) -> bool:
        """Whether it solves a gait."""
        return self.command.startswith("walk")


ROWS = {
    row.name: row
    for row in (
        Row("help", "--help", quick=True),
        Row("spatial", "walk --nodes 18", quick=True, goal=20.0),
        Row("spatial-pictures", "walk --nodes 18", quick=True, pictures=True),
        Row("spatial-35", "walk --nodes 35", quick=True, goal=90.0),
        Row("spatial-symmetric", "walk --model spatial-symmetric --nodes 19", quick=True, goal=8.0),
        Row("planar", "walk --model planar --nodes 18", quick=True, goal=5.0),
        Row("planar-symmetric-35", "walk --model planar-symmetric --nodes 35", quick=True,
            goal=5.0),
        Row("planar-symmetric-19", "walk --model planar-symmetric --nodes 19", quick=True),
        Row("heavy-foot-cold", "walk --nodes 18 --added-mass foot_r=2.0", quick=True),
        Row("heavy-foot", "walk --nodes 18 --added-mass foot_r=2.0 --guess {spatial}", quick=True,
            third_of="heavy-foot-cold"),
        Row("spatial-drake", "walk --nodes 18 --solver ipopt"),
        Row("planar-symmetric-35-drake", "walk --model planar-symmetric --nodes 35 --solver ipopt"),
        Row("planar-snopt", "walk --model planar --nodes 18 --solver snopt --time-limit 400"),
        Row("spatial-snopt", "walk --nodes 18 --solver snopt --guess {spatial} --time-limit 400"),
        Row("check", "check {spatial}", quick=True),
        Row("figures", "plot {spatial} --out {out}", quick=True),
        Row("replay", "replay {spatial} --html {out}/replay.html", quick=True),
    )
}  # fmt: skip
PICTURES_GOAL = 6.0
"""[s] for figures and replay of a walk together, beyond the walk without them."""


# Measuring ---------------------------------------------------------------------------------------


def run(row: Row) -> dict[str, Any]:
    """Run a row once.

    Returns:
        `wall_s` from before the process starts until it has ended, `first_iteration_s` until the
        solver showed its start, `peak_memory_MiB` resident, and what `summary.json` says.
    """
    folder = FOLDER / row.name
    folder.mkdir(parents=True, exist_ok=True)
    folders = {"out": str(folder)} | {name: str(FOLDER / name) for name in row.needs}
    words = shlex.split(row.command.format_map(folders))
    if row.walks:
        words += [*([] if row.pictures else ["--no-pictures"]), "--out", str(folder)]
        (folder / "summary.json").unlink(missing_ok=True)
    environment = {"OMP_CANCELLATION": "TRUE", **os.environ}  # as `make walk` does
    found: dict[str, Any] = {}
    started = time.perf_counter()
    process = subprocess.Popen(
        [sys.executable, "-m", "drakegait.cli", *words],
        cwd=ROOT, env=environment, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
    )  # fmt: skip
    assert process.stdout is not None
    output = []
    for line in process.stdout:
        if line.startswith("iteration ") and "first_iteration_s" not in found:
            found["first_iteration_s"] = time.perf_counter() - started
        output.append(line)
    # `wait4` and not `wait`: it tells the resources of this child alone.
    _, status, used = os.wait4(process.pid, 0)
    found["wall_s"] = time.perf_counter() - started
    process.returncode = found["exit_code"] = code = os.waitstatus_to_exitcode(status)
    unit = 2**20 if sys.platform == "darwin" else 2**10  # of ru_maxrss, per MiB
    found["peak_memory_MiB"] = used.ru_maxrss / unit
    if row.walks and (folder / "summary.json").exists():
        found |= _summarised(json.loads((folder / "summary.json").read_text()))
    elif code not in (0, NOT_PASSED):
        raise SystemExit(f"drakegait {shlex.join(words)} ended with {code}:\n{''.join(output)}")
    return found


def _summarised(summary: dict[str, Any]) -> dict[str, Any]:
    solver, cost = summary["solver"], summary["cost"]
    return {
        "solver": solver["name"],
        "status": solver["status"],
        "iterations": solver["iterations"],
        "solver_s": solver["wall_time_s"],
        "control_points": summary["control_points"],
        "passed": summary["check"]["passed"],
        "cost_of_transport_J_per_m": cost["metabolic_cost_of_transport_J_per_m"],
        "deviation_s": cost["deviation"],
    }


def measure(row: Row, repeats: int) -> dict[str, Any]:
    """Medians of several runs."""
    record: dict[str, Any] = {"command": f"drakegait {row.command}", "runs": repeats}
    record |= median_of([run(row) for _ in range(repeats)])
    record["measured"] = datetime.date.today().isoformat()
    return record


def median_of(runs: list[dict[str, Any]]) -> dict[str, Any]:
    """Medians of the numbers of several runs; words that differ between runs are all kept."""
    record: dict[str, Any] = {}
    for name, first in runs[0].items():
        values = [each[name] for each in runs if name in each]
        if all(value == first for value in values):
            record[name] = first
        elif isinstance(first, (int, float)) and not isinstance(first, bool):
            record[name] = statistics.median(values)
        else:
            record[name] = " / ".join(map(str, values))
    return record


def machine() -> dict[str, Any]:
    """What the times depend on."""
    model = platform.processor() or platform.machine()
    cpuinfo = Path("/proc/cpuinfo")
    if cpuinfo.exists():
        names = [line for line in cpuinfo.read_text().splitlines() if "model name" in line]
        model = names[0].partition(":")[2].strip() if names else model
    return {
        "processor": model,
        "cores": os.cpu_count(),
        "system": f"{platform.system()} {platform.machine()}",
        "versions": versions(),
    }


def stored() -> dict[str, Any]:
    """Results of earlier runs on this machine with these versions; empty if it was another."""
    here = machine()
    if RESULTS.exists():
        results = json.loads(RESULTS.read_text(encoding="utf-8"))
        if results["machine"] == here:
            return results
    return {"machine": here, "rows": {}}


def store(results: dict[str, Any]) -> None:
    """Write the results, rows in the order of `ROWS`."""
    results["rows"] = {name: results["rows"][name] for name in ROWS if name in results["rows"]}
    RESULTS.write_text(json.dumps(results, indent=2) + "\n", encoding="utf-8")


# Tables ------------------------------------------------------------------------------------------


def table(results: dict[str, Any], brief: bool) -> str:
    """The results as Markdown; `brief` for readers who want to know whether to wait."""
    rows = results["rows"]
    walks = [
        {**record, "with": _with(name), **_asked(name, rows)}
        for name, record in rows.items()
        if "status" in record
    ]
    others = [record for record in rows.values() if "status" not in record]
    columns: Columns = {
        "walk": lambda row: f"`{_typed(row).removeprefix('drakegait ')}`{row['with']}",
        "first iteration [s]": lambda row: _number(row.get("first_iteration_s"), ".1f"),
        "wall [s]": lambda row: _number(row["wall_s"], ".0f" if row["wall_s"] > 30 else ".1f"),
        "asked [s]": lambda row: row.get("asked", "-"),
        "met": lambda row: row.get("met", "-"),
        "iterations": lambda row: _number(row["iterations"], ".0f"),
        "ended": lambda row: row["status"].replace("_", " "),
        "check": lambda row: {True: "passed", False: "not passed"}.get(row.get("passed"), "-"),
        "energy [J/m]": lambda row: _number(row.get("cost_of_transport_J_per_m"), ".1f"),
        "deviation [s]": lambda row: _number(row.get("deviation_s"), ".3f"),
        "memory [MiB]": lambda row: _number(row["peak_memory_MiB"], ".0f"),
    }  # fmt: skip
    if brief:
        for name in ("first iteration [s]", "deviation [s]"):
            del columns[name]
    parts = [_markdown(walks, columns), _pictures(rows)]
    if not brief:
        named = {"command": lambda row: f"`{_typed(row)}`"}
        named |= {name: columns[name] for name in ("wall [s]", "memory [MiB]")}
        parts.append(_markdown(others, named))
        evaluation = results.get("evaluation", {}).items()
        parts.append(_markdown(
            [{"name": name, "value": value} for name, value in evaluation],
            {"one evaluation with all derivatives": lambda row: row["name"],
             "[ms]": lambda row: format(row["value"], ".1f")},
        ))  # fmt: skip
    return "\n\n".join([*filter(None, parts), _measured_on(results)])


def _typed(record: dict[str, Any]) -> str:
    """The command as it was typed, with the folders of the rows that it needs."""
    command = record["command"]
    fields = [field for _, field, _, _ in string.Formatter().parse(command) if field]
    return command.format_map({field: f"out/bench/{field}" for field in fields})


def _with(name: str) -> str:
    row = ROWS.get(name)
    return ", figures and replay" if row is not None and row.pictures else ""


def _asked(name: str, rows: dict[str, Any]) -> dict[str, str]:
    """What is asked of a walk, and whether an answer came in that time; empty if nothing is."""
    row, record = ROWS.get(name), rows[name]
    if row is None or (row.goal is None and row.third_of not in rows):
        return {}
    goal, wall = row.goal, record["wall_s"]
    met = {True: "yes", False: "no"}
    answered = record["status"] == "converged" and record.get("passed") is True
    if goal is not None:
        return {"asked": f"{goal:g}", "met": met[answered and wall <= goal]}
    cold = rows[row.third_of]["wall_s"]
    held = answered and wall <= cold / 3.0
    return {"asked": f"{cold / 3.0:.1f}, a third of cold", "met": f"{met[held]}, {wall / cold:.2f}"}


def _pictures(rows: dict[str, Any]) -> str:
    """A sentence about figures and replay together, if a walk with and without was measured."""
    if not {"spatial", "spatial-pictures"} <= rows.keys():
        return ""
    more = rows["spatial-pictures"]["wall_s"] - rows["spatial"]["wall_s"]
    met = "met" if more <= PICTURES_GOAL else "not met"
    return (
        f"With figures and replay the first walk takes {more:.1f} s more; at most "
        f"{PICTURES_GOAL:g} s are asked: {met}."
    )


def _markdown(rows: list[dict[str, Any]], columns: Columns) -> str:
    if not rows:
        return ""
    right = [name.endswith("]") or name == "iterations" for name in columns]
    lines = ["| " + " | ".join(columns) + " |"]
    lines.append("|" + "|".join("---:" if each else "---" for each in right) + "|")
    lines += ["| " + " | ".join(read(row) for read in columns.values()) + " |" for row in rows]
    return "\n".join(lines)


def _number(value: float | None, form: str) -> str:
    return "-" if value is None else format(value, form)


def _measured_on(results: dict[str, Any]) -> str:
    on, records = results["machine"], results["rows"].values()
    days = sorted({record["measured"] for record in records})
    runs = sorted({record["runs"] for record in records})
    how = "one run each" if runs == [1] else f"medians of {' or '.join(map(str, runs))} runs"
    software = ", ".join(f"{name} {on['versions'][name]}" for name in ("python", "drake", "casadi"))
    return (
        f"{how.capitalize()}, {' to '.join(dict.fromkeys([days[0], days[-1]]))}, on "
        f"{on['cores']} cores of {on['processor']} ({on['system']}) with {software}."
    )


def write_readme(path: Path, text: str, first: str = BEGIN, last: str = END) -> None:
    """Put `text` between the marks of a README file."""
    head, begin, rest = path.read_text(encoding="utf-8").partition(first)
    _, end, tail = rest.partition(last)
    if not begin or not end:
        raise SystemExit(f"{path} lacks the marks {first} and {last}.")
    path.write_text(f"{head}{begin}\n{text}\n{end}{tail}", encoding="utf-8")


def main() -> None:
    """Measure the rows asked for, or write what was measured into the README files."""
    parser = argparse.ArgumentParser(description="Times walks, each as a process of its own.")
    which = parser.add_mutually_exclusive_group()
    which.add_argument("--rows", nargs="+", choices=ROWS, metavar="ROW", help=", ".join(ROWS))
    which.add_argument("--all", action="store_true", help="every row")
    which.add_argument("--readme", action="store_true", help="only write the tables")
    parser.add_argument("--repeats", type=int, default=1, metavar="N", help="take medians of N")
    asked = parser.parse_args()
    if asked.repeats < 1:
        parser.error(f"--repeats is {asked.repeats}, but must be at least 1")
    if asked.readme:
        results = json.loads(RESULTS.read_text(encoding="utf-8")) if RESULTS.exists() else {}
        if not results.get("rows"):
            parser.error(f"{RESULTS.name} holds no rows yet: measure first")
        write_readme(ROOT / "README.md", table(results, brief=True))
        write_readme(RESULTS.with_name("README.md"), table(results, brief=False))
        return
    quick = [name for name, row in ROWS.items() if row.quick]
    wanted = list(ROWS) if asked.all else asked.rows or quick
    wanted += [need for name in wanted for need in ROWS[name].needs if need not in wanted]
    wanted += [ROWS[name].third_of for name in wanted if ROWS[name].third_of]
    results = stored()
    # In the order of ROWS a gait comes before those that start from it.
    for row in (row for name, row in ROWS.items() if name in wanted):
        print(f"drakegait {row.command} ...", flush=True)
        record = results["rows"][row.name] = measure(row, asked.repeats)
        ended = f", {record['status']}" if "status" in record else ""
        print(f"  {record['wall_s']:.1f} s, {record['peak_memory_MiB']:.0f} MiB{ended}", flush=True)
        store(results)
    print(f"\n{table(results, brief=False)}")


if __name__ == "__main__":
    main()
