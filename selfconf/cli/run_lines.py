"""The lines of `selfconf run`: for people on stderr, one for each event and nothing twice; for programs JSON on stdout.

They are printed by a thread of their own.
"""

from __future__ import annotations

import json
import queue
import sys
import threading
from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING, TextIO

from selfconf.cli.terminal import silence
from selfconf.model.immutable import replace

if TYPE_CHECKING:
    from selfconf.api.task import TaskSpecification
    from selfconf.model.run_event import RunEvent
    from selfconf.model.term import IRI


class TextLines:
    """Reports events to people, one line each on stderr, with the seconds since the first one; no failure twice.

    A task that waits looks again from time to time whether it can run: that is reported once it comes to something else
    than before.
    """

    def __init__(self, task: TaskSpecification, log_options: str = "") -> None:
        """`log_options` are those by which `selfconf log` finds what the components of the task have printed."""
        self._names, self._log_options = task.names, log_options
        self._interactions = task.document.template.interactions
        self._unconnected: set[str] = set()
        """What was said of interactions that connect nothing."""
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
        from selfconf.model.configuration import Configuration
        from selfconf.model.run_event import (
            CallDeclined,
            ComponentLost,
            ComponentUnreachable,
            SearchEnded,
            TaskRefused,
            TaskStopped,
            TaskWaiting,
        )
        from selfconf.render import unconnected_text
        from selfconf.render.run_events import details, log_hint, owed_sentences, sentence

        assert self._began is not None
        yield from details(event, self._names, self.told) if isinstance(event, TaskWaiting | TaskStopped) else ()
        if isinstance(event, TaskRefused):  # why is explained once everything is down
            yield from owed_sentences(event.owed, self._names)
        hint = ""
        if isinstance(event, CallDeclined | ComponentUnreachable):
            self._trouble[event.component] = event.detail
        elif isinstance(event, ComponentLost):
            hint = log_hint(event, self._log_options) if event.component not in self.told else ""
            self.told.add(event.component)
            if self._trouble.pop(event.component, None) == event.detail:
                event = replace(event, detail="")
        said = sentence(event, self._names)
        if said:
            yield f"{event.time - self._began:9.3f} s  {said}"
        if hint:
            yield f"{'':11}  {hint}"
        if isinstance(event, SearchEnded) and isinstance(event.outcome, Configuration):
            for line in unconnected_text(event.outcome, self._interactions, self._names):
                if line not in self._unconnected:
                    self._unconnected.add(line)
                    yield f"{'':11}         {line}"


class LinePrinter:
    """Reports events on a thread of its own: a terminal that is held must not hold up the task."""

    END = 2.0
    """Seconds for which the lines that are left are waited for at the end."""

    def __init__(self, report: Callable[[RunEvent], None], stream: TextIO, broken: Callable[[], None]) -> None:
        """The report of an event is written to the stream; `broken` is called when that cannot be."""
        self._report, self._stream, self._broken = report, stream, broken
        self.trouble: OSError | None = None
        """Why a line could not be written; None also where only the reader of the lines has gone."""
        self._events: queue.SimpleQueue[RunEvent | None] = queue.SimpleQueue()
        self._thread = threading.Thread(target=self._print, daemon=True, name="lines")
        self._thread.start()

    def put(self, event: RunEvent) -> None:
        """Report an event, soon."""
        self._events.put(event)

    def end(self) -> None:
        """Report what is left, unless that takes too long."""
        self._events.put(None)
        self._thread.join(self.END)

    def _print(self) -> None:
        while (event := self._events.get()) is not None:
            try:
                self._report(event)
            except OSError as error:  # the reader of the lines is gone, or the disk is full: end rather than run unseen
                silence(self._stream)
                if isinstance(error, BrokenPipeError):  # the reader that has gone may have read both
                    silence(sys.stderr)
                else:
                    self.trouble = error
                self._broken()
                return


def json_lines(event: RunEvent) -> None:
    """Reports an event to programs: a JSON object on a line of stdout. Raises OSError if it cannot be written."""
    from selfconf.render.run_events import event_body

    print(json.dumps(event_body(event), ensure_ascii=False), flush=True)
