"""What a configurator does and notices, sent to observers.

Nothing of a run depends on it: a notice is made only while an observer listens, and the network may drop it, so that an
observer that is slow, frozen or gone holds nothing up. The latest events are kept, for one that comes late or has found
a gap in the sequence. How a run has ended is not dropped, as no configurator could be asked for it any more: that is
one notice, which goes the way of the end of its life.
"""

from __future__ import annotations

from collections import deque

from selfconf.bus.answering import answering
from selfconf.bus.port import Bus, Request, Urgency
from selfconf.model.run_event import RunEvent, TaskRefused, TaskStopped
from selfconf.protocol.codec import LARGEST, encode
from selfconf.protocol.keys import Keys
from selfconf.protocol.messages import Notice
from selfconf.render.run_events import event_body

LATEST = 64
"""How many events are kept."""


class RunNotices:
    """Puts the events of one run on the bus, and answers which were the latest."""

    def __init__(self, bus: Bus, keys: Keys, name: str, task: str) -> None:
        self._keys, self._name, self._task = keys, name, task
        self._latest: deque[tuple[int, RunEvent]] = deque(maxlen=LATEST)
        self._sequence = 0
        self._heard = False
        # What is not EVENT is dropped where the network is short of room; EVENT would wait for a frozen observer. In
        # bulk many come in one message; each at once, a rush of five found no room on a busy machine.
        self._publisher = bus.publisher(keys.notices(name), Urgency.BULK, self._matched)
        self._last_words = bus.publisher(keys.notices(name), Urgency.EVENT)
        self._served = bus.serve(keys.notices(name), self._answer)

    def close(self) -> None:
        """Tell nothing any more, whatever is put yet: a call may be answered after its task has ended."""
        self._heard = False
        self._latest.clear()
        self._served()
        self._publisher.undeclare()
        self._last_words.undeclare()

    def put(self, event: RunEvent) -> None:
        """Tell an event."""
        self._sequence += 1
        self._latest.append((self._sequence, event))
        if self._heard:
            ends = isinstance(event, TaskStopped | TaskRefused)
            (self._last_words if ends else self._publisher).put(self._notice(self._sequence, event))

    def amend(self, event: RunEvent, amended: RunEvent) -> None:
        """Tell one of the latest events once more, by its number and with more facts; an older one is forgotten."""
        for place, (sequence, told) in enumerate(self._latest):
            if told is event:
                self._latest[place] = sequence, amended
                if self._heard:
                    self._publisher.put(self._notice(sequence, amended))

    def _matched(self, heard: bool) -> None:
        self._heard = heard

    def _answer(self, request: Request) -> None:
        with answering(request):
            for sequence, event in self._latest:
                request.reply(self._keys.notices(self._name), self._notice(sequence, event))

    def _notice(self, sequence: int, event: RunEvent) -> bytes:
        body = event_body(event)
        notice = encode(Notice(self._name, sequence, self._task, body))
        if len(notice) <= LARGEST:
            return notice
        short = {fact: body[fact] for fact in ("act", "time", "message")}
        return encode(Notice(self._name, sequence, self._task, short))
