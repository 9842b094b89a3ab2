"""The simulated network: what can go wrong on it, and that a seed replays it."""

from __future__ import annotations

from functools import partial
from typing import Any

import pytest

from selfconf.bus.memory import LEASE, Faults, MemoryBus, Network
from selfconf.bus.port import Replies, Request, Sample, Urgency
from selfconf.errors import ProgrammerError


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


@pytest.mark.parametrize("faults", [{"loss": "x"}, {"loss": 2}, {"doubling": float("nan")}, {"most_delay": -1.0}])
def test_faults_are_chances_and_delays(faults: Any) -> None:
    with pytest.raises(ProgrammerError, match=r"is a chance: a number from 0 to 1|delays are numbers of seconds"):
        Faults(**faults)


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


# Pauses, busy threads, one-way links, clocks.


class Watched:
    """Two nodes: one that is alive, hears a key and has a timer; another that watches it and talks to it."""

    def __init__(self, faults: Faults | None = None) -> None:
        self.network = Network(0, faults)
        self.one, self.other = self.network.node(), self.network.node()
        self.heard: list[str] = []
        self.lives: list[bool] = []
        self.seen: list[bool] = []
        self.one.subscribe("a", lambda sample: self.heard.append(sample.payload.decode()))
        self.one.announce("live/one")
        self.other.announce("live/other")
        self.other.watch("live/one", lambda _, alive: self.lives.append(alive))
        self.one.watch("live/other", lambda _, alive: self.seen.append(alive))
        self.publisher = self.other.publisher("a", Urgency.EVENT)
        self.let_pass(0.1)

    def let_pass(self, seconds: float) -> None:
        """Let simulated time pass."""
        self.network.run(lambda: False, seconds)

    def put(self, text: str) -> None:
        """Let the other node say something, and let it arrive."""
        self.publisher.put(text.encode())
        self.let_pass(0.1)


def test_a_paused_node_handles_what_has_arrived_late_and_its_timers_first() -> None:
    here = Watched()
    here.one.later(0.3, lambda: here.heard.append("timer"))
    here.network.pause(here.one)
    here.put("first")
    here.put("second")
    here.let_pass(0.5)
    assert here.heard == []
    here.network.resume(here.one)
    here.let_pass(0.1)
    assert here.heard == ["timer", "first", "second"]
    assert here.lives == [True]


def test_a_node_that_is_paused_for_longer_than_the_lease_is_gone_and_comes_back() -> None:
    here = Watched()
    here.network.pause(here.one)
    here.put("before the lease runs out")
    here.let_pass(2.0)
    assert here.lives == [True, False]
    here.put("lost")
    here.network.resume(here.one)
    here.let_pass(0.05)
    assert here.heard == ["before the lease runs out"]
    assert here.seen == [True, False]
    assert not here.one.link
    here.let_pass(1.0)
    assert here.lives == [True, False, True]
    assert here.seen == [True, False, True]
    here.put("again")
    assert here.heard == ["before the lease runs out", "again"]


def test_a_node_that_is_paused_again_before_it_is_connected_again_stays_gone() -> None:
    here = Watched()
    here.network.pause(here.one)
    here.let_pass(2.0)
    here.network.resume(here.one)
    here.let_pass(0.05)
    here.network.pause(here.one)
    here.let_pass(5.0)
    assert here.lives == [True, False]
    here.network.resume(here.one)
    here.let_pass(1.0)
    assert here.lives == [True, False, True]


def test_a_host_that_loses_its_power_is_missed_after_the_lease() -> None:
    here = Watched()
    here.network.pause(here.one)
    here.let_pass(0.9)
    assert here.lives == [True]
    here.let_pass(0.2)
    assert here.lives == [True, False]
    here.one.close()
    here.network.resume(here.one)
    here.let_pass(2.0)
    assert here.lives == [True, False]


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


def test_a_busy_node_lives_on_but_handles_nothing_and_what_it_sends_afterwards_is_late() -> None:
    here = Watched()
    said: list[tuple[float, bytes]] = []
    here.other.subscribe("b", lambda sample: said.append((round(here.network.time, 3), sample.payload)))
    publisher = here.one.publisher("b", Urgency.EVENT)
    began = here.network.time

    def slow() -> None:
        publisher.put(b"before")
        here.one.spend(3.0)
        publisher.put(b"after")

    here.one.wake_up(slow)
    here.let_pass(0.1)
    here.put("waits")
    here.let_pass(2.0)
    assert here.heard == []
    assert here.lives == [True]
    assert [payload for _, payload in said] == [b"before"]
    here.let_pass(1.0)
    assert here.heard == ["waits"]
    assert said[1] == (round(began + 3.0005, 3), b"after")


def test_a_link_may_be_cut_one_way() -> None:
    here = Watched()
    back: list[Sample] = []
    here.other.subscribe("b", back.append)
    publisher = here.one.publisher("b", Urgency.EVENT)
    here.network.mute(here.other, here.one)
    here.put("lost")
    publisher.put(b"arrives")
    here.let_pass(0.1)
    assert here.heard == []
    assert [sample.payload for sample in back] == [b"arrives"]
    assert here.lives == [True]
    assert here.seen == [True, False]
    here.network.reconnect(here.one, here.other)
    here.let_pass(0.1)
    assert here.lives == [True]
    assert here.seen == [True, False, True]


def test_a_third_node_sees_the_lives_that_two_others_have_lost_sight_of() -> None:
    here = Watched()
    third = here.network.node()
    lives: list[tuple[str, bool]] = []
    third.watch("live/*", lambda key, alive: lives.append((key, alive)))
    here.network.cut(here.one, here.other)
    here.let_pass(1.0)
    assert here.lives == [True, False]
    assert lives == [("live/one", True), ("live/other", True)]


def test_events_and_lives_may_be_delayed_and_keep_their_order() -> None:
    here = Watched(Faults(most_event_delay=2.0))
    here.let_pass(5.0)
    for number in range(20):
        here.publisher.put(str(number).encode())
    began = here.network.time
    here.network.run(lambda: bool(here.heard), 5.0)
    assert here.network.time - began > 0.01
    here.let_pass(5.0)
    assert here.heard == [str(number) for number in range(20)]


def test_a_life_that_is_ending_when_the_link_is_lost_has_ended() -> None:
    network = Network(1, Faults(most_event_delay=20.0))
    left, right = network.node(), network.node()
    seen: list[tuple[str, bool]] = []
    right.watch("a/*", lambda key, alive: seen.append((key, alive)))
    left.announce("a/1")
    network.run(lambda: False, 20.0)
    left.close()
    network.pause(right)
    network.run(lambda: False, LEASE + 0.1)
    assert seen == [("a/1", True)]
    network.run(lambda: False, 20.0)
    network.resume(right)
    network.run(lambda: False, 20.0)
    assert seen == [("a/1", True), ("a/1", False)]


def test_each_node_has_a_clock_of_its_own() -> None:
    network = Network()
    one, other = network.node(), network.node(clock=-300.0)
    went_off: list[float] = []
    other.later(1.0, lambda: went_off.append(network.time))
    network.run(lambda: False, 2.0)
    assert (one.now(), other.now()) == (2.0, -298.0)
    assert went_off == [1.0]


def test_whoever_wants_to_looks_at_every_step() -> None:
    network = Network()
    node = network.node()
    times: list[float] = []
    network.stepped = lambda: times.append(network.time)
    for seconds in (1.0, 2.0):
        node.later(seconds, lambda: None)
    network.run(lambda: False, 5.0)
    assert times == [1.0, 2.0]


def test_a_timer_that_is_renewed_until_a_time_has_passed_ends() -> None:
    network = Network(1)
    node = network.node()
    looks = 0

    def look(since: float) -> None:
        nonlocal looks
        looks += 1
        if (passed := node.now() - since) < 1.0 and looks < 1_000:  # 1.0554851481309644 - 0.0554851481309644 < 1.0
            node.later(1.0 - passed, partial(look, since))

    for begun in (number / 7 for number in range(1, 100)):
        network.run(lambda: False, 0.3)
        node.later(begun, partial(look, network.time))
    network.run(lambda: False, 20.0)
    assert looks < 400


def test_a_watch_without_history_is_told_of_a_lost_link_only_what_it_was_shown() -> None:
    network = Network(1)
    one, two = network.node(), network.node()
    one.announce("a/live/1")
    heard: list[tuple[str, bool]] = []
    two.watch("*/live/*", lambda key, alive: heard.append((key, alive)), history=False)
    one.announce("b/live/1")
    network.run(lambda: False, 0.1)
    network.cut(one, two)
    network.run(lambda: False, 0.1)
    assert heard == [("b/live/1", True), ("b/live/1", False)]
    network.reconnect(one, two)
    network.run(lambda: False, 0.1)
    assert sorted(heard[2:]) == [("a/live/1", True), ("b/live/1", True)]
