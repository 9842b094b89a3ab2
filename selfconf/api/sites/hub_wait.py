"""How long a site that has lost its hub waits for those that relay, before it takes the place of one that hangs.

A relay that hangs receives nothing. A site that has had no hub for `HUNG` seconds takes its place on another port and
writes into its file that it relays no more; when it goes on it reads that, and closes its hub. All others, and the site
itself, may still be waiting for the one that hangs to answer them, at each endpoint where it listens. So all let the
new one have the time of these handshakes and `REACHED` seconds: else each would take the place of the one before, or
that one would take its own hub for broken, and nothing would relay for longer than a moment.

A relay whose process runs is left its place for `SLOW` seconds more: it may only be busy with all those that have lost
it, as after a common stall. Who takes its place cuts off all that have reached it again, and the same begins anew.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

from selfconf.bus.zenoh import GREETING

HUNG = 0.5
"""Seconds without a hub, beyond the lease, after which one that relays and is suspended is taken to hang."""
SLOW = 1.5
"""Seconds more for one whose process runs: where all have lost it at once, it may only be busy with the others."""
REACHED = 1.0
"""Seconds until a site has surely reached one that has begun to relay, beyond handshakes with those that hang."""


class HubWait:
    """The wait of one site for a hub: it begins when the site has none, and anew when others relay than before."""

    def __init__(self, now: Callable[[], float], hubs: Sequence[str], endpoints_each: int) -> None:
        """`hubs` are the endpoints of those that relay now; each listens at `endpoints_each` endpoints."""
        self._now, self._endpoints_each = now, endpoints_each
        self.awaited = hubs
        """The endpoints of the hubs that there were when the site last had one, or that it has since tried."""
        self._over_at: float | None = None
        """When those that relay are taken to hang if they are suspended; None while there is a hub."""

    def end(self, hubs: Sequence[str]) -> None:
        """There is a hub, one of these."""
        self.awaited, self._over_at = hubs, None

    def begin(self) -> None:
        """There is no hub, from now on unless it was so before."""
        if self._over_at is None:
            self._over_at = self._now() + HUNG

    def begin_anew(self, hubs: Sequence[str]) -> None:
        """Let those that relay since this moment be reached: those before may have to be given up one by one first."""
        handshakes = self._endpoints_each * max(1, len(self.awaited))
        self.awaited, self._over_at = hubs, self._now() + handshakes * GREETING + REACHED

    def is_over(self, suspended: bool) -> bool:
        """Whether those that relay are taken to hang; sooner if it is known that they are suspended."""
        return self._over_at is not None and self._now() > self._over_at + (0.0 if suspended else SLOW)
