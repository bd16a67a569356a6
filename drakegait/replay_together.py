"""Several walkers in one replay, side by side and in step."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from drakegait.replay import open_meshcat
from drakegait.replay_film import FRAME_RATE, Film, add_walker, endless
from drakegait.replay_page import page_of_many
from drakegait.replay_scene import build, set_view

if TYPE_CHECKING:
    from drakegait.gait import Gait

STRIDES = 2
LANE = 1.05
"""Distance of the walkers from each other [m at 1.80 m of height]."""


def replay_together(
    gaits: Sequence[Gait], labels: Sequence[str], colours: Sequence[str], strides: int = STRIDES
) -> str:
    """A page that shows the walkers side by side, the first one nearest.

    In step means: at any time all are at the same percentage of their stride, from right heel
    strike. The stride of each is shown in the mean of their stride times; each keeps its place in
    the picture, its walkway moves.

    Args:
        labels: names of the walkers.
        colours: of their shirts, `"#rrggbb"`.
        strides: how many strides before the animation repeats.

    Returns:
        HTML that needs no other file and no network.
    """
    time = sum(gait.stride_time for gait in gaits) / len(gaits)
    frames = max(8, round(FRAME_RATE * time))
    size = max(gait.study.subject.length_scale for gait in gaits)
    lane = LANE * size
    meshcat = open_meshcat(None)
    set_view(meshcat, size, 0.5 * lane * (len(gaits) - 1), 1.0 + 0.12 * (len(gaits) - 1))
    animation = endless(frames / time)
    for number, (gait, colour) in enumerate(zip(gaits, colours, strict=True)):
        root = f"gait_{number + 1}"
        shirt = tuple(int(colour[place : place + 2], 16) / 255 for place in (1, 3, 5))
        pieces = build(meshcat, gait, strides, root, 0.95 * lane, shirt)
        film, scale = Film.of(gait, frames), gait.study.subject.length_scale
        add_walker(animation, film, pieces, strides, scale, root, number * lane)
    meshcat.SetAnimation(animation)
    return page_of_many(meshcat.StaticHtml(), gaits, labels, colours, time)
