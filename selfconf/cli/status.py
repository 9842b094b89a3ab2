"""`status`: what is deployed, by whom, since when."""

from __future__ import annotations

import argparse
import json
import time

from selfconf.cli import words
from selfconf.cli.inputs import complain
from selfconf.cli.live import add_connection_arguments, ask, connected
from selfconf.discovery import EcologyView
from selfconf.errors import PeerError
from selfconf.protocol.codec import decode
from selfconf.protocol.messages import Status
from selfconf.rdf.sparql import QUERY_PREFIXES

NAME = "status"
HELP = "show what is deployed, by whom, and since when"
EXAMPLE = """  selfconf status --format json"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The options of the command."""
    parser.add_argument("--format", choices=["text", "json"], default="text", help="default: %(default)s")
    add_connection_arguments(parser)


def run(given: argparse.Namespace) -> int:
    """0 once the ecology has answered, also if nothing is deployed."""
    with connected(given) as ecology:
        found = statuses(ecology)
    if given.format == "json":
        print(json.dumps([_body(status) for status in found], indent=2))
        return 0
    if not found:
        print(f"nothing is deployed in ecology {ecology.keys.ecology}")
    names = words.Names(QUERY_PREFIXES)
    for status in found:
        seconds = max(0.0, time.time() - status.since)
        print(f"{names(status.template)}: {status.phase} for {seconds:.0f} s, epoch {status.epoch}")
        print(f"  configurator {status.configurator}, process {status.process} on {status.host}")
        for component in status.components:
            print(f"  {names(component)}")
        for lost, cause in status.lost.items():
            print(f"  lost: {lost} ({cause})")
    return 0


def statuses(ecology: EcologyView) -> list[Status]:
    """What each configurator of the ecology says of itself, sorted by name."""
    found: list[Status] = []
    for sample in ask(ecology, ecology.keys.configurator_call("*", "status")).samples:
        try:
            status = decode(sample.payload, Status)
        except PeerError as error:
            complain(f"left out an answer: {error}")
            continue
        if sample.key == ecology.keys.configurator_call(status.configurator, "status"):
            found.append(status)
        else:
            complain(f"left out an answer on {sample.key}: it speaks of another configurator")
    return sorted(found, key=lambda status: status.configurator)


def _body(status: Status) -> dict[str, object]:
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
    }
