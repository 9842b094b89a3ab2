"""Questions that are waited for: all answers, none, and what never ends."""

from __future__ import annotations

import pytest

from selfconf.api.synchronous_bus import ANSWER_PATIENCE, SynchronousBus
from selfconf.bus.memory import Network
from selfconf.bus.port import Request
from selfconf.errors import NetworkError, ProgrammerError


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


def test_what_never_ends_is_given_up(network: Network) -> None:
    node = network.node()
    bus = SynchronousBus(node)
    node.later(2 * ANSWER_PATIENCE, lambda: None)
    with pytest.raises(NetworkError, match="the ecology does not answer"):
        bus.wait(lambda done: None)
