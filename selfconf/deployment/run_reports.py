"""The events of one run, as its listener and its observers hear them: when there is nothing more urgent to do."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from selfconf.bus.port import Bus
from selfconf.deployment.notices import RunNotices
from selfconf.deployment.run_request import RunRequest
from selfconf.model.immutable import replace
from selfconf.model.refusal import Refusal
from selfconf.model.run_event import AnyRunEvent, TaskWaiting

AT_LEISURE = 0.01
"""Seconds by which what nothing waits for is delayed, so that it does not delay what something waits for."""


class RunReports:
    """Reports the events of one run."""

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
