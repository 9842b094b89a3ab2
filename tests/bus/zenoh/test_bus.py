"""What only a real network does: routers that come and go, floods, and lives by the hundred."""

from __future__ import annotations

import contextlib
import logging
import socket
import threading
import time
from collections.abc import Callable
from types import SimpleNamespace

import pytest
from zenoh import SampleKind, TransportEvent, WhatAmI

from selfconf.bus.port import Replies, Request, Sample, Urgency
from selfconf.bus.zenoh import ZenohBus, client, router, unread_links


def until(condition: Callable[[], bool], *buses: ZenohBus, seconds: float = 10.0) -> bool:
    """Let the buses say what they have to say until a condition holds."""
    deadline = time.monotonic() + seconds
    while not condition() and time.monotonic() < deadline:
        for bus in buses:
            bus.poll(0.005)
    return condition()


def test_clients_of_two_routers_that_are_connected_hear_each_other(zenoh_router: ZenohBus, top: str) -> None:
    second = router(connect=[zenoh_router.endpoint])
    one, two = client([zenoh_router.endpoint]), client([second.endpoint])
    heard: list[Sample] = []
    two.subscribe(f"{top}/pose", heard.append)
    matches: list[bool] = []
    publisher = one.publisher(f"{top}/pose", Urgency.SIGNAL, matches.append)
    assert until(lambda: matches == [True], one, two)
    assert until(lambda: publisher.put(b"across") or bool(heard), one, two)  # a signal may be lost
    for bus in (one, two, second):
        bus.close()


def test_a_client_that_reads_nothing_of_a_new_link_makes_another_one(
    zenoh_router: ZenohBus, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(unread_links, "_first_bytes", lambda end: end.encode())
    bus = client([zenoh_router.endpoint])
    first = bus.link
    assert until(lambda: bus.link not in ("", first), bus)
    bus.close()


@pytest.mark.parametrize("many", [False, True])
def test_lives_end_for_a_bus_whose_session_other_code_has_closed(zenoh_router: ZenohBus, top: str, many: bool) -> None:
    here, there = client([zenoh_router.endpoint]), client([zenoh_router.endpoint])
    there.announce(f"{top}/live/1")
    lives: list[tuple[str, bool]] = []
    undone: list[tuple[str, bool]] = []
    here.watch(f"{top}/live/*", lambda key, alive: lives.append((key, alive)), many=many)
    undo = here.watch(f"{top}/live/*", lambda key, alive: undone.append((key, alive)), many=many)
    assert until(lambda: lives == undone == [(f"{top}/live/1", True)], here)
    undo()
    lost: list[str] = []
    here.when_lost(lambda: lost.append(here.link))
    here._session.close()
    assert until(lambda: bool(lost), here)
    assert lost == [""]
    assert until(lambda: lives[1:] == [(f"{top}/live/1", False)], here)
    assert len(undone) == 1
    here.close()
    there.close()


def test_no_callback_of_zenoh_runs_on_the_thread_that_opens_a_bus(
    zenoh_router: ZenohBus, monkeypatch: pytest.MonkeyPatch
) -> None:
    threads: list[int] = []
    turned = ZenohBus._turned

    def noted(bus: ZenohBus, event: TransportEvent) -> None:
        threads.append(threading.get_ident())
        turned(bus, event)

    monkeypatch.setattr(ZenohBus, "_turned", noted)
    bus = client([zenoh_router.endpoint])
    assert bus.link
    assert threads
    assert threading.get_ident() not in threads, "a Ctrl-C would be raised in the callback, and get lost"
    bus.close()


def test_a_client_whose_router_is_gone_is_not_linked_and_is_again_when_it_is_back(top: str) -> None:
    first = router()
    bus = client([first.endpoint])
    lives: list[tuple[str, bool]] = []
    bus.announce(f"{top}/live/1")
    bus.watch(f"{top}/live/*", lambda key, alive: lives.append((key, alive)))
    assert until(lambda: bool(lives), bus)
    first.close()
    assert until(lambda: not bus.link, bus)
    second = router(first.endpoint)
    assert until(lambda: bool(bus.link), bus)
    other = client([first.endpoint])
    called: list[tuple[str, ...]] = []

    def called_again() -> bool:
        """The link is there a little before what is announced over it."""
        called.clear()
        other.roll_call(f"{top}/live/*", 1.0, called.append)
        return until(lambda: bool(called), bus, other) and called == [(f"{top}/live/1",)]

    assert until(called_again, bus, other)
    for node in (bus, other, second):
        node.close()


def test_a_direct_callback_that_breaks_is_logged_and_not_the_last(
    zenoh_router: ZenohBus, top: str, caplog: pytest.LogCaptureFixture
) -> None:
    heard: list[bytes] = []

    def receive(sample: Sample) -> None:
        heard.append(sample.payload)
        raise RuntimeError("no such port")

    undo = zenoh_router.subscribe(f"{top}/pose", receive, direct=True)
    publisher = zenoh_router.publisher(f"{top}/pose", Urgency.EVENT)
    with caplog.at_level(logging.ERROR):
        publisher.put(b"1")
        publisher.put(b"2")
        assert until(lambda: heard == [b"1", b"2"], zenoh_router)
    undo()
    assert "no such port" in caplog.text


def test_the_undo_of_a_direct_subscription_waits_for_the_call_that_is_under_way(
    zenoh_router: ZenohBus, top: str
) -> None:
    bus = client([zenoh_router.endpoint])
    entered, leave, undone = threading.Event(), threading.Event(), threading.Event()

    def receive(_: Sample) -> None:
        entered.set()
        leave.wait(5.0)

    undo = zenoh_router.subscribe(f"{top}/pose", receive, direct=True)
    matches: list[bool] = []
    publisher = bus.publisher(f"{top}/pose", Urgency.EVENT, matches.append)
    assert until(lambda: matches == [True], bus)
    publisher.put(b"1")
    assert entered.wait(5.0)

    def undo_it() -> None:
        undo()
        undone.set()

    thread = threading.Thread(target=undo_it)
    thread.start()
    assert not undone.wait(0.05)
    leave.set()
    assert undone.wait(5.0)
    thread.join()
    bus.close()


def test_a_flood_of_signals_delays_no_call(zenoh_router: ZenohBus, top: str) -> None:
    busy, caller = client([zenoh_router.endpoint]), client([zenoh_router.endpoint])
    heard: list[Sample] = []
    behind: list[int] = []

    def answer(request: Request) -> None:
        behind.append(len(heard))
        request.reply(f"{top}/@ctl/state", b"")
        request.finish()

    busy.subscribe(f"{top}/pose", heard.append)
    busy.serve(f"{top}/@ctl/state", answer)
    matches: list[bool] = []
    publisher = caller.publisher(f"{top}/pose", Urgency.EVENT, matches.append)
    assert until(lambda: matches == [True], caller)
    for _ in range(2000):
        publisher.put(b"")
    replies: list[Replies] = []
    caller.ask(f"{top}/@ctl/state", b"", 5.0, replies.append)
    assert until(lambda: busy._waiting.qsize() == 2, seconds=5.0)  # the call, and the mark for one of the bulk
    assert until(lambda: bool(replies), busy, caller)
    assert behind == [1]
    for bus in (busy, caller):
        bus.close()


def test_a_question_for_which_there_is_no_room_is_ended_at_once(
    zenoh_router: ZenohBus, top: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    busy, asker = client([zenoh_router.endpoint]), client([zenoh_router.endpoint])
    said: list[Replies] = []

    def answer(request: Request) -> None:
        request.reply(request.key, b"")
        request.finish()

    def answered() -> bool:
        said.clear()
        asker.ask(f"{top}/busy", b"", 10.0, said.append)
        return until(lambda: bool(said), asker, busy) and bool(said[0].samples)

    try:
        busy.serve(f"{top}/busy", answer)
        assert until(answered), "it is known who answers"
        said.clear()
        monkeypatch.setattr(ZenohBus, "MOST_BYTES", 1000)
        for _ in range(3):
            asker.ask(f"{top}/busy", b"x" * 400, 10.0, said.append)
        assert until(lambda: len(said) == 2, asker)
        assert until(lambda: len(said) == 3, asker, busy)
    finally:
        busy.close()
        asker.close()


def test_a_roll_call_of_hundreds_and_a_watch_of_them_miss_nobody(zenoh_router: ZenohBus, top: str) -> None:
    crowd, bus = client([zenoh_router.endpoint]), client([zenoh_router.endpoint])
    names = {f"{top}/{number}/live" for number in range(450)}
    for name in names:
        crowd.announce(name)
    called: list[int] = []

    def call() -> int:
        number = len(called)
        bus.roll_call(f"{top}/*/live", 5.0, lambda keys: called.append(len(keys)))
        assert until(lambda: len(called) > number, bus)
        return called[-1]

    while call() < len(names):  # the last of them may be on the way
        assert len(called) < 100
    assert [call() for _ in range(10)] == [len(names)] * 10
    changes: list[tuple[str, bool]] = []
    undo = bus.watch(f"{top}/*/live", lambda key, alive: changes.append((key, alive)))
    assert until(lambda: len(changes) == len(names), bus)
    crowd.close()
    assert until(lambda: len(changes) == 2 * len(names), bus)
    assert {key for key, alive in changes if not alive} == names
    undo()
    bus.close()


def test_what_a_watch_tells_of_a_doubtful_life_is_asked_for_first(zenoh_router: ZenohBus, top: str) -> None:
    one, bus = client([zenoh_router.endpoint]), client([zenoh_router.endpoint])
    heard: list[tuple[str, bool]] = []
    asked: list[str] = []
    confirm = bus._roll_calls.confirm

    def noted(key: str, alive: bool, confirmed: Callable[[], None]) -> None:
        asked.append(key)
        confirm(key, alive, confirmed)

    bus._roll_calls.confirm = noted  # type: ignore[method-assign]  # it does the same, and notes it
    bus._roll_calls.doubtful[f"{top}/b/live/1"] = None
    bus.watch(f"{top}/*/live/*", lambda key, alive: heard.append((key.removeprefix(f"{top}/"), alive)))
    undo_others, undo = one.announce(f"{top}/a/live/1"), one.announce(f"{top}/b/live/1")
    # A watch that has only just begun may show a life twice.
    assert until(lambda: {*heard} == {("a/live/1", True), ("b/live/1", True)}, one, bus)
    undo()
    undo_others()
    assert until(lambda: {*heard} >= {("a/live/1", False), ("b/live/1", False)}, one, bus)
    assert heard[-1] == ("b/live/1", False), "the one that is asked for comes later"
    assert {*asked} == {f"{top}/b/live/1"}
    bus.close()
    one.close()


class Cable:
    """A TCP proxy to an endpoint, whose connections are cut at a word."""

    def __init__(self, endpoint: str) -> None:
        host, port = endpoint.removeprefix("tcp/").rsplit(":", 1)
        self._to, self._ends = (host, int(port)), list[socket.socket]()
        self._server = socket.create_server(("127.0.0.1", 0))
        self.endpoint = f"tcp/127.0.0.1:{self._server.getsockname()[1]}"
        threading.Thread(target=self._accept, daemon=True).start()

    def _accept(self) -> None:
        while True:
            try:
                here, there = self._server.accept()[0], socket.create_connection(self._to)
            except OSError:
                return
            self._ends += (here, there)
            for source, sink in ((here, there), (there, here)):
                threading.Thread(target=self._carry, args=(source, sink), daemon=True).start()

    def _carry(self, source: socket.socket, sink: socket.socket) -> None:
        try:
            while some := source.recv(1 << 16):
                sink.sendall(some)
        except OSError:
            pass  # it was cut

    def cut(self) -> None:
        """Cut the connections that there are; the next ones are carried again."""
        for end in self._ends:
            with contextlib.suppress(OSError):
                end.shutdown(socket.SHUT_RDWR)
            end.close()
        self._ends.clear()

    def close(self) -> None:
        """Cut the connections, and carry none any more."""
        self._server.shutdown(socket.SHUT_RDWR)
        self._server.close()
        self.cut()


def test_a_hub_that_is_told_to_be_lost_is_no_link_any_more(zenoh_router: ZenohBus) -> None:
    """Zenoh tells so a moment before it forgets the hub: who asked it again just then took the hub to be there."""
    bus = client([zenoh_router.endpoint])
    (hub,) = bus._session.info.routers_zid()
    links: list[str] = []
    forget = bus.watch_link(lambda: links.append(bus.link))
    bus._turned(SimpleNamespace(kind=SampleKind.DELETE, transport=SimpleNamespace(zid=hub, whatami=WhatAmI.ROUTER)))
    assert until(lambda: links == [""], bus)
    assert bus._session.info.routers_zid() == [hub]
    forget()
    bus._turned(SimpleNamespace(kind=SampleKind.PUT, transport=SimpleNamespace(zid=hub, whatami=WhatAmI.ROUTER)))
    assert bus.link.startswith(str(hub))
    bus.poll()
    assert links == [""]
    bus.close()


def test_a_router_that_was_lost_and_found_again_is_another_link(zenoh_router: ZenohBus) -> None:
    cable = Cable(zenoh_router.endpoint)
    bus = client([cable.endpoint])
    before = bus.link
    turned: list[str] = []
    bus.watch_link(lambda: turned.append(bus.link))
    cable.cut()
    assert until(lambda: len(turned) >= 2 and bool(bus.link), bus)
    assert bus.link.split()[0] == before.split()[0]  # it is the same router
    assert bus.link != before
    bus.close()
    cable.close()
