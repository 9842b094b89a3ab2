"""How long to wait before something that has failed is tried again, as nothing tells that it could go on by now.

The pause doubles with each try, and is as short as the first again once what was tried has been well for a while.
"""

from __future__ import annotations

WELL_AGAIN = 60.0
"""Seconds after which what was tried again and does not fail is well again."""


class GrowingPause:
    """The pause before the next try of one thing, or of some that are tried together."""

    def __init__(self, first: float, longest: float) -> None:
        """The pauses are in seconds."""
        self._first, self._longest = first, longest
        self.seconds = first
        """How long the next pause is, by what has failed up to now."""

    def tried(self) -> None:
        """Be twice as long next time, as a try begins."""
        self.seconds = min(2 * self.seconds, self._longest)

    def failed_after(self, seconds: float) -> None:
        """Be as short as the first if what has failed now had been well for so long that it was well again."""
        if seconds > WELL_AGAIN:
            self.begin_anew()

    def begin_anew(self) -> None:
        """Be as short as the first."""
        self.seconds = self._first
