"""What is handed to the thread that does what takes long: work comes before events, and none is lost."""

from __future__ import annotations

import pytest

from selfconf.api.work_queue import WorkQueue
from selfconf.model.run_event import EcologyAsked


def test_work_is_done_before_the_next_event_is_given() -> None:
    queue, done = WorkQueue(), list[str]()
    event = EcologyAsked()
    queue.report(event)
    queue.work(lambda: done.append("searched"))
    assert queue.next(0.0) is event
    assert done == ["searched"]
    assert queue.next(0.0) is None


def test_a_wake_up_ends_the_wait() -> None:
    queue = WorkQueue()
    queue.wake_up()
    assert queue.next(60.0) is None


def test_what_breaks_takes_nothing_with_it_that_waits() -> None:
    queue, done = WorkQueue(), list[str]()
    queue.work(lambda: {}["nothing"])
    queue.work(lambda: done.append("searched"))
    with pytest.raises(KeyError):
        queue.next(0.0)
    queue.next(0.0)
    assert done == ["searched"]
