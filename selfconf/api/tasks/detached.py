"""Tasks that live in the ecology: handed to its sites, run by one of them, and ended by name."""

from __future__ import annotations

import secrets
import time
from collections.abc import Callable, Mapping
from typing import Any

from selfconf.api.arguments import checked_choice, checked_upgrade
from selfconf.api.configuring import refusal_with_places
from selfconf.api.document_texts import DocumentText
from selfconf.api.method import Method
from selfconf.api.task import TaskSpecification
from selfconf.api.tasks.run_outcomes import composing, searched_ecology
from selfconf.api.tasks.task_options import AS_USUAL, TaskOptions
from selfconf.composition import Composer
from selfconf.configurator import Policy
from selfconf.deployment import Aside, RunRequest
from selfconf.discovery import Beliefs
from selfconf.errors import PeerError
from selfconf.model.immutable import replace
from selfconf.model.refusal import Refusal
from selfconf.model.seconds import DELAY_IN_WORDS, is_delay
from selfconf.model.term import IRI
from selfconf.model.wording import sayable
from selfconf.protocol.keys import safe_name, task_identity
from selfconf.protocol.messages import TaskRecord
from selfconf.rdf import tasks, turtle


def task_record(task: TaskSpecification, method: Method, how: TaskOptions = AS_USUAL) -> TaskRecord:
    """What the sites are given of a task that is to live in the ecology.

    Raises AuthorError for a name that is none, and ProgrammerError for a priority or upgrade that is none.
    """
    document = task.document.document
    options: dict[str, Any] = {
        "policy": how.policy.value,
        "strategy": method.strategy.value,
        "reasoning": method.reasoning.value,
        "steps": method.steps,
        "seconds": method.seconds,
        "upgrade": checked_upgrade(how.upgrade),
    }
    return TaskRecord(
        task=task_identity(how.name or safe_name(task.iri.short), secrets.token_hex(4)),
        revision=1,
        priority=how.priority_of(task),
        beginning=time.time(),
        document=turtle.to_turtle(document.triples()),
        source=sayable(document.source),
        wanted=str(task.document.task.iri or task.iri),
        bindings=dict(task.bindings),
        ontologies=tuple(turtle.in_turtle(*text) for text in method.ontologies),
        options=options,
    )


def recorded_task(record: TaskRecord) -> tuple[TaskSpecification, Method, Composer]:
    """The task of a record, how it is to be composed, and what composes it. Raises SelfconfError for what is none."""
    options = record.options
    method = Method.of(
        options.get("strategy") or "first",
        options.get("reasoning") or "syntactic",
        steps=options.get("steps"),
        seconds=options.get("seconds"),
    )
    texts = (DocumentText(text.encode(), f"ontology-{n}.ttl", None) for n, text in enumerate(record.ontologies))
    method = replace(method, ontologies=tuple(texts))
    document = tasks.read_task(turtle.parse(record.document.encode(), record.source), IRI.unchecked(record.wanted))
    task = TaskSpecification(tasks.bind(document, list(record.bindings.items()))).complete()
    return task, method, method.composer(task)


def _upgrade(options: Mapping[str, Any]) -> float | None:
    """The seconds before a change for the better, if there is to be one. Raises PeerError for what is no time."""
    value = options.get("upgrade")
    if value is not None and not is_delay(value):
        raise PeerError(f"the option 'upgrade' is {DELAY_IN_WORDS}, not {value!r}")
    return value


def request_of(
    record: TaskRecord,
    aside: Aside,
    believed: Beliefs | None = None,
    at_leisure: Callable[[Callable[[], None]], None] = lambda work: None,
) -> RunRequest:
    """The request by which a site runs a task that it keeps. Raises SelfconfError for what cannot be read.

    `at_leisure` does what nothing waits for: while the task waits, it finds out what else a refusal can tell.
    """
    task, method, composer = recorded_task(record)
    options = record.options

    def explain(refusal: Refusal, found: Callable[[Refusal], None]) -> None:
        def find() -> None:  # with a composer of its own: the partition of the next search must not be spoilt
            composer, ecology = method.composer(task), searched_ecology(refusal)
            found(refusal_with_places(composer, ecology, refusal, method, method.explaining()))

        at_leisure(find)

    return replace(
        RunRequest.of(composer, composing(composer, method.seconds)),
        policy=checked_choice(Policy, "policy", options.get("policy") or "repair"),
        patient=True,
        priority=record.priority,
        upgrade=_upgrade(options),
        believed=believed,
        aside=aside,
        at_leisure=at_leisure,
        explain=explain,
        record=record,
    )
