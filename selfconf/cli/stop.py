"""`stop`: takes down what is deployed, also what no configurator answers for any more."""

from __future__ import annotations

import argparse
import json

from selfconf.cli.live import add_connection_arguments, ask, connected, wait
from selfconf.cli.status import statuses
from selfconf.discovery import EcologyView
from selfconf.errors import NetworkError
from selfconf.protocol.keys import owner_of

NAME = "stop"
HELP = "take down what is deployed; components are turned off, not ended"
EXAMPLE = """  selfconf stop"""
TAKING_DOWN = 15.0
"""How long, in seconds, a configurator may take to release everything."""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The options of the command."""
    parser.add_argument("--configurator", metavar="NAME", help="only this one; by default all of the ecology")
    parser.add_argument("--format", choices=["text", "json"], default="text", help="default: %(default)s")
    add_connection_arguments(parser)


def run(given: argparse.Namespace) -> int:
    """0 when nothing is deployed any more."""
    with connected(given) as ecology:
        found = [s.configurator for s in statuses(ecology) if given.configurator in (None, s.configurator)]
        if given.configurator is not None and not found:
            raise NetworkError(f"no configurator {given.configurator!r} answers; `selfconf status` shows those that do")
        for name in found:
            ask(ecology, ecology.keys.configurator_call(name, "stop"))
        _gone(ecology, set(found))
    if given.format == "json":
        print(json.dumps({"ecology": ecology.keys.ecology, "stopped": found}, indent=2))
        return 0
    where = f"in ecology {ecology.keys.ecology}"
    print(f"took down {', '.join(found)} {where}" if found else f"nothing is deployed {where}")
    return 0


def _gone(ecology: EcologyView, names: set[str]) -> None:
    """Wait until the configurators have released everything and left."""
    bus = ecology.bus
    deadline = bus.now() + TAKING_DOWN
    while names:
        alive: tuple[str, ...] = wait(bus, lambda done: bus.roll_call(ecology.keys.any_configurator_life(), 3.0, done))
        names &= {owner_of(key) for key in alive}
        if bus.now() > deadline:
            raise NetworkError(f"{', '.join(sorted(names))} did not end after {TAKING_DOWN:.0f} s")
        bus.poll(0.02)
