"""The threads that read what comes by the thousand: one for each reading at a time, kept for the next one, ended."""

from __future__ import annotations

import threading
import weakref
from collections.abc import Iterator
from contextlib import contextmanager

import pytest

from selfconf.bus.zenoh.reader_threads import MOST_IDLE, ReaderThreads

PATIENCE = 10.0


class Reading:
    """Something to be read, which goes on until it is told to end, and by which thread it was read."""

    def __init__(self) -> None:
        self._begun, self._over = threading.Event(), threading.Event()
        self.thread = threading.current_thread()

    def __call__(self) -> None:
        self.thread = threading.current_thread()
        self._begun.set()
        assert self._over.wait(PATIENCE)

    def begun(self) -> bool:
        """Wait until it is read."""
        return self._begun.wait(PATIENCE)

    def finish(self) -> None:
        """There is nothing more to read."""
        self._over.set()


@contextmanager
def begun(threads: ReaderThreads, number: int) -> Iterator[list[Reading]]:
    """Readings that go on at once."""
    readings = [Reading() for _ in range(number)]
    for reading in readings:
        threads.begin(reading)
    assert all(reading.begun() for reading in readings)
    yield readings
    for reading in readings:
        reading.finish()


def idle(threads: ReaderThreads, number: int) -> bool:
    """Wait until so many threads have nothing to read."""
    pause, waited = threading.Event(), 0
    while threads._idle != number and waited < 1000:
        pause.wait(PATIENCE / 1000)
        waited += 1
    return threads._idle == number


def test_each_reading_has_a_thread_of_its_own_as_long_as_it_goes_on() -> None:
    threads = ReaderThreads()
    with begun(threads, 3) as readings:
        assert len({reading.thread for reading in readings}) == 3
    threads.end(PATIENCE)


def test_a_thread_that_has_read_to_the_end_reads_what_comes_next() -> None:
    threads = ReaderThreads()
    with begun(threads, 1) as first:
        pass
    assert idle(threads, 1)
    with begun(threads, 1) as second:
        assert second[0].thread is first[0].thread
    threads.end(PATIENCE)


def test_few_threads_are_kept_of_many() -> None:
    threads = ReaderThreads()
    with begun(threads, 2 * MOST_IDLE) as readings:
        pass
    for reading in readings:
        if idle(threads, MOST_IDLE) and not reading.thread.is_alive():
            break
    else:
        raise AssertionError("no thread has ended")
    threads.end(PATIENCE)


def test_those_that_wait_and_those_that_read_end() -> None:
    threads = ReaderThreads()
    with begun(threads, 2) as over:
        pass
    assert idle(threads, 2)
    with begun(threads, 1) as going_on:
        threading.Timer(0.05, going_on[0].finish).start()
        threads.end(PATIENCE)
    assert not any(reading.thread.is_alive() for reading in (*over, *going_on))


def test_one_that_breaks_ends_alone() -> None:
    threads, heard = ReaderThreads(), list[object]()
    before, threading.excepthook = threading.excepthook, lambda broken: heard.append(broken.exc_type)
    try:
        threads.begin(lambda: 1 / 0)
        threads.end(PATIENCE)
    finally:
        threading.excepthook = before
    assert heard == [ZeroDivisionError]
    assert not threads._threads


def test_what_was_read_is_not_held_by_a_thread_that_waits() -> None:
    threads = ReaderThreads()
    with begun(threads, 1) as readings:
        read = weakref.ref(readings[0])
    readings.clear()
    assert idle(threads, 1)
    assert read() is None
    threads.end(PATIENCE)


def test_nothing_is_read_after_the_end() -> None:
    threads, reading = ReaderThreads(), Reading()
    threads.end(PATIENCE)
    threads.begin(reading)
    reading.finish()
    assert not threads._threads
    assert not reading._begun.is_set()


def test_what_no_thread_could_be_started_for_is_not_read_later() -> None:
    threads, read = ReaderThreads(), list[str]()
    before = threading.stack_size(1 << 47)  # more than there are addresses
    try:
        with pytest.raises(RuntimeError, match="can't start new thread"):
            threads.begin(lambda: read.append("first"))
    finally:
        threading.stack_size(before)
    threads.begin(lambda: read.append("second"))
    assert idle(threads, 1)
    threads.end(PATIENCE)
    assert read == ["second"]
