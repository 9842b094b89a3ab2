"""Questions that are waited for: all answers, none, and what never ends."""

from __future__ import annotations

import os
import threading
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from functools import partial

import pytest

from selfconf.api import synchronous_bus
from selfconf.api.synchronous_bus import ANSWER_PATIENCE, LOSS_TOLD, SynchronousBus
from selfconf.bus.loop import Loop
from selfconf.bus.memory import MemoryBus, Network
from selfconf.bus.port import Replies, Request
from selfconf.errors import AuthorError, NetworkError, ProgrammerError


@pytest.fixture
def network() -> Network:
    """A network on which one node answers, and another refuses."""
    network = Network()

    def answer(request: Request) -> None:
        request.reply(request.key, b"said " + request.payload)
        request.finish()

    def refuse(request: Request) -> None:
        request.refuse("not today")
        request.finish()

    network.node().serve("k/answers", answer)
    network.node().serve("k/refuses", refuse)
    network.node().announce("k/life/1")
    return network


def test_a_question_returns_its_answers(network: Network) -> None:
    bus = SynchronousBus(network.node())
    assert [sample.payload for sample in bus.ask("k/answers", b"x").samples] == [b"said x"]
    assert bus.ask("k/nobody").samples == ()
    assert bus.living("k/life/*") == ("k/life/1",)


def test_several_questions_are_asked_at_once_and_answered_in_order(network: Network) -> None:
    bus = SynchronousBus(network.node())
    network.node().serve("k/mute", lambda request: None)
    began = bus.now()
    mute, nobody, said = bus.ask_each([("k/mute", b""), ("k/nobody", b""), ("k/answers", b"x")], seconds=2.0)
    assert (mute.complete, nobody.complete, [sample.payload for sample in said.samples]) == (False, True, [b"said x"])
    assert bus.now() - began < 3.0
    assert bus.ask_each([]) == []


@pytest.fixture
def links(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """The links that a bus has, one each time that it is asked, the last one forever; at first it has the first."""
    links = ["hub 1"]
    monkeypatch.setattr(MemoryBus, "link", property(lambda _: links.pop(0) if len(links) > 1 else links[0]))
    return links


def asked_with(links: list[str], *then: str) -> tuple[list[bytes], tuple[str, ...], int]:
    """What is heard of a question and a roll-call by a bus with some links, and how often the question was asked."""
    network, asked = Network(), list[bytes]()
    bus = SynchronousBus(network.node())

    def answer(request: Request) -> None:
        asked.append(request.payload)
        request.reply(request.key, b"said")
        request.finish()

    network.node().serve("k/answers", answer)
    network.node().announce("k/life/1")
    links[:] = then
    heard = [sample.payload for sample in bus.ask("k/answers").samples]
    return heard, bus.living("k/life/*"), len(asked)


@pytest.mark.parametrize(
    ("then", "times"),
    [
        (["hub 1"], 1),  # nothing has happened
        (["hub 2"], 1),  # it was lost before the question
        (["hub 1", "hub 2"], 2),  # while that was asked
        (["hub 1", "", "hub 2"], 2),
        (["hub 1", "hub 2", "hub 2", "hub 2", "hub 2", "hub 3"], 3),
    ],
)
def test_what_was_asked_as_the_link_was_lost_is_asked_again(links: list[str], then: list[str], times: int) -> None:
    assert asked_with(links, *then) == ([b"said"], ("k/life/1",), times)


@pytest.mark.parametrize("then", [[""], ["hub 1", ""], [f"hub {number}" for number in range(100)]])
def test_what_is_cut_off_hears_nothing_and_says_so(links: list[str], then: list[str]) -> None:
    with pytest.raises(NetworkError, match="cut off from the ecology while it was asked"):
        asked_with(links, *then)


def test_nothing_is_believed_only_over_a_link_that_is_not_about_to_be_lost(monkeypatch: pytest.MonkeyPatch) -> None:
    network = Network()
    bus, other = SynchronousBus(network.node(), lives="k/life/*"), network.node()

    def come_back() -> None:
        other.serve("k/answers", lambda request: (request.reply(request.key, b"said"), request.finish()))
        other.announce("k/life/1")

    other.later(LOSS_TOLD / 2, come_back)
    monkeypatch.setattr(MemoryBus, "link", property(lambda _: f"hub {network.time > LOSS_TOLD / 2}"))
    assert [sample.payload for sample in bus.ask("k/answers").samples] == [b"said"]
    began = bus.now()
    assert bus.ask("k/nobody").samples == ()  # others are seen to live, so it is not waited for a loss
    assert bus.now() - began < LOSS_TOLD


def test_where_nobody_lives_nothing_is_believed_after_a_while() -> None:
    bus = SynchronousBus(Network().node(), lives="k/life/*")
    assert (bus.ask("k/nobody").samples, bus.living("k/life/*")) == ((), ())


def test_what_is_demanded_is_not_demanded_again_as_the_link_is_lost(network: Network, links: list[str]) -> None:
    bus = SynchronousBus(network.node())
    links[:] = ["hub 2", "hub 3"]
    bus.demand("k/answers", b"", "it did not move")
    assert links == ["hub 2", "hub 3"]


def test_what_is_not_done_is_trouble_with_its_reason(network: Network) -> None:
    bus = SynchronousBus(network.node())
    bus.demand("k/answers", b"", "it did not move")
    with pytest.raises(NetworkError, match="it did not move: not today"):
        bus.demand("k/refuses", b"", "it did not move")
    with pytest.raises(NetworkError, match="it did not move: it does not answer"):
        bus.demand("k/nobody", b"", "it did not move")


def test_nothing_is_asked_once_the_ecology_was_left(network: Network) -> None:
    bus = SynchronousBus(network.node())
    bus.leave()
    for ask in (bus.check, lambda: bus.ask("k/answers"), lambda: bus.living("k/life/*")):
        with pytest.raises(ProgrammerError, match="the ecology was left"):
            ask()


@pytest.mark.parametrize("then", [[""], ["hub 1", ""]])
def test_what_is_cut_off_for_a_reason_of_its_own_says_that(links: list[str], then: list[str], network: Network) -> None:
    def check_own() -> None:
        raise AuthorError("the certificate has expired")

    bus = SynchronousBus(network.node(), check_own=check_own)
    links[:] = then
    with pytest.raises(AuthorError, match="has expired"):
        bus.ask("k/answers")


def test_a_bus_that_is_attended_to_does_what_is_due_also_while_nothing_is_asked(
    network: Network, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(synchronous_bus, "ATTENDED", 0.01)
    shared, done = SharedBus(network), threading.Event()
    bus, others = SynchronousBus(shared), threading.active_count()
    shared.later(0.02, done.set)
    bus.attend()
    assert done.wait(ANSWER_PATIENCE)
    assert [bus.ask(str(number)).errors for number in range(50)] == [(str(number),) for number in range(50)]
    bus.leave()
    assert threading.active_count() == others, "the thread has ended, so that the bus can be closed"


def test_what_interrupts_a_thread_in_its_turn_may_leave_an_ecology_that_is_attended_to(
    network: Network, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(synchronous_bus, "ATTENDED", 0.01)
    shared = SharedBus(network)
    bus, left = SynchronousBus(shared), threading.Event()

    def leave() -> None:
        left.wait(0.1)  # in which the other thread looks for its turn several times
        bus.leave()
        left.set()

    bus.attend()
    shared.later(0.05, leave)
    with pytest.raises(ProgrammerError, match="the ecology was left"):
        bus.run(lambda: False)
    assert left.is_set()


def test_what_never_ends_is_given_up(network: Network) -> None:
    node = network.node()
    bus = SynchronousBus(node)
    node.later(2 * ANSWER_PATIENCE, lambda: None)
    with pytest.raises(NetworkError, match="the ecology does not answer"):
        bus.wait(lambda done: None)


class SharedBus(MemoryBus):
    """A bus in real time for several threads, that answers each question a moment later, unless it is about a mute."""

    def __init__(self, network: Network) -> None:
        super().__init__(network, 0, 0.0)
        self.loop, self.asked = Loop(), threading.Event()
        self._polled = threading.Lock()

    def now(self) -> float:
        return self.loop.now()

    def later(self, seconds: float, action: Callable[[], None]) -> Callable[[], None]:
        return self.loop.later(seconds, action)

    def poll(self, seconds: float = 0.0) -> None:
        assert self._polled.acquire(blocking=False), "two threads let the bus run at the same time"
        try:
            self.loop.poll(seconds)
        finally:
            self._polled.release()

    def run(self, until: Callable[[], bool]) -> None:
        while not until():
            self.poll(0.5)

    def ask(self, key: str, payload: bytes, seconds: float, done: Callable[[Replies], None]) -> None:
        self.asked.set()
        if key != "mute":
            self.later(0.001, partial(done, Replies(errors=(key,))))


def test_several_threads_ask_in_turns_and_each_gets_its_answers(network: Network) -> None:
    bus = SynchronousBus(SharedBus(network))
    questions = [str(number) for number in range(200)]
    with ThreadPoolExecutor(4) as threads:
        assert [replies.errors for replies in threads.map(bus.ask, questions)] == [(one,) for one in questions]


def test_a_thread_asks_while_another_waits_without_an_end(network: Network) -> None:
    shared, ended = SharedBus(network), threading.Event()
    bus = SynchronousBus(shared)
    with ThreadPoolExecutor(1) as threads:
        waiting = threads.submit(bus.run, ended.is_set)
        assert [bus.ask(str(number)).errors for number in range(20)] == [(str(number),) for number in range(20)]
        ended.set()
        waiting.result(ANSWER_PATIENCE)


def test_a_question_ends_when_another_thread_leaves_the_ecology(network: Network) -> None:
    shared = SharedBus(network)
    bus = SynchronousBus(shared)
    with ThreadPoolExecutor(1) as threads:
        asked = threads.submit(bus.ask, "mute")
        assert shared.asked.wait(ANSWER_PATIENCE)
        bus.leave()
        with pytest.raises(ProgrammerError, match="the ecology was left"):
            asked.result(ANSWER_PATIENCE / 2)


def test_what_interrupts_a_thread_in_its_turn_may_ask_too(network: Network) -> None:
    shared = SharedBus(network)
    bus, said = SynchronousBus(shared), list[Replies]()
    shared.later(0.01, lambda: None)

    def interrupt() -> None:
        shared._polled.release()
        said.append(bus.ask("meanwhile"))
        shared._polled.acquire()

    shared.later(0.001, interrupt)
    bus.run(lambda: bool(said))
    assert said[0].errors == ("meanwhile",)


def test_a_process_that_is_forked_is_told_that_it_has_not_joined(
    network: Network, monkeypatch: pytest.MonkeyPatch
) -> None:
    bus = SynchronousBus(network.node())
    monkeypatch.setattr(os, "getpid", lambda: -1)
    with pytest.raises(ProgrammerError, match="joined before this process was forked; spawn it, and join there"):
        bus.ask("k/answers")
