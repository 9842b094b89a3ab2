"""The simulated network: what can go wrong on it, and that a seed replays it."""

from __future__ import annotations

from functools import partial

from selfconf.bus.memory import Faults, MemoryBus, Network
from selfconf.bus.port import Replies, Request, Sample, Urgency


def echo(node: MemoryBus, key: str = "a") -> None:
    """Serve a key with one reply."""

    def answer(request: Request) -> None:
        request.reply(key, request.payload)
        request.finish()

    node.serve(key, answer)


def history(seed: int, faults: Faults) -> list[tuple[float, bytes]]:
    """What one node hears of a hundred signals of another, and when."""
    network = Network(seed, faults)
    one, two = network.node(), network.node()
    heard: list[tuple[float, bytes]] = []
    two.subscribe("a", lambda sample: heard.append((network.time, sample.payload)))
    publisher = one.publisher("a", Urgency.SIGNAL)
    for number in range(100):
        one.later(number * 0.01, partial(publisher.put, b"%d" % number))
    network.run(lambda: False, 10.0)
    return heard


BAD = Faults(loss=0.3, doubling=0.3, least_delay=0.001, most_delay=0.1)


def test_a_seed_replays_a_history_and_another_seed_is_another_history() -> None:
    assert history(1, BAD) == history(1, BAD)
    assert history(1, BAD) != history(2, BAD)


def test_signals_are_lost_doubled_and_overtake_each_other_where_the_faults_say_so() -> None:
    heard = [payload for _, payload in history(1, BAD)]
    assert len(set(heard)) < 100
    assert len(set(heard)) < len(heard)
    assert heard != sorted(heard, key=int)


def test_a_perfect_network_loses_nothing() -> None:
    assert [payload for _, payload in history(1, Faults())] == [b"%d" % n for n in range(100)]


def test_events_are_neither_lost_nor_doubled_and_keep_their_order() -> None:
    network = Network(3, BAD)
    one, two = network.node(), network.node()
    heard: list[Sample] = []
    two.subscribe("fail", heard.append)
    publisher = one.publisher("fail", Urgency.EVENT)
    for number in range(50):
        publisher.put(b"%d" % number)
    network.run(lambda: False, 10.0)
    assert [sample.payload for sample in heard] == [b"%d" % n for n in range(50)]


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


def test_nodes_that_are_cut_off_hear_nothing_of_each_other_and_see_each_other_die() -> None:
    network = Network()
    one, two, three = (network.node() for _ in range(3))
    heard: list[Sample] = []
    lives: list[tuple[str, bool]] = []
    matches: list[bool] = []
    two.subscribe("a", heard.append)
    publisher = one.publisher("a", Urgency.EVENT, matches.append)
    two.announce("live/two")
    three.announce("live/three")
    one.watch("live/*", lambda key, alive: lives.append((key, alive)))
    network.run(lambda: False, 1.0)
    network.cut(one, two)
    publisher.put(b"nobody hears")
    network.run(lambda: False, 1.0)
    assert not heard
    assert lives[2:] == [("live/two", False)]
    assert matches == [True, False]
    assert one.link
    assert two.link
    network.reconnect(one, two)
    publisher.put(b"again")
    network.run(lambda: False, 1.0)
    assert [sample.payload for sample in heard] == [b"again"]
    assert lives[3:] == [("live/two", True)]
    assert matches == [True, False, True]


def test_a_node_that_reaches_no_other_knows_that_it_is_cut_off() -> None:
    network = Network()
    one, two = network.node(), network.node()
    assert one.link
    network.cut(one, two)
    assert not one.link
    network.reconnect(one, two)
    assert one.link
    two.close()
    assert one.link  # it is alone, not cut off


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


def test_time_stands_still_unless_something_happens_or_it_is_let_pass() -> None:
    network = Network()
    node = network.node()
    assert not network.step()
    assert node.now() == 0.0
    assert not network.run(lambda: False, 5.0)
    assert node.now() == 5.0
