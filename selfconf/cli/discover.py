"""`discover`: what is out there, as a table."""

from __future__ import annotations

import argparse
import json
from typing import NamedTuple

from selfconf.cli import words
from selfconf.cli.live import add_connection_arguments, connected, discover
from selfconf.discovery import EcologyView, FoundAdvertisement
from selfconf.model.term import IRI
from selfconf.rdf.sparql import QUERY_PREFIXES
from selfconf.rdf.vocabulary import SC

NAME = "discover"
HELP = "show what is out there: every advertised component, its site, and whether it lives"
EXAMPLE = """  selfconf discover --format json"""


class Row(NamedTuple):
    """A component that is out there."""

    component: IRI
    types: list[IRI]
    site: str
    state: str


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The options of the command."""
    parser.add_argument("--format", choices=["table", "json"], default="table", help="default: %(default)s")
    add_connection_arguments(parser)


def run(given: argparse.Namespace) -> int:
    """0 once the ecology has answered."""
    with connected(given) as ecology:
        discovery = discover(ecology)
        rows = [
            Row(
                component,
                sorted(found.advertisement.profile.types - {SC.Component}),
                found.site,
                state(ecology, component, found),
            )
            for component, found in sorted(discovery.found.items())
        ]
    if given.format == "json":
        body = {
            "ecology": ecology.keys.ecology,
            "components": [row._asdict() for row in rows],
            "sites": discovery.sites,
        }
        print(json.dumps({**body, "missing": discovery.missing}, indent=2))
        return 0
    names = words.Names(QUERY_PREFIXES)
    cells = [[str(row.component), ", ".join(names(kind) for kind in row.types), row.site, row.state] for row in rows]
    print(words.table(["component", "types", "site", "state"], cells))
    where = f"{words.count(len(discovery.sites), 'site')} of ecology {ecology.keys.ecology}"
    print(f"{words.count(len(rows), 'component')} at {where}")
    return 0


def state(ecology: EcologyView, component: IRI, found: FoundAdvertisement) -> str:
    """`alive`; `dormant` if its site can start it; `absent` if it is advertised, but nobody runs it."""
    if ecology.life(component) is not None:
        return "alive"
    return "dormant" if found.startable else "absent"
