"""The living ecology for a command: find it, connect, ask, and leave."""

from __future__ import annotations

import argparse
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from functools import partial
from typing import TypeVar

from selfconf import rendezvous
from selfconf.bus.port import Bus, Replies
from selfconf.bus.zenoh_bus import client
from selfconf.cli.inputs import complain
from selfconf.discovery import Discovery, EcologyView
from selfconf.errors import NetworkError
from selfconf.model.term import IRI
from selfconf.rdf.advertisements import Advertisement

ANSWER = 3.0
"""How long, in seconds, a roll-call may take."""
PATIENCE = 20.0
"""How long, in seconds, a command waits for an answer that the bus itself should end earlier."""
T = TypeVar("T")


def add_connection_arguments(parser: argparse.ArgumentParser) -> None:
    """The options by which a command finds the living ecology."""
    parser.add_argument("--ecology", metavar="NAME", help="the ecology; by default the only one on this machine")
    parser.add_argument(
        "--connect",
        metavar="ENDPOINT",
        action="append",
        default=[],
        help="where a site listens, such as tcp/127.0.0.1:7447; repeatable; by default the sites on this machine",
    )


@contextmanager
def connected(given: argparse.Namespace) -> Iterator[EcologyView]:
    """The ecology that the arguments name. Raises NetworkError if there is none."""
    name, endpoints = rendezvous.find(given.ecology, given.connect)
    bus = client(endpoints)
    ecology = EcologyView(bus, name)
    try:
        sites: tuple[str, ...] = wait(bus, partial(bus.roll_call, ecology.keys.any_site_life(), ANSWER))
        if not sites:
            raise NetworkError(f"no site of the ecology {name!r} answers; is it the right name?")
        yield ecology
    finally:
        bus.close()


def wait(bus: Bus, begin: Callable[[Callable[[T], None]], None]) -> T:
    """Begin something that says when it is done, and let the bus run until then."""
    results: list[T] = []
    begin(results.append)
    deadline = bus.now() + PATIENCE
    bus.run(lambda: bool(results) or bus.now() > deadline)
    if not results:
        raise NetworkError("the ecology does not answer")
    return results[0]


def discover(ecology: EcologyView) -> Discovery:
    """Acts 1 and 2; complaints and sites that did not answer are named on stderr."""
    discovery = wait(ecology.bus, ecology.discover)
    for complaint in discovery.complaints:
        complain(complaint)
    for site in discovery.missing:
        complain(f"site {site} lives, but did not answer in full; what it advertises may be missing")
    return discovery


def advertised(discovery: Discovery) -> Mapping[IRI, Advertisement]:
    """The advertisements of a discovery by component."""
    return {component: found.advertisement for component, found in discovery.found.items()}


def ask(ecology: EcologyView, key: str, payload: bytes = b"", seconds: float = 3.0) -> Replies:
    """Ask and wait for all the replies."""

    def begin(done: Callable[[Replies], None]) -> None:
        ecology.bus.ask(key, payload, seconds, done)

    return wait(ecology.bus, begin)
