"""The pictures of README.md and of the guide, and the outputs that the guide shows.

    make walk
    python docs/pictures/make_pictures.py --walk out/walk      # README.md: the default walk
    python docs/pictures/make_pictures.py --guide out/guide    # the guide: runs the examples

The guide's programs run in the folder that is given, some minutes. What they print replaces what
is between the markers in docs/*.md; what they draw becomes a picture here. `--keep` runs only what
has not run there yet, `--only NAME` one part. `drakegait fidelity --docs docs` makes the figures of
docs/fidelity.md.

Chromium or Chrome must be installed.
"""

from __future__ import annotations

import argparse
import tempfile
from pathlib import Path

from browser import picture_of
from guide import PICTURES, RUNS, Program, guide_output, run
from PIL import Image

from drakegait import Gait, compare, plot, replay
from drakegait.paper.document import update

FOLDER = Path(__file__).resolve().parent
DOCS = FOLDER.parent
WIDTH = 1000  # [pixel] of all pictures
LARGEST = 150_000  # [byte] of a file
WINDOW = (1500, 900)  # [pixel] of the browser
CUT = (200, 115, 1420, 805)  # of the replay's view: left, upper, right, lower [pixel]
SHARE = 1.02  # strides after the start: just after a right heel strike
# Holds the film at an instant, again and again until the picture is taken, without the legend.
HOLD = """<script>setInterval(() => {{
  viewer.animator.pause(); viewer.animator.seek({time});
  document.querySelectorAll(".dg, body > div:not(#meshcat-pane)").forEach((box) => {{
    box.style.display = "none";
  }});
}}, 50)</script></body>"""


def replay_picture(gait: Gait, folder: Path) -> Image.Image:
    """The replay at `SHARE` strides."""
    page = folder / "replay.html"
    replay(gait, html=page, strides=3)
    head, _, tail = page.read_text(encoding="utf-8").rpartition("</body>")
    page.write_text(head + HOLD.format(time=SHARE * gait.stride_time) + tail, encoding="utf-8")
    return picture_of(page, WINDOW, folder).crop(CUT)


def compare_picture(gaits: list[Gait], labels: list[str], folder: Path) -> Image.Image:
    """The top of a comparison."""
    page = folder / "compare.html"
    compare(*gaits, labels=labels).save(page)
    return picture_of(page, (1100, 1000), folder)


def save(picture: Image.Image, name: str, colours: int | None = 256) -> None:
    """Write a PNG of few bytes, with a palette of so many colours if that is enough for it."""
    size = (WIDTH, round(WIDTH * picture.height / picture.width))
    small = picture.convert("RGB").resize(size, Image.Resampling.LANCZOS)
    path = FOLDER / f"{name}.png"
    if colours is not None:
        small = small.quantize(colours, dither=Image.Dither.NONE)
    small.save(path, optimize=True)
    print(f"{path}: {size[0]} x {size[1]}, {path.stat().st_size / 1000:.0f} kB")
    if path.stat().st_size > LARGEST:
        raise SystemExit(f"{path} is larger than {LARGEST / 1000:.0f} kB.")


def make_readme(gait: Gait, folder: Path) -> None:
    """The pictures of README.md."""
    plot(gait, folder)
    save(Image.open(folder / "joint_angles.png"), "joint_angles")
    save(replay_picture(gait, folder), "replay", colours=None)


def make_part(program: Program, runs: Path, keep: bool, folder: Path) -> None:
    """Run a program of the guide; put down what it prints and draws."""
    printed = run(program, runs, keep)
    if program.page is not None:
        begin, end = (f"<!-- output:{program.name}:{word} -->" for word in ("begin", "end"))
        update(DOCS / program.page, guide_output(program, printed), begin, end)
    for name, file in PICTURES.items():
        if file.startswith(f"{program.name}/"):
            save(Image.open(runs / file), name)
    out = runs / program.name
    if program.name == "first_walk":
        save(replay_picture(Gait.load(out / "gait.nc"), folder), "first_walk_replay")
    elif program.name == "own_data":
        page = out / "subject_quality.html"
        save(picture_of(page, (1100, 1250), folder), "own_data_quality", colours=64)
    elif program.name == "heavy_foot":
        gaits = [Gait.load(out / "normal.nc"), Gait.load(out / "heavy.nc")]
        labels = ["no weight", "2 kg on the right foot"]
        save(compare_picture(gaits, labels, folder), "compare")


def main() -> None:
    """Make what is asked for."""
    parser = argparse.ArgumentParser(description="Makes the pictures of README.md and the guide.")
    parser.add_argument("--walk", type=Path, help="a gait.nc, or the folder that holds it")
    parser.add_argument("--guide", type=Path, help="folder in which the examples run")
    parser.add_argument("--keep", action="store_true", help="use what has run there earlier")
    parser.add_argument("--only", choices=[p.name for p in RUNS], help="one part of the guide")
    given = parser.parse_args()
    if given.walk is None and given.guide is None:
        parser.error("give --walk, --guide or both")
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as name:
        if given.walk is not None:
            path = given.walk / "gait.nc" if given.walk.is_dir() else given.walk
            make_readme(Gait.load(path), Path(name))
        if given.guide is not None:
            for program in RUNS:
                if given.only in (None, program.name):
                    make_part(program, given.guide.resolve(), given.keep, Path(name))


if __name__ == "__main__":
    main()
