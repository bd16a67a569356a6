"""Pages as pictures, by Chromium or Chrome without a window."""

from __future__ import annotations

import os
import shutil
import subprocess
from pathlib import Path

from PIL import Image

BROWSERS = ("chromium", "chromium-browser", "google-chrome", "chrome")
# No window, no calls to the network, and a graphics card made of software.
FLAGS = (
    "--headless", "--hide-scrollbars", "--no-first-run", "--disable-background-networking",
    "--disable-component-update", "--disable-sync", "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader", "--ignore-gpu-blocklist", "--timeout=9000",
)  # fmt: skip


def browser() -> str:
    """The command of a browser that can work without a window."""
    for name in BROWSERS:
        if shutil.which(name):
            return name
    raise SystemExit(f"Pictures of pages need one of: {', '.join(BROWSERS)}.")


def picture_of(page: Path, window: tuple[int, int], folder: Path) -> Image.Image:
    """What a window of this size [pixel] shows of a page; the browser works in `folder`."""
    picture = folder / f"{page.stem}.png"
    flags = [*FLAGS, f"--user-data-dir={folder / 'profile'}"]
    flags += [f"--window-size={window[0]},{window[1]}", f"--screenshot={picture}"]
    if hasattr(os, "geteuid") and os.geteuid() == 0:
        flags.append("--no-sandbox")  # Chromium's own refuses to run for root
    subprocess.run(
        [browser(), *flags, page.as_uri()], check=True, timeout=300, stderr=subprocess.DEVNULL
    )
    return Image.open(picture).convert("RGB")
