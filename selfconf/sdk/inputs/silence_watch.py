"""Whether an output that has promised a rate keeps it, as one input that follows it sees.

An output is silent when no signal has come for `PATIENCE` of the promised periods, and is reported again for as long as
none comes. While this process stands still (its machine stalls, or it is suspended) no signal can come, so the time by
which a check is late does not count. Checks are made once in each promised period, or 40 times a second; so of a
standstill at most one period, or 25 ms, counts.

What lies between may stand still as well: the router that all signals go through. So before the first report the
network is asked who lives as the component. If the answer takes longer than a period, the output gets the whole time
once more; an answer that never comes is waited for no longer than `NETWORK_ANSWER`.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from selfconf.bus.port import Bus, Undo

PATIENCE = 4.0
"""After how many promised periods without a signal an output counts as silent."""
LEAST_PATIENCE = 0.1
"""Seconds without a signal that no output is blamed for: less than that is the network's and the scheduler's."""
NETWORK_ANSWER = 1.0
"""Seconds that the network may take to answer at most."""
BEGINNING = 20.0
"""Seconds that an output may take to issue its first signal: its component may have to be started by its site."""


class SilenceWatch:
    """Looks for the silence of one output from when a signal is expected until it is ended."""

    def __init__(
        self, bus: Bus, key: str, period: float | None, heard_at: Callable[[], float], silent: Callable[[float], None]
    ) -> None:
        """`period` is the promised one in seconds, None if no rate is; `heard_at` tells when the newest signal came.

        `key` is that of the lives of the component; `silent` is called with the seconds for which no signal has come.
        """
        self._bus, self._key, self._period, self._heard_at, self._silent = bus, key, period, heard_at, silent
        self._looking: _Looking | None = None

    def expect(self, first: bool) -> None:
        """Expect a signal within the promised time, from now on; `first` if none has come yet."""
        if self._period is None:
            return
        self.end()
        usual = max(PATIENCE * self._period, LEAST_PATIENCE)
        self._looking = _Looking(
            self._bus, self._key, usual, max(usual, BEGINNING) if first else usual, self._heard_at, self._silent
        )

    def end(self) -> None:
        """Expect no signal any more."""
        if self._looking is not None:
            self._looking.end()
            self._looking = None


class _Looking:
    """Looks from time to time whether a signal has come: the first one within a time of its own."""

    def __init__(
        self,
        bus: Bus,
        key: str,
        usual: float,
        first: float,
        heard_at: Callable[[], float],
        silent: Callable[[float], None],
    ) -> None:
        self._bus, self._key, self._usual, self._first = bus, key, usual, first
        self._heard_at, self._silent = heard_at, silent
        self._began = self._quiet_since = bus.now()
        self._excused_at: float | None = None
        """When the newest signal had come as the output was given the whole time once more."""
        self._ended = False
        self._next: Undo
        self._wait(usual)

    def end(self) -> None:
        """Look no more."""
        self._ended = True
        self._next()

    @property
    def _allowed(self) -> float:
        return self._usual if self._heard_at() >= self._began else self._first

    def _wait(self, left: float) -> None:
        pause = min(left, self._usual / PATIENCE)
        self._next = self._bus.later(pause, partial(self._look, self._bus.now() + pause))

    def _look(self, due: float) -> None:
        now = self._bus.now()
        self._quiet_since = min(now, max(self._quiet_since, self._heard_at()) + max(0.0, now - due))
        left = self._quiet_since + self._allowed - now
        if left > 0:
            self._wait(left)
        elif self._excused_at == self._heard_at():
            self._silent(self._allowed)
        else:
            self._bus.roll_call(self._key, NETWORK_ANSWER, partial(self._answered, now))

    def _answered(self, asked: float, _: tuple[str, ...]) -> None:
        """The network has answered, or not in time."""
        if self._ended:
            return
        now, heard_at = self._bus.now(), self._heard_at()
        if heard_at > asked:
            self._quiet_since = heard_at
            self._wait(self._allowed)
        elif now - asked > self._usual / PATIENCE:
            self._excused_at, self._quiet_since = heard_at, now
            self._wait(self._allowed)
        else:
            self._silent(self._allowed)
