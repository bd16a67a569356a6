"""The recording and the live view in a real browser: they load, walk, and stay at home."""

import os
import re
import signal
import socket
import subprocess
import sys

import pytest
from browser_cases import VIEW, Visit, changed, not_blank, picture
from gait_cases import reference_gait

from drakegait.replay import replay

# Right of the legend.
SCENE = {"x": 420, "y": 0, "width": VIEW["width"] - 420, "height": VIEW["height"]}
QUARTERS = (0.0, 0.25, 0.5, 0.75)


@pytest.fixture(scope="module")
def recording(visit, tmp_path_factory):
    path = tmp_path_factory.mktemp("replay") / "replay.html"
    replay(reference_gait("spatial"), html=path, strides=2)
    visit.page.context.set_offline(True)
    visit.page.goto(path.as_uri())
    visit.ready()
    return visit


def test_recording_loads_without_complaint_and_without_network(recording):
    assert recording.complaints == []
    assert recording.abroad == []


def test_figure_walks_by_itself(recording):
    page = recording.page
    start = page.evaluate("walk.share()")
    page.wait_for_function(
        "(start) => { const moved = (walk.share() - start + 1) % 1;"
        " return moved > 0.02 && moved < 0.98; }",
        arg=start,
    )
    page.click("#walk-pause")
    assert not page.evaluate("viewer.animator.playing")
    assert page.inner_text("#walk-pause") in ("Pause", "Play")
    page.wait_for_function("document.getElementById('walk-pause').textContent === 'Play'")


def test_quarters_of_the_stride_look_different_and_are_not_blank(recording):
    page = recording.page
    shots = []
    for share in QUARTERS:
        page.evaluate("(share) => walk.seek(share)", share)
        assert page.evaluate("walk.share()") == pytest.approx(share, abs=1e-6)
        shots.append(picture(page, clip=SCENE))
        assert not_blank(shots[-1])
    for number, shot in enumerate(shots):
        for other in shots[:number]:
            assert changed(shot, other) > 0.01
    # The same instant looks the same.
    page.evaluate("walk.seek(0.25)")
    assert changed(picture(page, clip=SCENE), shots[1]) < 1e-3


def test_legend_says_where_in_the_cycle_the_walker_is(recording):
    page = recording.page
    page.evaluate("walk.seek(0.3)")
    page.wait_for_function(
        "document.getElementById('walk-phase').textContent.includes('30 % of the cycle')"
    )
    assert "right single support" in page.inner_text("#walk-phase")
    assert float(page.input_value("#walk-at")) == pytest.approx(30.0)


def test_slider_seeks(recording):
    page = recording.page
    page.evaluate(
        "() => { const at = document.getElementById('walk-at'); at.value = 62.5;"
        " at.dispatchEvent(new Event('input')); }"
    )
    assert page.evaluate("walk.share()") == pytest.approx(0.625, abs=1e-6)


@pytest.fixture(scope="module")
def live(browser, tmp_path_factory):
    """Where `drakegait replay GAIT` serves the live view."""
    path = tmp_path_factory.mktemp("live") / "gait.nc"
    reference_gait("spatial").save(path)
    with socket.socket() as probe:
        probe.bind(("localhost", 0))
        port = probe.getsockname()[1]
    command = [sys.executable, "-m", "drakegait.cli", "replay", str(path), "--port", str(port)]
    server = subprocess.Popen(
        command, stdout=subprocess.PIPE, text=True, env={**os.environ, "PYTHONUNBUFFERED": "1"}
    )
    line = server.stdout.readline()
    yield re.search(r"http://\S+?(?=;)", line)[0]
    server.send_signal(signal.SIGINT)
    assert server.wait(timeout=30) == 0
    assert "Ended" in server.stdout.read()
    server.stdout.close()


def test_live_view_walks_and_stays_at_home(browser, live):
    visit = Visit(browser.new_page(viewport=VIEW))
    visit.page.goto(live)
    visit.ready()
    page = visit.page
    start = page.evaluate("viewer.animator.time")
    page.wait_for_function("(start) => Math.abs(viewer.animator.time - start) > 0.05", arg=start)
    duration = page.evaluate("viewer.animator.duration")
    assert duration == pytest.approx(3 * reference_gait("spatial").stride_time, rel=0.01)
    shots = []
    for share in QUARTERS:
        page.evaluate(
            "(time) => { viewer.animator.pause(); viewer.animator.seek(time); }",
            share * duration / 3,
        )
        shots.append(picture(page, clip=SCENE))
        assert not_blank(shots[-1])
    assert all(
        changed(shot, other) > 0.01 for number, shot in enumerate(shots) for other in shots[:number]
    )
    assert visit.complaints == []
    assert visit.abroad == []
    page.close()
