"""A component that is started again: its site ends its process, and starts another one."""

from __future__ import annotations

from collections.abc import Callable, Iterable

from selfconf.api.living.component_states import ComponentState
from selfconf.api.synchronous_bus import SynchronousBus
from selfconf.discovery import FoundAdvertisement
from selfconf.errors import NetworkError
from selfconf.protocol.codec import encode
from selfconf.protocol.keys import Keys
from selfconf.protocol.messages import End, Wake

ENDING_PROCESS = 10.0
"""How long, in seconds, a site may take to end a process."""
LIVES_AGAIN = 20.0
"""How long, in seconds, a component that is started again may take until it lives."""


def restarted(
    bus: SynchronousBus,
    keys: Keys,
    found: FoundAdvertisement,
    life: str | None,
    states: Callable[[], Iterable[ComponentState]],
) -> ComponentState:
    """How a component is once it lives again; `life` is the one that it lives now, `states` tells how all are.

    Raises NetworkError for what its site cannot or does not do.
    """
    one, site = found.advertisement.component, found.site
    if not found.startable:
        raise NetworkError(
            f"the site {site} cannot start {one.short}: its advertisement has no sc:command; restart its program"
            " by what has started it"
        )
    if life is not None:
        bus.demand(keys.end(site), encode(End(one)), f"the site {site} did not end {one.short}", ENDING_PROCESS)
    bus.demand(keys.wake(site), encode(Wake(one)), f"the site {site} did not start {one.short}")
    deadline = bus.now() + LIVES_AGAIN
    while bus.now() < deadline:
        now = next((state for state in states() if state.component == one), None)
        if now is not None and now.life and now.life != life:
            return now
        bus.pause(0.1)
    raise NetworkError(
        f"the site {site} has started {one.short}, which does not live after {LIVES_AGAIN:.0f} s;"
        f" `selfconf log {one.short}` shows what it has said"
    )
