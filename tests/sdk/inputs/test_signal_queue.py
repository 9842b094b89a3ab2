"""Signals that wait: bounded in number and, where nobody has said how many, in bytes."""

from __future__ import annotations

from selfconf.bus.port import Sample
from selfconf.sdk.inputs.signal_queue import EVENT_BYTES, EVENTS, SignalQueue


def waiting(queue: SignalQueue) -> list[int]:
    """The lengths of the signals that wait, which wait no more."""
    found = []
    while (sample := queue.pop()) is not None:
        found.append(len(sample.payload))
    return found


def filled(depth: int | None, *lengths: int) -> tuple[SignalQueue, list[bool]]:
    """A queue to which signals of these lengths have come, and whether each made it longer."""
    queue = SignalQueue(depth)
    return queue, [queue.append(Sample("k", bytes(length))) for length in lengths]


def test_the_oldest_are_driven_out_and_counted() -> None:
    queue, grown = filled(2, 1, 2, 3, 4)
    assert grown == [True, True, False, False]
    assert (queue.dropped, len(queue), waiting(queue)) == (2, 2, [3, 4])
    assert queue.pop() is None


def test_events_wait_up_to_a_number() -> None:
    queue, grown = filled(None, *[0] * (EVENTS + 3))
    assert grown.count(False) == queue.dropped == 3
    assert len(queue) == EVENTS


def test_events_that_are_large_wait_up_to_a_number_of_bytes() -> None:
    half = EVENT_BYTES // 2
    queue, _ = filled(None, half, half, half, 1)
    assert (queue.dropped, waiting(queue)) == (2, [half, 1])
    queue, _ = filled(None, 1, EVENT_BYTES + 1)
    assert (queue.dropped, waiting(queue)) == (1, [EVENT_BYTES + 1])


def test_a_depth_that_was_declared_holds_however_large_the_signals_are() -> None:
    half = EVENT_BYTES // 2
    queue, _ = filled(3, half, half, half)
    assert queue.dropped == 0


def test_what_has_been_read_or_forgotten_makes_room_and_is_not_counted() -> None:
    half = EVENT_BYTES // 2
    queue, _ = filled(None, half, half)
    queue.pop()
    assert queue.append(Sample("k", bytes(half)))
    queue.keep(1)
    assert queue.append(Sample("k", bytes(half)))
    queue.keep(0)
    assert (queue.dropped, len(queue)) == (0, 0)


def test_what_is_said_of_a_signal_takes_room_as_well() -> None:
    queue = SignalQueue(None)
    for _ in range(3):
        queue.append(Sample("k", b"", bytes(EVENT_BYTES // 2)))
    assert (queue.dropped, len(queue)) == (1, 2)


def test_the_newest_that_waits_is_seen_and_waits_on() -> None:
    queue, _ = filled(None, 1, 2)
    newest = queue.newest()
    assert newest is not None
    assert len(newest.payload) == 2
    assert waiting(queue) == [1, 2]
    assert queue.newest() is None
