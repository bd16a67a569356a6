"""What the tests do with a page: listen to it, wait for it, look at it."""

import io
from urllib.parse import urlsplit

import numpy as np

VIEW = {"width": 1000, "height": 640}


class Visit:
    """A page with what it complained about and where it wanted to go."""

    def __init__(self, page):
        self.page, self.complaints, self.abroad = page, [], []
        page.on("console", self._hear)
        page.on("pageerror", lambda error: self.complaints.append(str(error)))
        page.on("request", lambda request: self._see(request.url))
        page.on("websocket", lambda socket: self._see(socket.url))

    def _hear(self, message):
        # Software rendering reports how slow it is to read pixels back; that is the test's doing.
        if message.type in ("error", "warning") and "GPU stall" not in message.text:
            self.complaints.append(message.text)

    def _see(self, address: str):
        there = urlsplit(address)
        if there.scheme in ("http", "https", "ws", "wss") and there.hostname != "localhost":
            self.abroad.append(address)

    def ready(self, frame=None):
        """The frame, once its animation is loaded."""
        frame = frame or self.page
        frame.wait_for_function(
            "() => typeof viewer !== 'undefined' && viewer.animator.actions.length > 0",
            timeout=60_000,
        )
        return frame


def picture(page, **options) -> np.ndarray:
    """A screenshot as an array (rows, columns, 3), 0..255."""
    from PIL import Image

    shot = Image.open(io.BytesIO(page.screenshot(**options))).convert("RGB")
    return np.asarray(shot, dtype=float)


def not_blank(shot: np.ndarray) -> bool:
    """Whether there is more to see than a background that fades from top to bottom."""
    across = shot.std(axis=1).mean(axis=1)  # within each row
    return bool((across > 5.0).mean() > 0.3)


def changed(first: np.ndarray, second: np.ndarray) -> float:
    """Share of pixels that clearly differ."""
    return float((np.abs(first - second).max(axis=-1) > 40.0).mean())
