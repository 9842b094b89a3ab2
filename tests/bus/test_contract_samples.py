"""The contract of a bus, kept by the memory bus and by the Zenoh bus: what is put and heard."""

from __future__ import annotations

import threading

import pytest

from selfconf.bus.port import Sample, Urgency
from tests.bus.nets import Net, payloads

EVERY_URGENCY = list(Urgency)


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
