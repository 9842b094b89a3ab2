"""A component is started again by its site: its process ends first, and what does not come back is an error."""

from __future__ import annotations

from pathlib import Path

import pytest

from selfconf import files
from selfconf.api.living.component_states import ComponentState
from selfconf.api.living.restarting import LIVES_AGAIN, restarted
from selfconf.api.synchronous_bus import SynchronousBus
from selfconf.bus.memory import Network
from selfconf.bus.port import Request
from selfconf.discovery import FoundAdvertisement
from selfconf.errors import NetworkError
from selfconf.protocol.codec import decode
from selfconf.protocol.keys import Keys
from selfconf.protocol.messages import End, Wake

ROOT = Path(__file__).resolve().parents[3]
KEYS = Keys("lab")
CLOCK = files.advertisements(ROOT / "examples" / "clock" / "clock.ttl")[0][0]


class Attic:
    """A site that ends and starts the process of a component, which lives a new life then if it `obeys`."""

    def __init__(self, *, obeys: bool = True, startable: bool = True, life: str | None = "1") -> None:
        self.network, self.life, self.obeys = Network(), life, obeys
        self.said: list[str] = []
        self.found = FoundAdvertisement(CLOCK, "attic", "clock.ttl", startable)
        node = self.network.node()
        node.serve(KEYS.end("attic"), self._end)
        node.serve(KEYS.wake("attic"), self._wake)
        self._bus = SynchronousBus(self.network.node())

    def _end(self, request: Request) -> None:
        self.said.append(f"end {decode(request.payload, End).component.short}")
        self.life = None
        request.reply(request.key, b"")
        request.finish()

    def _wake(self, request: Request) -> None:
        self.said.append(f"wake {decode(request.payload, Wake).component.short}")
        if self.obeys:
            self.life = "2"
        request.reply(request.key, b"")
        request.finish()

    def states(self) -> list[ComponentState]:
        """How the component is."""
        return [ComponentState(CLOCK.component, (), "attic", "alive", life=self.life or "")]

    def restarted(self) -> ComponentState:
        """Have the component started again."""
        return restarted(self._bus, KEYS, self.found, self.life, self.states)


def test_the_process_that_lives_ends_before_another_is_started() -> None:
    attic = Attic()
    assert attic.restarted().life == "2"
    assert attic.said == ["end clock", "wake clock"]


def test_what_does_not_live_is_only_started() -> None:
    attic = Attic(life=None)
    assert attic.restarted().life == "2"
    assert attic.said == ["wake clock"]


def test_what_its_site_cannot_start_is_not_ended() -> None:
    attic = Attic(startable=False)
    with pytest.raises(NetworkError, match="the site attic cannot start clock: its advertisement has no sc:command"):
        attic.restarted()
    assert attic.said == []


def test_what_is_started_and_does_not_live_is_an_error_that_says_where_to_look() -> None:
    attic = Attic(obeys=False)
    began = attic.network.time
    with pytest.raises(NetworkError, match="which does not live after 20 s; `selfconf log clock` shows"):
        attic.restarted()
    assert LIVES_AGAIN <= attic.network.time - began < LIVES_AGAIN + 1.0
