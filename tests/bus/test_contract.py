"""The contract of a bus, kept by the memory bus and by the Zenoh bus."""

from __future__ import annotations

import threading
from functools import partial

import pytest

from selfconf.bus.memory import questions
from selfconf.bus.port import Replies, Request, Sample, Urgency
from selfconf.bus.zenoh import bus as zenoh_bus
from tests.bus.nets import Net

EVERY_URGENCY = list(Urgency)


def payloads(samples: list[Sample]) -> list[bytes]:
    """What was put, in order of arrival."""
    return [sample.payload for sample in samples]


# Samples.


@pytest.mark.parametrize("urgency", EVERY_URGENCY)
def test_what_is_put_is_heard_by_every_subscriber(net: Net, top: str, urgency: Urgency) -> None:
    one, two, three = net.node(), net.node(), net.node()
    heard: list[Sample] = []
    matches: list[bool] = []
    two.subscribe(f"{top}/pose", heard.append, urgency)
    three.subscribe(f"{top}/*", heard.append, urgency)
    publisher = one.publisher(f"{top}/pose", urgency, matches.append)
    assert net.until(lambda: bool(matches))
    net.settle()
    publisher.put(b"here", b"stamp")
    assert net.until(lambda: len(heard) == 2)
    assert heard == [Sample(f"{top}/pose", b"here", b"stamp")] * 2


def test_samples_of_one_publisher_keep_their_order(net: Net, top: str) -> None:
    one, two = net.node(), net.node()
    heard: list[Sample] = []
    two.subscribe(f"{top}/fail", heard.append, Urgency.EVENT)
    matches: list[bool] = []
    publisher = one.publisher(f"{top}/fail", Urgency.EVENT, matches.append)
    assert net.until(lambda: matches == [True])
    for number in range(500):
        publisher.put(b"%d" % number)
    assert net.until(lambda: len(heard) == 500)
    assert payloads(heard) == [b"%d" % number for number in range(500)]


def test_a_node_hears_itself(net: Net, top: str) -> None:
    node = net.node()
    heard: list[Sample] = []
    node.subscribe(f"{top}/pose", heard.append)
    node.publisher(f"{top}/pose", Urgency.SIGNAL).put(b"here")
    assert net.until(lambda: payloads(heard) == [b"here"])


def test_a_subscriber_hears_nothing_of_other_keys_nor_of_control_keys(net: Net, top: str) -> None:
    one, two = net.node(), net.node()
    heard: list[Sample] = []
    two.subscribe(f"{top}/**", heard.append, Urgency.EVENT)
    net.settle()
    for key in (f"{top}/@ctl/apply", f"{top}x/pose", f"{top}/a/b"):
        one.publisher(key, Urgency.EVENT).put(b"")
    assert net.until(lambda: bool(heard))
    net.settle()
    assert [sample.key for sample in heard] == [f"{top}/a/b"]


def test_nothing_is_heard_once_a_subscription_is_undone_not_even_what_was_on_the_way(net: Net, top: str) -> None:
    one, two = net.node(), net.node()
    heard: list[Sample] = []
    others: list[Sample] = []
    undo = two.subscribe(f"{top}/pose", heard.append)
    net.node().subscribe(f"{top}/pose", others.append)
    matches: list[bool] = []
    publisher = one.publisher(f"{top}/pose", Urgency.EVENT, matches.append)
    assert net.until(lambda: matches == [True])
    net.settle()
    publisher.put(b"late")
    undo()
    undo()
    assert net.until(lambda: bool(others))
    net.settle()
    assert not heard


def test_a_publisher_notices_when_there_begins_to_be_a_subscriber_and_when_there_is_none_again(
    net: Net, top: str
) -> None:
    one, two, three = net.node(), net.node(), net.node()
    matches: list[bool] = []
    one.publisher(f"{top}/pose", Urgency.SIGNAL, matches.append)
    net.settle()
    assert matches == []
    undo_first = two.subscribe(f"{top}/pose", lambda _: None)
    assert net.until(lambda: matches == [True])
    undo_second = three.subscribe(f"{top}/*", lambda _: None)
    net.settle()
    undo_first()
    net.settle()
    assert matches == [True]
    undo_second()
    assert net.until(lambda: matches == [True, False])


def test_a_publisher_that_comes_late_notices_the_subscriber_there_is(net: Net, top: str) -> None:
    one, two = net.node(), net.node()
    two.subscribe(f"{top}/pose", lambda _: None)
    net.settle()
    matches: list[bool] = []
    one.publisher(f"{top}/pose", Urgency.SIGNAL, matches.append)
    assert net.until(lambda: matches == [True])


def test_a_publisher_notices_when_its_last_subscriber_dies(net: Net, top: str) -> None:
    one, two = net.node(), net.node()
    matches: list[bool] = []
    two.subscribe(f"{top}/pose", lambda _: None)
    one.publisher(f"{top}/pose", Urgency.SIGNAL, matches.append)
    assert net.until(lambda: matches == [True])
    two.close()
    assert net.until(lambda: matches == [True, False])


def test_a_latched_signal_reaches_a_subscriber_that_comes_late(net: Net, top: str) -> None:
    one, two = net.node(), net.node()

    def matched(matching: bool) -> None:
        if matching:
            publisher.put(b"last")

    publisher = one.publisher(f"{top}/pose", Urgency.SIGNAL, matched)
    net.settle()
    heard: list[Sample] = []
    two.subscribe(f"{top}/pose", heard.append)
    assert net.until(lambda: payloads(heard) == [b"last"])


def test_samples_may_be_put_from_any_thread(net: Net, top: str) -> None:
    one, two = net.node(), net.node()
    heard: list[Sample] = []
    two.subscribe(f"{top}/fail", heard.append, Urgency.EVENT)
    matches: list[bool] = []
    publisher = one.publisher(f"{top}/fail", Urgency.EVENT, matches.append)
    assert net.until(lambda: matches == [True])
    thread = threading.Thread(target=lambda: [publisher.put(b"%d" % n) for n in range(50)])
    thread.start()
    thread.join()
    assert net.until(lambda: len(heard) == 50)


def test_a_direct_subscription_hears_though_nobody_polls_its_bus(net: Net, top: str) -> None:
    one, two = net.node(), net.node()
    heard: list[bytes] = []
    matches: list[bool] = []
    two.subscribe(f"{top}/pose", lambda sample: heard.append(sample.payload), direct=True)
    publisher = one.publisher(f"{top}/pose", Urgency.EVENT, matches.append)
    assert net.until(lambda: matches == [True])
    for number in range(100):
        publisher.put(b"%d" % number)
    assert net.until(lambda: len(heard) == 100)
    assert heard == [b"%d" % number for number in range(100)]


def test_a_direct_subscription_hears_nothing_once_it_is_undone_nor_when_its_bus_is_closed(net: Net, top: str) -> None:
    one, two, three = net.node(), net.node(), net.node()
    heard: list[Sample] = []
    others: list[Sample] = []
    undo = two.subscribe(f"{top}/pose", heard.append, direct=True)
    three.subscribe(f"{top}/pose", heard.append, direct=True)
    net.node().subscribe(f"{top}/pose", others.append)
    matches: list[bool] = []
    publisher = one.publisher(f"{top}/pose", Urgency.EVENT, matches.append)
    assert net.until(lambda: matches == [True])
    net.settle()
    undo()
    undo()
    three.close()
    publisher.put(b"late")
    assert net.until(lambda: bool(others))
    net.settle()
    assert not heard


# Questions.


def test_a_question_without_a_queryable_ends_at_once_with_nothing(net: Net, top: str) -> None:
    node = net.node()
    replies: list[Replies] = []
    began = node.now()
    node.ask(f"{top}/@ctl/state", b"", 5.0, replies.append)
    assert net.until(lambda: bool(replies))
    assert replies == [Replies((), (), True)]
    assert node.now() - began < 2.0


def test_a_question_is_answered_with_what_came_along(net: Net, top: str) -> None:
    one, two = net.node(), net.node()

    def answer(request: Request) -> None:
        request.reply(f"{top}/@ctl/state", b"got " + request.payload, b"page")
        request.finish()

    two.serve(f"{top}/@ctl/*", answer)
    net.settle()
    replies: list[Replies] = []
    one.ask(f"{top}/@ctl/state", b"it", 5.0, replies.append)
    assert net.until(lambda: bool(replies))
    assert replies == [Replies((Sample(f"{top}/@ctl/state", b"got it", b"page"),))]


def test_a_question_reaches_all_queryables_and_ends_with_the_last(net: Net, top: str) -> None:
    asking = net.node()
    waiting: list[Request] = []
    for name in ("a", "b", "c"):

        def answer(request: Request, name: str = name) -> None:
            request.reply(f"{top}/site/{name}/ads/1", name.encode())
            request.reply(f"{top}/site/{name}/ads/2", name.encode())
            waiting.append(request)

        net.node().serve(f"{top}/site/{name}/ads/**", answer)
    net.settle()
    replies: list[Replies] = []
    asking.ask(f"{top}/site/*/ads/**", b"", 5.0, replies.append)
    assert net.until(lambda: len(waiting) == 3)
    for request in waiting[:2]:
        request.finish()
    net.settle()
    assert not replies
    waiting[2].finish()
    assert net.until(lambda: bool(replies))
    assert sorted(payloads(list(replies[0].samples))) == [b"a", b"a", b"b", b"b", b"c", b"c"]
    assert replies[0].complete


def test_several_replies_on_one_key_all_arrive(net: Net, top: str) -> None:
    asking = net.node()
    for name in ("a", "b"):

        def answer(request: Request, name: str = name) -> None:
            request.reply(f"{top}/cfg", name.encode())
            request.finish()

        net.node().serve(f"{top}/cfg", answer)
    net.settle()
    replies: list[Replies] = []
    asking.ask(f"{top}/cfg", b"", 5.0, replies.append)
    assert net.until(lambda: bool(replies))
    assert sorted(payloads(list(replies[0].samples))) == [b"a", b"b"]


def test_of_an_answer_that_is_too_large_the_rest_is_dropped(
    net: Net, top: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    for module in (questions, zenoh_bus):
        monkeypatch.setattr(module, "LARGEST_REPLIES", 1000)
    asking, answering = net.node(), net.node()

    def answer(request: Request) -> None:
        for _ in range(15):
            request.reply(f"{top}/cfg", b"x" * 100)
        request.finish()

    answering.serve(f"{top}/cfg", answer)
    net.settle()
    replies: list[Replies] = []
    asking.ask(f"{top}/cfg", b"", 5.0, replies.append)
    assert net.until(lambda: bool(replies))
    assert len(replies[0].samples) == 10
    assert not replies[0].complete


def test_a_refusal_is_heard_with_its_reason(net: Net, top: str) -> None:
    one, two = net.node(), net.node()

    def answer(request: Request) -> None:
        request.refuse("not today, nor \udcff")
        request.finish()

    two.serve(f"{top}/@ctl/apply", answer)
    net.settle()
    replies: list[Replies] = []
    one.ask(f"{top}/@ctl/apply", b"", 5.0, replies.append)
    assert net.until(lambda: bool(replies))
    assert replies == [Replies((), ("not today, nor ?",), True)]


def test_a_queryable_that_never_finishes_is_not_waited_for_longer_than_asked(net: Net, top: str) -> None:
    asking, quick, stuck = net.node(), net.node(), net.node()
    kept: list[Request] = []

    def answer(request: Request) -> None:
        request.reply(f"{top}/a", b"quick")
        request.finish()

    quick.serve(f"{top}/a", answer)
    stuck.serve(f"{top}/b", kept.append)
    net.settle()
    replies: list[Replies] = []
    began = asking.now()
    asking.ask(f"{top}/*", b"", 0.3, replies.append)
    assert net.until(lambda: bool(replies))
    assert 0.2 < asking.now() - began < 2.0
    assert payloads(list(replies[0].samples)) == [b"quick"]
    assert not replies[0].complete
    assert replies[0].errors == ()
    for request in kept:
        request.reply(f"{top}/b", b"late")
        request.finish()
    net.settle()
    assert len(replies) == 1


def test_an_answer_may_come_after_a_while_and_finishing_twice_does_nothing(net: Net, top: str) -> None:
    one, two = net.node(), net.node()
    kept: list[Request] = []
    two.serve(f"{top}/a", kept.append)
    net.settle()
    replies: list[Replies] = []
    one.ask(f"{top}/a", b"", 5.0, replies.append)
    assert net.until(lambda: bool(kept))
    net.settle()
    kept[0].reply(f"{top}/a", b"at last")
    kept[0].finish()
    kept[0].finish()
    assert net.until(lambda: bool(replies))
    assert payloads(list(replies[0].samples)) == [b"at last"]


def test_a_queryable_that_was_undone_is_not_asked(net: Net, top: str) -> None:
    one, two = net.node(), net.node()
    asked: list[Request] = []
    undo = two.serve(f"{top}/a", asked.append)
    net.settle()
    undo()
    undo()
    net.settle()
    replies: list[Replies] = []
    one.ask(f"{top}/a", b"", 5.0, replies.append)
    assert net.until(lambda: bool(replies))
    assert not asked


def test_a_broad_question_does_not_reach_a_control_call(net: Net, top: str) -> None:
    one, two = net.node(), net.node()
    asked: list[Request] = []
    two.serve(f"{top}/@ctl/*", asked.append)
    net.settle()
    replies: list[Replies] = []
    one.ask(f"{top}/**", b"", 5.0, replies.append)
    assert net.until(lambda: bool(replies))
    assert not asked


# Lives.


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


# Time.


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


# The end.


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
