"""The events of a run in words and as JSON: the one place for both, for `run`, for the demo and for the library."""

from __future__ import annotations

import os
from collections.abc import Collection, Iterable, Iterator, Mapping
from dataclasses import fields
from typing import Any

from selfconf.model.configuration import Configuration
from selfconf.model.refusal import Refusal, Undecided
from selfconf.model.run_event import (
    ComponentLost,
    ComponentReleased,
    EcologyDiscovered,
    RunEvent,
    SearchEnded,
    TaskRefused,
    TaskStopped,
    TaskWaiting,
)
from selfconf.model.term import IRI
from selfconf.model.wording import MANY, counted, one_line
from selfconf.render.bodies import configuration_body, refusal_body, undecided_body
from selfconf.render.names import short
from selfconf.render.text import Name, disobedience_text, refusal_text

SENTENCES: Mapping[str, str] = {
    "query": "act 1  asking the ecology what it has",
    "discovered": "act 2  {components} at {sites}{missing}",
    "composed": "act 3  {found} in {milliseconds:.1f} ms",
    "watching": "act 4  listening to FAIL of {component}",
    "waking": "act 4  {component} is dormant; site {site} starts it",
    "awaiting": "act 4  {component} is held by another task; waiting for it",
    "connecting": "act 4  {source} {output} -> {sink} {input}",
    "activating": "",
    "activated": "act 4  {component} is active",
    "set": "act 4  {component} has its parameters",
    "declined": "       {component} declines: {detail}",
    "unreachable": "       {component} cannot be reached: {detail}",
    "lost": "LOST   {component}: {loss}",
    "released": "       {component} {state}",
    "running": "       running",
    "waiting": "       waiting for the ecology to change",
    "refused": "",
    "stopped": "       taken down",
    "detached": "       the sites keep {task}; `selfconf tasks` shows whether it runs, `selfconf stop {task}` ends it",
    "cut off": "       cut off from the ecology; waiting to be connected again",
    "connected": "       connected again; looking at what has become of it",
    "complaint": "       {detail}",
    "left out": "       left out {component}: {reason}",
}
"""For each act a sentence with the facts of the event; an act with an empty one is not worth a line."""


def sentence(event: RunEvent, name: Name) -> str:
    """An event in one line; empty for an event that is not worth one."""
    facts: dict[str, Any] = {one.name: _word(getattr(event, one.name), name) for one in fields(event)}
    if isinstance(event, ComponentLost):
        facts["loss"] = f"{event.cause}, {event.detail}" if event.detail else event.cause
    if isinstance(event, ComponentReleased):
        facts["state"] = f"acts on for the task {event.holder}" if event.holder else "is off"
    if isinstance(event, SearchEnded):
        facts |= {"found": _outcome(event), "milliseconds": event.seconds * 1000}
    if isinstance(event, EcologyDiscovered):
        facts["components"] = counted(event.components, "component")
        facts["missing"] = "".join(f"; site {site} did not answer in full" for site in event.missing[:MANY])
        if len(event.missing) > MANY:
            facts["missing"] += f"; nor did {counted(len(event.missing) - MANY, 'other')}"
    return SENTENCES[event.act].format(**facts)


def log_hint(event: ComponentLost, options: str = "") -> str:
    """Where to look for the last words of a component that has ended or hangs; empty for one that said them itself.

    `options` are those that the command needs to find its log.
    """
    command = f"selfconf log {event.component.short} {options}".rstrip()
    return f"       `{command}` shows what it has printed" if event.cause in ("crash", "hung") else ""


def details(event: RunEvent, name: Name, told: Collection[IRI] = ()) -> Iterator[str]:
    """What there is to say before an event: why a task waits or is refused, what is lost or does not obey.

    Of the components that have been `told`, it is not said once more why they were lost.
    """
    if isinstance(event, TaskWaiting | TaskRefused):
        if isinstance(event.refusal, Undecided):
            yield f"  {event.refusal}"
        elif isinstance(event.refusal, Refusal):
            yield refusal_text(event.refusal, name)
        yield from lost_sentences(event.lost, name, told)
    if isinstance(event, TaskRefused | TaskStopped):
        yield from owed_sentences(event.owed, name)


def owed_sentences(owed: Iterable[IRI], name: Name) -> Iterator[str]:
    """Which components do not obey, a line each."""
    return (f"  {line}" for line in disobedience_text(dict.fromkeys(owed, ""), name))


def lost_sentences(losses: Mapping[IRI, str], name: Name, told: Collection[IRI] = ()) -> Iterator[str]:
    """Why each component was lost, a line each, but for those of which it is known."""
    return (f"  {name(component)} was lost: {why}" for component, why in losses.items() if component not in told)


def _outcome(event: SearchEnded) -> str:
    if isinstance(event.outcome, Configuration):
        return counted(len(event.outcome.components), "component")
    return "no answer" if isinstance(event.outcome, Undecided) else "no configuration"


def _word(value: object, name: Name) -> object:
    if isinstance(value, IRI):
        return name(value)
    if isinstance(value, tuple):
        more = f" and {counted(len(value) - MANY, 'other')}" if len(value) > MANY else ""
        return ", ".join(map(str, value[:MANY])) + more or "no site"
    return one_line(value) if isinstance(value, str) else value  # the name of a port is any text


def event_body(event: RunEvent) -> dict[str, Any]:
    """An event of a run, as a line of `run --format json`: its act, time and facts, a sentence, and the process."""
    facts = {one.name: _fact(getattr(event, one.name)) for one in fields(event) if one.name != "time"}
    message = sentence(event, short).lstrip()  # the indentation is for lines below each other
    return {"act": event.act, "time": event.time, **facts, "message": message, "process": os.getpid()}


def _fact(value: object) -> Any:
    if isinstance(value, Configuration):
        return configuration_body(value)
    if isinstance(value, Refusal):
        return refusal_body(value)
    if isinstance(value, Undecided):
        return undecided_body(value)
    if isinstance(value, tuple):
        return list(value)
    return dict(value) if isinstance(value, Mapping) else value
