"""Outcomes of a run in the words of its task: configurations and refusals as `configure` would answer with them.

The events that have a configuration are classes of their own here, so that a type checker knows it as an Answer; they
are the `TaskRunning` and `SearchEnded` of `selfconf.values`. The floors below know no answers.

A refusal of a run keeps among which advertisements it was found: what else it can tell is found out later, and by then
another search may have been made, in another ecology.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import field
from typing import TypeAlias, overload

from selfconf.api.answer import Answer, ExplainedRefusal
from selfconf.composition import Composer, TimeLimit, composed
from selfconf.deployment import ComposeFunction
from selfconf.model.configuration import Configuration
from selfconf.model.immutable import FrozenMapping, immutable, recast, replace
from selfconf.model.optimum import Optimum, outcome_of
from selfconf.model.partition import Barred
from selfconf.model.refusal import Outcome, Refusal, Undecided
from selfconf.model.run_event import (
    AnyRunEvent,
    EventWithoutConfiguration,
    SearchEnded,
    TaskRefused,
    TaskRunning,
    TaskWaiting,
)
from selfconf.model.term import IRI
from selfconf.rdf.advertisements import Advertisement
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


@immutable
class RefusalAmong(Refusal):
    """A refusal that keeps among which advertisements no configuration was found, also where facts are added to it."""

    ecology: Mapping[IRI, Advertisement] = field(kw_only=True, repr=False, compare=False)


def outcome_among(
    answer: Optimum | Outcome, found: Mapping[IRI, Advertisement], left_out: Collection[Barred]
) -> Outcome:
    """What a search in an ecology without what is left out has come to: a refusal keeps that ecology."""
    if isinstance(answer, Refusal):
        able = FrozenMapping({component: one for component, one in found.items() if component not in left_out})
        return recast(answer, RefusalAmong, Refusal, ecology=able)
    return outcome_of(answer)


def composing(composer: Composer, seconds: float | None = None) -> ComposeFunction:
    """Act 3 of a run: the best answer of a composer within some seconds; a refusal keeps the ecology it is about."""

    def compose(
        found: Mapping[IRI, Advertisement], left_out: frozenset[Barred], running: Configuration | None
    ) -> Outcome:
        return outcome_among(composed(composer, found, left_out, running, TimeLimit(seconds)), found, left_out)

    return compose


def searched_ecology(refusal: Refusal) -> Mapping[IRI, Advertisement]:
    """The advertisements among which a refusal was found; none if it does not keep them."""
    return refusal.ecology if isinstance(refusal, RefusalAmong) else {}
