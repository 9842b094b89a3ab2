"""The contract of a bus, kept by the memory bus and by the Zenoh bus: lives, timers, and the end of a node."""

from __future__ import annotations

import threading
from functools import partial

import pytest

from selfconf.bus.port import Replies, Sample, Urgency
from tests.bus.nets import Net


@pytest.mark.parametrize("many", [False, True], ids=["few", "many"])
def test_a_watch_shows_lives_that_are_there_that_begin_and_that_end(net: Net, top: str, many: bool) -> None:
    one, two, watching = net.node(), net.node(), net.node()
    undo = one.announce(f"{top}/c/a/live/1")
    net.settle()
    heard: list[tuple[str, bool]] = []
    watching.watch(f"{top}/c/*/live/*", lambda key, alive: heard.append((key, alive)), many=many)
    assert net.until(lambda: heard == [(f"{top}/c/a/live/1", True)])
    two.announce(f"{top}/c/b/live/1")
    assert net.until(lambda: heard[1:] == [(f"{top}/c/b/live/1", True)])
    undo()
    undo()
    assert net.until(lambda: heard[2:] == [(f"{top}/c/a/live/1", False)])
    two.close()
    assert net.until(lambda: heard[3:] == [(f"{top}/c/b/live/1", False)])


@pytest.mark.slow
def test_a_watch_without_history_shows_what_begins_and_every_end(net: Net, top: str) -> None:
    one, two, watching = net.node(), net.node(), net.node()
    undo = one.announce(f"{top}/c/a/live/1")
    net.settle()
    heard: list[tuple[str, bool]] = []
    watching.watch(f"{top}/c/*/live/*", lambda key, alive: heard.append((key, alive)), history=False)
    net.settle()
    two.announce(f"{top}/c/b/live/1")
    assert net.until(lambda: heard == [(f"{top}/c/b/live/1", True)])
    undo()
    assert net.until(lambda: heard[1:] == [(f"{top}/c/a/live/1", False)])
    called: list[tuple[str, ...]] = []
    watching.roll_call(f"{top}/c/b/live/*", 20.0, called.append)
    assert net.until(lambda: called == [(f"{top}/c/b/live/1",)])


def test_a_watch_that_is_undone_hears_no_more(net: Net, top: str) -> None:
    one, two, other = net.node(), net.node(), net.node()
    heard: list[str] = []
    others: list[str] = []
    undo = two.watch(f"{top}/live/*", lambda key, _: heard.append(key))
    other.watch(f"{top}/live/*", lambda key, _: others.append(key))
    net.settle()
    undo()
    undo()
    one.announce(f"{top}/live/1")
    assert net.until(lambda: bool(others))
    net.settle()
    assert not heard


def test_a_watch_undone_inside_a_callback_receives_nothing_of_what_was_on_the_way(net: Net, top: str) -> None:
    one, two = net.node(), net.node()
    heard: list[str] = []

    def changed(key: str, _: bool) -> None:
        heard.append(key)
        undo()

    undo = two.watch(f"{top}/live/*", changed)
    net.settle()
    undos = [one.announce(f"{top}/live/{number}") for number in range(5)]
    assert net.until(lambda: bool(heard))
    net.settle()
    assert len(heard) == 1
    assert len(undos) == 5


def test_a_roll_call_names_exactly_the_lives_there_are(net: Net, top: str) -> None:
    one, two, asking = net.node(), net.node(), net.node()
    one.announce(f"{top}/live/b")
    undo = one.announce(f"{top}/live/c")
    two.announce(f"{top}/live/a")
    net.settle()
    undo()
    net.settle()
    called: list[tuple[str, ...]] = []
    asking.roll_call(f"{top}/live/*", 3.0, called.append)
    assert net.until(lambda: bool(called))
    assert called == [(f"{top}/live/a", f"{top}/live/b")]


def test_a_roll_call_without_lives_is_empty(net: Net, top: str) -> None:
    called: list[tuple[str, ...]] = []
    net.node().roll_call(f"{top}/live/*", 3.0, called.append)
    assert net.until(lambda: called == [()])


def test_timers_go_off_once_in_the_order_of_their_times(net: Net) -> None:
    node = net.node()
    went_off: list[tuple[str, float]] = []
    began = node.now()
    for name, seconds in (("c", 0.06), ("a", 0.02), ("b", 0.04)):

        def go_off(name: str = name) -> None:
            went_off.append((name, node.now() - began))

        node.later(seconds, go_off)
    assert net.until(lambda: len(went_off) == 3)
    net.settle()
    assert [name for name, _ in went_off] == ["a", "b", "c"]
    assert all(late >= early for (_, late), early in zip(went_off, (0.02, 0.04, 0.06), strict=True))


def test_a_timer_that_is_undone_does_not_go_off(net: Net) -> None:
    node = net.node()
    went_off: list[str] = []
    undo = node.later(0.02, lambda: went_off.append("undone"))
    node.later(0.04, lambda: went_off.append("kept"))
    undo()
    undo()
    assert net.until(lambda: bool(went_off))
    assert went_off == ["kept"]


def test_a_timer_undone_after_it_went_off_leaves_others_alone(net: Net) -> None:
    node = net.node()
    went_off: list[str] = []
    undo = node.later(0.0, lambda: went_off.append("first"))
    assert net.until(lambda: went_off == ["first"])
    node.later(0.01, lambda: went_off.append("second"))
    undo()
    assert net.until(lambda: went_off == ["first", "second"])


def test_waking_up_says_it_soon_on_the_thread_of_the_bus(net: Net) -> None:
    node = net.node()
    said: list[int] = []
    thread = threading.Thread(target=lambda: node.wake_up(lambda: said.append(threading.get_ident())))
    thread.start()
    thread.join()
    assert not said
    assert net.until(lambda: bool(said))
    assert said == [threading.get_ident()]


def test_what_is_woken_up_is_said_in_order(net: Net) -> None:
    node = net.node()
    said: list[int] = []
    for number in range(10):
        node.wake_up(partial(said.append, number))
    assert net.until(lambda: len(said) == 10)
    assert said == list(range(10))


def test_a_closed_node_lives_no_more_serves_no_more_and_hears_no_more(net: Net, top: str) -> None:
    one, two = net.node(), net.node()
    heard: list[object] = []
    two.announce(f"{top}/live/two")
    two.subscribe(f"{top}/pose", heard.append)
    two.serve(f"{top}/a", heard.append)
    matches: list[bool] = []
    publisher = one.publisher(f"{top}/pose", Urgency.EVENT, matches.append)
    assert net.until(lambda: matches == [True])
    two.later(0.0, lambda: heard.append("timer"))
    two.wake_up(lambda: heard.append("woken up"))
    two.close()
    two.close()
    publisher.put(b"too late")
    replies: list[Replies] = []
    called: list[tuple[str, ...]] = []
    one.ask(f"{top}/a", b"", 1.0, replies.append)
    one.roll_call(f"{top}/live/*", 1.0, called.append)
    assert net.until(lambda: bool(replies) and bool(called))
    net.settle()
    assert called == [()]
    assert replies[0].samples == ()
    assert not heard


def test_what_is_taken_back_or_put_after_the_end_does_nothing(net: Net, top: str) -> None:
    node, heard = net.node(), list[Sample]()
    net.node().subscribe(f"{top}/pose", heard.append)
    undos = [
        node.announce(f"{top}/live/1"),
        node.subscribe(f"{top}/pose", lambda _: None),
        node.serve(f"{top}/a", lambda _: None),
        node.watch(f"{top}/live/*", lambda *_: None),
        node.later(1.0, lambda: None),
    ]
    publisher = node.publisher(f"{top}/pose", Urgency.SIGNAL)
    node.close()
    for undo in undos:
        undo()
    publisher.put(b"nobody")
    publisher.undeclare()
    net.settle()
    assert heard == []


def test_a_node_that_reaches_the_network_is_linked_and_one_that_is_closed_is_not(net: Net) -> None:
    node = net.node()
    net.node()
    assert net.until(lambda: bool(node.link))
    node.close()
    assert not node.link
