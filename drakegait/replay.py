"""A gait to look at: Drake's Meshcat, live or recorded in one self-contained file.

    replay(gait, html="replay.html")        # open it in any browser, also without a network
    meshcat = replay(gait)                  # live at meshcat.web_url()

Muscles turn from blue (activation 0) to red (1); where they run is decoration. Arrows are the
ground reactions at the centres of pressure. The view travels with the walker.
"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from drakegait.errors import InvalidInput
from drakegait.quantities import check_count
from drakegait.replay_page import page_of_one
from drakegait.whole_file import write_text

if TYPE_CHECKING:
    from pydrake.geometry import Meshcat

    from drakegait.gait import Gait

MOST_STRIDES = 20
PORTS = (1024, 65535)


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
    check_count("strides", strides, 1, MOST_STRIDES)
    if port is not None:
        check_count("port", port, *PORTS)
    from drakegait.replay_film import Film, animate
    from drakegait.replay_scene import build, set_view

    meshcat = open_meshcat(port)
    size = gait.study.subject.length_scale
    set_view(meshcat, size)
    pieces = build(meshcat, gait, int(strides))
    meshcat.SetAnimation(animate(Film.of(gait), pieces, int(strides), size))
    if html is not None:
        write_text(html, page_of_one(meshcat.StaticHtml(), gait))
    return meshcat


def open_meshcat(port: int | None) -> Meshcat:
    """A Meshcat that listens; raises InvalidInput if the port is taken."""
    from pydrake.geometry import Meshcat, MeshcatParams

    params = MeshcatParams(show_stats_plot=False)
    params.port = None if port is None else int(port)
    try:
        return Meshcat(params)
    except RuntimeError as error:
        raise InvalidInput("port", port, f"a free one ({error})") from None
