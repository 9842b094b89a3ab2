"""The router of a site: its hub tells where it listens, and its uplink is replaced when a link is back."""

from __future__ import annotations

import socket
import time
from collections.abc import Iterator
from contextlib import ExitStack
from pathlib import Path
from typing import Any

import pytest

from selfconf.access import Authority, PrincipalKind
from selfconf.bus.credentials import Credentials
from selfconf.bus.loop import Loop
from selfconf.bus.zenoh import ANYWHERE_ON_LOOPBACK, Security, ZenohBus, client, router, with_port
from selfconf.bus.zenoh import relay as relaying
from selfconf.bus.zenoh.descriptors import sockets_at
from selfconf.bus.zenoh.door import MOST_AT_DOOR, Door
from selfconf.bus.zenoh.relay import Hub, Relay
from selfconf.bus.zenoh.session import GREETING, open_session
from selfconf.errors import NetworkError
from selfconf.protocol.endpoints import endpoint_port
from tests.bus.zenoh.test_bus import until

NOBODY = "tcp/127.0.0.1:1"
"""An endpoint on which nothing listens: an uplink does not wait for it. No hub that takes any free port is given it."""


class CountedRelay(Relay):
    """A relay that counts its uplinks."""

    opened = 0

    def open_uplink(self) -> list[Any]:
        self.opened += 1
        return super().open_uplink()


@pytest.fixture
def hub() -> Hub:
    """A hub, which its relay closes."""
    return Hub(ANYWHERE_ON_LOOPBACK)


@pytest.fixture
def relay(hub: Hub, monkeypatch: pytest.MonkeyPatch) -> Iterator[CountedRelay]:
    """A relay without others, which replaces its uplink without delay where there is need."""
    monkeypatch.setattr(relaying, "QUIET", 0.0)
    monkeypatch.setattr(relaying, "RETRY_SPREAD", 0.0)
    monkeypatch.setattr(relaying, "AFTER_END", 0.0)
    relay = CountedRelay(hub, Loop(), [])
    yield relay
    relay.close()


def notice(relay: CountedRelay, *changes: bool) -> None:
    """Let the present uplink see its link to one hub change, and let the loop do what follows."""
    assert relay._uplink is not None
    for up in changes:
        relay.link_changed(relay._uplink, "another hub", up)
    relay._loop.poll()


def test_a_hub_says_which_free_port_it_has_taken(relay: CountedRelay, hub: Hub) -> None:
    assert not hub.endpoint.endswith(":0")
    with pytest.raises(NetworkError, match=f"cannot listen on {hub.endpoint}: the port is in use"):
        Hub(hub.endpoint)


def test_a_hub_on_all_addresses_is_reached_from_its_own_host_by_loopback() -> None:
    hub = Hub("tcp/0.0.0.0:0")
    assert hub.from_here == hub.endpoint.replace("0.0.0.0", "127.0.0.1")
    hub.close()


def test_nobody_stays_connected_to_a_hub_that_has_broken_inside_and_was_closed(monkeypatch: pytest.MonkeyPatch) -> None:
    hub = Hub(ANYWHERE_ON_LOOPBACK)
    connected = client([hub.endpoint])
    try:
        assert until(lambda: bool(connected.link), connected)
        with monkeypatch.context() as broken:
            broken.setattr(relaying, "_close", lambda _: None)
            hub.close()
        assert until(lambda: not connected.link, connected)
    finally:
        connected.close()
        hub.close()


def test_what_has_connected_while_a_hub_was_opened_is_to_connect_again(monkeypatch: pytest.MonkeyPatch) -> None:
    """A client that connects while a router begins may hear nothing of it."""
    early: list[socket.socket] = []

    def opened(*arguments: Any, listen: list[str], **options: Any) -> Any:
        session = open_session(*arguments, listen=listen, **options)
        port = endpoint_port(listen[0])
        assert port is not None
        early.append(socket.create_connection(("127.0.0.1", port)))
        deadline = time.monotonic() + 10.0
        while len(list(sockets_at(port))) < 2 and time.monotonic() < deadline:
            time.sleep(0.005)  # nothing tells when Zenoh has accepted a connection
        return session

    monkeypatch.setattr(relaying, "open_session", opened)
    hub = Hub(ANYWHERE_ON_LOOPBACK)
    try:
        early[0].settimeout(10.0)
        began = time.monotonic()
        assert early[0].recv(1) == b""
        assert time.monotonic() - began < GREETING / 2, "it was ended, and not only given up"
        client([hub.endpoint]).close()
    finally:
        early[0].close()
        hub.close()


def test_a_hub_listens_for_datagrams_too() -> None:
    """To cut the connections that are made too early, its one socket of UDP is not to be shut down."""
    hub = Hub("udp/127.0.0.1:0")
    try:
        client([hub.endpoint]).close()
    finally:
        hub.close()


def test_strangers_who_fill_the_door_of_a_hub_keep_out_neither_its_host_nor_others_for_long(tmp_path: Path) -> None:
    authority = Authority.init(tmp_path / "authority")
    hub = Hub("tls/127.0.0.1:0", Security(authority.credentials((PrincipalKind.SITE,), "home")))
    reader = authority.credentials((PrincipalKind.READER,))
    try:
        with ExitStack() as held:
            for _ in range(MOST_AT_DOOR + 20):
                held.enter_context(socket.create_connection(("127.0.0.1", endpoint_port(hub.endpoint))))
            began = time.monotonic()
            client([hub.from_here], credentials=reader).close()
            assert time.monotonic() - began < 1.0
        assert endpoint_port(hub.from_here) != endpoint_port(hub.endpoint)
        client([hub.endpoint], seconds=30.0, credentials=reader).close()
    finally:
        hub.close()


def sees(bus: ZenohBus, life: str) -> bool:
    """Whether a bus is told of a life now."""
    told: list[tuple[str, ...]] = []
    bus.roll_call(life, 0.5, told.append)
    return until(lambda: bool(told), bus) and life in told[0]


def test_a_hub_that_is_opened_anew_sees_the_one_that_it_connects_to_again(tmp_path: Path) -> None:
    """An uplink that leaves just as its successor comes has that taken for it at the other hub."""
    authority = Authority.init(tmp_path / "authority")
    shown = [Security(authority.credentials((PrincipalKind.SITE,), name)) for name in ("kitchen", "attic")]
    kitchen = router("tls/127.0.0.1:0", security=shown[0])
    attic = router("tls/127.0.0.1:0", [kitchen.endpoint], security=shown[1])
    try:
        kitchen.announce("life")
        assert until(lambda: sees(attic, "life"), kitchen)
        for _ in range(6):
            attic.secure(shown[1])
            assert until(lambda: sees(attic, "life"), kitchen)
    finally:
        attic.close()
        kitchen.close()


def test_an_uplink_has_the_rules_and_the_certificate_of_its_hub_and_ends_with_it(tmp_path: Path) -> None:
    authority = Authority.init(tmp_path / "authority")
    shown = [Security(authority.credentials((PrincipalKind.SITE,), name)) for name in ("kitchen", "attic")]
    kitchen = router("tls/127.0.0.1:0", security=shown[0])
    attic = router("tls/127.0.0.1:0", [kitchen.endpoint], security=shown[1])

    def links() -> set[int]:
        port = endpoint_port(kitchen.endpoint)
        assert port is not None
        return {found.getsockname()[1] for found in sockets_at(port, from_here=True)}

    try:
        assert until(links, kitchen)
        before = links()
        attic.secure(Security(shown[1].credentials))
        assert until(lambda: links() and not links() & before, attic), "each link is a new one"
    finally:
        attic.close()
        alone = until(lambda: not links(), kitchen)
        kitchen.close()
    assert alone


def test_strangers_are_kept_out_of_a_hub_that_was_opened_anew_too(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    judged: list[str] = []

    class CountedDoor(Door):
        def opened(self) -> None:
            judged.append(self._endpoint)
            super().opened()

    monkeypatch.setattr(relaying, "Door", CountedDoor)
    shown = Security(Authority.init(tmp_path / "authority").credentials((PrincipalKind.SITE,), "kitchen"))
    kitchen = Hub("tls/127.0.0.1:0", shown)
    try:
        kitchen.secure(shown)
    finally:
        kitchen.close()
    assert judged == [kitchen.endpoint] * 2


@pytest.mark.parametrize("settings", ["#so_rcvbuf=65536", "?prio=1"])
def test_a_hub_with_settings_of_its_link_listens_on_a_free_port_and_is_closed(settings: str) -> None:
    hub = Hub(f"{ANYWHERE_ON_LOOPBACK}{settings}")
    assert hub.endpoint.endswith(settings)
    assert hub.endpoint != f"{ANYWHERE_ON_LOOPBACK}{settings}"
    hub.close()


def test_a_hub_on_a_local_socket_is_closed(tmp_path: Path) -> None:
    Hub(f"unixsock-stream/{tmp_path / 'hub'}").close()


def test_a_hub_at_a_port_that_is_taken_reads_no_rules(monkeypatch: pytest.MonkeyPatch) -> None:
    """A site that takes the place of another tries several ports; the rules of hundreds of components take a while."""

    def opened(*_: object, **__: object) -> None:
        raise AssertionError("Zenoh reads the rules before it looks whether the port is free")

    monkeypatch.setattr(relaying, "open_session", opened)
    with socket.create_server(("127.0.0.1", 0)) as taken, pytest.raises(NetworkError, match="the port is in use"):
        Hub(f"tcp/127.0.0.1:{taken.getsockname()[1]}")


def test_a_hub_whose_keys_are_gone_stays_as_it_is(tmp_path: Path) -> None:
    hub = Hub(ANYWHERE_ON_LOOPBACK)
    gone = Credentials("site.home", tmp_path / "certificate.pem", tmp_path / "key", tmp_path / "authority", tmp_path)
    with pytest.raises(NetworkError, match=r"certificate\.pem cannot be read"):
        hub.secure(Security(gone))
    with pytest.raises(NetworkError, match="the port is in use"):
        Hub(hub.endpoint)
    hub.close()


def test_a_relay_without_other_hubs_needs_no_uplink(relay: CountedRelay, hub: Hub) -> None:
    relay.connect([hub.endpoint])
    assert relay.opened == 0


def test_a_further_hub_is_reached_by_a_new_uplink(relay: CountedRelay) -> None:
    relay.connect([NOBODY])
    relay.connect([with_port(ANYWHERE_ON_LOOPBACK)])
    assert relay.opened == 2
    assert len(relay._others) == 2


def test_an_uplink_that_has_lost_a_hub_and_has_it_back_is_replaced(relay: CountedRelay) -> None:
    relay.connect([NOBODY])
    notice(relay, False, True)
    assert relay.opened == 2


def test_an_uplink_that_has_lost_a_hub_for_good_stays(relay: CountedRelay) -> None:
    relay.connect([NOBODY])
    notice(relay, True, False)
    assert relay.opened == 1


def test_an_uplink_that_was_replaced_is_listened_to_no_more(relay: CountedRelay) -> None:
    relay.connect([NOBODY])
    old = relay._uplink
    assert old is not None
    relay.connect([NOBODY])
    relay.link_changed(old, "another hub", False)
    relay.link_changed(old, "another hub", True)
    relay._loop.poll()
    assert relay.opened == 2


def test_few_replaced_uplinks_stay_however_fast_links_change(relay: CountedRelay) -> None:
    for _ in range(relaying.MOST_LINGERING + 3):
        relay.connect([NOBODY])
    assert len(relay._lingering) == relaying.MOST_LINGERING


def test_an_uplink_for_which_no_new_one_can_be_opened_stays_until_one_can(
    relay: CountedRelay, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    relay.connect([NOBODY])
    old = relay._uplink
    with monkeypatch.context() as refusing:

        def refuse(_: CountedRelay) -> list[Any]:
            refusing.undo()
            assert relay._uplink is old
            raise NetworkError("too many open files")

        refusing.setattr(CountedRelay, "open_uplink", refuse)
        notice(relay, False, True)
    assert "too many open files" in caplog.text
    relay._loop.run(lambda: relay._uplink is not old)
    assert relay.opened == 2
