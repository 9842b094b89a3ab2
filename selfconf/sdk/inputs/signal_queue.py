"""The signals that wait until the code of a component has time for them: bounded, in order, the newest kept."""

from __future__ import annotations

import math
import threading
from collections import deque

from selfconf.bus.port import Sample

EVENTS = 1000
"""How many signals of an output that promises no rate wait at most, unless the input says otherwise."""
EVENT_BYTES = 64_000_000
"""How many bytes these have together at most; one signal may always wait."""


class SignalQueue:
    """Filled by the thread that signals arrive on, emptied by that of the component's code."""

    def __init__(self, depth: int | None) -> None:
        """`depth` is how many signals wait at most; None for what events may need."""
        self._depth = EVENTS if depth is None else depth
        self._most_bytes = EVENT_BYTES if depth is None else math.inf
        self._waiting: deque[Sample] = deque()
        self._bytes = 0
        self._lock = threading.Lock()
        self.dropped = 0
        """How many signals were driven out by newer ones."""

    def __len__(self) -> int:
        return len(self._waiting)

    def append(self, sample: Sample) -> bool:
        """Let a signal wait, and drive out the oldest if these are too many; whether none was."""
        waiting = self._waiting
        with self._lock:
            waiting.append(sample)
            self._bytes += len(sample.payload) + len(sample.attachment)
            if len(waiting) <= self._depth and self._bytes <= self._most_bytes:
                return True
            dropped = 0
            while len(waiting) > self._depth or (self._bytes > self._most_bytes and len(waiting) > 1):
                self._bytes -= _size(waiting.popleft())
                dropped += 1
            self.dropped += dropped
            return not dropped

    def pop(self) -> Sample | None:
        """The oldest signal, which does not wait any more; None if there is none."""
        with self._lock:
            if not self._waiting:
                return None
            sample = self._waiting.popleft()
            self._bytes -= len(sample.payload) + len(sample.attachment)
            return sample

    def newest(self) -> Sample | None:
        """The newest signal that waits; None if there is none."""
        with self._lock:
            return self._waiting[-1] if self._waiting else None

    def keep(self, newest: int) -> None:
        """Forget all but so many of the newest signals; these do not count as dropped."""
        with self._lock:
            while len(self._waiting) > newest:
                self._bytes -= _size(self._waiting.popleft())


def _size(sample: Sample) -> int:
    return len(sample.payload) + len(sample.attachment)
