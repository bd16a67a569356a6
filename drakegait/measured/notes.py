"""What the reader of measurements has to say: everything it changed or doubts, in words."""

from __future__ import annotations


class Notes:
    """Sentences for the user, each said once, in the order in which they came up."""

    def __init__(self) -> None:
        self._sentences: list[str] = []

    def say(self, sentence: str) -> None:
        """Note one sentence."""
        if sentence not in self._sentences:
            self._sentences.append(sentence)

    @property
    def sentences(self) -> tuple[str, ...]:
        """All that was said."""
        return tuple(self._sentences)
