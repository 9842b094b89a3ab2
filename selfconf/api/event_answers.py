"""Outcomes in the words of a task: configurations and refusals of a run as `configure` would answer with them."""

from __future__ import annotations

from dataclasses import replace
from typing import overload

from selfconf.api.answer import Answer, ExplainedRefusal
from selfconf.model.configuration import Configuration
from selfconf.model.refusal import Outcome, Refusal, Undecided
from selfconf.model.run_event import AnyRunEvent, SearchEnded, TaskRefused, TaskRunning, TaskWaiting
from selfconf.rdf.tasks import TaskDocument


@overload
def answered(found: Configuration, task: TaskDocument) -> Answer: ...
@overload
def answered(found: Refusal | Undecided, task: TaskDocument) -> Refusal | Undecided: ...
@overload
def answered(found: None, task: TaskDocument) -> None: ...
def answered(found: Outcome | None, task: TaskDocument) -> Outcome | None:
    """A configuration as an Answer, a refusal as one that prints with the prefixes of the task, all else as it is."""
    if isinstance(found, Configuration):
        return found if isinstance(found, Answer) else Answer.of(found, task)
    if isinstance(found, Refusal):
        return found if isinstance(found, ExplainedRefusal) else ExplainedRefusal.of(found, task)
    return found


def answered_event(event: AnyRunEvent, task: TaskDocument) -> AnyRunEvent:
    """An event whose configuration or refusal, if it has one, is as `answered` gives it."""
    if isinstance(event, TaskRunning):
        return replace(event, configuration=answered(event.configuration, task))
    if isinstance(event, SearchEnded):
        return replace(event, outcome=answered(event.outcome, task))
    if isinstance(event, TaskWaiting | TaskRefused) and event.refusal is not None:
        return replace(event, refusal=answered(event.refusal, task))
    return event
