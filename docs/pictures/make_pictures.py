"""The pictures of README.md, from a gait that was solved and saved.

    make walk
    python docs/pictures/make_pictures.py out/walk

`replay.png` is a view of the replay in a browser without a window (Chromium or Chrome must be
installed); `joint_angles.png` is the figure of that name.
"""

from __future__ import annotations

import argparse
import os
import shutil
import subprocess
import tempfile
from pathlib import Path

from PIL import Image

from drakegait import Gait, plot, replay

FOLDER = Path(__file__).resolve().parent
WIDTH = 1000  # [pixel] of both pictures
LARGEST = 250_000  # [byte] of a file
WINDOW = (1500, 900)  # [pixel] of the browser
CUT = (200, 115, 1420, 805)  # of the browser's view: left, upper, right, lower [pixel]
SHARE = 1.02  # strides after the start: just after a right heel strike
BROWSERS = ("chromium", "chromium-browser", "google-chrome", "chrome")
# No window, no calls to the network, and a graphics card made of software.
FLAGS = (
    "--headless", "--no-first-run", "--disable-background-networking", "--disable-component-update",
    "--disable-sync", "--use-angle=swiftshader", "--enable-unsafe-swiftshader",
    "--ignore-gpu-blocklist", "--timeout=9000",
)  # fmt: skip
# Holds the film at an instant, again and again until the picture is taken, without the legend.
HOLD = """<script>setInterval(() => {{
  viewer.animator.pause(); viewer.animator.seek({time});
  document.querySelectorAll(".dg, body > div:not(#meshcat-pane)").forEach((box) => {{
    box.style.display = "none";
  }});
}}, 50)</script></body>"""


def browser() -> str:
    """The command of a browser that can work without a window."""
    for name in BROWSERS:
        if shutil.which(name):
            return name
    raise SystemExit(f"The picture of the replay needs one of: {', '.join(BROWSERS)}.")


def screenshot(gait: Gait, folder: Path) -> Image.Image:
    """The replay at `SHARE` strides."""
    page, picture = folder / "replay.html", folder / "replay.png"
    replay(gait, html=page, strides=3)
    head, _, tail = page.read_text(encoding="utf-8").rpartition("</body>")
    page.write_text(head + HOLD.format(time=SHARE * gait.stride_time) + tail, encoding="utf-8")
    flags = [*FLAGS, f"--user-data-dir={folder / 'profile'}"]
    flags += [f"--window-size={WINDOW[0]},{WINDOW[1]}", f"--screenshot={picture}"]
    if hasattr(os, "geteuid") and os.geteuid() == 0:
        flags.append("--no-sandbox")  # Chromium's own refuses to run for root
    subprocess.run(
        [browser(), *flags, page.as_uri()], check=True, timeout=120, stderr=subprocess.DEVNULL
    )
    return Image.open(picture).convert("RGB").crop(CUT)


def save(picture: Image.Image, name: str, colours: int | None = None) -> None:
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


def main() -> None:
    """Make both pictures."""
    parser = argparse.ArgumentParser(description="Makes the pictures of README.md.")
    parser.add_argument("gait", type=Path, help="a gait.nc, or the folder that holds it")
    given = parser.parse_args().gait
    gait = Gait.load(given / "gait.nc" if given.is_dir() else given)
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as name:
        folder = Path(name)
        plot(gait, folder)
        save(Image.open(folder / "joint_angles.png"), "joint_angles", colours=256)
        save(screenshot(gait, folder), "replay")


if __name__ == "__main__":
    main()
