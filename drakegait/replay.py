"""A gait to look at: Drake's Meshcat, live or recorded in one self-contained file.

    replay(gait, html="replay.html")        # open it in any browser, also without a network
    meshcat = replay(gait)                  # live at meshcat.web_url()

Muscles turn from blue (activation 0) to red (1); where they run is decoration. Arrows are the
ground reactions at the centres of pressure. The view travels with the walker.
"""

from __future__ import annotations

import html as html_text
import json
import os
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from drakegait.errors import BadFile, InvalidInput
from drakegait.replay_muscles import activation_colours
from drakegait.report.style import SIDE_COLOURS
from drakegait.walker import feet

if TYPE_CHECKING:
    from pydrake.geometry import Meshcat

    from drakegait.gait import Gait

MOST_STRIDES = 20
PORTS = (1024, 65535)
_LEGEND = """
  <div style="position:fixed; left:14px; top:12px; font:13px/1.5 sans-serif; color:#333;
              background:rgb(255 255 255 / 0.75); padding:8px 12px; border-radius:6px;
              max-width:46%">
    <b>{title}</b>{state}<br>
    muscle activation 0
    <span style="display:inline-block; width:90px; height:9px; border-radius:4px;
                 background:linear-gradient(90deg, {resting}, {active})"></span> 1
    &ensp; <span style="color:#1a9e40">&#9650;</span> ground reaction
    &ensp; <span style="color:{right}">&#9632;</span> right foot
    <span style="color:{left}">&#9632;</span> left foot<br>
    <button id="walk-pause">Pause</button>
    <select id="walk-speed"><option value="1">real time</option><option value="0.5">1/2</option>
    <option value="0.25">1/4</option><option value="0.1">1/10</option></select>
    <span id="walk-phase"></span><br>
    <small>Drag to turn, scroll to zoom. Where muscles run is for illustration only.</small>
  </div>
  <script>
    const walk = {facts};
    const walkPause = document.getElementById("walk-pause");
    walkPause.onclick = () => {{
      if (viewer.animator.playing) viewer.animator.pause(); else viewer.animator.play();
    }};
    document.getElementById("walk-speed").onchange = (choice) => {{
      viewer.animator.mixer.timeScale = Number(choice.target.value);
    }};
    setInterval(() => {{
      const share = (viewer.animator.time / walk.stride_time) % 1;
      const phase = walk.events.filter((event) => event <= share + 1e-9).length;
      walkPause.textContent = viewer.animator.playing ? "Pause" : "Play";
      document.getElementById("walk-phase").textContent =
        `${{Math.floor(100 * share)}} % of the cycle, phase ${{phase}}: `
        + walk.phases[phase - 1];
    }}, 60);
  </script>
"""


def replay(
    gait: Gait, html: str | Path | None = None, strides: int = 3, port: int | None = None
) -> Meshcat:
    """Show a gait walking several strides, with play and pause.

    Args:
        gait: the gait, converged or not.
        html: file for the recording, self-contained; none is written by default.
        strides: how many strides, 1 to 20; the animation repeats.
        port: where the live view listens, by default the first free one from 7000.

    Returns:
        The Meshcat. The live view lasts as long as it is kept.

    Raises:
        InvalidInput: for a number of strides or a port that cannot be.
        BadFile: the file cannot be written.
    """
    if isinstance(strides, bool) or not isinstance(strides, (int, np.integer)) or not (
        1 <= strides <= MOST_STRIDES
    ):  # fmt: skip
        raise InvalidInput("strides", strides, f"a whole number from 1 to {MOST_STRIDES}")
    whole = isinstance(port, (int, np.integer)) and not isinstance(port, bool)
    if port is not None and not (whole and PORTS[0] <= port <= PORTS[1]):
        raise InvalidInput("port", port, f"a whole number from {PORTS[0]} to {PORTS[1]}")
    from drakegait.replay_film import Film, animate
    from drakegait.replay_scene import build

    meshcat = _open(port)
    pieces = build(meshcat, gait, int(strides))
    size = gait.study.subject.length_scale
    meshcat.SetAnimation(animate(Film.of(gait), pieces, int(strides), size))
    if html is not None:
        _write(Path(html), _with_legend(meshcat.StaticHtml(), gait))
    return meshcat


def _open(port: int | None) -> Meshcat:
    from pydrake.geometry import Meshcat, MeshcatParams

    params = MeshcatParams(show_stats_plot=False)
    params.port = None if port is None else int(port)
    try:
        return Meshcat(params)
    except RuntimeError as error:
        raise InvalidInput("port", port, f"a free one ({error})") from None


def _with_legend(page: str, gait: Gait) -> str:
    """The recording with a title and a legend over it."""
    study = gait.study
    worn = "".join(f", {item.mass:g} kg on {item.segment}" for item in study.added_masses)
    title = (
        f"{study.model} model, {study.subject.height:.2f} m, {study.subject.mass:g} kg{worn}; "
        f"{gait.speed:.2f} m/s, stride {gait.stride_length:.2f} m in {gait.stride_time:.2f} s"
    )
    state = "" if gait.converged else "<br><b>This gait has not converged.</b>"
    legend = _LEGEND.format(
        title=html_text.escape(title), state=state,
        resting=_css(activation_colours(0.0)), active=_css(activation_colours(1.0)),
        facts=json.dumps({
            "stride_time": float(gait.values.stride_time),
            "events": [float(event) for event in gait.values.events],
            "phases": feet.PHASE_NAMES,
        }),
        right=SIDE_COLOURS["right"], left=SIDE_COLOURS["left"],
    )  # fmt: skip
    page = page.replace("<title>Drake MeshCat</title>", "<title>drakegait replay</title>", 1)
    head, end, tail = page.rpartition("</body>")
    return f"{head}{legend}{end}{tail}"


def _css(colour: np.ndarray) -> str:
    return "rgb({:.0f} {:.0f} {:.0f})".format(*(255 * colour))


def _write(path: Path, text: str) -> None:
    part = path.with_name(f".{path.name}.{os.getpid()}")
    try:
        part.write_text(text, encoding="utf-8")
        part.replace(path)
    except OSError as error:
        part.unlink(missing_ok=True)
        raise BadFile(path, f"cannot be written ({error.strerror or error}).") from None
