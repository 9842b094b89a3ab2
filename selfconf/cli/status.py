"""`status`: what is deployed, by which configurator, since when."""

from __future__ import annotations

import argparse
import json
import time
from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any

from selfconf.cli.options import add_ecology_arguments, add_format_argument, complain_of, joined
from selfconf.cli.tasks import code_of_tasks
from selfconf.cli.terminal import STATE_COLOURS, complain, display, display_json, paint
from selfconf.model.term import IRI
from selfconf.model.wording import counted, one_line

if TYPE_CHECKING:
    from selfconf.api.living.living_ecology import LivingEcology
    from selfconf.protocol.messages import Status
    from selfconf.render import Names

EXAMPLE = """  selfconf status --format json"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The options of the command."""
    add_format_argument(parser)
    add_ecology_arguments(parser)


def run(given: argparse.Namespace) -> int:
    """Return 0 once every configurator has answered, also if nothing is deployed; else as `code_of_tasks`."""
    with joined(given) as ecology:
        found = ecology.tasks
        complain_of(ecology)
        deployed = _deployed(ecology) if found else {}
        disobedient = ecology.out_of_control() if given.format != "json" else {}
        code = code_of_tasks(ecology)
    if given.format == "json":
        bodies = [_body(status, deployed.get(status.configurator, {})) for status in found]
        display_json(bodies)
        return code
    if not found and not code:
        display(f"nothing is deployed in ecology {ecology.name}")
    for line in _told(found, deployed, disobedient):
        display(line)
    return code


def _deployed(ecology: LivingEcology) -> dict[str, dict[str, Any]]:
    """What each configurator has deployed; on stderr, what was left out of that."""
    deployed = ecology.deployed()
    for one in ecology.complaints:
        complain(one)
    return deployed


def _told(
    found: Sequence[Status], deployed: Mapping[str, Mapping[str, Any]], disobedient: Mapping[IRI, str]
) -> Iterator[str]:
    """The tasks for people, and the components out of control of which none of them tells."""
    from selfconf.rdf.sparql import QUERY_PREFIXES
    from selfconf.render import disobedience_text, ecology_names

    owed = {component for one in found for component in one.owed}
    forgotten = {component: why for component, why in disobedient.items() if component not in owed}
    named = [iri for one in found for iri in (one.template, *one.components)]
    names, note = ecology_names(QUERY_PREFIXES, [*named, *forgotten])
    for depth, status in _nested(found):
        yield from ("    " * depth + line for line in _lines(status, deployed.get(status.configurator), names))
    yield from disobedience_text(forgotten, names)
    if note:
        yield note


def _nested(found: Sequence[Status]) -> Iterator[tuple[int, Status]]:
    """The tasks in order, each followed by those that its composites are inside, with how deep each of them lies."""
    waiting = [(0, one) for one in found if not _holders(one, found)]
    while waiting:
        depth, status = waiting.pop(0)
        yield depth, status
        waiting = [*((depth + 1, one) for one in found if status in _holders(one, found)), *waiting]


def _holders(inside: Status, found: Sequence[Status]) -> list[Status]:
    """The first task that holds the composite of which one is the inside, if it is one and that is known."""
    if inside.outside is None:
        return []
    return [one for one in found if inside.outside in one.components and one is not inside][:1]


def _lines(status: Status, deployed: Mapping[str, Any] | None, names: Names) -> Iterator[str]:
    """A task for people: its configurator, what is deployed, and what is wrong."""
    from selfconf.render import disobedience_text, duration

    phase = paint(status.phase, STATE_COLOURS.get(status.phase, ""))
    lasts = duration(time.time() - status.since)
    of = "" if status.outside is None else f"inside of {names(status.outside)}: "
    yield f"{of}{names(status.template)}: {phase} for {lasts}, epoch {status.epoch}"
    yield f"  task {status.name}, priority {status.priority}"
    yield f"  configurator {status.configurator}, process {status.process} on {status.host}"
    for line in map(names, status.components) if deployed is None else _configuration(deployed, status, names):
        yield f"  {line}"
    for lost, cause in status.lost.items():
        yield f"  lost: {names(IRI.unchecked(lost))} ({cause})"
    for slow, count in status.dropped.items():
        yield f"  too slow: {names(IRI.unchecked(slow))} has passed over {counted(count, 'signal')}"
    yield from (f"  {line}" for line in disobedience_text(dict.fromkeys(status.owed, ""), names))


def _configuration(body: Mapping[str, Any], status: Status, names: Names) -> Iterator[str]:
    """What is deployed: which values are bound, which component plays which role, and which feeds which."""
    for name, value in body["bindings"].items():
        yield f"{one_line(name)} = {_value(value, names)}"
    width = max((len(names(IRI.unchecked(role["role"]))) for role in body["roles"]), default=0)
    for role in body["roles"]:
        players = ", ".join(names(IRI.unchecked(one)) for one in role["components"])
        yield f"{names(IRI.unchecked(role['role'])):{width}}  {players}"
    for one in body["recruits"]:
        yield f"recruit: {names(IRI.unchecked(one))}"
    played = {*body["recruits"], *(one for role in body["roles"] for one in role["components"])}
    yield from (f"also held: {names(one)}" for one in status.components if one not in played)
    for wire in body["connections"]:
        source, sink = (names(IRI.unchecked(wire[end]["component"])) for end in ("from", "to"))
        yield f"{source} {one_line(wire['from']['output'])} -> {sink} {one_line(wire['to']['input'])}"


def _value(value: Any, names: Names) -> str:
    """A value as people read it: a short IRI, or a literal as JSON."""
    is_iri = isinstance(value, str) and value.startswith(("http://", "https://", "urn:"))
    return names(IRI.unchecked(value)) if is_iri else json.dumps(value, ensure_ascii=False)


def _body(status: Status, deployed: Mapping[str, Any]) -> dict[str, object]:
    return {
        "configurator": status.configurator,
        "phase": status.phase,
        "template": status.template,
        "inside_of": status.outside,
        "epoch": status.epoch,
        "since": status.since,
        "host": status.host,
        "process": status.process,
        "components": list(status.components),
        "lost": dict(status.lost),
        "task": status.name,
        "priority": status.priority,
        "beginning": status.beginning,
        "owed": list(status.owed),
        "dropped": dict(status.dropped),
        "bindings": deployed.get("bindings", {}),
        "roles": [{"role": one["role"], "components": one["components"]} for one in deployed.get("roles", ())],
        "recruits": deployed.get("recruits", []),
        "connections": deployed.get("connections", []),
    }
