"""`site`: an init-component, which serves the advertisements of this host and watches the files."""

from __future__ import annotations

import argparse
import os
import secrets
from pathlib import Path

from selfconf import rendezvous
from selfconf.bus.zenoh_bus import ANYWHERE_ON_LOOPBACK, ZenohBus, router
from selfconf.cli import words
from selfconf.cli.inputs import complain, existing
from selfconf.errors import NetworkError
from selfconf.protocol.keys import checked_name
from selfconf.rendezvous import LocalSite
from selfconf.site import Shelf, Site
from selfconf.termination import Termination

NAME = "site"
HELP = "serve the advertisements of this host to an ecology, and watch their files"
EXAMPLE = """  selfconf site examples/peis-home --ecology home"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The options of the command."""
    parser.add_argument(
        "paths",
        metavar="PATH",
        type=Path,
        nargs="+",
        help="advertisements: files, or folders with *.ttl below them",
    )
    parser.add_argument("--ecology", metavar="NAME", required=True, help="the ecology that this site is part of")
    parser.add_argument("--name", metavar="SITE", help="the name of the site; by default one of its own")
    parser.add_argument(
        "--listen",
        metavar="ENDPOINT",
        help="where to listen; port 0 is any free one (default: on 127.0.0.1, at a port that goes with the name of the"
        " ecology, so that a site that is started again is found by those who were connected; if it is taken, at any)",
    )
    parser.add_argument(
        "--connect",
        metavar="ENDPOINT",
        action="append",
        default=[],
        help="where other sites listen; repeatable; those of the ecology on this machine are found by themselves",
    )


def run(given: argparse.Namespace) -> int:
    """Serve until SIGINT or SIGTERM; then 0."""
    for path in given.paths:
        existing(path)
    checked_name(given.ecology, "an ecology")
    name = checked_name(given.name or f"s{secrets.token_hex(3)}", "a site")
    shelf = Shelf(given.paths, complain)
    with rendezvous.turn():
        others = [meeting.endpoint for meeting in rendezvous.local_sites(given.ecology)]
        bus = _router(given.listen, given.ecology, list(dict.fromkeys([*given.connect, *others])))
        ending = Termination(bus)
        environment = rendezvous.environment(given.ecology, bus.endpoint)
        site = Site(bus, given.ecology, name, shelf, environment)
        meeting = rendezvous.announce(LocalSite(given.ecology, name, bus.endpoint, os.getpid()))
    count = len(site.shelf.advertisements)
    complain(f"site {name} of ecology {given.ecology} serves {words.count(count, 'advertisement')} on {bus.endpoint}")
    try:
        bus.run(ending)
    finally:
        rendezvous.leave(meeting)
        site.close()
    return 0


def _router(listen: str | None, ecology: str, connect: list[str]) -> ZenohBus:
    if listen is not None:
        return router(listen, connect)
    try:
        return router(rendezvous.usual_endpoint(ecology), connect)
    except NetworkError:  # somebody else has that port
        return router(ANYWHERE_ON_LOOPBACK, connect)
