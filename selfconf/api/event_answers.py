"""Outcomes in the words of a task: configurations and refusals of a run as `configure` would answer with them.

The events that have a configuration are classes of their own here, so that a type checker knows it as an Answer; they
are the `TaskRunning` and `SearchEnded` of `selfconf.values`. The floors below know no answers.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TypeAlias, overload

from selfconf.api.answer import Answer, ExplainedRefusal
from selfconf.model.configuration import Configuration
from selfconf.model.immutable import immutable
from selfconf.model.refusal import Outcome, Refusal, Undecided
from selfconf.model.run_event import (
    AnyRunEvent,
    EventWithoutConfiguration,
    SearchEnded,
    TaskRefused,
    TaskRunning,
    TaskWaiting,
)
from selfconf.rdf.tasks import TaskDocument


@immutable
class AnsweredRunning(TaskRunning):
    """A configuration is complete and runs; it is as `configure` answers with it."""

    configuration: Answer


@immutable
class AnsweredSearch(SearchEnded):
    """Act 3: the search has ended, after so many seconds; a configuration is as `configure` answers with it."""

    outcome: Answer | Refusal | Undecided


AnsweredEvent: TypeAlias = EventWithoutConfiguration | AnsweredSearch | AnsweredRunning
"""An event of a run as the library hands it out, told apart from the others by its `act` or its class."""


@overload
def answered(found: Configuration, task: TaskDocument) -> Answer: ...
@overload
def answered(found: Refusal | Undecided, task: TaskDocument) -> Refusal | Undecided: ...
@overload
def answered(found: Outcome, task: TaskDocument) -> Answer | Refusal | Undecided: ...
@overload
def answered(found: None, task: TaskDocument) -> None: ...
def answered(found: Outcome | None, task: TaskDocument) -> Outcome | None:
    """A configuration as an Answer, a refusal as one that prints with the prefixes of the task, all else as it is."""
    if isinstance(found, Configuration):
        return found if isinstance(found, Answer) else Answer.of(found, task)
    if isinstance(found, Refusal):
        return found if isinstance(found, ExplainedRefusal) else ExplainedRefusal.of(found, task)
    return found


def answered_event(event: AnyRunEvent, task: TaskDocument) -> AnsweredEvent:
    """An event whose configuration or refusal, if it has one, is as `answered` gives it."""
    if isinstance(event, TaskRunning):
        return AnsweredRunning(answered(event.configuration, task), event.epoch, time=event.time)
    if isinstance(event, SearchEnded):
        return AnsweredSearch(answered(event.outcome, task), event.seconds, time=event.time)
    if isinstance(event, TaskWaiting | TaskRefused) and event.refusal is not None:
        return replace(event, refusal=answered(event.refusal, task))
    return event
