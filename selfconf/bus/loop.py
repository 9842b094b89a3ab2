"""The event loop of a bus in real time: callbacks from a queue, and timers, on one thread.

What is urgent (`wake_up`) stands in one queue, what comes in bulk (`enqueue_bulk`) in another. The queue of the urgent
holds at most one mark that says "now one of the bulk": so an urgent callback waits for the urgent ones before it and
for one of the bulk, however many of these there are, and the bulk is not starved either.

What others send is bounded, in bytes: of the bulk the oldest make room, while an urgent message (`enqueue_urgent`) that
finds none is dropped itself, as those before it may say the same. What a program asks of its own loop is not.
"""

from __future__ import annotations

import heapq
import itertools
import logging
import queue
import threading
import time
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass

log = logging.getLogger(__name__)


class Loop:
    """Runs one callback after the other, in the thread that calls `poll` or `run`."""

    MOST_AT_ONCE = 1000
    """How many callbacks a call of `poll` runs at most, so that `run` asks whether to go on even in a flood of them."""
    FEW_TIMERS = 64
    """How many timers are kept without asking how many of them were taken back."""
    MOST_IN_BULK = 10_000
    """How many callbacks wait in bulk at most; then each that comes drives out the oldest one."""
    MOST_BYTES = 64_000_000
    """How large what others have sent may be together, in bulk and of the urgent; one message may always wait."""
    OVERHEAD = 500
    """Bytes that a message takes besides what it says."""
    ROUND = 0.5
    """Seconds that one round of `run` takes at most, after which `until` is asked again, whatever it looks at."""
    LONG_ROUND = 600.0
    """Seconds that one takes on a thread of the loop's own, which `end` wakes up: idle programs are to sleep."""

    def __init__(self) -> None:
        self._waiting: queue.SimpleQueue[Callable[[], None]] = queue.SimpleQueue()
        self._urgent_bytes = 0
        """The size of the urgent messages that wait."""
        self._bulk: deque[tuple[Callable[[], None], int]] = deque()
        self._bulk_bytes = 0
        self._size_lock = threading.Lock()
        self._bulk_lock = threading.Lock()
        self._bulk_is_marked = False
        """Whether `_waiting` holds the mark that lets one of the bulk run."""
        self.dropped = 0
        """How many messages were driven out of the bulk, or found no room among the urgent."""
        self._timers: list[tuple[float, int, _TimedAction]] = []
        self._timer_lock = threading.Lock()
        self._taken_back = 0
        """How many entries of the heap were taken back; they stay until their time, or until they are the majority."""
        self._count = itertools.count()
        self._ended = False
        self._thread: threading.Thread | None = None

    def now(self) -> float:
        """Seconds of the machine's monotonic clock."""
        return time.monotonic()

    def wake_up(self, action: Callable[[], None]) -> None:
        """Call `action` on the loop's thread, soon; may be called from any thread."""
        self._waiting.put(action)

    def enqueue_urgent(self, action: Callable[[], None], size: int) -> bool:
        """Call `action` on the loop's thread, soon, for a message of so many bytes; False if there is no room for it.

        May be called from any thread.
        """
        size += self.OVERHEAD
        with self._size_lock:
            if self._urgent_bytes and self._urgent_bytes + size > self.MOST_BYTES:
                self.dropped += 1
                return False
            self._urgent_bytes += size

        def run() -> None:
            with self._size_lock:
                self._urgent_bytes -= size
            action()

        self._waiting.put(run)
        return True

    def enqueue_bulk(self, action: Callable[[], None], size: int = 0) -> bool:
        """Call `action` on the loop's thread, for a message of so many bytes, unless newer ones drive it out.

        May be called from any thread. Returns True: there is always room for the newest.
        """
        size += self.OVERHEAD
        with self._bulk_lock:
            self._bulk.append((action, size))
            self._bulk_bytes += size
            while len(self._bulk) > self.MOST_IN_BULK or (self._bulk_bytes > self.MOST_BYTES and len(self._bulk) > 1):
                self._bulk_bytes -= self._bulk.popleft()[1]
                self.dropped += 1
            self._mark_bulk()
        return True

    def _mark_bulk(self) -> None:
        if self._bulk and not self._bulk_is_marked:
            self._bulk_is_marked = True
            self._waiting.put(self._run_one_of_bulk)

    def _run_one_of_bulk(self) -> None:
        with self._bulk_lock:
            self._bulk_is_marked = False
            action, size = self._bulk.popleft() if self._bulk else (None, 0)
            self._bulk_bytes -= size
            self._mark_bulk()
        if action is not None:
            action()

    def later(self, seconds: float, action: Callable[[], None]) -> Callable[[], None]:
        """Call `action` once, after that time; the result takes it back. May be called from any thread."""
        timer = _TimedAction(action)
        with self._timer_lock:
            heapq.heappush(self._timers, (self.now() + seconds, next(self._count), timer))
        if self._thread is not None and self._thread is not threading.current_thread():
            self.wake_up(lambda: None)  # it waits for an earlier timer

        def undo() -> None:
            if timer.action is not None:
                timer.action = None
                self._taken_back += 1
                self._drop_taken_back()

        return undo

    def poll(self, seconds: float = 0.0) -> None:
        """Run every callback that is due; if there is none, wait up to that long for the first."""
        deadline, was_timer = self.now() + seconds, False
        for already_run in range(self.MOST_AT_ONCE):
            # In turns: timers that are due again at once may not hold up what has arrived, nor that them.
            timer = None if was_timer else self._due()
            action, was_timer = timer or self._next(None if already_run else deadline), timer is not None
            if action is None or self._ended:
                return
            self._run_callback(action)

    def run(self, until: Callable[[], bool]) -> None:
        """Run callbacks until `until` holds; it is asked after each round."""
        while not until():
            self.poll(self.ROUND)

    def run_aside(self) -> bool:
        """Run callbacks on a thread of their own from now on, until the loop ends."""
        if self._thread is None:
            self._thread = threading.Thread(target=self._run_to_the_end, daemon=True, name="bus")
            self._thread.start()
        return True

    def _run_to_the_end(self) -> None:
        while not self._ended:
            self.poll(self.LONG_ROUND)

    def end(self) -> None:
        """Run no callback any more; one that runs on the loop's own thread is waited for."""
        self._ended = True
        self.wake_up(lambda: None)
        own = self._thread
        if own is not None and own.ident is not None and own is not threading.current_thread():
            own.join()
        self._timers.clear()
        self._taken_back = 0
        with self._bulk_lock:
            self._bulk.clear()
            self._bulk_bytes = 0

    def _due(self) -> Callable[[], None] | None:
        """The timer whose time has come; timers go before the queue, or a flood in the queue would hold them up."""
        with self._timer_lock:
            while self._timers and (self._timers[0][2].action is None or self._timers[0][0] <= self.now()):
                timer = heapq.heappop(self._timers)[2]
                if timer.action is None:
                    self._taken_back -= 1
                    continue
                action, timer.action = timer.action, None  # taking it back from now on does nothing
                return action
            return None

    def _drop_taken_back(self) -> None:
        """Build the heap anew once most of it was taken back: constant cost per timer, as none is dropped twice."""
        with self._timer_lock:
            if len(self._timers) > self.FEW_TIMERS and 2 * self._taken_back > len(self._timers):
                self._timers = [entry for entry in self._timers if entry[2].action is not None]
                heapq.heapify(self._timers)
                self._taken_back = 0

    def _next(self, deadline: float | None) -> Callable[[], None] | None:
        """The next callback, of the queue or of a timer; it is waited for until the deadline, if there is one."""
        while True:
            wait = 0.0 if deadline is None else deadline - self.now()
            with self._timer_lock:
                if self._timers:
                    wait = min(wait, self._timers[0][0] - self.now())
            try:
                return self._waiting.get(wait > 0, wait if wait > 0 else None)
            except queue.Empty:
                action = self._due()
                if action is not None or deadline is None or self.now() >= deadline:
                    return action

    def _run_callback(self, action: Callable[[], None]) -> None:
        """The outermost loop: what breaks in a callback is logged, and the loop goes on, as timers and the end need it.

        What Zenoh panics with is no Exception of Python.
        """
        try:
            action()
        except (KeyboardInterrupt, SystemExit):
            raise
        except BaseException:
            log.exception("a callback broke; going on")


@dataclass(slots=True, eq=False)
class _TimedAction:
    """A callback to be run at a time; no action is left once it was run or taken back."""

    action: Callable[[], None] | None
