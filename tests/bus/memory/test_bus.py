"""The nodes of the network in memory: their clocks, their timers and what they watch."""

from __future__ import annotations

from functools import partial

from selfconf.bus.memory import Network
from selfconf.bus.port import Urgency
from tests.bus.watched import Watched


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


def test_each_node_has_a_clock_of_its_own() -> None:
    network = Network()
    one, other = network.node(), network.node(clock=-300.0)
    went_off: list[float] = []
    other.later(1.0, lambda: went_off.append(network.time))
    network.run(lambda: False, 2.0)
    assert (one.now(), other.now()) == (2.0, -298.0)
    assert went_off == [1.0]


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
