"""A question in the network in memory: as it was asked, and as it arrived at each node that answers it."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from selfconf.bus.port import LARGEST_REPLIES, Replies, Sample

if TYPE_CHECKING:
    from selfconf.bus.memory.bus import MemoryBus


class MemoryQuestion:
    """A question that was asked: collects replies until all queryables have finished, or the time is over."""

    def __init__(self, bus: MemoryBus, done: Callable[[Replies], None]) -> None:
        self.bus, self._done = bus, done
        self._samples: list[Sample] = []
        self._errors: list[str] = []
        self._open = self._size = 0
        self._over = False
        self._undo: Callable[[], None] = lambda: None
        """Undoes the timer that ends the waiting."""

    def asked(self, node: MemoryBus, said: Sample, answer: Callable[[MemoryRequest], None]) -> None:
        """Have the question arrive at a node that answers it."""
        self._open += 1
        request = MemoryRequest(self, node, said)
        self.bus.network.deliver(self.bus, node, lambda: answer(request), sure=False)

    def sent(self, seconds: float) -> None:
        """Wait for the replies of the nodes that were asked, for so many seconds."""
        if self._open == 0:
            self.bus.network.deliver(self.bus, self.bus, lambda: self._end(complete=True))
        self._undo = self.bus.later(seconds, lambda: self._end(complete=False))

    def replied(self, sample: Sample | None, error: str | None) -> None:
        """Keep a reply, or the reason why there is none, as long as all of them are not too large."""
        self._size += len(error or "") if sample is None else len(sample.payload)
        if self._size > LARGEST_REPLIES:
            return
        if sample is not None:
            self._samples.append(sample)
        if error is not None:
            self._errors.append(error)

    def finished(self) -> None:
        """Note that a node has ended its answer."""
        self._open -= 1
        if self._open == 0:
            self._end(complete=True)

    def _end(self, complete: bool) -> None:
        if not self._over:
            self._over = True
            self._undo()
            self._done(Replies(tuple(self._samples), tuple(self._errors), complete and self._size <= LARGEST_REPLIES))


class MemoryRequest:
    """A question as it arrived at a node."""

    def __init__(self, question: MemoryQuestion, node: MemoryBus, said: Sample) -> None:
        self._question, self._node = question, node
        self.key, self.payload, self.attachment = said
        self._finished = False
        self._lost = node.network.loses()
        """Whether the answer is lost: all of it, and its end, so that it shows as a time-out."""

    def reply(self, key: str, payload: bytes, attachment: bytes = b"") -> None:
        """One reply."""
        self._back(lambda: self._question.replied(Sample(key, payload, attachment), None))

    def refuse(self, reason: str) -> None:
        """Reply that it cannot be answered."""
        said = reason.encode(errors="replace").decode()
        self._back(lambda: self._question.replied(None, said))

    def finish(self) -> None:
        """End the answer."""
        if not self._finished:
            self._finished = True
            self._back(self._question.finished)

    def _back(self, action: Callable[[], None]) -> None:
        if not self._lost:
            self._node.network.deliver(self._node, self._question.bus, action)
