"""`status`: what is deployed, by whom, since when."""

from __future__ import annotations

import argparse
import json
import time
from typing import TYPE_CHECKING

from selfconf.cli.options import add_ecology_arguments, complain_of, joined

if TYPE_CHECKING:
    from selfconf.protocol.messages import Status

EXAMPLE = """  selfconf status --format json"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The options of the command."""
    parser.add_argument("--format", choices=["text", "json"], default="text", help="default: %(default)s")
    add_ecology_arguments(parser)


def run(given: argparse.Namespace) -> int:
    """0 once every configurator has answered, also if nothing is deployed; 2 if one lives and does not answer."""
    from selfconf.model.term import IRI
    from selfconf.protocol.keys import task_name
    from selfconf.rdf.sparql import QUERY_PREFIXES
    from selfconf.render import Names

    with joined(given) as ecology:
        found = ecology.tasks
        complain_of(ecology)
    if given.format == "json":
        print(json.dumps([_body(status) for status in found], indent=2))
        return 2 if ecology.silent else 0
    if not found and not ecology.silent:
        print(f"nothing is deployed in ecology {ecology.name}")
    names = Names(QUERY_PREFIXES)
    for status in found:
        seconds = max(0.0, time.time() - status.since)
        print(f"{names(status.template)}: {status.phase} for {seconds:.0f} s, epoch {status.epoch}")
        print(f"  task {task_name(status.task)}, priority {status.priority}")
        print(f"  configurator {status.configurator}, process {status.process} on {status.host}")
        for component in status.components:
            print(f"  {names(component)}")
        for lost, cause in status.lost.items():
            print(f"  lost: {lost} ({cause})")
        for slow, count in status.dropped.items():
            print(f"  too slow: {names(IRI(slow))} has passed over {count} signals")
        for component in status.owed:
            print(f"  out of control: {names(component)} was turned off and has not obeyed")
    return 2 if ecology.silent else 0


def _body(status: Status) -> dict[str, object]:
    from selfconf.protocol.keys import task_name

    return {
        "configurator": status.configurator,
        "phase": status.phase,
        "template": status.template,
        "epoch": status.epoch,
        "since": status.since,
        "host": status.host,
        "process": status.process,
        "components": list(status.components),
        "lost": dict(status.lost),
        "task": task_name(status.task),
        "priority": status.priority,
        "beginning": status.beginning,
        "owed": list(status.owed),
        "dropped": dict(status.dropped),
    }
