"""The page of a recording: Meshcat's own, with a title, a legend and controls over it.

In the page, `walk.seek(share)` stops at a share of the first stride (0 to 1, from right heel
strike) and `walk.share()` tells where the walker is; the slider uses them, and so may a program
that drives the browser.
"""

from __future__ import annotations

import html
import json
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from drakegait.replay_muscles import activation_colours
from drakegait.report.study_words import who
from drakegait.report.style import SIDE_COLOURS
from drakegait.walker import feet

if TYPE_CHECKING:
    from drakegait.gait import Gait

_LEGEND = """
  <div style="position:fixed; left:14px; top:12px; font:13px/1.5 sans-serif; color:#333;
              background:rgb(255 255 255 / 0.75); padding:8px 12px; border-radius:6px;
              max-width:40%">
    {title}<br>
    muscle activation 0
    <span style="display:inline-block; width:90px; height:9px; border-radius:4px;
                 background:linear-gradient(90deg, {resting}, {active})"></span> 1
    &ensp; <span style="white-space:nowrap"><span style="color:#1a9e40">&#9650;</span>
    ground reaction</span>
    &ensp; <span style="white-space:nowrap"><span style="color:{right}">&#9632;</span> right
    <span style="color:{left}">&#9632;</span> left foot</span><br>
    <button id="walk-pause">Pause</button>
    <select id="walk-speed" aria-label="speed">
    <option value="1">real time</option><option value="0.5">1/2</option>
    <option value="0.25">1/4</option><option value="0.1">1/10</option></select>
    <input id="walk-at" type="range" min="0" max="100" step="0.5" value="0"
           aria-label="% of the cycle" style="width:130px; vertical-align:middle"><br>
    <span id="walk-phase"></span><br>
    <small>Drag to turn, scroll to zoom. Where muscles run is for illustration only.</small>
  </div>
  <script>
    const walk = {facts};
    walk.share = () => (viewer.animator.time / walk.stride_time) % 1;
    walk.seek = (share) => {{
      const time = share * walk.stride_time;
      viewer.animator.pause();
      viewer.animator.seek(time);
      viewer.animator.display_progress(time);
      walkAt.value = 100 * share;
    }};
    const walkPause = document.getElementById("walk-pause");
    walkPause.onclick = () => {{
      if (viewer.animator.playing) viewer.animator.pause(); else viewer.animator.play();
    }};
    document.getElementById("walk-speed").onchange = (choice) => {{
      viewer.animator.mixer.timeScale = Number(choice.target.value);
    }};
    const walkAt = document.getElementById("walk-at");
    walkAt.oninput = () => walk.seek(Number(walkAt.value) / 100);
    setInterval(() => {{
      const share = walk.share();
      const phase = walk.events.filter((event) => event <= share + 1e-9).length;
      walkPause.textContent = viewer.animator.playing ? "Pause" : "Play";
      if (viewer.animator.playing) walkAt.value = 100 * share;
      document.getElementById("walk-phase").textContent =
        `${{Math.floor(100 * share + 1e-6)}} % of the cycle`
        + (phase ? `, phase ${{phase}}: ${{walk.phases[phase - 1]}}` : "");
    }}, 60);
  </script>
"""


def page_of_one(page: str, gait: Gait) -> str:
    """The recording of one walker with its title and legend.

    Args:
        page: Meshcat's static page.
    """
    text = (
        f"{who(gait.study)}; "
        f"{gait.speed:.2f} m/s, stride {gait.stride_length:.2f} m in {gait.stride_time:.2f} s"
    )
    title = f"<b>{html.escape(text)}</b>"
    title += "" if gait.converged else "<br><b>This gait has not converged.</b>"
    events = [float(event) for event in gait.values.events]
    return _with_legend(page, title, float(gait.values.stride_time), events)


def page_of_many(
    page: str, gaits: Sequence[Gait], labels: Sequence[str], colours: Sequence[str], time: float
) -> str:
    """The recording of several walkers in step.

    Args:
        labels, colours: names of the walkers and colours of their shirts, nearest first.
        time: how long the stride of all takes in the picture [s].
    """
    names = "<br>".join(
        f'<b><span style="color:{colour}">&#9632;</span> {html.escape(label)}</b>'
        f"{'' if gait.converged else ' <b>(has not converged)</b>'}, "
        f"{gait.speed:.2f} m/s, stride {gait.stride_length:.2f} m in {gait.stride_time:.2f} s"
        for gait, label, colour in zip(gaits, labels, colours, strict=True)
    )
    pace = f"<br>In step: all strides are shown in {time:.2f} s. Nearest first."
    return _with_legend(page, names + (pace if len(gaits) > 1 else ""), time, [])


def _with_legend(page: str, title: str, stride_time: float, events: list[float]) -> str:
    facts = {"stride_time": stride_time, "events": events, "phases": feet.PHASE_NAMES}
    legend = _LEGEND.format(
        title=title, resting=_css(activation_colours(0.0)), active=_css(activation_colours(1.0)),
        facts=json.dumps(facts), right=SIDE_COLOURS["right"], left=SIDE_COLOURS["left"],
    )  # fmt: skip
    page = page.replace("<title>Drake MeshCat</title>", "<title>drakegait replay</title>", 1)
    head, end, tail = page.rpartition("</body>")
    return f"{head}{legend}{end}{tail}"


def _css(colour: np.ndarray) -> str:
    return "rgb({:.0f} {:.0f} {:.0f})".format(*(255 * colour))
