"""The threads of a bus that read what comes by the thousand.

One that has read to the end is kept for what is to be read next: to start a thread is to wait until it has begun,
which on a busy machine takes as long as a question and its answer.
"""

from __future__ import annotations

import queue
import threading
from collections.abc import Callable

MOST_IDLE = 4
"""How many threads with nothing to read are kept at most."""


class ReaderThreads:
    """Threads that read, as many as there is to be read at once."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._readings: queue.SimpleQueue[Callable[[], None] | None] = queue.SimpleQueue()
        self._idle = 0
        """How many threads wait for a reading that is not promised to them yet."""
        self._threads: set[threading.Thread] = set()
        self._ended = False

    def begin(self, reading: Callable[[], None]) -> None:
        """Call `reading`, which returns when there is nothing more to read, on a thread that does nothing else.

        After `end` nothing is read any more. Raises RuntimeError where the system starts no more threads.
        """
        with self._lock:
            if self._ended:
                return
            if self._idle:
                self._idle -= 1
            else:
                thread = threading.Thread(target=self._read, daemon=True, name="bulk")
                thread.start()
                self._threads.add(thread)
            self._readings.put(reading)

    def end(self, seconds: float) -> None:
        """Have the threads end, and wait for those that still read, for each so many seconds at most."""
        with self._lock:
            self._ended = True
            for _ in range(self._idle):
                self._readings.put(None)
            self._idle = 0
            threads = list(self._threads)
        for thread in threads:
            thread.join(seconds)

    def _read(self) -> None:
        try:
            while (reading := self._readings.get()) is not None:
                reading()
                reading = None  # while the thread waits, what was read must not be held by it
                with self._lock:
                    if self._ended or self._idle >= MOST_IDLE:
                        return
                    self._idle += 1
        finally:
            with self._lock:
                self._threads.discard(threading.current_thread())
