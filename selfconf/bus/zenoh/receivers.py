"""What Zenoh calls back for a declaration, and how that comes to the thread that it is meant for.

Zenoh calls back on threads that are none of Python's. Such a thread has a state of Python for one call at a time, and
with the state comes and goes the memory of its frames, which is mapped and unmapped: that takes longer than most calls,
and twice as many small signals arrive in a second without it. So a thread keeps the state of its first call for good.
"""

from __future__ import annotations

import ctypes
import logging
import threading
from collections.abc import Callable
from typing import Any

import zenoh
from zenoh.handlers import Callback

from selfconf.bus.loop import Loop
from selfconf.bus.port import Sample, Undo

log = logging.getLogger(__name__)


def sample_of(sample: zenoh.Sample, key: str = "") -> Sample:
    """What Zenoh has received, as a value of our own; `key` is its key where that is known, which saves asking."""
    attachment = sample.attachment
    beside = b"" if attachment is None else attachment.to_bytes()
    return Sample(key or str(sample.key_expr), sample.payload.to_bytes(), beside)


_THREAD = threading.local()


def callback(call: Callable[[Any], object], end: Callable[[], None] | None = None) -> Any:
    """What Zenoh calls, on its own thread, for each that comes, and in the end; it is not to take long."""

    def called(received: Any) -> None:
        if not hasattr(_THREAD, "kept"):
            _THREAD.kept = ctypes.pythonapi.PyGILState_Ensure()  # never released; what is in _THREAD is lost with it
        call(received)

    return Callback(called, end, indirect=False)


class ZenohRequest:
    """A Zenoh query, kept until it is finished."""

    def __init__(self, query: zenoh.Query) -> None:
        self._query: Any = query
        self.key = str(query.key_expr)
        self.payload = bytes(query.payload) if query.payload is not None else b""
        self.attachment = bytes(query.attachment) if query.attachment is not None else b""

    def reply(self, key: str, payload: bytes, attachment: bytes = b"") -> None:
        """One reply, on a concrete key of one's own."""
        if self._query is not None:
            self._query.reply(key, payload, attachment=attachment)

    def refuse(self, reason: str) -> None:
        """Reply that it cannot be answered."""
        if self._query is not None:
            self._query.reply_err(reason.encode(errors="replace"))

    def finish(self) -> None:
        """End the answer."""
        if self._query is not None:
            self._query.drop()
            self._query = None


class Receiver:
    """Calls back on a loop's thread for what a declaration receives, until the declaration is taken back."""

    def __init__(self, loop: Loop, call: Callable[..., None]) -> None:
        self._loop, self._call = loop, call
        self._listening = True

    def received(self, *arguments: Any) -> None:
        """Called by Zenoh, on a thread of its own, for what may not be missed: it waits however much else does."""
        self._loop.wake_up(lambda: self._call(*arguments) if self._listening else None)

    def received_message(self, message: Sample | ZenohRequest, urgent: bool = True) -> bool:
        """Called by Zenoh, on a thread of its own, for what others say; whether there is room for it."""
        enqueue = self._loop.enqueue_urgent if urgent else self._loop.enqueue_bulk
        size = len(message.payload) + len(message.attachment)
        return enqueue(lambda: self._call(message) if self._listening else None, size)

    def until(self, undeclare: Undo) -> Undo:
        """Return what takes the declaration back, with every callback that has not run yet."""

        def undo() -> None:
            self._listening = False
            undeclare()

        return undo


class DirectReceiver:
    """Calls back on Zenoh's thread for what a subscription receives, until the subscription is taken back."""

    def __init__(self, key: str, receive: Callable[[Sample], None]) -> None:
        self._key = "" if "*" in key else key
        """The key of every sample; empty where these are of several keys."""
        self._receive = receive
        self._listening = True
        # Held during each call, so that `close` waits for one that is under way. Reentrant: `receive` may put on the
        # key that it receives, which arrives on the same thread.
        self._calling = threading.RLock()

    def received(self, sample: zenoh.Sample) -> None:
        """Called by Zenoh, on a thread of its own, or on the thread of a publisher of the same session."""
        with self._calling:
            if not self._listening:
                return
            try:
                self._receive(sample_of(sample, self._key))
            except Exception:  # an outermost loop, like that of the bus: Zenoh would print it and go on
                log.exception("a direct callback broke; going on")

    def close(self) -> None:
        """Wait for a call that is under way, and let none begin any more."""
        with self._calling:
            self._listening = False
