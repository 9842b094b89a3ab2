"""The simulated network: what can go wrong on it, and that a seed replays it."""

from __future__ import annotations

from functools import partial
from typing import Any

import pytest

from selfconf.bus.memory import LEASE, Faults, Network
from selfconf.bus.port import Sample, Urgency
from selfconf.errors import ProgrammerError
from tests.bus.watched import Watched


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


def test_time_stands_still_unless_something_happens_or_it_is_let_pass() -> None:
    network = Network()
    node = network.node()
    assert not network.step()
    assert node.now() == 0.0
    assert not network.run(lambda: False, 5.0)
    assert node.now() == 5.0


# Pauses, busy threads, one-way links, clocks.


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


def test_what_a_node_has_missed_comes_before_what_happens_as_it_goes_on() -> None:
    here = Watched()
    here.network.pause(here.one)
    here.put("missed")
    here.let_pass(0.5)

    def put_and_go_on() -> None:
        here.one.wake_up(lambda: here.heard.append("new"))
        here.network.resume(here.one)

    here.network.after(0.0, put_and_go_on)
    here.let_pass(0.1)
    assert here.heard == ["missed", "new"]


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


def test_a_paused_node_hears_that_a_link_is_lost_after_what_has_arrived_before_that() -> None:
    network = Network()
    one, other = network.node(), network.node()
    lives: list[bool] = []
    one.watch("lives/*", lambda key, alive: lives.append(alive))
    network.pause(one)
    other.announce("lives/other")
    network.let_pass(0.1)
    network.cut(one, other)
    network.let_pass(0.1)
    network.resume(one)
    network.let_pass(0.1)
    assert lives == [True, False]
    network.pause(one)
    network.reconnect(one, other)
    network.cut(one, other)
    network.resume(one)
    network.let_pass(0.1)
    assert lives == [True, False, True, False]


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


def test_a_node_that_is_gone_when_its_host_is_frozen_sees_that_again_when_it_is_connected_again() -> None:
    network = Network()
    one, other = network.node(), network.node()
    other.announce("lives/other")
    lives: list[bool] = []
    one.watch("lives/*", lambda key, alive: lives.append(alive))
    network.let_pass(0.1)
    network.pause(one)
    network.let_pass(2.0)
    network.resume(one)
    network.pause(one, other)
    network.let_pass(0.5)
    network.resume(one)
    network.resume(other)
    assert not network.reaches(one, other)
    network.let_pass(1.0)
    assert lives == [True, False, True]


def test_the_nodes_of_a_host_that_is_frozen_are_gone_for_all_but_each_other() -> None:
    here = Watched()
    third = here.network.node()
    third.announce("lives/third")
    seen: list[bool] = []
    third.watch("seen/*", lambda key, alive: seen.append(alive))
    here.one.announce("seen/one")
    here.let_pass(0.1)
    here.network.pause(here.one, third)
    here.let_pass(3.0)
    assert here.lives == [True, False]
    assert here.network.reaches(here.one, third)
    assert here.network.reaches(third, here.one)
    assert not here.network.reaches(third, here.other)
    here.network.resume(here.one)
    here.network.resume(third)
    here.let_pass(1.0)
    assert here.lives == [True, False, True]
    assert seen == [True]
    here.network.pause(here.one)
    here.let_pass(3.0)
    assert seen == [True, False]


def test_nodes_that_stall_together_go_on_as_if_no_time_had_passed() -> None:
    here = Watched()
    here.one.later(0.3, lambda: here.heard.append("timer"))
    go_on = here.network.stall()
    here.put("first")
    here.let_pass(5.0)
    assert here.heard == []
    go_on()
    here.let_pass(0.1)
    assert here.heard == ["timer", "first"]
    assert here.lives == [True]


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


def test_whoever_wants_to_looks_at_every_step() -> None:
    network = Network()
    node = network.node()
    times: list[float] = []
    network.stepped = lambda: times.append(network.time)
    for seconds in (1.0, 2.0):
        node.later(seconds, lambda: None)
    network.run(lambda: False, 5.0)
    assert times == [1.0, 2.0]


def test_a_timer_that_is_undone_and_one_of_a_question_that_is_answered_are_no_steps() -> None:
    network = Network()
    asker, answerer = network.node(), network.node()
    answerer.serve("a", lambda request: request.finish())
    asker.later(1.0, lambda: None)()
    asker.ask("a", b"", 2.0, lambda replies: None)
    asker.later(3.0, lambda: None)
    times: list[float] = []
    network.stepped = lambda: times.append(network.time)
    network.run(lambda: False, 2.5)
    assert max(times) < 0.1
    network.let_pass(1.0)
    assert times[-1] == 3.0
    assert not network.step()
