"""What a configurator does and notices, as the listener of the run and observers hear it.

The listener hears it when there is nothing more urgent to do. Nothing of a run depends on the observers: a notice is
made only while one listens, and the network may drop it, so that an observer that is slow, frozen or gone holds nothing
up. The latest events are kept, for one that comes late or has found a gap in the sequence. How a run has ended is not
dropped, as no configurator could be asked for it any more: that is one notice, which goes the way of the end of its
life.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from functools import partial

from selfconf.bus.answers import answering
from selfconf.bus.port import Bus, Request, Urgency
from selfconf.deployment.run_request import RunRequest
from selfconf.model.immutable import replace
from selfconf.model.refusal import Refusal
from selfconf.model.run_event import AnyRunEvent, RunEvent, TaskRefused, TaskStopped, TaskWaiting
from selfconf.protocol.codec import LARGEST, encode
from selfconf.protocol.keys import Keys
from selfconf.protocol.messages import Notice
from selfconf.render.run_events import event_body

LATEST = 64
"""How many events are kept."""
AT_LEISURE = 0.01
"""Seconds by which what nothing waits for is delayed, so that it does not delay what something waits for."""


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


class RunReports:
    """Reports the events of one run to its listener, and to observers by its notices."""

    def __init__(self, bus: Bus, request: RunRequest, notices: RunNotices, clock: Callable[[], float]) -> None:
        self._bus, self._request, self._notices, self._clock = bus, request, notices, clock
        self._untold: list[AnyRunEvent] = []

    def note(self, event: AnyRunEvent) -> None:
        """Note an event with its time, and tell it soon."""
        if not self._untold:
            self._bus.later(AT_LEISURE, self.tell)
        self._untold.append(replace(event, time=self._clock()))

    def tell(self) -> None:
        """Tell now all that has happened; called in the thread of the bus."""
        untold, self._untold = self._untold, []
        for event in untold:
            self._notices.put(event)
            self._request.report(event)
            if isinstance(event, TaskWaiting) and isinstance(event.refusal, Refusal):
                self._request.explain(event.refusal, partial(self.explained, event))

    def explained(self, event: TaskWaiting, refusal: Refusal) -> None:
        """Tell observers what else was found out about an earlier event; may be called from any thread."""
        self._bus.wake_up(lambda: self._notices.amend(event, replace(event, refusal=refusal)))
