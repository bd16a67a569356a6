"""What is shown while solving: one line, the worst law by name, plain lines without a terminal."""

from __future__ import annotations

import io

import pytest
from rich.console import Console

from drakegait.commands import screen
from drakegait.solvers.monitor import Progress

NAME = "equations of motion | left single support 0.31 | hip_adduction_r"


def progress(iteration=12, worst=NAME, round=1, remaining=3599.0) -> Progress:
    return Progress(round, iteration, 4.8311, 2.375, worst, 1.0, remaining)


def test_a_line_names_iteration_cost_worst_law_and_time_left():
    line = screen.progress_line(progress())
    for word in ("iteration 12", "cost 4.8311", "59:59 left", "2.4 x tolerance: equations of",
                 "left single support 0.31, hip_adduction_r"):  # fmt: skip
        assert word in line
    assert "\n" not in line and not line.startswith("round")
    assert "every law holds" in screen.progress_line(progress(worst=""))
    assert screen.progress_line(progress(round=2)).startswith("round 2")


@pytest.mark.parametrize(
    ("seconds", "text"), [(0.4, "0:00"), (-3.0, "0:00"), (61.0, "1:01"), (3725.0, "1:02:05")]
)
def test_time_is_shown_as_a_clock(seconds, text):
    assert screen.clock(seconds) == text


def test_on_a_terminal_one_line_is_overwritten_and_never_wraps():
    file = io.StringIO()
    console = Console(file=file, force_terminal=True, width=60, color_system=None)
    with screen.ProgressDisplay(console) as display:
        for iteration in range(5):
            display.report(progress(iteration))
    shown = file.getvalue()
    assert all(f"iteration {iteration}" in shown for iteration in range(5))
    assert shown.count("\n") <= 1 and "…" in shown


def test_without_a_terminal_there_are_plain_lines_now_and_then(capsys, monkeypatch):
    now = [100.0]
    monkeypatch.setattr(screen.time, "monotonic", lambda: now[0])
    with screen.ProgressDisplay(Console(file=io.StringIO())) as display:
        for iteration in range(40):
            display.report(progress(iteration))
            now[0] += 0.5
    lines = capsys.readouterr().out.splitlines()
    assert [line.split()[1] for line in lines] == ["0", "10", "20", "30"]
    assert "\x1b" not in "".join(lines)
