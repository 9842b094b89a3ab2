"""What `selfconf run` tells people: a line on stderr for each event, and nothing twice."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from dataclasses import replace
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from selfconf.api.task import TaskSpecification
    from selfconf.model.run_event import RunEvent
    from selfconf.model.term import IRI


class TextLines:
    """Reports events to people, one line each on stderr, with the seconds since the first one; no failure twice.

    A task that waits looks again from time to time whether it can run: that is reported once it comes to something else
    than before.
    """

    def __init__(self, task: TaskSpecification) -> None:
        self._names = task.names
        self._began: float | None = None
        self.told: set[IRI] = set()
        """The components that were reported as lost, and why."""
        self._trouble: dict[IRI, str] = {}
        """What was reported last of a component that declines or cannot be reached, which is then lost for that."""
        self._waiting: list[RunEvent] | None = None
        """While the task waits, what it saw when it looked last, without the times, and why it waits."""
        self._seen: list[RunEvent] = []
        """What it has seen since it looks."""
        self._held: list[str] = []
        """The lines of that which are not told yet."""

    def __call__(self, event: RunEvent) -> None:
        """Raises OSError if the line cannot be written."""
        from selfconf.model.configuration import Configuration
        from selfconf.model.run_event import (
            AnswerRejected,
            EcologyAsked,
            EcologyDiscovered,
            SearchEnded,
            TaskStopped,
            TaskWaiting,
        )

        self._began = event.time if self._began is None else self._began
        if isinstance(event, TaskStopped):
            self._held = []
        self._held += self._lines(event)
        if isinstance(event, EcologyAsked):
            self._seen = []
        if isinstance(event, EcologyDiscovered | AnswerRejected | TaskWaiting):
            self._seen.append(replace(event, time=0.0))
        if isinstance(event, TaskWaiting):
            if self._seen == self._waiting:
                self._held = []
            self._waiting, self._seen = self._seen, []
        elif isinstance(event, SearchEnded) and isinstance(event.outcome, Configuration):
            self._waiting = None
        elif self._waiting is not None and isinstance(
            event, EcologyAsked | EcologyDiscovered | AnswerRejected | SearchEnded
        ):
            return
        self._tell()

    def _tell(self) -> None:
        lines, self._held = self._held, []
        for line in lines:
            print(line, file=sys.stderr, flush=True)

    def _lines(self, event: RunEvent) -> Iterator[str]:
        from selfconf.model.run_event import (
            CallDeclined,
            ComponentLost,
            ComponentUnreachable,
            TaskRefused,
            TaskStopped,
            TaskWaiting,
        )
        from selfconf.render.run_events import details, log_hint, owed_sentences, sentence

        assert self._began is not None
        yield from details(event, self._names, self.told) if isinstance(event, TaskWaiting | TaskStopped) else ()
        if isinstance(event, TaskRefused):  # why is explained once everything is down
            yield from owed_sentences(event.owed, self._names)
        hint = ""
        if isinstance(event, CallDeclined | ComponentUnreachable):
            self._trouble[event.component] = event.detail
        elif isinstance(event, ComponentLost):
            hint = log_hint(event) if event.component not in self.told else ""
            self.told.add(event.component)
            if self._trouble.pop(event.component, None) == event.detail:
                event = replace(event, detail="")
        said = sentence(event, self._names)
        if said:
            yield f"{event.time - self._began:9.3f} s  {said}"
        if hint:
            yield f"{'':11}  {hint}"
