"""`discover`: what is out there, as a table."""

from __future__ import annotations

import argparse
import json
from typing import NamedTuple

from selfconf.cli.options import add_ecology_arguments, complain_of, joined
from selfconf.model.term import IRI

EXAMPLE = """  selfconf discover --format json"""


class DiscoveredComponent(NamedTuple):
    """A component that is out there."""

    component: str
    types: list[IRI]
    site: str
    state: str


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The options of the command."""
    parser.add_argument("--format", choices=["table", "json"], default="table", help="default: %(default)s")
    add_ecology_arguments(parser)


def run(given: argparse.Namespace) -> int:
    """0 once the ecology has answered."""
    from selfconf.rdf.sparql import QUERY_PREFIXES
    from selfconf.rdf.vocabulary import SC
    from selfconf.render import Names, count, table

    with joined(given) as ecology:
        discovery = ecology.discover()
        complain_of(ecology)
        rows = [
            DiscoveredComponent(
                component,
                sorted(found.advertisement.profile.types - {SC.Component}),
                found.site,
                ecology.state(component),
            )
            for component, found in sorted(discovery.found.items())
        ]
    if given.format == "json":
        body = {"ecology": ecology.name, "components": [row._asdict() for row in rows], "sites": discovery.sites}
        print(json.dumps({**body, "missing": discovery.missing}, indent=2))
        return 0
    names = Names(QUERY_PREFIXES)
    kinds = [", ".join(names(kind) for kind in found.types) for found in rows]
    cells = [[row.component, kind, row.site, row.state] for row, kind in zip(rows, kinds, strict=True)]
    print(table(["component", "types", "site", "state"], cells))
    print(f"{count(len(rows), 'component')} at {count(len(discovery.sites), 'site')} of ecology {ecology.name}")
    return 0
