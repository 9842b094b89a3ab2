"""Whether an output that has promised a rate keeps it, as one input that follows it sees.

An output is silent when no signal has come for `PATIENCE` of the promised periods, and is reported again for as long as
none comes. While this process stands still (its machine stalls, or it is suspended) no signal can come, so the time by
which a check is late does not count. Checks are made once in each promised period, or 40 times a second; so of a
standstill at most one period, or 25 ms, counts.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from selfconf.bus.port import Bus, Undo

PATIENCE = 4.0
"""After how many promised periods without a signal an output counts as silent."""
LEAST_PATIENCE = 0.1
"""Seconds without a signal that no output is blamed for: less than that is the network's and the scheduler's."""
BEGINNING = 20.0
"""Seconds that an output may take to issue its first signal: its component may have to be started by its site."""


class SilenceWatch:
    """Looks for the silence of one output from when a signal is expected until it is ended."""

    def __init__(
        self, bus: Bus, period: float | None, heard_at: Callable[[], float], silent: Callable[[float], None]
    ) -> None:
        """`period` is the promised one in seconds, None if no rate is; `heard_at` tells when the newest signal came.

        `silent` is called with the seconds for which none has come.
        """
        self._bus, self._period, self._heard_at, self._silent = bus, period, heard_at, silent
        self._next_look: Undo | None = None

    def expect(self, first: bool) -> None:
        """Expect a signal within the promised time, from now on; `first` if none has come yet."""
        if self._period is None:
            return
        self.end()
        usual = max(PATIENCE * self._period, LEAST_PATIENCE)
        self._look(self._bus.now(), usual, max(usual, BEGINNING) if first else usual)

    def end(self) -> None:
        """Expect no signal any more."""
        if self._next_look is not None:
            self._next_look()
            self._next_look = None

    def _look(self, began: float, usual: float, seconds: float) -> None:
        """Look from time to time whether a signal has come: within `seconds` the first, the next ones as usual."""
        quiet_since = began

        def wait(left: float) -> None:
            pause = min(left, usual / PATIENCE)
            self._next_look = self._bus.later(pause, partial(look, self._bus.now() + pause))

        def look(due: float) -> None:
            nonlocal quiet_since
            now = self._bus.now()
            quiet_since = min(now, max(quiet_since, self._heard_at()) + max(0.0, now - due))
            allowed = usual if self._heard_at() >= began else seconds
            left = quiet_since + allowed - now
            if left > 0:
                wait(left)
            else:
                self._silent(allowed)

        wait(usual)
