"""Questions in the network in memory end once, with every reply or when their time is over."""

from __future__ import annotations

from selfconf.bus.memory import Faults, MemoryBus, Network
from selfconf.bus.port import Replies, Request
from tests.bus.watched import Watched


def echo(node: MemoryBus, key: str = "a") -> None:
    """Serve a key with one reply."""

    def answer(request: Request) -> None:
        request.reply(key, request.payload)
        request.finish()

    node.serve(key, answer)


def test_a_question_or_an_answer_that_is_lost_shows_as_a_time_out() -> None:
    network = Network(5, Faults(loss=0.3))
    one, two = network.node(), network.node()
    asked: list[bytes] = []

    def answer(request: Request) -> None:
        asked.append(request.payload)
        request.reply("a", request.payload)
        request.finish()

    two.serve("a", answer)
    replies: list[Replies] = []
    for number in range(100):
        one.ask("a", b"%d" % number, 1.0, replies.append)
    network.run(lambda: len(replies) == 100, 10.0)
    answered = [said for said in replies if said.samples]
    assert all(said.complete == bool(said.samples) for said in replies)
    assert len(answered) < len(asked) < 100


def test_a_question_that_is_doubled_is_answered_twice_but_ends_once() -> None:
    network = Network(0, Faults(doubling=1.0))
    one, two, three = network.node(), network.node(), network.node()
    echo(two)
    echo(three)
    replies: list[Replies] = []
    one.ask("a", b"x", 1.0, replies.append)
    network.run(lambda: False, 2.0)
    assert len(replies) == 1
    assert replies[0].complete
    assert len(replies[0].samples) >= 2


def test_a_node_that_dies_in_the_middle_of_its_answer_is_waited_for_until_the_time_is_over() -> None:
    network = Network()
    one, two = network.node(), network.node()

    def answer(request: Request) -> None:
        request.reply("a", b"first")
        two.close()
        request.reply("a", b"never said")
        request.finish()

    two.serve("a", answer)
    replies: list[Replies] = []
    one.ask("a", b"", 1.0, replies.append)
    network.run(lambda: bool(replies), 5.0)
    assert not replies[0].complete


def test_a_question_to_a_paused_node_shows_as_a_time_out_and_is_answered_too_late() -> None:
    here = Watched()
    echo(here.one, "b")
    here.network.pause(here.one)
    replies: list[Replies] = []
    here.other.ask("b", b"", 0.3, replies.append)
    here.let_pass(0.5)
    here.network.resume(here.one)
    here.let_pass(0.5)
    assert [said.complete for said in replies] == [False]
